//! A picture as text for a terminal: each letter is two pixels, one above the other, in 24-bit
//! colours.

use super::super::{Failure, output};
use rtc_image::{DisplayedPicture, Image, shrunk};
use rtc_source::{Loader, SourceMap};
use std::fmt::Write;
use std::path::Path;

/// The largest picture file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 32;

/// The default width of a terminal, and the maximum length of a line.
const WIDTH: u32 = 80;
const WIDEST: u32 = 400;

/// Prints the picture of a file, as wide as the terminal at most.
pub(super) fn show(path: &Path) -> Result<(), Failure> {
    let trouble = |message: String| Failure::Failed(format!("`{}`: {message}", path.display()));
    let bytes = Loader.bytes(path, MAX_BYTES, &SourceMap::default());
    let bytes = bytes.map_err(|error| trouble(error.to_string()))?;
    let picture = DisplayedPicture::read(&bytes, u64::MAX);
    let picture = picture.map_err(|error| trouble(error.to_string()))?;
    let columns = std::env::var("COLUMNS").ok();
    let columns = columns.and_then(|columns| columns.parse().ok());
    let width = columns.unwrap_or(WIDTH).clamp(1, WIDEST);
    output::to_stdout(half_blocks(&shrunk(picture.image(), [width, width])).as_bytes())
}

/// The picture as lines of upper half blocks: the foreground is the upper pixel, the background the
/// lower one.
fn half_blocks(image: &Image) -> String {
    let mut text = String::new();
    let rows: Vec<_> = image.pixels.chunks(image.width.max(1) as usize).collect();
    for pair in rows.chunks(2) {
        for (x, upper) in pair[0].iter().enumerate() {
            let _ = write!(text, "\u{1b}[38;2;{}m", code(upper));
            // Below the last row is the background.
            if let Some(lower) = pair.get(1).map(|row| &row[x]) {
                let _ = write!(text, "\u{1b}[48;2;{}m", code(lower));
            }
            text.push('▀');
        }
        text += "\u{1b}[0m\n";
    }
    text
}

/// A colour as a terminal escape.
fn code(color: &[f64; 3]) -> String {
    color
        .map(|value| rtc_color::quantize8(value).to_string())
        .join(";")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rows_are_a_line() {
        let image = Image {
            width: 2,
            height: 3,
            pixels: [1.0, 0.0, 0.0, 1.0, 0.5, 0.5]
                .map(|value| [value, 0.0, 1.0])
                .to_vec(),
        };
        let lines = half_blocks(&image);
        assert_eq!(
            lines,
            "\u{1b}[38;2;255;0;255m\u{1b}[48;2;0;0;255m▀\u{1b}[38;2;0;0;255m\u{1b}[48;2;255;0;255m▀\u{1b}[0m\n\
             \u{1b}[38;2;127;0;255m▀\u{1b}[38;2;127;0;255m▀\u{1b}[0m\n"
        );
    }
}
