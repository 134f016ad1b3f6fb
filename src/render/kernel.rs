//! The compiled integrators, and the choice of the smallest one with all features of a plan.

use crate::film::heartbeat::OnPixel;
use crate::film::{Film, Job};
use crate::frame::picture::Sums;
use crate::integrator::path::Strategy;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
use rtc_plan::{Features, PathFeatures};
use std::ops::Range;

/// An integrator compiled for a set of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kernel {
    /// Its name.
    pub name: &'static str,
    /// Its features.
    pub features: Features,
}

const fn kernel(name: &'static str, features: Features) -> Kernel {
    Kernel { name, features }
}

const PHONG: Features = Features::LIGHT.with(Features::HIGHLIGHT);
const WHITTED: Features = PHONG
    .with(Features::SHADOW)
    .with(Features::BOUNCE)
    .with(Features::CAMERA);

/// The compiled integrators: `benches/kernels.md` has the measurements behind the selection.
pub const KERNELS: [Kernel; 7] = [
    kernel("phong", PHONG),
    kernel("phong, camera", PHONG.with(Features::CAMERA)),
    kernel("phong, shadows", PHONG.with(Features::SHADOW)),
    kernel(
        "diffuse, maps, camera",
        Features::LIGHT.with(Features::MAPS).with(Features::CAMERA),
    ),
    kernel("whitted, camera", WHITTED),
    kernel("whitted, maps, camera", WHITTED.with(Features::MAPS)),
    kernel("everything", Features::EVERYTHING),
];

/// The index of the integrator with the fewest features among those that have all of `needed`; the
/// first of equals.
#[must_use]
pub fn choose(needed: Features) -> usize {
    let able = (0..KERNELS.len()).filter(|index| KERNELS[*index].features.contains(needed));
    able.min_by_key(|index| KERNELS[*index].features.count())
        .unwrap_or(KERNELS.len() - 1)
}

/// Calls a method of a world with the features of one kernel of a table: the kernel chosen, or the
/// last one, which can do everything, if the shapes have no kernels of their own. The list of
/// indices must name all kernels of the table.
macro_rules! call_kernel {
    ($table:ident [$($index:literal)* / $last:literal], $chosen:expr, $world:ident.$method:ident $arguments:tt) => {{
        const { assert!([$($index,)* $last].len() == $table.len() && $last + 1 == $table.len()) };
        if S::HAS_KERNELS {
            match $chosen {
                $($index => $crate::kernel::call_kernel!(@ $table $index $world.$method $arguments),)*
                _ => $crate::kernel::call_kernel!(@ $table $last $world.$method $arguments),
            }
        } else {
            $crate::kernel::call_kernel!(@ $table $last $world.$method $arguments)
        }
    }};
    (@ $table:ident $index:literal $world:ident.$method:ident ($($argument:expr),*)) => {
        $world.$method::<{ $table[$index].features.0 }>($($argument),*)
    };
}
pub(crate) use call_kernel;

/// Calls a method of a world with the features of the integrator chosen.
macro_rules! dispatch {
    ($world:ident.$method:ident $arguments:tt) => {{
        use $crate::kernel::{KERNELS, choose};
        let chosen = choose($world.plan.features);
        $crate::kernel::call_kernel!(KERNELS[0 1 2 3 4 5 / 6], chosen, $world.$method $arguments)
    }};
}
pub(crate) use dispatch;

/// The sets of features that the path integrator is compiled for: diffuse surfaces, reflecting ones
/// without layers, and all.
pub const PATH_KERNELS: [PathKernel; 3] = [
    path_kernel("paths, diffuse", LIGHT_SAMPLING),
    path_kernel("paths, reflecting", REFLECTING),
    path_kernel("paths", PathFeatures::EVERYTHING),
];

/// A path integrator compiled for a set of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathKernel {
    /// Its name.
    pub name: &'static str,
    /// Its features.
    pub features: PathFeatures,
}

const LIGHT_SAMPLING: PathFeatures = PathFeatures::NEE.with(PathFeatures::SHADOWS);

const REFLECTING: PathFeatures = LIGHT_SAMPLING
    .with(PathFeatures::MICROFACETS)
    .with(PathFeatures::ALPHA);

const fn path_kernel(name: &'static str, features: PathFeatures) -> PathKernel {
    PathKernel { name, features }
}

/// The index of the path integrator with the fewest features that has all of `needed`.
#[must_use]
pub fn choose_for_paths(needed: PathFeatures) -> usize {
    let able = |kernel: &PathKernel| kernel.features.contains(needed);
    PATH_KERNELS
        .iter()
        .position(able)
        .unwrap_or(PATH_KERNELS.len() - 1)
}

/// Calls a method of a world with the features of the path integrator chosen.
macro_rules! dispatch_paths {
    ($world:ident.$method:ident $arguments:tt) => {{
        use $crate::kernel::{PATH_KERNELS, choose_for_paths};
        let everything = rtc_plan::PathFeatures::EVERYTHING;
        let needed = $world.plan.paths.as_ref().map_or(everything, |plan| plan.features);
        let chosen = choose_for_paths(needed);
        $crate::kernel::call_kernel!(PATH_KERNELS[0 1 / 2], chosen, $world.$method $arguments)
    }};
}
pub(super) use dispatch_paths;

impl<S: Intersect> World<S> {
    /// Renders on the threads of the current pool; see [`super::AnyWorld::render`].
    #[must_use]
    pub fn render(&self, job: &Job, on_pixel: &OnPixel<'_>) -> Option<Film> {
        self.whole(job, |samples, job| self.sum(samples, job, on_pixel))
    }

    /// As [`Self::render`], where paths are traced by another strategy.
    #[must_use]
    pub fn render_paths(
        &self,
        strategy: Strategy,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Film> {
        self.whole(job, |samples, job| {
            self.sum_paths(strategy, samples, job, on_pixel)
        })
    }

    /// Sums samples of the pixels, where their number is that of the scene, else all; `None` if
    /// `on_pixel` said stop.
    pub(crate) fn sum(
        &self,
        samples: &Range<u32>,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Sums> {
        if let Mode::Path(_) = self.settings.mode {
            return self.sum_paths(Strategy::Mis, samples, job, on_pixel);
        }
        dispatch!(self.sum_with(job, on_pixel))
    }

    fn sum_paths(
        &self,
        strategy: Strategy,
        samples: &Range<u32>,
        job: &Job,
        on_pixel: &OnPixel<'_>,
    ) -> Option<Sums> {
        dispatch_paths!(self.sum_paths_with(strategy, samples, job, on_pixel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_kernel_chosen_can_do_all_that_is_needed() {
        for needed in 0..=PathFeatures::EVERYTHING.0 {
            let chosen = choose_for_paths(PathFeatures(needed));
            let features = PATH_KERNELS[chosen].features;
            assert!(features.contains(PathFeatures(needed)), "{needed:b}");
            let mut smaller = PATH_KERNELS.iter().take(chosen);
            assert!(!smaller.any(|kernel| kernel.features.contains(PathFeatures(needed))));
        }
    }

    #[test]
    fn the_kernel_chosen_can_do_all_that_is_needed_and_no_smaller_one_can() {
        for needed in 0..1 << 9 {
            let needed = Features(needed);
            let chosen = KERNELS[choose(needed)].features;
            assert!(chosen.contains(needed), "{needed:?}: {chosen:?}");
            let smaller = KERNELS
                .iter()
                .filter(|kernel| kernel.features.contains(needed));
            assert!(
                smaller.map(|kernel| kernel.features.count()).min() == Some(chosen.count()),
                "{needed:?}"
            );
        }
    }
}
