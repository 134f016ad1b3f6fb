//! Pictures for the HTML report as data URIs: the rendered tiles side by side, and their FLIP maps.

use super::super::difference::heat_map;
use super::super::flip::{PIXELS_PER_DEGREE, flip};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use rtc_image::{FileFormat, Image, Picture, shrunk};

/// Wider pictures are shrunk to this width, in pixels.
const WIDTH: u32 = 400;

/// The tiles side by side, as a PNG data URI.
pub(super) fn tiles(tiles: &[Image]) -> String {
    uri(&shrunk(mosaic(tiles), [WIDTH, u32::MAX]))
}

/// A single picture as a PNG data URI.
pub(super) fn wide(image: &Image) -> String {
    /// Wider pictures are shrunk to this width, in pixels.
    const WIDTH: u32 = 1600;
    uri(&shrunk(image.clone(), [WIDTH, u32::MAX]))
}

/// The FLIP map, from black for no difference to white for the largest.
pub(super) fn heat(test: &[Image], reference: &[Image]) -> String {
    let map = |(test, reference): (&Image, &Image)| {
        let flips = flip(reference, test, PIXELS_PER_DEGREE);
        heat_map([test.width, test.height], &flips)
    };
    tiles(&test.iter().zip(reference).map(map).collect::<Vec<_>>())
}

/// Tiles in a grid that is about square; black where there is none.
fn mosaic(tiles: &[Image]) -> Image {
    let side = |of: fn(&Image) -> u32| tiles.iter().map(of).max().unwrap_or(1);
    let (width, height) = (side(|tile| tile.width), side(|tile| tile.height));
    let columns = (1..=tiles.len())
        .find(|columns| columns * columns >= tiles.len())
        .unwrap_or(1);
    let rows = tiles.len().div_ceil(columns);
    let pixel = |x: usize, y: usize| {
        let tile = tiles.get(y / height as usize * columns + x / width as usize)?;
        let (x, y) = (x % width as usize, y % height as usize);
        tile.pixels
            .get(y * tile.width as usize + x)
            .filter(|_| x < tile.width as usize)
    };
    let size = [columns * width as usize, rows * height as usize];
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let pixels = places
        .map(|(x, y)| pixel(x, y).copied().unwrap_or([0.0; 3]))
        .collect();
    let [width, height] = size.map(|pixels| u32::try_from(pixels).unwrap_or(u32::MAX));
    Image {
        width,
        height,
        pixels,
    }
}

fn uri(image: &Image) -> String {
    // A picture that is too large to encode is omitted.
    let bytes = Picture::opaque(image.clone())
        .encode(FileFormat::Png8)
        .unwrap_or_default();
    format!("data:image/png;base64,{}", BASE64_STANDARD.encode(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mosaic_holds_every_tile_once() {
        let tile = |value: f64| Image {
            width: 2,
            height: 1,
            pixels: vec![[value; 3]; 2],
        };
        let mosaic = mosaic(&[tile(0.1), tile(0.2), tile(0.3)]);
        assert_eq!((mosaic.width, mosaic.height), (4, 2));
        let row = mosaic
            .pixels
            .iter()
            .map(|pixel| pixel[0])
            .collect::<Vec<_>>();
        assert_eq!(row, [0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.0, 0.0]);
    }

    #[test]
    fn a_wide_picture_is_shrunk_to_fit() {
        let wide = Image {
            width: 1001,
            height: 7,
            pixels: vec![[0.5; 3]; 7007],
        };
        let small = shrunk(wide, [WIDTH, u32::MAX]);
        assert_eq!(
            (small.width, small.height, small.pixels.len()),
            (400, 2, 400 * 2)
        );
    }
}
