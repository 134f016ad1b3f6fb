//! `RD`: diagnostics of rendering.

super::codes! { RD:
    NOTHING_IN_VIEW = "RD001", Warning, "no camera ray hits anything";
    IMPRECISE = "RD002", Warning, "the chosen arithmetic is too coarse for the scene";
    STUDIO = "RD003", Note, "the scene has no light and is shown in the studio";
    BEYOND_FLOAT = "RD004", Warning, "the picture has values that an EXR file cannot hold";
    UNNUMBERED = "RD005", Warning, "pixels of the picture are not a number";
    RAYS_RAN_OUT = "RD006", Error, "the picture takes more rays than its limit";
    EXPOSED = "RD007", Note, "the exposure of the picture is automatic";
    NEVER_SEEN = "RD008", Warning, "no ray of any pixel hits an object";
    FILLED = "RD009", Note, "the studio adds fill light to the light of the asset";
    FITTED = "RD010", Note, "the picture shows more than the camera of the scene";
    TOO_SHORT = "RD011", Warning, "the time budget is too short";
    UNTEXTURED = "RD012", Warning, "a surface has no texture coordinates for its texture";
    Z_UP = "RD013", Warning, "a mesh stands as if z pointed up";
    CAUSTICS = "RD014", Note, "caustics of a small light are found by chance, or not at all";
    CLOSED_ROOM = "RD015", Note, "no light gets into a closed room that the camera looks into";
    FLAT = "RD016", Warning, "pictures that are compared are of one value each";
    UNMET = "RD017", Warning, "a picture ends above its target error";
    DARK = "RD018", Warning, "all surfaces in view are black";
    UNSAMPLED = "RD019", Note, "light of infinite faces of a solid is found by chance";
}
