//! Validates the settings, and the limits on pixels and rays.

use super::camera::Stereo;
use super::check::{Checker, ValidationOptions};
use rtc_color::Tone;
use rtc_diag::Diagnostic;
use rtc_diag::codes;
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{PixelFilter, Vec3};
use rtc_source::Resource;
use std::num::NonZeroU32;

/// The maximum number of bounces: a path stores a few bytes for each.
const MAX_DEPTH: u32 = 1_000_000;

/// The integrator and its sampling parameters.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The integrator.
    pub mode: Mode,
    /// Whether surfaces cast shadows.
    pub shadows: bool,
    /// The maximum number of reflections or refractions after the first hit.
    pub max_depth: u32,
    /// Sub-samples along each side of a pixel.
    pub supersampling: NonZeroU32,
    /// The position of each sub-sample in its cell.
    pub pattern: Pattern,
    /// Samples per soft light.
    pub light_samples: NonZeroU32,
    /// Toon shading: the Phong terms of the first hit are quantised; true in Phong mode only.
    pub toon: bool,
    /// How the ambient term of the Phong model is added.
    pub ambient: Ambient,
}

/// How the ambient term of the Phong model is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ambient {
    /// Once per light, multiplied by the colour of the light.
    PerLight,
    /// Once, multiplied by this colour.
    Once(Vec3),
}

/// The position of each sub-sample in its cell of the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// At the centre of the cell.
    Grid,
    /// Uniformly in the cell, seeded by pixel and sample.
    Jitter,
    /// Uniformly in the pixel, seeded by pixel and sample.
    Random,
}

/// The integrator.
#[derive(Clone, Copy, Debug)]
pub enum Mode {
    /// Whitted ray tracing with the Phong model.
    Phong,
    /// The distance of the first hit.
    Depth,
    /// The normal of the first hit.
    Normal,
    /// Gooch's cool-to-warm shading.
    Gooch(Gooch),
    /// Path tracing.
    Path(PathSettings),
}

impl Mode {
    /// The default tone map: sRGB encoding for radiance, none for colours of the course.
    #[must_use]
    pub fn tone(&self) -> Tone {
        match self {
            Self::Path(_) => Tone::Srgb,
            Self::Phong | Self::Depth | Self::Normal | Self::Gooch(_) => Tone::None,
        }
    }
}

/// Parameters of path tracing.
#[derive(Clone, Copy, Debug)]
pub struct PathSettings {
    /// Paths per pixel.
    pub samples: NonZeroU32,
    /// Whether rough surfaces keep the energy of multiple scattering between their facets.
    pub multiple_scattering: bool,
    /// Whether caustics of small lights are estimated by manifold sampling.
    pub caustics: bool,
    /// The reconstruction filter of the pixels: its numbers are in range.
    pub filter: PixelFilter,
}

impl PathSettings {
    /// How far the rays of a pixel reach beyond it, in pixels.
    #[must_use]
    pub fn reach(&self) -> f64 {
        (self.filter.radius() - 0.5).max(0.0)
    }
}

/// The parameters of Gooch shading, finite.
#[derive(Clone, Copy, Debug)]
pub struct Gooch {
    /// The blue of the cool colour.
    pub b: f64,
    /// The yellow of the warm colour.
    pub y: f64,
    /// The fraction of the surface's colour in the cool tone.
    pub alpha: f64,
    /// The fraction of the surface's colour in the warm tone.
    pub beta: f64,
}

