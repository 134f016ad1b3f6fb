//! `RD`: what a render found out about the scene.

super::codes! { RD:
    NOTHING_IN_VIEW = "RD001", Warning, "no ray of the camera hit anything",
        "The picture is all background. Most often the camera looks the wrong way, or stands inside or behind what it \
         should see. Check `eye`, `center` and the positions of the objects.";
    IMPRECISE = "RD002", Warning, "the arithmetic chosen is too coarse for the scene",
        "`--arithmetic plain` and `f32` show what ray tracers lose that bound no errors: formulas that cancel, and hits \
         within 1e-5 that count as none. Where the rounding of a point is larger than that, surfaces shade themselves; \
         where it is large beside the surface, curved ones lose their shape; where things are hardly larger than 1e-5, \
         rays pass through them. The warning is an estimate from the sizes and distances in the scene. Without the \
         option rtc bounds its errors, and none of this happens.";
    STUDIO = "RD003", Note, "the scene has no light, so it is shown in the studio",
        "A scene whose paths are traced is black without light. If it has no light of its own, no environment, and no \
         surface that glows enough to light the others (labels and eyes do not), it is shown in the studio: three soft \
         boxes in a dim room, the brightest from the left and above. `--env`, `--env-color` and `--sun` give other light; \
         `--env-color 0,0,0` is darkness.";
    BEYOND_FLOAT = "RD004", Warning, "an EXR can't hold values of the picture",
        "An EXR holds 32-bit floats, at most 3.4e38 in size. A channel has larger values, as the distances of a scene may \
         be; the file has the largest float in their place, so that no reader meets an infinity. Make the scene smaller: \
         a scene times a factor makes the same picture.";
    UNNUMBERED = "RD005", Warning, "pixels of the picture came out as no number",
        "Sums and products of the render left the range of its numbers, and infinity less infinity is no number. The \
         file has 0 there: black. With `--arithmetic f32` squares of lengths beyond 1e19 do that, so leave the option \
         out; else colours and coefficients are so large that light which is mirrored again and again grows without end.";
    RAYS_RAN_OUT = "RD006", Error, "the picture takes more rays than its limit",
        "Rays are counted while they are traced: those of the camera, those to lights, mirrored and refracted ones. Where \
         a ray branches at each bounce, as in glass, or into a lobe, their number grows as a power of the bounces, and \
         nobody can tell before how far. The finding names the first pixel, in the order of rows, up to which the \
         picture takes more than `--limit rays`, 2^32 unless another limit is set, and the key that makes them so many. \
         With `--verify-effects` each of the two renders has that limit; with `--time-budget` samples end there, and it \
         is found only if not even the crudest picture is done. `rtc cost` and `--allow-huge` have none.";
    EXPOSED = "RD007", Note, "the picture is shown brighter or darker than its values",
        "The lights of a glTF asset are in lux and candela: a sun has 100 000 lux, a white page in it a radiance of 30 000, \
         and 1 is white. So the PNG of an asset with lights of its own is exposed as a camera would: by whole thirds of a \
         stop, so that what is lit is a middle grey in the mean and hardly anything of it is clipped. The exposure is found \
         from 64 × 64 pixels of the whole view; it does not depend on the size, the part or the samples of the picture, and \
         is one for all pictures of a turntable. `--exposure` sets it. An EXR holds the values as they are.";
    NEVER_SEEN = "RD008", Warning, "no ray of any pixel meets an object",
        "The object lies outside the picture, shows in no mirror and casts no shadow, so the picture would be the same \
         without it. That is proven from its bounds, without a ray: an object without this warning may be hidden as well. \
         Check `eye`, `center` and the position. A plane written as a normal and a distance d holds the points whose \
         distance from the origin along the normal is d; in other programs the sign of d differs, or the normal's length \
         counts.";
    FILLED = "RD009", Note, "the studio fills in beside the light of the scene",
        "A glTF asset by itself that only glows, or has one weak lamp, leaves most of what is in the picture black. Where its \
         own light shows less than half of its surfaces, the studio stays as a fill light: half as bright, as the \
         picture is exposed. How much is seen is found from 64 × 64 pixels of the whole view; it does not depend on the size, \
         the part or the samples of the picture. `--studio on|off|fill` says which it is to be. `rtc cost` and `rtc compile` \
         do not look: there the studio fills in only if asked for.";
    FITTED = "RD010", Note, "the picture shows more than the camera of the asset sees",
        "A camera of glTF sees a picture of a certain shape. With `--size` of another shape the picture is fitted around what \
         the camera sees: nothing of that is cut off, and there is more of the scene at two sides.";
    TOO_SHORT = "RD011", Warning, "the time budget is too short",
        "`--time-budget` counts from the start of the program: reading and checking the scene, preparing it, sampling and \
         encoding the picture. If each pixel can't have a sample in that time, one pixel of a block of 8 × 8, 4 × 4 or 2 × 2 \
         is sampled and all of the block show it; no error is known of such a picture. The crudest picture is made in any \
         case, and a mode that takes one ray a pixel makes its picture to the end; where that is later than 5 % of the \
         budget and than 20 ms, the warning says how long it took.";
}
