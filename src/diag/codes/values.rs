//! `VA`: values that mean nothing, or surely not what was meant.

super::codes! { VA:
    NOT_FINITE = "VA001", Error, "a number is not finite or too large to compute with",
        "Every number of a scene must be finite, and lengths and coordinates must keep their squares within what a \
         64-bit float holds: at most 1e60 in size. An overflow would show as black or white pixels far from its cause.";
}
