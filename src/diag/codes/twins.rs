//! `EX`: what is written for other renderers.

super::codes! { EX:
    NO_TWIN = "EX001", Warning, "a part of the scene has no exact twin in the other renderer",
        "`rtc compile --emit mitsuba` and `--emit pov` write what the other renderer shows just so: Mitsuba 3 traces the \
         same paths between spheres, meshes, matt surfaces and mirrors, under suns, points and an even sky; POV-Ray has \
         Phong's model of the course with its shapes and lights. Each part that is left out, or that something near \
         stands for, is named in a warning of its own: the pictures differ there.";
}
