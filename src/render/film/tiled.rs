//! Pixel values stored tile by tile, so that each thread owns its tile, and tiles that are not held
//! need no memory. Tiles start at multiples of [`Tiles::SIDE`] of the picture, for every crop.

use super::{Crop, Tiles};
use rayon::prelude::*;
use std::ops::Range;

/// One value a pixel of the tiles held, and one value for all pixels of the other tiles.
#[derive(Clone, Debug)]
pub(crate) struct TiledValues<K> {
    crop: Crop,
    /// For each tile the values in rows; empty for missing tiles.
    tiles: Vec<Vec<K>>,
    elsewhere: K,
}

impl<K: Clone + Send + Sync> TiledValues<K> {
    /// The same value in all pixels. Only the tiles given are held, all of them without. All
    /// threads of the pool fill them, as the system hands out their memory page by page.
    #[must_use]
    pub(crate) fn new(crop: Crop, held: Option<Tiles>, value: K) -> Self {
        let is_held = |area: &Crop| held.is_none_or(|tiles| tiles.contain([area.x, area.y]));
        let tile = |area: Crop| {
            let pixels = if is_held(&area) { area.pixels() } else { 0 };
            vec![value.clone(); pixels]
        };
        let areas: Vec<_> = tiles_of(crop).collect();
        Self {
            crop,
            tiles: areas.into_par_iter().map(tile).collect(),
            elsewhere: value,
        }
    }
}

impl<K> TiledValues<K> {
    /// No tile is held.
    pub(crate) fn empty(crop: Crop, elsewhere: K) -> Self {
        let tiles = tiles_of(crop).map(|_| Vec::new()).collect();
        Self {
            crop,
            tiles,
            elsewhere,
        }
    }

    /// The part of the picture.
    #[must_use]
    pub(crate) fn crop(&self) -> Crop {
        self.crop
    }

    /// The number of pixels of the part.
    #[must_use]
    pub(crate) fn len(&self) -> usize {
        self.crop.pixels()
    }

    /// The value of a pixel, counted row by row.
    #[must_use]
    pub(crate) fn at(&self, index: usize) -> &K {
        let width = self.crop.width as usize;
        let (column, row) = (index % width, index / width);
        let (tile_row, top, _) = tile_around(self.crop.y, row, self.crop.height as usize);
        let (tile_column, left, tile_width) = tile_around(self.crop.x, column, width);
        let tile = &self.tiles[tile_row * tiles_across(self.crop.x, self.crop.width) + tile_column];
        tile.get((row - top) * tile_width + (column - left))
            .unwrap_or(&self.elsewhere)
    }

    /// The values held, tile by tile.
    pub(crate) fn values(&self) -> impl Iterator<Item = &K> {
        self.tiles.iter().flatten()
    }

    /// The same, to be changed.
    pub(crate) fn values_mut(&mut self) -> impl Iterator<Item = &mut K> {
        self.tiles.iter_mut().flatten()
    }

    /// The values row by row.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &K> {
        (0..self.crop.height).flat_map(|row| self.row(row))
    }

    /// The values of a row: its pieces of one row of tiles.
    pub(super) fn row(&self, row: u32) -> impl Iterator<Item = &K> {
        let Crop {
            x, width, height, ..
        } = self.crop;
        let (tile_row, top, _) = tile_around(self.crop.y, row as usize, height as usize);
        let first = tile_row * tiles_across(x, width);
        let tiles = self.tiles[first..].iter().zip(cuts(x, width));
        tiles.flat_map(move |(tile, columns)| {
            let start = (row as usize - top) * columns.len();
            let place = move |column: usize| tile.get(start + column);
            (0..columns.len()).map(move |column| place(column).unwrap_or(&self.elsewhere))
        })
    }

    /// The tiles held, each with its rectangle of the picture and its values in rows.
    pub(crate) fn tiles_mut(&mut self) -> impl Iterator<Item = (Crop, &mut [K])> {
        let tiles = tiles_of(self.crop).zip(&mut self.tiles);
        let held = tiles.filter(|(_, tile)| !tile.is_empty());
        held.map(|(area, tile)| (area, tile.as_mut_slice()))
    }

    /// Takes the tiles held, each with its number and its rectangle of the picture.
    pub(crate) fn take_tiles(&mut self) -> Vec<(usize, Crop, Vec<K>)> {
        let tiles = tiles_of(self.crop).zip(&mut self.tiles).enumerate();
        let taken = tiles.map(|(tile, (area, values))| (tile, area, std::mem::take(values)));
        taken.filter(|(_, _, values)| !values.is_empty()).collect()
    }

    /// Stores the values of a tile, given its number.
    pub(crate) fn put(&mut self, tile: usize, values: Vec<K>) {
        self.tiles[tile] = values;
    }

    /// The values of each tile in rows, tile by tile; none where the tile is not held.
    pub(crate) fn tiles(&self) -> &[Vec<K>] {
        &self.tiles
    }

    /// As [`Self::tiles`].
    pub(crate) fn into_tiles(self) -> Vec<Vec<K>> {
        self.tiles
    }
}

/// The rectangles of the tiles of a part of the picture, row by row.
pub(crate) fn tiles_of(crop: Crop) -> impl Iterator<Item = Crop> {
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

/// The number of the tile around a position, its start and its length, all counted from `first`.
fn tile_around(first: u32, at: usize, count: usize) -> (usize, usize, usize) {
    let (first, side) = (first as usize, Tiles::SIDE as usize);
    let tile = (first + at) / side;
    let end = ((tile + 1) * side).min(first + count) - first;
    let start = (tile * side).saturating_sub(first);
    (tile - first / side, start, end - start)
}

/// The number of tiles per row.
fn tiles_across(first: u32, count: u32) -> usize {
    (first.saturating_add(count).div_ceil(Tiles::SIDE) - first / Tiles::SIDE) as usize
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
            let mut tiled = TiledValues::new(crop, None, [0, 0]);
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
        assert_eq!(TiledValues::new(crop, None, 0).tiles_mut().count(), 0);
    }

    #[test]
    fn a_tile_that_is_not_held_takes_no_memory_and_shows_the_value_of_all() {
        let crop = Crop {
            x: 5,
            y: 3,
            width: 100,
            height: 70,
        };
        let held = Tiles::shares([2, 3], 7);
        let mut tiled = TiledValues::new(crop, Some(held), 0);
        assert!(tiled.values().count() < crop.pixels() / 2);
        tiled.values_mut().for_each(|value| *value = 1);
        let pixels = (0..crop.height).flat_map(|y| (0..crop.width).map(move |x| [x, y]));
        let expected = pixels.map(|[x, y]| i32::from(held.contain([crop.x + x, crop.y + y])));
        assert!(tiled.iter().copied().eq(expected.clone()));
        assert!((0..tiled.len()).map(|index| *tiled.at(index)).eq(expected));
        assert!(
            tiled
                .tiles_mut()
                .all(|(area, _)| held.contain([area.x, area.y]))
        );
    }
}
