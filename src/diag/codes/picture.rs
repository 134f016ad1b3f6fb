//! `RD`: what a render found out about the scene.

super::codes! { RD:
    NOTHING_IN_VIEW = "RD001", Warning, "no ray of the camera hit anything",
        "The picture is all background. Most often the camera looks the wrong way, or stands inside or behind what it \
         should see. Check `eye`, `center` and the positions of the objects.";
}
