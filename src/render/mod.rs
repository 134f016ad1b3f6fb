//! A proven scene becomes a world, the world a film. Nothing here can fail, and nothing depends on the threads.

use crate::image::Image;
use crate::valid::ValidScene;

/// What to render of a world.
#[derive(Clone, Copy, Debug, Default)]
pub struct Job {
    /// The part of the picture wanted, or all of it; parts outside the picture are cut off.
    pub crop: Option<Crop>,
    /// Which values the film holds.
    pub values: Values,
}

/// A rectangle of pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

/// Which values a film holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Values {
    /// Each sub-sample clamped to [0, 1] before the mean: what a display shows.
    #[default]
    Display,
    /// The plain mean of the sub-samples.
    Linear,
}

/// How many rays were traced, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// From the eye.
    pub camera: u64,
    /// To a light.
    pub shadow: u64,
    /// Mirrored, glossy ones included.
    pub reflected: u64,
    /// Refracted.
    pub refracted: u64,
    /// Camera rays that hit something.
    pub hits: u64,
}

impl Counts {
    /// All rays.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.camera + self.shadow + self.reflected + self.refracted
    }
}

/// A picture and what it took.
#[derive(Clone, Debug)]
pub struct Film {
    /// The picture, of the size of the crop.
    pub image: Image,
    /// The rays it took.
    pub counts: Counts,
}

/// A scene prepared for tracing.
pub struct World;

impl World {
    /// Prepares a scene: frames of shapes, the BVH.
    #[must_use]
    pub fn prepare(_scene: &ValidScene) -> Self {
        Self
    }

    /// Renders on the threads of the current pool; `None` if `proceed` said stop.
    ///
    /// `proceed` is called from all threads with the rays traced since the last call.
    #[must_use]
    pub fn render(&self, _job: &Job, _proceed: &(dyn Fn(u64) -> bool + Sync)) -> Option<Film> {
        None
    }
}
