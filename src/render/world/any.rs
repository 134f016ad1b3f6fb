//! A world of any shape set and arithmetic, built once for several renders.

use crate::accel::simd::SimdLevel;
use crate::film::heartbeat::PixelObserver;
use crate::film::partial::{FilmError, PartialFilm};
use crate::film::progressive::ProgressiveFilm;
use crate::film::{Film, RayCounts, RenderSelection};
use crate::frame::halves::GuidedFilm;
use crate::integrator::aov::Aov;
use crate::ray::Ray;
use crate::shape::basic::BasicShape;
use crate::shape::{PlainShape, PlainShapeF32, Shape};
use crate::world::World;
use crate::world::behind::SeenBehind;
use rtc_image::{DenoisingGuide, PixelLayers};
use rtc_math::{StoredTree, Vec3};
use rtc_plan::{Arithmetic, Plan, RuleSet, ShapeSet};
use rtc_valid::ValidScene;
use std::ops::Range;

/// A scene prepared as planned. It renders on the threads of the current pool.
pub enum AnyWorld {
    /// With the basic shapes only.
    Basic(World<BasicShape>),
    /// With all shapes.
    All(World<Shape>),
    /// By baseline formulas.
    Plain(World<PlainShape>),
    /// By baseline formulas in f32.
    F32(World<PlainShapeF32>),
}

/// Does the same with each kind of world.
macro_rules! each {
    ($any:expr, $world:pat => $what:expr) => {
        match $any {
            Self::Basic($world) => $what,
            Self::All($world) => $what,
            Self::Plain($world) => $what,
            Self::F32($world) => $what,
        }
    };
}

impl AnyWorld {
    /// Prepares a scene.
    #[must_use]
    pub fn prepare(scene: &ValidScene, plan: &Plan) -> Self {
        Self::prepare_at(scene, plan, SimdLevel::best())
    }

    /// As [`AnyWorld::prepare`], for rays traced with the SIMD instructions of a level: pictures
    /// are the same bytes.
    #[must_use]
    pub fn prepare_at(scene: &ValidScene, plan: &Plan, simd: SimdLevel) -> Self {
        match (plan.arithmetic, plan.shapes) {
            (Arithmetic::Robust, ShapeSet::Basic) => {
                Self::Basic(World::prepare_at(scene, plan, simd))
            }
            (Arithmetic::Robust, ShapeSet::All) => Self::All(World::prepare_at(scene, plan, simd)),
            (Arithmetic::Plain, _) => Self::Plain(World::prepare_at(scene, plan, simd)),
            (Arithmetic::F32, _) => Self::F32(World::prepare_at(scene, plan, simd)),
        }
    }

    /// The scene it shows.
    #[must_use]
    pub fn scene(&self) -> &ValidScene {
        each!(self, world => world.scene())
    }

    /// The hierarchy over its meshes, to be stored with the scene; `None` if it is small or rays
    /// search the meshes one by one.
    #[must_use]
    pub fn tree_to_store(&self) -> Option<StoredTree> {
        each!(self, world => world.tree_to_store())
    }

    /// Shows another scene, which differs from the one before in its camera and settings alone, by
    /// the same rules. Shapes, materials and lights stay if the new plan needs the same ones.
    pub fn change(&mut self, scene: ValidScene) {
        let old = each!(self, world => &world.plan);
        let plan = Plan::with_arithmetic(old.arithmetic, &scene, old.rules);
        // The plan of paths has the materials and lights.
        let is_same = !scene.moves()
            && (plan.shapes, &plan.surfaces, &plan.constants, &plan.paths)
                == (old.shapes, &old.surfaces, &old.constants, &old.paths);
        if is_same {
            each!(self, world => world.show(scene, plan));
        } else {
            let simd = each!(self, world => world.simd);
            *self = Self::prepare_at(&scene, &plan, simd);
        }
    }

    /// The greatest radiance that a path may find by chance, on a surface or outside the scene, in
    /// the strongest channel; 0 without path tracing, infinite where there is no useful bound on
    /// the throughput. Where only rough surfaces can find a light that is aimed at, it is what the
    /// aimed sample brings. An anaglyph may show more than what an eye sees.
    #[must_use]
    pub fn brightest(&self) -> f64 {
        each!(self, world => world.brightest())
    }

