//! `SY`: text that is not YAML.

super::codes! { SY:
    NOT_UTF8 = "SY001", Error, "the file is not UTF-8";
    SYNTAX = "SY002", Error, "the text is not YAML";
    UNCLOSED = "SY003", Error, "a bracket is not closed";
    CONTROL_CHARACTER = "SY004", Error, "the text has a control character";
    TWO_DOCUMENTS = "SY005", Error, "the file has more than one document";
    EMPTY_FILE = "SY006", Error, "the file is empty";
    DUPLICATE_KEY = "SY007", Error, "a map has the same key twice";
    SELF_ALIAS = "SY008", Error, "an alias stands inside its own anchor";
    NESTED_TOO_DEEP = "SY009", Error, "lists and maps are nested too deep";
    TOO_LONG = "SY010", Error, "a scalar is longer than 1 MiB";
    REPETITION = "SY011", Error, "aliases and merge keys make the scene too large";
    TAG = "SY012", Warning, "a tag has no effect in a scene";
}