pub(super) fn settings(settings: &ir::Settings, check: &mut Checker<'_>) -> Option<Settings> {
    let ir::Settings {
        mode,
        shadows,
        max_depth,
        supersampling,
        pattern,
        light_samples,
        toon,
        ambient,
        ambient_light,
        background,
        stereo: _,
        stereo_view: _,
        shutter,
    } = settings;
    // Check each value.
    let mode = valid_mode(mode, check);
    let supersampling = check.count(
        *supersampling,
        "supersampling factor",
        at(EntityField::Supersampling),
    );
    let light_samples = check.count(
        *light_samples,
        "light samples",
        at(EntityField::LightSamples),
    );
    for time in shutter {
        check.number(*time, at(EntityField::Shutter))?;
    }
    let ambient_light = check.color(*ambient_light, at(EntityField::AmbientLight));
    let background = background.unwrap_or_default();
    let background = check.color(background, at(EntityField::Background));
    if *max_depth > MAX_DEPTH {
        let diagnostic = Diagnostic::new(
            &codes::TOO_DEEP,
            format!("{max_depth} bounces are too many"),
        );
        check.report(
            at(EntityField::MaxDepth),
            "",
            diagnostic.hint(format!("at most {MAX_DEPTH}; 5 is enough for most scenes")),
        );
        return None;
    }
    // All values must be valid.
    background?;
    let ambient_light = ambient_light?;
    Some(Settings {
        mode: mode?,
        shadows: *shadows,
        max_depth: *max_depth,
        supersampling: supersampling?,
        pattern: match pattern {
            ir::Pattern::Grid => Pattern::Grid,
            ir::Pattern::Jitter => Pattern::Jitter,
            ir::Pattern::Random => Pattern::Random,
        },
        light_samples: light_samples?,
        toon: *toon && matches!(settings.mode, ir::Mode::Phong),
        ambient: match ambient {
            ir::Ambient::PerLight => Ambient::PerLight,
            ir::Ambient::Once => Ambient::Once(ambient_light),
        },
    })
}

fn valid_mode(mode: &ir::Mode, check: &mut Checker<'_>) -> Option<Mode> {
    match mode {
        ir::Mode::Phong => Some(Mode::Phong),
        ir::Mode::Depth => Some(Mode::Depth),
        ir::Mode::Normal => Some(Mode::Normal),
        ir::Mode::Gooch(parameters) => gooch(parameters, check),
        ir::Mode::Path(ir::PathSettings {
            samples,
            multiple_scattering,
            caustics,
            filter,
        }) => {
            let samples = check.count(*samples, "samples", at(EntityField::Mode));
            let filter = valid_filter(*filter, check);
            let (samples, filter) = (samples?, filter?);
            Some(Mode::Path(PathSettings {
                samples,
                multiple_scattering: *multiple_scattering,
                caustics: *caustics,
                filter,
            }))
        }
    }
}

/// The filter, if its numbers are in range.
fn valid_filter(filter: PixelFilter, check: &mut Checker<'_>) -> Option<PixelFilter> {
    /// The range of radii and deviations, in pixels.
    const RANGE: std::ops::RangeInclusive<f64> = 1e-3..=16.0;
    let (are_in_range, others) = match filter {
        PixelFilter::Box { .. } | PixelFilter::Tent { .. } => (true, ""),
        PixelFilter::Gaussian { deviation, .. } => {
            (RANGE.contains(&deviation), ", a deviation too")
        }
        PixelFilter::Mitchell { b, c, .. } => {
            let is_fraction = |number: f64| (0.0..=1.0).contains(&number);
            (is_fraction(b) && is_fraction(c), ", b and c from 0 to 1")
        }
        PixelFilter::Lanczos { window, radius } => {
            let is_wide = window >= 1.0 && radius >= 1.0;
            (
                is_wide && RANGE.contains(&window),
                ", of Lanczos it and the window at least 1",
            )
        }
    };
    if are_in_range && RANGE.contains(&filter.radius()) {
        return Some(filter);
    }
    let message = "the numbers of a filter are out of range";
    let hint = format!("a radius is from 0.001 to 16 pixels{others}");
    let diagnostic = Diagnostic::new(&codes::BAD_FACTOR, message).hint(hint);
    check.report(at(EntityField::Mode), "", diagnostic);
    None
}

fn gooch(gooch: &ir::Gooch, check: &mut Checker<'_>) -> Option<Mode> {
    let ir::Gooch { b, y, alpha, beta } = gooch;
    let b = check.number(*b, at(EntityField::GoochB));
    let y = check.number(*y, at(EntityField::GoochY));
    let alpha = check.number(*alpha, at(EntityField::GoochAlpha));
    let beta = check.number(*beta, at(EntityField::GoochBeta));
    Some(Mode::Gooch(Gooch {
        b: b?,
        y: y?,
        alpha: alpha?,
        beta: beta?,
    }))
}

