//! `EX`: exports to other renderers.

super::codes! { EX:
    NO_TWIN = "EX001", Warning, "a part of the scene has no exact equivalent in the other renderer";
}
