//! The settings and the camera of a world.

use super::World;
use crate::camera::grid::{Pattern, SampleGrid};
use crate::camera::{Camera, Projection};
use crate::film::filter::FilterSampler;
use rtc_math::Vec3;
use rtc_plan::Plan;
use rtc_valid::{self as valid, ValidScene};
use std::sync::Arc;

/// The rules applied to the picture.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    /// The kind of value of a pixel.
    pub(crate) mode: Mode,
    /// Whether surfaces hide lights from each other.
    pub(crate) shadows: bool,
    /// Whether Phong's terms of the first hit fall in steps.
    pub(crate) toon: bool,
    /// The colour of the light of Phong's ambient term, if it is added once instead of once per
    /// light.
    pub(crate) ambient_light: Option<Vec3>,
    /// Whether rough surfaces keep the light that bounces between their facets, where paths are
    /// traced.
    pub(crate) multiple_scattering: bool,
    /// Whether caustics are estimated by manifold sampling, where paths are traced.
    pub(crate) caustics: bool,
    /// The filter of the pixels, where paths are traced; `None` for the pixel itself.
    pub(crate) filter: Option<Arc<FilterSampler>>,
    /// The points of each soft light.
    pub(crate) light_samples: u32,
    /// The arrangement of the samples of a pixel, without path tracing.
    pub(crate) grid: SampleGrid,
}

/// The kind of value of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Mode {
    /// Phong's model.
    Phong,
    /// The distance of the first hit.
    Depth,
    /// The normal of the first hit.
    Normal,
    /// Gooch's cool-to-warm shading.
    Gooch(Gooch),
    /// The light along all paths, with this many paths per pixel.
    Path(u32),
}

/// The parameters of Gooch shading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gooch {
    /// The blue of the cool colour.
    pub(crate) b: f64,
    /// The yellow of the warm colour.
    pub(crate) y: f64,
    /// The fraction of the surface's colour in the cool tone.
    pub(crate) alpha: f64,
    /// The fraction of the surface's colour in the warm tone.
    pub(crate) beta: f64,
}

impl<S> World<S> {
    /// The scene that is shown.
    pub(super) fn scene(&self) -> &ValidScene {
        &self.scene
    }

    /// Shows another scene, which differs from the one before in its camera and settings alone, by
    /// a plan for it.
    pub(super) fn show(&mut self, scene: ValidScene, plan: Plan) {
        self.camera = camera(scene.camera());
        self.settings = settings(&scene);
        if let Some(small_scene) = &mut self.small_scene {
            small_scene.follow(&self.surfaces, &plan);
        }
        (self.scene, self.plan) = (scene, plan);
    }
}

pub(super) fn camera(camera: &valid::Camera) -> Camera {
    let valid::Camera {
        eye,
        center,
        right,
        up,
        width,
        height,
        lens,
        projection,
    } = *camera;
    // A pinhole takes one lens sample.
    let lens_radius = lens.radius.get();
    let camera = Camera {
        eye,
        center,
        right,
        up,
        size: [width.get(), height.get()],
        lens_radius,
        lens_samples: if lens_radius == 0.0 {
            1
        } else {
            lens.samples.get()
        },
        projection: match projection {
            valid::Projection::Perspective | valid::Projection::Stereo(_) => {
                Projection::Perspective
            }
            valid::Projection::Orthographic => Projection::Orthographic,
        },
        eyes: None,
    };
    // A stereo camera has two eyes at a distance.
    match projection {
        valid::Projection::Stereo(eyes) => camera.with_eyes(eyes.distance, eyes.is_anaglyph),
        valid::Projection::Perspective | valid::Projection::Orthographic => camera,
    }
}

pub(super) fn settings(scene: &ValidScene) -> Settings {
    let valid::Settings {
        mode,
        shadows,
        max_depth: _,
        supersampling,
        pattern,
        light_samples,
        toon,
        ambient,
    } = *scene.settings();
    let pattern = match pattern {
        valid::Pattern::Grid => Pattern::Grid,
        valid::Pattern::Jitter => Pattern::Jitter,
        valid::Pattern::Random => Pattern::Random,
    };
    let points = camera(scene.camera()).lens_samples;
    let multiple_scattering = matches!(mode, valid::Mode::Path(path) if path.multiple_scattering);
    let caustics = matches!(mode, valid::Mode::Path(path) if path.caustics);
    let filter = match mode {
        valid::Mode::Path(path) => FilterSampler::new(&path.filter).map(Arc::new),
        valid::Mode::Phong | valid::Mode::Depth | valid::Mode::Normal | valid::Mode::Gooch(_) => {
            None
        }
    };
    let mode = prepared_mode(mode);
    Settings {
        mode,
        shadows,
        toon,
        ambient_light: match ambient {
            valid::Ambient::PerLight => None,
            valid::Ambient::Once(color) => Some(color),
        },
        multiple_scattering,
        caustics,
        filter,
        light_samples: light_samples.get(),
        grid: match mode {
            // A depth buffer has one ray through the middle of each pixel.
            Mode::Depth => SampleGrid::MIDDLE,
            Mode::Phong | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => {
                SampleGrid::new(supersampling.get(), points, pattern)
            }
        },
    }
}

fn prepared_mode(mode: valid::Mode) -> Mode {
    match mode {
        valid::Mode::Phong => Mode::Phong,
        valid::Mode::Depth => Mode::Depth,
        valid::Mode::Normal => Mode::Normal,
        valid::Mode::Gooch(valid::Gooch { b, y, alpha, beta }) => {
            Mode::Gooch(Gooch { b, y, alpha, beta })
        }
        valid::Mode::Path(path) => Mode::Path(path.samples.get()),
    }
}