fn at(field: EntityField) -> ValuePath {
    ValuePath::new(EntityKind::Settings, 0, field)
}

/// Rejects pictures beyond the limits on pixels and rays.
pub(super) fn budget(scene: &ir::Scene, options: &ValidationOptions, check: &mut Checker<'_>) {
    let [width, height] = scene.camera.size;
    let pixels = u128::from(width) * u128::from(height);
    let limit = options.limits.of(Resource::Pixels, 0);
    if pixels > limit.into() {
        let message = format!("the image is too large: {width} × {height} = {pixels} pixels");
        let diagnostic = Diagnostic::new(&codes::HUGE_IMAGE, message);
        let diagnostic = diagnostic.hint(format!(
            "at most {limit} pixels; `--limit pixels=…` changes the limit"
        ));
        check.report(
            ValuePath::new(EntityKind::Camera, 0, EntityField::Size),
            "",
            diagnostic,
        );
        return;
    }
    too_many_rays(scene, pixels, options.limits.of(Resource::Rays, 0), check);
}

/// Rejects a picture with too many camera and shadow rays, further bounces not counted.
fn too_many_rays(scene: &ir::Scene, pixels: u128, limit: u64, check: &mut Checker<'_>) {
    let [width, height] = scene.camera.size;
    let supersampling = scene.settings.supersampling;
    // Multiply the samples of all dimensions.
    let cells = u128::from(supersampling) * u128::from(supersampling);
    let samples = SampleCounts::of(scene);
    let mut product = format!("{width} × {height} pixels × {supersampling}² sub-samples");
    let mut rays = pixels.saturating_mul(cells);
    for (count, entity) in [
        (samples.paths, "paths"),
        (samples.lens, "aperture samples"),
        (samples.light, "light samples"),
        (samples.eyes, "eyes"),
    ] {
        rays = rays.saturating_mul(count.into());
        if count > 1 {
            product += &format!(" × {count} {entity}");
        }
    }
    if rays <= limit.into() {
        return;
    }
    // Report the product.
    let total = if rays == u128::MAX {
        "more than 2¹²⁸".to_owned()
    } else {
        rays.to_string()
    };
    let diagnostic = Diagnostic::new(
        &codes::TOO_MANY_RAYS,
        format!("the picture takes too many rays: {product} = {total}"),
    );
    let diagnostic = diagnostic.hint(format!(
        "at most {limit} rays; `--limit rays=…` changes the limit"
    ));
    let field = if u128::from(samples.light) > cells {
        EntityField::LightSamples
    } else {
        EntityField::Supersampling
    };
    check.report(at(field), "", diagnostic);
}

/// Validates the display settings: the exposure is in range.
pub(super) fn display(display: &ir::Display, check: &mut Checker<'_>) {
    const MOST: f64 = ir::Display::MOST_STOPS;
    let ir::Display { exposure, tone: _ } = display;
    if !(-MOST..=MOST).contains(exposure) {
        let message =
            format!("the exposure is `{exposure}` stops, but must be from -{MOST} to {MOST}");
        let diagnostic = Diagnostic::new(&codes::OUT_OF_RANGE, message);
        check.report(at(EntityField::Whole), "", diagnostic);
    }
}

/// The number of rays per sub-sample, by purpose.
struct SampleCounts {
    paths: u32,
    lens: u32,
    light: u32,
    eyes: u32,
}

impl SampleCounts {
    fn of(scene: &ir::Scene) -> Self {
        let ir::Settings {
            ref mode,
            light_samples,
            ..
        } = scene.settings;
        let ir::Lens { radius, samples } = scene.camera.lens;
        let is_soft = scene
            .lights
            .iter()
            .filter_map(ir::Light::point)
            .any(|light| light.radius > 0.0);
        let Stereo {
            distance,
            is_anaglyph,
        } = Stereo::of(&scene.settings);
        Self {
            eyes: 1 + u32::from(distance > 0.0 && is_anaglyph),
            paths: if let ir::Mode::Path(path) = mode {
                path.samples
            } else {
                1
            },
            lens: if radius == 0.0 { 1 } else { samples },
            light: if is_soft && matches!(mode, ir::Mode::Phong) {
                light_samples
            } else {
                1
            },
        }
    }
}
