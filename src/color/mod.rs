//! Colour: display values and how they become integers.
