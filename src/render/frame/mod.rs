//! The loop over tiles, on all threads of the pool.
//!
//! - `picture` renders complete and partial pictures, `progressive` refines one in rounds, `halves`
//!   renders the two halves for the denoiser, `layers` renders AOVs, and `verify` compares a plan
//!   with the
//!   unpruned picture.
//! - Each of them passes a [`PixelSelection`] of pixels, an accumulator and a maker of integrators
//!   to [`run`] or
//!   [`run_tiles`]. These distribute the tiles over the threads; each thread has an integrator of
//!   its
//!   own.
//!
//! A pixel's value does not depend on the thread or on the order of tiles. An observer is called
//! after each pixel and may stop the loop; then unfinished tiles are unchanged.

pub(crate) mod halves;
pub(crate) mod picture;
pub(crate) mod progressive;
pub(crate) mod verify;

use super::film::monitor::FilmMonitor;
use super::film::partial::FilmLayout;
use super::film::pixel::{PixelAccumulator, PixelSum};
use super::film::tile::{BeginPixel, Tile};
use super::film::tiled::TiledValues;
use super::film::{Crop, PixelStride, RayCounts, Tiles};
use super::integrator::Integrator;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Which pixels of a film are rendered.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PixelSelection {
    /// The requested tiles; `None` for all.
    pub(crate) tiles: Option<Tiles>,
    /// The requested pixels of them.
    pub(crate) stride: PixelStride,
}

/// A tile's position in the picture, and the state of its pixels.
type SavedTile<'film, K> = (Crop, &'film mut [K]);

impl PixelSelection {
    /// The requested tiles of a film.
    fn tiles_of<K>(self, film: &mut TiledValues<K>) -> Vec<SavedTile<'_, K>> {
        let is_wanted = |area: &Crop| self.tiles.is_none_or(|own| own.contain([area.x, area.y]));
        film.tiles_mut()
            .filter(|(area, _)| is_wanted(area))
            .collect()
    }
}

/// Makes the integrator of a thread.
pub(crate) type MakeIntegrator<'work, 'run, PixelSample> =
    dyn Fn() -> Box<dyn Integrator<'run, Sample = PixelSample> + 'work> + Sync + 'work;

/// Renders the selected pixels, as `open` begins each of them, by integrators that
/// `make_integrator` makes; returns the number of rays, or `None` if the observer said stop.
pub(crate) fn run<A: PixelAccumulator>(
    film: &mut TiledValues<A::PixelState>,
    selection: PixelSelection,
    make_integrator: &MakeIntegrator<'_, '_, A::Sample>,
    open: &BeginPixel<'_, A>,
) -> Option<RayCounts> {
    let crop = film.crop();
    let tiles = selection.tiles_of(film);
    let (counts, is_done) = share(tiles, make_integrator, &|integrator, (area, kept)| {
        integrator.render(&mut Tile::new([area, crop], selection.stride, kept, open))
    });
    is_done.then_some(counts)
}

/// As [`run`], where a monitor may show the film meanwhile.
pub(crate) fn run_monitored<A: PixelAccumulator<PixelState = PixelSum>>(
    (layout, film): (FilmLayout, &mut TiledValues<PixelSum>),
    monitor: Option<&FilmMonitor>,
    selection: PixelSelection,
    make_integrator: &MakeIntegrator<'_, '_, A::Sample>,
    open: &BeginPixel<'_, A>,
) -> Option<RayCounts> {
    let Some(monitor) = monitor else {
        return run(film, selection, make_integrator, open);
    };
    monitor.begin(layout);
    let (crop, tiles) = (film.crop(), film.take_tiles());
    let (counts, is_done) = share(
        tiles,
        make_integrator,
        &|integrator, (number, area, mut sums)| {
            let mut tile = Tile::new([area, crop], selection.stride, &mut sums, open);
            let is_done = integrator.render(&mut tile);
            if is_done {
                monitor.finish(number, sums);
            }
            is_done
        },
    );
    *film = monitor.end()?;
    is_done.then_some(counts)
}

/// As [`run`], in tiles distributed over the picture; if the observer said stop, unfinished tiles
/// are unchanged. Returns the number of rays, and whether all are done.
pub(crate) fn run_tiles<A: PixelAccumulator<PixelState: Copy>>(
    film: &mut TiledValues<A::PixelState>,
    selection: PixelSelection,
    make_integrator: &MakeIntegrator<'_, '_, A::Sample>,
    open: &BeginPixel<'_, A>,
) -> (RayCounts, bool) {
    let crop = film.crop();
    let mut tiles = selection.tiles_of(film);
    tiles.sort_unstable_by_key(|(area, _)| Tiles::rank(0, [area.x, area.y]));
    share(tiles, make_integrator, &|integrator, (area, kept)| {
        let before = kept.to_vec();
        let mut tile = Tile::new([area, crop], selection.stride, &mut *kept, open);
        let is_done = integrator.render(&mut tile);
        if !is_done {
            // A pixel that was cut short is wrong.
            kept.copy_from_slice(&before);
        }
        is_done
    })
}

/// Renders a tile; false if the observer said stop.
type RenderTile<'work, 'run, PixelSample, T> =
    dyn Fn(&mut (dyn Integrator<'run, Sample = PixelSample> + '_), T) -> bool + Sync + 'work;

/// Distributes tiles over the integrators of all threads: each renders the next remaining one,
/// until none is left or the observer said stop. Returns the rays of the finished tiles, and
/// whether all are finished.
fn share<'run, PixelSample: Copy, T: Send>(
    tiles: Vec<T>,
    make_integrator: &MakeIntegrator<'_, 'run, PixelSample>,
    render: &RenderTile<'_, 'run, PixelSample, T>,
) -> (RayCounts, bool) {
    let left = Mutex::new(tiles.into_iter());
    let next = || locked(&left).next();
    let done = Mutex::new((RayCounts::default(), true));
    on_all_threads(&|| {
        let mut integrator = make_integrator();
        let mut counts = RayCounts::default();
        while let Some(tile) = next() {
            let before = *integrator.counts();
            if !render(&mut *integrator, tile) {
                *locked(&left) = Vec::new().into_iter();
                locked(&done).1 = false;
                break;
            }
            counts = counts.plus(integrator.counts().since(&before));
        }
        let mut done = locked(&done);
        done.0 = done.0.plus(counts);
    });
    *locked(&done)
}

/// Does some work on all threads of the pool at once. Not generic, so that the code of rayon is
/// compiled once, not for each kind of film.
fn on_all_threads(work: &(dyn Fn() + Sync)) {
    rayon::scope(|scope| {
        for _ in 1..rayon::current_num_threads() {
            scope.spawn(|_| work());
        }
        work();
    });
}

/// A thread that panicked leaves no inconsistent state here.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
