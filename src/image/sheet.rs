//! Pictures made small, and a contact sheet of many with their names beneath.

use super::Image;
use crate::color::quantize16;
use ::image::imageops::thumbnail;
use ::image::{ImageBuffer, Rgb};
use font8x8::{BASIC_FONTS, UnicodeFonts};

/// A picture of display values, of at most so many pixels across and down, of the same shape: each pixel the mean of those
/// it stands for. One that fits stays as it is.
#[must_use]
pub fn shrunk(image: Image, [width, height]: [u32; 2]) -> Image {
    if image.width <= width && image.height <= height {
        return image;
    }
    let sides = [image.width, image.height].map(u64::from);
    let most = [width, height].map(u64::from);
    let is_wide = sides[0] * most[1] >= sides[1] * most[0];
    let fitted = match is_wide {
        true => [most[0], sides[1] * most[0] / sides[0]],
        false => [sides[0] * most[1] / sides[1], most[1]],
    };
    let [width, height] = fitted.map(|side| u32::try_from(side.max(1)).unwrap_or(u32::MAX));
    // The crate rounds up floats as if they were whole numbers, so it is given those.
    let channels = image.pixels.into_iter().flatten().map(quantize16);
    let whole: Option<ImageBuffer<Rgb<u16>, Vec<u16>>> =
        ImageBuffer::from_raw(image.width, image.height, channels.collect());
    let small = thumbnail(&whole.unwrap_or_default(), width, height);
    let value = |channel: u16| f64::from(channel) / 65535.0;
    Image {
        width,
        height,
        pixels: small.pixels().map(|pixel| pixel.0.map(value)).collect(),
    }
}

/// The side of a glyph in pixels.
const GLYPH: usize = 8;

/// A picture of a sheet has at most so many pixels across and down, its name so many glyphs.
const PICTURE: [u32; 2] = [160, 120];
const NAME: usize = 160 / GLYPH;

/// The pixels of a cell, with a margin at its left and its top.
const MARGIN: usize = 8;
const CELL: [usize; 2] = [160 + MARGIN, 120 + 2 * MARGIN + GLYPH];

/// The most cells of a row.
const COLUMNS: usize = 8;

/// What is behind pictures, the place of one that is missing, and names.
const BEHIND: f64 = 0.1;
const MISSING: f64 = 0.25;
const INK: f64 = 0.9;

/// One picture that shows all, in rows, each in its shape with its name beneath; grey where there is
/// none. Names that are too long lose their beginning.
#[must_use]
pub fn contact_sheet(pictures: &[(String, Option<Image>)]) -> Image {
    let columns = pictures.len().clamp(1, COLUMNS);
    let rows = pictures.len().div_ceil(columns);
    let size = [columns * CELL[0] + MARGIN, rows * CELL[1] + MARGIN];
    let mut sheet = vec![[BEHIND; 3]; size[0] * size[1]];
    for (index, (name, picture)) in pictures.iter().enumerate() {
        let corner = [
            index % columns * CELL[0] + MARGIN,
            index / columns * CELL[1] + MARGIN,
        ];
        let mut put = |x: usize, y: usize, color| {
            sheet[(corner[1] + y) * size[0] + corner[0] + x] = color;
        };
        let [width, height] = PICTURE.map(|side| side as usize);
        match picture {
            Some(picture) => {
                let [wide, high] = [picture.width, picture.height].map(|side| side as usize);
                let [left, top] = [
                    (width.saturating_sub(wide)) / 2,
                    (height.saturating_sub(high)) / 2,
                ];
                for (at, color) in picture.pixels.iter().enumerate() {
                    put(left + at % wide, top + at / wide, *color);
                }
            }
            None => (0..width * height).for_each(|at| put(at % width, at / width, [MISSING; 3])),
        }
        for (place, letter) in shown_name(name).into_iter().enumerate() {
            let glyph = BASIC_FONTS.get(letter).unwrap_or_default();
            for (y, row) in glyph.into_iter().enumerate() {
                let lit = (0..GLYPH).filter(|x| row >> x & 1 == 1);
                lit.for_each(|x| put(place * GLYPH + x, height + MARGIN / 2 + y, [INK; 3]));
            }
        }
    }
    let [width, height] = size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    Image {
        width,
        height,
        pixels: sheet,
    }
}

/// The pictures of a sheet, as small as it shows them.
#[must_use]
pub fn for_sheet(image: Image) -> Image {
    shrunk(image, PICTURE)
}

/// The last letters of a name, those that the font lacks replaced.
fn shown_name(name: &str) -> Vec<char> {
    let known = |letter: char| match BASIC_FONTS.get(letter) {
        Some(_) => letter,
        None => '?',
    };
    let letters: Vec<char> = name.chars().map(known).collect();
    match letters.len().checked_sub(NAME) {
        None | Some(0) => letters,
        Some(over) => [vec!['~'], letters[over + 1..].to_vec()].concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, value: f64) -> Image {
        Image {
            width,
            height,
            pixels: vec![[value; 3]; (width * height) as usize],
        }
    }

    #[test]
    fn pictures_keep_their_shape() {
        let sides = |image: Image| [image.width, image.height];
        assert_eq!(sides(shrunk(grey(400, 100, 0.5), [160, 120])), [160, 40]);
        assert_eq!(sides(shrunk(grey(100, 400, 0.5), [160, 120])), [30, 120]);
        assert_eq!(sides(shrunk(grey(9000, 1, 0.5), [160, 120])), [160, 1]);
        assert_eq!(shrunk(grey(7, 9, 0.5), [160, 120]), grey(7, 9, 0.5));
        assert!(
            shrunk(grey(320, 240, 0.5), [160, 120])
                .pixels
                .iter()
                .all(|pixel| pixel.iter().all(|value| (value - 0.5).abs() < 1e-4))
        );
    }

    #[test]
    fn a_sheet_shows_each_picture_and_name() {
        let pictures: Vec<_> = (0..9)
            .map(|index| {
                (
                    format!("n{index}"),
                    (index != 4).then(|| grey(160, 120, 0.5)),
                )
            })
            .collect();
        let sheet = contact_sheet(&pictures);
        assert_eq!([sheet.width, sheet.height], [8 * 168 + 8, 2 * 144 + 8]);
        let count = |value: f64| {
            sheet
                .pixels
                .iter()
                .filter(|pixel| **pixel == [value; 3])
                .count()
        };
        assert_eq!([count(0.5), count(MISSING)], [8 * 160 * 120, 160 * 120]);
        assert!(count(INK) > 9 * 16, "each name has two letters");
        assert_eq!(contact_sheet(&[]).pixels.len(), (168 + 8) * 8);
    }

    #[test]
    fn long_names_lose_their_beginning() {
        let shown = |name: &str| shown_name(name).into_iter().collect::<String>();
        assert_eq!(shown("a-name-of-20-letters"), "a-name-of-20-letters");
        assert_eq!(shown("a-name-of-twenty-two-a"), "~ame-of-twenty-two-a");
        assert_eq!(shown("ж.png"), "?.png");
    }
}
