//! The finished tiles of a picture that is being rendered.

use super::partial::{FilmLayout, Summation};
use super::pixel::PixelSum;
use super::tiled::{TiledValues, tiles_of};
use super::{Crop, Film, RayCounts};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Shows a picture while it is rendered: the threads hand over each tile that they finish, so that
/// nothing is copied or developed before it is asked for.
#[derive(Debug, Default)]
pub struct FilmMonitor(Mutex<Option<FilmSoFar>>);

/// The finished tiles.
type FilmSoFar = (FilmLayout, TiledValues<PixelSum>);

impl FilmMonitor {
    /// The film so far, without its counts, and the rectangles of its finished tiles in it, whose
    /// pixels are final. Other pixels are black. `None` before and after the render, where the value
    /// of a pixel depends on all others, and without memory.
    #[must_use]
    pub fn film(&self) -> Option<(Film, Vec<Crop>)> {
        /// The bytes per pixel of a copy of the film, the film developed, and its picture.
        const PIXEL: usize = 160;
        // Copied, so that no thread waits while the film is developed.
        let (layout, tiles) = {
            let so_far = self.lock();
            let (layout, tiles) = so_far.as_ref()?;
            let bytes = tiles.len().saturating_mul(PIXEL);
            let has_memory = Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
            if layout.summation == Summation::Distance || !has_memory {
                return None;
            }
            (*layout, tiles.clone())
        };
        let Crop { x, y, .. } = layout.crop;
        let finished = tiles_of(layout.crop).zip(tiles.tiles());
        let finished = finished.filter(|(_, tile)| !tile.is_empty());
        let finished = finished.map(|(area, _)| Crop {
            x: area.x - x,
            y: area.y - y,
            ..area
        });
        let finished = finished.collect();
        Some((layout.develop(&tiles, RayCounts::default()), finished))
    }

    /// Begins a film without tiles.
    pub(crate) fn begin(&self, layout: FilmLayout) {
        let none = TiledValues::empty(layout.crop, PixelSum::default());
        *self.lock() = Some((layout, none));
    }

    /// Takes over a finished tile, given its number.
    pub(crate) fn finish(&self, tile: usize, sums: Vec<PixelSum>) {
        if let Some((_, film)) = &mut *self.lock() {
            film.put(tile, sums);
        }
    }

    /// Gives back the tiles.
    pub(crate) fn end(&self) -> Option<TiledValues<PixelSum>> {
        self.lock().take().map(|(_, film)| film)
    }

    /// A thread that panicked leaves no inconsistent state here.
    fn lock(&self) -> MutexGuard<'_, Option<FilmSoFar>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
