//! `PB`: scenes of pbrt.

super::codes! { PB:
    PBRT_SYNTAX = "PB001", Error, "the text of a pbrt scene has a mistake in its syntax";
    PBRT_VALUE = "PB002", Error, "a directive of a pbrt scene has a mistake";
    PBRT_PLUGIN = "PB003", Warning, "a part of a pbrt scene is not supported";
    PBRT_APPROXIMATE = "PB004", Warning, "a part of a pbrt scene is shown approximately";
    PBRT_IGNORED = "PB005", Warning, "a parameter of a pbrt scene has no effect";
    PBRT_DOUBTFUL = "PB006", Warning, "a part of a pbrt scene is probably not what was meant";
}