    /// The point that a camera ray sees behind back faces of single-sided materials, if it passes
    /// any; of a world of path tracing.
    #[must_use]
    pub fn seen_behind(&self, ray: Ray) -> Option<SeenBehind> {
        each!(self, world => world.seen_behind(ray))
    }

    /// Whether anything that casts shadows is strictly between two points. `from` should be a start
    /// of rays, off its own surface.
    #[must_use]
    pub fn occluded(&self, from: Vec3, to: Vec3) -> bool {
        each!(self, world => world.occluded(from, to))
    }

    /// Renders a picture; `None` if `on_pixel` returned false.
    ///
    /// `on_pixel` is called from all threads, after each pixel and within long ones.
    #[must_use]
    pub fn render(&self, job: &RenderSelection, on_pixel: &PixelObserver<'_>) -> Option<Film> {
        each!(self, world => world.render(job, on_pixel))
    }

    /// Renders a part of a picture: the tiles of the job, and with path tracing only the given
    /// range of samples, if any. It must consist of whole blocks of 16 samples. `None` if
    /// `on_pixel` said stop; it is called as by [`Self::render`].
    ///
    /// # Errors
    /// If the samples are not whole blocks, or no paths are traced.
    pub fn render_part(
        &self,
        job: &RenderSelection,
        samples: Option<Range<u32>>,
        on_pixel: &PixelObserver<'_>,
    ) -> Result<Option<PartialFilm>, FilmError> {
        each!(self, world => {
            world.part(job, samples, |samples, job| world.sum(samples, job, on_pixel))
        })
    }

    /// Renders layers of the pixels of a job; `None` if `on_pixel` said stop.
    ///
    /// `on_pixel` is called from all threads after each pixel.
    #[must_use]
    pub fn layers(
        &self,
        wanted: &[Aov],
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<PixelLayers> {
        let unpruned = self.unpruned();
        let world = unpruned.as_ref().unwrap_or(self);
        each!(world, world => world.layers(wanted, job, on_pixel))
    }

    /// The world without rules, if this one applies some: rules keep the colours, but only a plan
    /// without them keeps everything that a layer may show.
    #[must_use]
    pub fn unpruned(&self) -> Option<Self> {
        let rules = each!(self, world => world.plan.rules);
        (rules != RuleSet::NONE).then(|| self.bare())
    }

    /// Sums a range of the samples of traced paths, with the guides of their camera rays.
    pub(crate) fn guided(
        &self,
        samples: &Range<u32>,
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<GuidedFilm> {
        each!(self, world => world.guided(samples, job, on_pixel))
    }

    /// The world by no rule.
    pub(crate) fn bare(&self) -> Self {
        let (scene, plan) = each!(self, world => (world.scene(), &world.plan));
        let simd = each!(self, world => world.simd);
        let bare = Plan::with_arithmetic(plan.arithmetic, scene, RuleSet::NONE);
        Self::prepare_at(scene, &bare, simd)
    }

    /// The guides of a denoiser, by the samples of traced paths that each pixel is to take, and the
    /// rays they take.
    pub(crate) fn guides(
        &self,
        samples: &(dyn Fn(usize) -> Range<u32> + Sync),
        job: &RenderSelection,
        on_pixel: &PixelObserver<'_>,
    ) -> Option<(Vec<DenoisingGuide>, RayCounts)> {
        each!(self, world => world.guides(samples, job, on_pixel))
    }

    /// Takes samples until each pixel has the requested number: `wanted(i)` is the minimum for each
    /// replicate of pixel i, and for its pilot. False if `on_pixel` said stop; unfinished tiles are
    /// then unchanged.
    ///
    /// `on_pixel` is called from all threads, after each pixel and within long ones.
    pub fn grow(
        &self,
        film: &mut ProgressiveFilm,
        wanted: &(dyn Fn(usize) -> [u32; 2] + Sync),
        on_pixel: &PixelObserver<'_>,
    ) -> bool {
        each!(self, world => world.grow(film, wanted, on_pixel))
    }
}

/// Renders a scene as planned; see [`AnyWorld::render`].
#[must_use]
pub fn render(
    scene: &ValidScene,
    plan: &Plan,
    job: &RenderSelection,
    on_pixel: &PixelObserver<'_>,
) -> Option<Film> {
    AnyWorld::prepare(scene, plan).render(job, on_pixel)
}
