//! Pictures made small, and a contact sheet of many with their names beneath.

use super::Image;
use noto_sans_mono_bitmap::{
    FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width,
};
use rtc_color::quantize16;
use std::ops::Range;

/// A picture of display values, of at most this many pixels across and down, with the same aspect
/// ratio: each pixel is the mean of the pixels it covers. A picture that fits is unchanged.
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
    let columns: Vec<_> = (0..width).map(|x| span(image.width, width, x)).collect();
    let mut pixels = Vec::with_capacity(columns.len() * height as usize);
    for y in 0..height {
        let rows = span(image.height, height, y);
        let small = columns.iter().map(|columns| mean(&image, columns, &rows));
        pixels.extend(small);
    }
    Image {
        width,
        height,
        pixels,
    }
}

/// The pixels of a side that one of fewer pixels covers; at least one.
fn span(from: u32, to: u32, column: u32) -> Range<usize> {
    let ratio = from as f32 / to as f32;
    let start = column as f32 * ratio;
    let [start, end] = [start, start + ratio].map(|at| at.ceil() as usize);
    let from = from as usize;
    let start = start.min(from.saturating_sub(1));
    start..end.clamp(start + 1, from.max(start + 1))
}

/// The mean of a block of pixels, in whole numbers of 16 bits.
fn mean(image: &Image, columns: &Range<usize>, rows: &Range<usize>) -> [f64; 3] {
    let mut sums = [0_u64; 3];
    for y in rows.clone() {
        let row = image.pixels.iter().skip(y * image.width as usize);
        for pixel in row.skip(columns.start).take(columns.len()) {
            let channels = sums.iter_mut().zip(pixel);
            channels.for_each(|(sum, channel)| *sum += u64::from(quantize16(*channel)));
        }
    }
    let count = (columns.len() * rows.len()) as u64;
    sums.map(|sum| ((sum + count / 2) / count) as f64 / 65535.0)
}

/// The width and height of a glyph in pixels.
const GLYPH: [usize; 2] = [
    get_raster_width(FontWeight::Regular, RasterHeight::Size16),
    RasterHeight::Size16.val(),
];

/// The maximum width and height of a picture on a sheet in pixels, and the maximum length of its
/// name.
const PICTURE: [u32; 2] = [160, 120];
const NAME: usize = 160 / GLYPH[0];

/// The pixels of a cell, with a margin at its left and its top.
const MARGIN: usize = 8;
const CELL: [usize; 2] = [160 + MARGIN, 120 + 2 * MARGIN + GLYPH[1]];

/// The most cells of a row.
const COLUMNS: usize = 8;

/// The colours of the background, of a missing picture, and of names.
const BEHIND: f64 = 0.1;
const MISSING: f64 = 0.25;
const INK: f64 = 0.9;

/// One picture that shows all, in rows, each in its shape with its name beneath; grey where there
/// is none. Names that are too long lose their beginning.
#[must_use]
pub fn contact_sheet(pictures: &[(String, Option<Image>)]) -> Image {
    // Lay out the cells in a grid.
    let columns = pictures.len().clamp(1, COLUMNS);
    let rows = pictures.len().div_ceil(columns);
    let size = [columns * CELL[0] + MARGIN, rows * CELL[1] + MARGIN];
    let mut sheet = vec![[BEHIND; 3]; size[0] * size[1]];
    for (index, (name, picture)) in pictures.iter().enumerate() {
        let corner = [
            index % columns * CELL[0] + MARGIN,
            index / columns * CELL[1] + MARGIN,
        ];
        // Draw each picture centred in its cell.
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
        // Write its name below.
        for (column, letter) in shown_name(name).into_iter().enumerate() {
            let Some(glyph) = glyph(letter) else {
                continue;
            };
            for (y, row) in glyph.rows().enumerate() {
                for (x, share) in row.iter().enumerate() {
                    let ink = BEHIND + (INK - BEHIND) * f64::from(*share) / 255.0;
                    let at = [column * GLYPH[0] + x, height + MARGIN / 2 + y];
                    put(at[0], at[1], [ink; 3]);
                }
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

/// The glyph of a character, if the font has it.
fn glyph(letter: char) -> Option<RasterizedChar> {
    get_raster(letter, FontWeight::Regular, RasterHeight::Size16)
}

/// The last characters of a name, with those that the font lacks replaced.
fn shown_name(name: &str) -> Vec<char> {
    let known = |letter: char| match glyph(letter) {
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
    fn the_witness_shrinks_to_the_same_pixels() {
        use ::image::{ImageBuffer, Rgb, imageops::thumbnail};
        for [width, height] in [
            [161, 3],
            [200, 333],
            [321, 120],
            [640, 481],
            [1919, 1],
            [5, 997],
        ] {
            let count = u64::from(width * height);
            let value = |at: u64| ((at * 2_654_435_761) % 65_536) as u16;
            let whole: Vec<u16> = (0..count * 3).map(value).collect();
            let pixels = whole.as_chunks::<3>().0;
            let pixels = pixels
                .iter()
                .map(|pixel| pixel.map(|v| f64::from(v) / 65535.0));
            let shrunk_picture = shrunk(
                Image {
                    width,
                    height,
                    pixels: pixels.collect(),
                },
                [160, 120],
            );
            let whole: ImageBuffer<Rgb<u16>, _> =
                ImageBuffer::from_raw(width, height, whole).unwrap();
            let small = thumbnail(&whole, shrunk_picture.width, shrunk_picture.height);
            let small: Vec<_> = small.pixels().map(|pixel| pixel.0).collect();
            let shrunk_picture: Vec<_> = shrunk_picture
                .pixels
                .iter()
                .map(|pixel| pixel.map(quantize16))
                .collect();
            assert_eq!(shrunk_picture, small, "{width}×{height}");
        }
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
        assert_eq!([sheet.width, sheet.height], [8 * 168 + 8, 2 * 152 + 8]);
        let count = |value: f64| {
            sheet
                .pixels
                .iter()
                .filter(|pixel| **pixel == [value; 3])
                .count()
        };
        assert_eq!([count(0.5), count(MISSING)], [8 * 160 * 120, 160 * 120]);
        let is_written = |pixel: &&[f64; 3]| pixel[0] > 0.6;
        let written = sheet.pixels.iter().filter(is_written).count();
        assert!(written > 9 * 16, "each name has two letters");
        assert_eq!(contact_sheet(&[]).pixels.len(), (168 + 8) * 8);
    }

    #[test]
    fn long_names_lose_their_beginning() {
        let shown = |name: &str| shown_name(name).into_iter().collect::<String>();
        assert_eq!(shown("a-name-of-22-letters-x"), "a-name-of-22-letters-x");
        assert_eq!(shown("a-name-of-twenty-four-ab"), "~ame-of-twenty-four-ab");
        assert_eq!(shown("ж.png"), "?.png");
    }
}
