//! `IR`: files of the intermediate representation that can't be decoded.

super::codes! { IR:
    NEWER_VERSION = "IR001", Error, "the file was written by a newer rtc",
        "The intermediate representation carries a version. This rtc reads its own version and every older one; \
         `rtc -V` lists them. Use a newer rtc, or compile the scene again with this one.";
}
