//! `IR`: files of the intermediate representation that can't be decoded.

super::codes! { IR:
    NEWER_VERSION = "IR001", Error, "the file was written by a newer rtc";
    NOT_JSON = "IR002", Error, "the text of an IR file is not JSON";
    WRONG_SHAPE = "IR003", Error, "an IR file does not follow the schema of its version";
    WRONG_MAGIC = "IR004", Error, "the first bytes of an IR file are damaged";
    TRUNCATED = "IR005", Error, "an IR file is cut off";
    DAMAGED = "IR006", Error, "a checksum of an IR file is wrong";
    MALFORMED = "IR007", Error, "the parts of an IR file contradict each other";
}
