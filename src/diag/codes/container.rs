//! `IR`: files of the intermediate representation that can't be decoded.

super::codes! { IR:
    NEWER_VERSION = "IR001", Error, "the file was written by a newer rtc",
        "The intermediate representation carries a version. This rtc reads its own version and every older one; \
         `rtc -V` lists them. Use a newer rtc, or compile the scene again with this one.";
    NOT_JSON = "IR002", Error, "an IR text is not JSON",
        "The text form of the intermediate representation is JSON (RFC 8259), with `irVersion` as its first key. The \
         label stands at the first byte that can't be. A number that no 64-bit float holds, as 1e400, is refused too. \
         If the file was edited by hand, look for a missing comma or quote; else compile the scene again.";
    WRONG_SHAPE = "IR003", Error, "an IR file holds something else than its version prescribes",
        "A key is missing, unknown or written twice, or a value is of the wrong type. `rtc schema ir` prints the shape \
         of the text form as a JSON Schema, which editors understand. The range of numbers is checked later.";
    WRONG_MAGIC = "IR004", Error, "the first bytes of an IR file are damaged",
        "A binary IR file starts with the eight bytes 89 52 54 49 0d 0a 1a 0a. They are chosen so that the common ways \
         to spoil a binary file show in them: line ends turned from CR LF to LF or back, the eighth bit cut off, the \
         bytes taken for text and written as UTF-8. Copy the file again as binary.";
    TRUNCATED = "IR005", Error, "an IR file ends too early",
        "The file is shorter than its own table of contents says: a copy or download was cut off, or the disk was \
         full. Copy the file again, or compile the scene again.";
    DAMAGED = "IR006", Error, "a checksum of an IR file is wrong",
        "Every byte of a binary IR file is guarded: the header by a CRC-32, each section by an XXH3 hash, and the \
         padding between them must be zero. At least one bit has changed since the file was written, so nothing in it \
         can be trusted. Copy the file again, or compile the scene again.";
    MALFORMED = "IR007", Error, "the parts of an IR file don't fit together",
        "The checksums are right, but what they guard makes no sense: sections that overlap, are not aligned or lie \
         outside the file, a table that names a section that isn't there or has another length, a number that is not \
         finite. The program that wrote the file has a fault; if that was rtc, please report it.";
}
