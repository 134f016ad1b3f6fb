//! `SY`: text that is not YAML.

super::codes! { SY:
    NOT_UTF8 = "SY001", Error, "the file is not UTF-8",
        "Scene files are UTF-8 text, with or without a byte order mark. The label stands at the first byte that is not \
         UTF-8. Save the file as UTF-8 in your editor, or convert it with `iconv -t UTF-8`.";
    SYNTAX = "SY002", Error, "the text is not YAML",
        "The parser could not go on at the place of the label. Most often a colon lacks the space after it, a line is \
         indented differently from its neighbours, or a quote is not closed. Only the first such place is reported, \
         because what follows it can't be understood.";
    UNCLOSED = "SY003", Error, "a bracket is never closed",
        "A `[` or `{` has no partner. The label stands at the bracket, not at the place far below where the parser \
         gave up.";
    CONTROL_CHARACTER = "SY004", Error, "the text holds a control character",
        "YAML allows tabs and line ends, but no other control characters, and no NUL. Such a character is invisible in \
         most editors; the message gives its number. It often means that the file is not text at all.";
    TWO_DOCUMENTS = "SY005", Error, "the file holds more than one document",
        "A line `---` starts a new document. One may stand at the top of the file; a second would make a second scene, \
         and a file is one scene.";
    EMPTY_FILE = "SY006", Error, "the file holds no scene",
        "There is nothing in the file but comments and blank lines. A scene has at least a camera.";
    DUPLICATE_KEY = "SY007", Error, "a key stands twice in one map",
        "Only one of the two could count, and readers of YAML do not agree on which. Remove one.";
    SELF_ALIAS = "SY008", Error, "an alias refers to what it stands in",
        "An alias `*name` stands for the value marked `&name`. Inside that value it would never end.";
    NESTED_TOO_DEEP = "SY009", Error, "lists and maps lie too deep in each other",
        "A scene needs a depth of about 6; this text passed the limit of 128. Most often a bracket was typed too often.";
    TOO_LONG = "SY010", Error, "a word is longer than a MiB",
        "No value of a scene is that long, so this is most likely not a scene file.";
    REPETITION = "SY011", Error, "aliases and merge keys make the scene too large",
        "Aliases and merge keys may be used freely, but what they repeat must stay in proportion to the file, so that a \
         small file can't stop the machine.";
    TAG = "SY012", Warning, "a tag has no meaning in a scene",
        "A tag such as `!!float` would set the type of a value. The types of a scene are given by its keys, so tags are \
         ignored.";
}
