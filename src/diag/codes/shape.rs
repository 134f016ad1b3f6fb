//! `SC`: the structure of the document: keys, types, and missing parts.

super::codes! { SC:
    UNKNOWN_KEY = "SC001", Warning, "a key is unknown";
    MISSING_KEY = "SC002", Error, "a key is missing";
    WRONG_TYPE = "SC003", Error, "a value has the wrong type";
    WRONG_LENGTH = "SC004", Error, "a list has the wrong number of items";
    UNKNOWN_WORD = "SC005", Error, "a key does not take this keyword";
    UNKNOWN_TYPE = "SC006", Error, "the type of an object is unknown";
    UNSUPPORTED = "SC007", Error, "a part of the format is not supported";
    CONFLICTING_KEYS = "SC008", Error, "two keys give the same setting";
    NOT_A_SCENE = "SC009", Error, "the file is not a scene";
    SPELLING = "SC010", Note, "the file uses other spellings than the canonical ones";
    NO_EFFECT = "SC011", Note, "a key has no effect with the other settings";
    ASSUMED = "SC012", Warning, "a value is missing and is assumed";
    KEY_READ_DIFFERENTLY = "SC013", Warning, "other programs read this key differently";
}
