//! From world to film: the one loop over tiles, on all threads of the pool. It renders whole
//! pictures, parts, growing pictures and layers.

pub(in crate::render) mod layers;
pub(in crate::render) mod picture;
pub(in crate::render) mod progressive;
pub(in crate::render) mod verify;

use super::film::pixel::Accumulator;
use super::film::tile::{Open, Tile};
use super::film::tiled::Tiled;
use super::film::{Counts, Stride, Tiles};
use super::integrator::Integrator;
use rayon::prelude::*;

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
