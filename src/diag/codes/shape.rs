//! `SC`: the shape of the document: keys, types, and what is missing.

super::codes! { SC:
    UNKNOWN_KEY = "SC001", Warning, "a key has no meaning here",
        "The key is not part of the format, so it is ignored and the picture is made without it. The scene format asks \
         for that, so that newer files stay readable. With `--strict` it is an error.";
}
