//! From world to film: the one loop over tiles, on all threads of the pool. It renders whole
//! pictures, parts, growing pictures and layers.

pub(in crate::render) mod halves;
pub(in crate::render) mod layers;
pub(in crate::render) mod picture;
pub(in crate::render) mod progressive;
pub(in crate::render) mod verify;

use super::film::pixel::Accumulator;
use super::film::tile::{Open, Tile};
use super::film::tiled::Tiled;
use super::film::{Counts, Crop, Stride, Tiles};
use super::integrator::Integrator;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Which pixels of a film are rendered.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct Selection {
    /// The tiles wanted; `None` for all.
    pub(in crate::render) tiles: Option<Tiles>,
    /// The pixels wanted of them.
    pub(in crate::render) stride: Stride,
}

/// Renders the pixels selected, as `open` begins each of them, by integrators that `worker` makes;
/// the rays traced, or `None` if the observer said stop.
pub(in crate::render) fn run<'run, I, A>(
    film: &mut Tiled<A::Kept>,
    selection: Selection,
    worker: impl Fn() -> I + Sync + Send,
    open: &Open<'_, A>,
) -> Option<Counts>
where
    I: Integrator<'run>,
    A: Accumulator<Sample = I::Sample>,
{
    let crop = film.crop();
    let is_wanted = |[x, y]: [u32; 2]| selection.tiles.is_none_or(|tiles| tiles.contain([x, y]));
    let tiles = film.tiles_mut();
    let tiles: Vec<_> = tiles
        .filter(|(area, _)| is_wanted([area.x, area.y]))
        .collect();
    let render = |integrator: &mut I, (area, kept)| {
        let before = *integrator.counts();
        let mut tile = Tile::new([area, crop], selection.stride, kept, open);
        integrator
            .render(&mut tile)
            .then(|| integrator.counts().since(&before))
    };
    let counts = tiles.into_par_iter().map_init(worker, render);
    counts.try_reduce(Counts::default, |a, b| Some(a.plus(b)))
}

/// As [`run`], in tiles all over the picture; if the observer said stop, tiles that are not done are as
/// before. The rays traced, and whether all are done.
pub(in crate::render) fn run_tiles<'run, I, A>(
    film: &mut Tiled<A::Kept>,
    selection: Selection,
    worker: impl Fn() -> I + Sync + Send,
    open: &Open<'_, A>,
) -> (Counts, bool)
where
    I: Integrator<'run>,
    A: Accumulator<Sample = I::Sample>,
    A::Kept: Copy,
{
    let (crop, is_stopped) = (film.crop(), AtomicBool::new(false));
    let is_wanted = |[x, y]: [u32; 2]| selection.tiles.is_none_or(|tiles| tiles.contain([x, y]));
    let tiles = film.tiles_mut();
    let mut tiles: Vec<_> = tiles
        .filter(|(area, _)| is_wanted([area.x, area.y]))
        .collect();
    tiles.sort_unstable_by_key(|(area, _)| Tiles::rank(0, [area.x, area.y]));
    let render = |integrator: &mut I, (area, kept): (Crop, &mut [A::Kept])| {
        if is_stopped.load(Relaxed) {
            return (Counts::default(), false);
        }
        let (counts, before) = (*integrator.counts(), kept.to_vec());
        let mut tile = Tile::new([area, crop], selection.stride, &mut *kept, open);
        let is_done = integrator.render(&mut tile);
        if !is_done {
            // A pixel that was cut short is wrong.
            is_stopped.store(true, Relaxed);
            kept.copy_from_slice(&before);
            return (Counts::default(), false);
        }
        (integrator.counts().since(&counts), true)
    };
    let done = tiles.into_par_iter().map_init(worker, render);
    let both = |a: (Counts, bool), b: (Counts, bool)| (a.0.plus(b.0), a.1 && b.1);
    done.reduce(|| (Counts::default(), true), both)
}
