//! `SC`: the shape of the document: keys, types, and what is missing.

super::codes! { SC:
    UNKNOWN_KEY = "SC001", Warning, "a key has no meaning here",
        "The key is not part of the format, so it is ignored and the picture is made without it. The scene format asks \
         for that, so that newer files stay readable. With `--strict` it is an error.";
    MISSING_KEY = "SC002", Error, "a key is missing",
        "The key has no default, because a picture made with a guess would be a wrong picture. Add it.";
    WRONG_TYPE = "SC003", Error, "a value is of the wrong type",
        "The message says what the key takes: a number, a list, a map, a truth value. Numbers are written without \
         quotes, and `true` and `false` are the only truth values. A key with nothing after its colon has no value.";
    WRONG_LENGTH = "SC004", Error, "a list has the wrong number of items",
        "Points, directions and colours are lists of exactly three numbers; the size of an image is a list of two.";
    UNKNOWN_WORD = "SC005", Error, "the key does not take this word",
        "The key takes one word of a list, which the hint gives. Upper and lower case don't matter.";
    UNKNOWN_TYPE = "SC006", Error, "there is no such type of object",
        "The object would be missing, and a picture with something missing is a wrong picture. With `--lenient` it is \
         left out with a warning.";
    UNSUPPORTED = "SC007", Error, "a part of the format is not supported by this version",
        "The format has this type or key, but this version of rtc can't show it yet. With `--lenient` it is left out \
         with a warning that says what is missing from the picture.";
    CONFLICTING_KEYS = "SC008", Error, "keys say the same thing more than once",
        "The format has several spellings for some keys, and several ways to give some shapes. Use one of them, so that \
         it is clear which one counts.";
    NOT_A_SCENE = "SC009", Error, "the file is no scene",
        "A scene is a map of keys and values: `Camera:`, `Lights:`, `Objects:` and so on. The document is a single word \
         or a list; or the file is something else by its first bytes, as a picture, a page of HTML or a pointer of \
         Git LFS, and the message says what.";
    SPELLING = "SC010", Note, "the file uses other spellings than the canonical ones",
        "Scene files of this family differ in spelling. All are read; `rtc compile --emit yaml` writes the canonical \
         ones.";
    NO_EFFECT = "SC011", Note, "a key has no effect with the other settings",
        "The key is read and checked, but another setting makes it irrelevant to this picture.";
    ASSUMED = "SC012", Warning, "the file does not say all, and something is assumed",
        "The message says what is missing and what is taken in its place. Write it out, so that the picture does not \
         depend on the assumption.";
    TWO_READINGS = "SC013", Warning, "a key has other meanings in other programs",
        "Programs for scenes of this family give some keys different meanings. The message says which one counts here, \
         so that the picture can be compared with that of the other program.";
}
