//! The compiled integrators, and the choice of the smallest one with all features of a plan.

use crate::film::heartbeat::PixelObserver;
use crate::film::{Film, RenderSelection};
use crate::frame::picture::PictureSums;
use crate::integrator::path::SamplingStrategy;
use crate::shape::geometry::Intersect;
use crate::world::World;
use crate::world::settings::Mode;
use rtc_plan::{PathFeatures, WhittedFeatures};
use std::ops::Range;

/// An integrator compiled for a set of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kernel<F = WhittedFeatures> {
    /// Its name.
    pub name: &'static str,
    /// Its features.
    pub features: F,
}

/// Work that is compiled for each kernel of a table.
pub(crate) trait KernelTask: Sized {
    /// Whether there is a kernel for each row, or only the last one, which can do everything.
    const HAS_KERNELS: bool;

    /// What the work gives.
    type Output;

    /// Does the work by an integrator with the features `F`.
    fn run<const F: u32>(self) -> Self::Output;
}

/// Declares a table of kernels and the function that runs one of them, from the same rows. The last
/// kernel can do everything.
macro_rules! kernels {
    (
        $(#[$doc:meta])*
        $table:ident: $Features:ident, $run:ident;
        $($name:literal: $features:expr,)*
    ) => {
        $(#[$doc])*
        pub const $table: &[Kernel<$Features>] = &[
            $(Kernel { name: $name, features: $features },)*
        ];

        /// Does some work by the kernel with an index.
        pub(crate) fn $run<T: KernelTask>(index: usize, task: T) -> T::Output {
            if T::HAS_KERNELS {
                let mut rows = 0..;
                $(if rows.next() == Some(index) {
                    return task.run::<{ $features.0 }>();
                })*
            }
            task.run::<{ $Features::EVERYTHING.0 }>()
        }

        const _: () = assert!($table[$table.len() - 1].features.contains($Features::EVERYTHING));
    };
}

const PHONG: WhittedFeatures = WhittedFeatures::LIGHT.with(WhittedFeatures::HIGHLIGHT);
const WHITTED: WhittedFeatures = PHONG
    .with(WhittedFeatures::SHADOW)
    .with(WhittedFeatures::BOUNCE)
    .with(WhittedFeatures::CAMERA);

kernels! {
    /// The compiled integrators: `benches/kernels.md` has the measurements behind the selection.
    KERNELS: WhittedFeatures, run;
    "phong": PHONG,
    "phong, camera": PHONG.with(WhittedFeatures::CAMERA),
    "phong, shadows": PHONG.with(WhittedFeatures::SHADOW),
    "diffuse, maps, camera": WhittedFeatures::LIGHT.with(WhittedFeatures::MAPS).with(WhittedFeatures::CAMERA),
    "whitted, camera": WHITTED,
    "whitted, maps, camera": WHITTED.with(WhittedFeatures::MAPS),
    "everything": WhittedFeatures::EVERYTHING,
}

/// The index of the integrator with the fewest features among those that have all of `needed`; the
/// first of equals.
#[must_use]
pub fn choose(needed: WhittedFeatures) -> usize {
    let able = (0..KERNELS.len()).filter(|index| KERNELS[*index].features.contains(needed));
    able.min_by_key(|index| KERNELS[*index].features.count())
        .unwrap_or(KERNELS.len() - 1)
}

const LIGHT_SAMPLING: PathFeatures = PathFeatures::NEE.with(PathFeatures::SHADOWS);

kernels! {
    /// The path integrators: for diffuse surfaces, for reflecting ones without layers, for all
    /// surfaces, and for these in media.
    PATH_KERNELS: PathFeatures, run_paths;
    "paths, diffuse": LIGHT_SAMPLING,
    "paths, reflecting": LIGHT_SAMPLING
        .with(PathFeatures::MICROFACETS)
        .with(PathFeatures::ALPHA),
    "paths": LIGHT_SAMPLING
        .with(PathFeatures::MICROFACETS)
        .with(PathFeatures::ALPHA)
        .with(PathFeatures::TRANSMISSION)
        .with(PathFeatures::LAYERS),
    "paths, media": PathFeatures::EVERYTHING,
}

/// The index of the path integrator with the fewest features that has all of `needed`.
#[must_use]
pub fn choose_for_paths(needed: PathFeatures) -> usize {
    let able = |kernel: &Kernel<PathFeatures>| kernel.features.contains(needed);
    PATH_KERNELS
        .iter()
        .position(able)
        .unwrap_or(PATH_KERNELS.len() - 1)
}

impl<S: Intersect> World<S> {
    /// Renders on the threads of the current pool; see [`super::AnyWorld::render`].
    #[must_use]
    pub fn render(&self, job: &RenderSelection, on_pixel: &PixelObserver<'_>) -> Option<Film> {
        self.whole(job, |samples, job| self.sum(samples, job, on_pixel))
    }

    /// As [`Self::render`], where paths are traced by another strategy.
    #[must_use]
    pub fn render_paths(
        &self,
        strategy: SamplingStrategy,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
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
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PictureSums> {
        if let Mode::Path(_) = self.settings.mode {
            return self.sum_paths(SamplingStrategy::Mis, samples, job, on_pixel);
        }
        self.run(Sum(self, job, on_pixel))
    }

    /// Does some work by the kernel for the plan.
    pub(crate) fn run<T: KernelTask>(&self, task: T) -> T::Output {
        run(choose(self.plan.features), task)
    }

    /// Does some work by the path kernel for the plan.
    pub(crate) fn run_paths<T: KernelTask>(&self, task: T) -> T::Output {
        let plan = self.plan.paths.as_ref();
        let needed = plan.map_or(PathFeatures::EVERYTHING, |plan| plan.features);
        run_paths(choose_for_paths(needed), task)
    }

    fn sum_paths(
        &self,
        strategy: SamplingStrategy,
        samples: &Range<u32>,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PictureSums> {
        self.run_paths(SumPaths(self, strategy, samples, job, on_pixel))
    }
}

/// Sums the samples of the pixels.
struct Sum<'run, S>(
    &'run World<S>,
    &'run RenderSelection<'run>,
    &'run PixelObserver<'run>,
);

impl<S: Intersect> KernelTask for Sum<'_, S> {
    const HAS_KERNELS: bool = S::HAS_KERNELS;
    type Output = Option<PictureSums>;

    fn run<const F: u32>(self) -> Option<PictureSums> {
        let Self(world, job, on_pixel) = self;
        world.sum_with::<F>(job, on_pixel)
    }
}

/// Sums samples of the pixels by paths.
struct SumPaths<'run, S>(
    &'run World<S>,
    SamplingStrategy,
    &'run Range<u32>,
    &'run RenderSelection<'run>,
    &'run PixelObserver<'run>,
);

impl<S: Intersect> KernelTask for SumPaths<'_, S> {
    /// A page downloads one path tracer, not three.
    const HAS_KERNELS: bool = S::HAS_KERNELS && cfg!(not(target_family = "wasm"));
    type Output = Option<PictureSums>;

    fn run<const F: u32>(self) -> Option<PictureSums> {
        let Self(world, strategy, samples, job, on_pixel) = self;
        world.sum_paths_with::<F>(strategy, samples, job, on_pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_plan::FeatureSet;

    #[test]
    fn the_path_kernel_chosen_can_do_all_that_is_needed() {
        for needed in 0..=PathFeatures::EVERYTHING.0 {
            let chosen = choose_for_paths(FeatureSet(needed));
            let features = PATH_KERNELS[chosen].features;
            assert!(features.contains(FeatureSet(needed)), "{needed:b}");
            let mut smaller = PATH_KERNELS.iter().take(chosen);
            assert!(!smaller.any(|kernel| kernel.features.contains(FeatureSet(needed))));
        }
    }

    #[test]
    fn the_kernel_chosen_can_do_all_that_is_needed_and_no_smaller_one_can() {
        for needed in 0..1 << 9 {
            let needed = FeatureSet(needed);
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
