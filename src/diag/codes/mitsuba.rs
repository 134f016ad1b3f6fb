//! `MI`: scenes of Mitsuba.

super::codes! { MI:
    MITSUBA_XML = "MI001", Error, "the text of a Mitsuba scene is not XML";
    MITSUBA_ELEMENT = "MI002", Error, "an element of a Mitsuba scene has a mistake";
    MITSUBA_PLUGIN = "MI003", Warning, "a plugin of a Mitsuba scene is not supported";
    MITSUBA_APPROXIMATE = "MI004", Warning, "a plugin of a Mitsuba scene is shown approximately";
    MITSUBA_IGNORED = "MI005", Warning, "a property of a Mitsuba scene has no effect";
    MITSUBA_DOUBTFUL = "MI006", Warning, "a value of a Mitsuba scene is probably not what was meant";
}
