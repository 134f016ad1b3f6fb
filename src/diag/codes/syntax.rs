//! `SY`: text that is not YAML.

super::codes! { SY:
    NOT_UTF8 = "SY001", Error, "the file is not UTF-8",
        "Scene files are UTF-8 text, with or without a byte order mark. The label stands at the first byte that is not \
         UTF-8. Save the file as UTF-8 in your editor, or convert it with `iconv -t UTF-8`.";
}
