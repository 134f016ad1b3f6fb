//! Values of the pixels of a part of the picture, tile by tile, so that threads work on tiles that
//! are their own. Tiles are cut from the picture at multiples of [`Tiles::SIDE`], whatever part of
//! it is held.

use super::{Crop, Tiles};
use std::ops::Range;

/// One value a pixel, the pixels of a tile side by side in rows.
#[derive(Clone, Debug)]
pub(in crate::render) struct Tiled<K> {
    crop: Crop,
    pixels: Vec<K>,
}

impl<K: Clone> Tiled<K> {
    /// The same value in all pixels.
    #[must_use]
    pub(in crate::render) fn new(crop: Crop, value: K) -> Self {
        Self {
            crop,
            pixels: vec![value; crop.width as usize * crop.height as usize],
        }
    }
}

impl<K> Tiled<K> {
    /// The part of the picture that is held.
    #[must_use]
    pub(in crate::render) fn crop(&self) -> Crop {
        self.crop
    }

    /// How many pixels there are.
    #[must_use]
    pub(in crate::render) fn len(&self) -> usize {
        self.pixels.len()
    }

    /// The value of a pixel, counted row by row.
    #[must_use]
    pub(in crate::render) fn at(&self, index: usize) -> &K {
        let width = self.crop.width as usize;
        &self.pixels[self.place(index % width, index / width)]
    }

    /// The values tile by tile.
    #[must_use]
    pub(in crate::render) fn values(&self) -> &[K] {
        &self.pixels
    }

    /// The same, to be changed.
    pub(in crate::render) fn values_mut(&mut self) -> &mut [K] {
        &mut self.pixels
    }

    /// The values row by row.
    pub(in crate::render) fn iter(&self) -> impl Iterator<Item = &K> {
        (0..self.crop.height).flat_map(|row| self.row(row))
    }

    /// The values of a row of the part held: its pieces of one row of tiles.
    fn row(&self, row: u32) -> impl Iterator<Item = &K> {
        let Crop {
            x, width, height, ..
        } = self.crop;
        let (row, height) = (row as usize, height as usize);
        let (top, tile_height) = tile_around(self.crop.y, row, height);
        cuts(x, width).flat_map(move |columns| {
            let (left, piece) = ((columns.start - x) as usize, columns.len());
            let start = top * width as usize + left * tile_height + (row - top) * piece;
            &self.pixels[start..start + piece]
        })
    }

    /// All tiles, each with its rectangle of the picture and its values in rows.
    pub(in crate::render) fn tiles_mut(&mut self) -> Vec<(Crop, &mut [K])> {
        let mut rest = self.pixels.as_mut_slice();
        let cut = |area: Crop| {
            let length = area.width as usize * area.height as usize;
            let (tile, after) = std::mem::take(&mut rest).split_at_mut(length);
            rest = after;
            (area, tile)
        };
        tiles_of(self.crop).map(cut).collect()
    }

    /// Where the value of a pixel stands, given by its column and row in the part held.
    fn place(&self, column: usize, row: usize) -> usize {
        let (width, height) = (self.crop.width as usize, self.crop.height as usize);
        let (left, tile_width) = tile_around(self.crop.x, column, width);
        let (top, tile_height) = tile_around(self.crop.y, row, height);
        top * width + left * tile_height + (row - top) * tile_width + (column - left)
    }
}

/// The rectangles of the tiles of a part of the picture, row by row.
pub(in crate::render) fn tiles_of(crop: Crop) -> impl Iterator<Item = Crop> {
    let row = move |rows: Range<u32>| {
        cuts(crop.x, crop.width).map(move |columns| Crop {
            x: columns.start,
            y: rows.start,
            width: columns.end - columns.start,
            height: rows.end - rows.start,
        })
    };
    cuts(crop.y, crop.height).flat_map(row)
}

/// The start and the length of the tile around a place, both counted from `first`.
fn tile_around(first: u32, at: usize, count: usize) -> (usize, usize) {
    let (first, side) = (first as usize, Tiles::SIDE as usize);
    let start = (first + at) / side * side;
    let end = (start + side).min(first + count) - first;
    let start = start.saturating_sub(first);
    (start, end - start)
}

/// The stretches into which tiles cut `count` rows or columns from `first` on.
fn cuts(first: u32, count: u32) -> impl Iterator<Item = Range<u32>> {
    let end = first.saturating_add(count);
    let tiles = first / Tiles::SIDE..end.div_ceil(Tiles::SIDE);
    let cut = move |tile: u32| {
        let start = tile * Tiles::SIDE;
        start.max(first)..start.saturating_add(Tiles::SIDE).min(end)
    };
    tiles.filter(move |_| count > 0).map(cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_belongs_to_one_tile_and_is_found_again_by_its_row() {
        for (x, y, width, height) in [
            (0, 0, 16, 16),
            (5, 3, 40, 17),
            (15, 31, 1, 2),
            (7, 0, 3, 70),
        ] {
            let crop = Crop {
                x,
                y,
                width,
                height,
            };
            let mut tiled = Tiled::new(crop, [0, 0]);
            for (area, pixels) in tiled.tiles_mut() {
                assert_eq!(
                    area.x / Tiles::SIDE,
                    (area.x + area.width - 1) / Tiles::SIDE
                );
                assert_eq!(
                    area.y / Tiles::SIDE,
                    (area.y + area.height - 1) / Tiles::SIDE
                );
                for (index, pixel) in (0_u32..).zip(pixels) {
                    *pixel = [area.x + index % area.width, area.y + index / area.width];
                }
            }
            let rows = (y..y + height).flat_map(|y| (x..x + width).map(move |x| [x, y]));
            assert!(tiled.iter().copied().eq(rows), "{crop:?}");
        }
    }

    #[test]
    fn a_part_without_pixels_has_no_tiles() {
        let crop = Crop {
            x: 4,
            y: 4,
            width: 0,
            height: 9,
        };
        assert!(Tiled::new(crop, 0).tiles_mut().is_empty());
    }
}
