//! Pictures in tiles (UDIM): `c.<UDIM>.png` stands for `c.1001.png`, `c.1002.png` and so on, one
//! for each unit square of the texture coordinates, ten in a row. They become one picture.

use super::Lowering;
use super::texture::{INSTEAD, TEXTURES};
use crate::exchange::SpannedText;
use rtc_image::{Pixels, is_radiance};
use rtc_source::{Resource, Span};
use std::rc::Rc;

/// What stands for the number of a tile in a path.
const MARK: &str = "<UDIM>";
/// The number of the first tile.
const FIRST: u32 = 1001;
/// The tiles of a row, and the rows that are looked for, as OpenUSD does.
const COLUMNS: u32 = 10;
const ROWS: u32 = 10;

/// The tiles of a picture that are there.
#[derive(Debug)]
pub(super) struct TileGrid {
    columns: u32,
    rows: u32,
    /// The column and the row, from the bottom, and the path.
    tiles: Vec<([u32; 2], String)>,
}

impl TileGrid {
    /// The map from the texture coordinates to those of the one picture.
    pub(super) fn rows(&self) -> [[f64; 3]; 2] {
        let [u, v] = [self.columns, self.rows].map(|count| 1.0 / f64::from(count));
        [[u, 0.0, 0.0], [0.0, v, 0.0]]
    }
}

impl Lowering<'_> {
    /// The tiles of a path with a mark for their numbers; `None` for other paths, and without a
    /// tile.
    pub(super) fn tile_grid(&mut self, path: &SpannedText, layer: usize) -> Option<Rc<TileGrid>> {
        if !path.text.contains(MARK) {
            return None;
        }
        let key = (layer, path.text.clone());
        if let Some(known) = self.tile_grids.get(&key) {
            return known.clone();
        }
        let mut tiles = Vec::new();
        for index in 0..COLUMNS * ROWS {
            let tile = SpannedText {
                text: path.text.replace(MARK, &(FIRST + index).to_string()),
                span: path.span,
            };
            if self.exists(&tile, layer, &TEXTURES) {
                tiles.push(([index % COLUMNS, index / COLUMNS], tile.text));
            }
        }
        let most = |axis: usize| tiles.iter().map(|(place, _)| place[axis]).max();
        let grid = most(0).zip(most(1)).map(|(column, row)| TileGrid {
            columns: column + 1,
            rows: row + 1,
            tiles,
        });
        let grid = grid.map(Rc::new);
        self.tile_grids.insert(key, grid.clone());
        grid
    }

    /// The one picture of some tiles, all as large as the largest; black where there is none.
    /// `None` if one cannot be read, which is reported.
    pub(super) fn tiled(&mut self, grid: &TileGrid, layer: usize, span: Span) -> Option<Pixels> {
        let mut tiles = Vec::new();
        for (place, path) in &grid.tiles {
            let path = SpannedText {
                text: path.clone(),
                span,
            };
            let bytes = self.file(&path, layer, &TEXTURES, INSTEAD)?;
            if is_radiance(&bytes) {
                self.report(
                    &rtc_diag::codes::USD_UNSUPPORTED,
                    span,
                    format!("tiles of radiance are not read: {INSTEAD}"),
                );
                return None;
            }
            tiles.push((*place, self.decoded(&path, &bytes)?));
        }
        let width = tiles.iter().map(|(_, tile)| tile.width).max()?;
        let height = tiles.iter().map(|(_, tile)| tile.height).max()?;
        let [columns, rows] = [
            u64::from(grid.columns) * u64::from(width),
            u64::from(grid.rows) * u64::from(height),
        ];
        self.charge(Resource::Textures, 4 * columns * rows, span)?;
        let (columns, rows) = (u32::try_from(columns).ok()?, u32::try_from(rows).ok()?);
        let mut bytes = [0, 0, 0, 255].repeat(columns as usize * rows as usize);
        for ([column, row], tile) in &tiles {
            let size = if tile.has_alpha { 4 } else { 3 };
            let [w, h] = [tile.width, tile.height].map(|side| side as usize);
            let [left, top] = [column * width, (grid.rows - 1 - row) * height];
            for y in 0..height as usize {
                for x in 0..width as usize {
                    let from = y * h / height as usize * w + x * w / width as usize;
                    let to = (top as usize + y) * columns as usize + left as usize + x;
                    let texel = &tile.bytes[from * size..][..size];
                    bytes[4 * to..][..size].copy_from_slice(texel);
                }
            }
        }
        Some(Pixels {
            width: columns,
            height: rows,
            has_alpha: true,
            bytes,
        })
    }
}
