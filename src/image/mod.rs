//! Pixels and pixel files.

/// A picture: rows from the top, each from the left; red, green, blue.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` values.
    pub pixels: Vec<[f64; 3]>,
}
