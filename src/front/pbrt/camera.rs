//! Camera, film, sampler, filter and integrator.

use super::Lowering;
use super::parameter::Parameters;
use super::plugins::{CAMERAS, FILMS, FILTERS, INTEGRATORS, SAMPLERS};
use crate::exchange::SpannedText;
use crate::exchange::traced;
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, clip, codes};
use rtc_ir::{Camera, EntityKind, Lens, Mode, Projection, Settings};
use rtc_math::{PixelFilter, Vec3, cos, sin};
use rtc_source::Span;

/// The size of a film without one, in pixels.
const SIZE: [u32; 2] = [1280, 720];
/// The samples of a sampler without a count.
const SAMPLES: u32 = 16;
/// The most bounces of a path by default.
const MAX_DEPTH: u32 = 5;
/// The field of view of a camera without one, in degrees.
const FIELD_OF_VIEW: f64 = 90.0;
/// The focal distance of a camera without one: pbrt's 10⁶.
const FOCAL_DISTANCE: f64 = 1e6;
/// The points of a lens that a sample takes: one, as paths are many.
const LENS_SAMPLES: u32 = 2;
/// The tolerance of the rotation of a camera's axes, relative to their lengths.
const SEEN_SKEW: f64 = 1e-3;
/// The tolerance of their perpendicularity: the rounding of products.
const ROUNDING: f64 = 1e-12;

/// The directives that make the view, in any order before the world.
#[derive(Default)]
pub(super) struct ViewDirectives {
    camera: Option<(SpannedText, Parameters, AffineTransform)>,
    pub(super) film: Option<(SpannedText, Parameters)>,
    pub(super) sampler: Option<(SpannedText, Parameters)>,
    pub(super) integrator: Option<(SpannedText, Parameters)>,
    pub(super) filter: Option<(SpannedText, Parameters)>,
}

/// The film: its whole size in pixels, and the part of it that is shown.
struct CroppedFilm {
    size: [u32; 2],
    /// The first column, the one behind the last, the first row, the one behind the last.
    crop: [u32; 4],
}

/// The camera before one is read.
pub(super) fn default_camera() -> Camera {
    Camera {
        eye: [0.0; 3],
        center: [0.0, 0.0, 1.0],
        right: [2.0 / f64::from(SIZE[1]), 0.0, 0.0],
        up: [0.0, 2.0 / f64::from(SIZE[1]), 0.0],
        size: SIZE,
        lens: Lens::PINHOLE,
        projection: Projection::Perspective,
    }
}

/// The filter of a film without one, in version 4.
const GAUSSIAN: PixelFilter = PixelFilter::Gaussian {
    deviation: 0.5,
    radius: 1.5,
};

/// The settings before an integrator and a sampler are read.
pub(super) fn default_settings() -> Settings {
    traced(SAMPLES, MAX_DEPTH)
}

impl Lowering<'_> {
    /// A camera directive: the current transform is that from the world to the camera.
    pub(super) fn camera(&mut self, plugin: SpannedText, parameters: Parameters, span: Span) {
        let Some(from_camera) = self.state.transform.inverse() else {
            return self.mistake(span, "the transform of the camera does not span space");
        };
        self.systems.insert("camera".to_owned(), from_camera);
        self.scene.medium = self.state.media.exterior;
        self.record(EntityKind::Camera, 0, span);
        self.view.camera = Some((plugin, parameters, from_camera));
    }

    /// Makes camera and settings of the directives before the world.
    pub(super) fn finish_view(&mut self) {
        let view = std::mem::take(&mut self.view);
        let film = self.film(view.film.as_ref());
        self.sampler(view.sampler.as_ref(), view.integrator.as_ref());
        self.integrator(view.integrator.as_ref());
        self.filter(view.filter.as_ref());
        match &view.camera {
            Some((plugin, parameters, from_camera)) => {
                self.view_of(plugin, parameters, from_camera, &film);
            }
            None => {
                let message = "the scene has no camera: it is seen from the origin along +z";
                self.sink
                    .push(Diagnostic::new(&codes::PBRT_APPROXIMATE, message));
                let parameters = Parameters::default();
                let camera = perspective(&parameters, &AffineTransform::IDENTITY, &film);
                self.scene.camera = camera;
            }
        }
    }

    fn film(&mut self, film: Option<&(SpannedText, Parameters)>) -> CroppedFilm {
        let whole = |size: [u32; 2]| CroppedFilm {
            size,
            crop: [0, size[0], 0, size[1]],
        };
        let Some((plugin, parameters)) = film else {
            return whole(SIZE);
        };
        let side = |name, default| parameters.count(name).unwrap_or(default).max(1);
        let size = [side("xresolution", SIZE[0]), side("yresolution", SIZE[1])];
        if FILMS.find(&plugin.text).is_none() {
            self.unsupported("film", plugin, &FILMS, "`rgb` replaces it");
        }
        // Parameters other than colours and size do not change the picture.
        parameters.skip(&["filename", "diagonal", "savefp16"]);
        for name in ["maxcomponentvalue", "maxsampleluminance"] {
            if parameters.number(name).is_some() {
                let message =
                    format!("`{name}` is left out: brighter samples are kept as they are");
                self.approximate(plugin.span, message);
            }
        }
        let scale = parameters.number("scale").unwrap_or(1.0);
        self.exposure *= scale * parameters.number("iso").map_or(1.0, |iso| iso / 100.0);
        if let Some(sensor) = parameters.string("sensor")
            && sensor.text != "cie1931"
        {
            let message = format!("the sensor `{}` is shown as `cie1931`", clip(&sensor.text));
            self.approximate(sensor.span, message);
        }
        let bounds = parameters.numbers("pixelbounds").map(<[f64]>::to_vec);
        let window = parameters.numbers("cropwindow").map(<[f64]>::to_vec);
        self.ignored("film", &plugin.text, (&FILMS, parameters));
        let crop = match (bounds.as_deref(), window.as_deref()) {
            (Some(&[x0, x1, y0, y1]), _) => [x0, x1, y0, y1],
            (None, Some(&[x0, x1, y0, y1])) => {
                let [width, height] = size.map(f64::from);
                [x0 * width, x1 * width, y0 * height, y1 * height].map(f64::ceil)
            }
            (None, None) => return whole(size),
            _ => {
                self.mistake(plugin.span, "the crop of the film needs 4 numbers");
                return whole(size);
            }
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates"
        )]
        let [x0, x1, y0, y1] = crop.map(|edge| edge as u32);
        let [width, height] = size;
        let crop = [x0, x1.min(width), y0, y1.min(height)];
        if crop[0] >= crop[1] || crop[2] >= crop[3] {
            self.mistake(plugin.span, "the crop of the film holds no pixel");
            return whole(size);
        }
        CroppedFilm { size, crop }
    }

    fn sampler(
        &mut self,
        sampler: Option<&(SpannedText, Parameters)>,
        integrator: Option<&(SpannedText, Parameters)>,
    ) {
        // Photon mapping and mutations count their samples themselves.
        let of_integrator = integrator.and_then(|(_, parameters)| {
            let passes = parameters.count("numiterations");
            passes.or_else(|| parameters.count("mutationsperpixel"))
        });
        let mut samples = of_integrator;
        if let Some((plugin, parameters)) = sampler {
            let stratified = match plugin.text.as_str() {
                "stratified" => {
                    let side = |name| parameters.count(name).unwrap_or(4);
                    Some(side("xsamples").saturating_mul(side("ysamples")))
                }
                _ => None,
            };
            let own = parameters.count("pixelsamples").or(stratified);
            samples = samples.or(own);
            // How samples are spread is `rtc`'s own affair.
            parameters.skip(&["jitter", "seed", "randomization", "dimensions", "scramble"]);
            parameters.skip(&["samplepixelcenter"]);
            self.ignored("sampler", &plugin.text, (&SAMPLERS, parameters));
        }
        if let Mode::Path(path) = &mut self.scene.settings.mode {
            path.samples = samples.unwrap_or(SAMPLES).max(1);
        }
    }

    fn integrator(&mut self, integrator: Option<&(SpannedText, Parameters)>) {
        let Some((plugin, parameters)) = integrator else {
            return;
        };
        self.record(EntityKind::Settings, 0, plugin.span);
        let depth = parameters.count("maxdepth").unwrap_or(MAX_DEPTH);
        self.scene.settings.max_depth = depth;
        self.integrator_of_media(&plugin.text);
        if self.ignores_media {
            self.scene.medium = None;
        }
        match INTEGRATORS.known(&plugin.text) {
            "path" | "volpath" | "simplepath" => {}
            // They find the same light by other ways.
            "bdpt" | "mlt" | "sppm" | "lightpath" | "photonmap" | "exphotonmap" | "igi"
            | "irradiancecache" => {
                let name = clip(&plugin.text);
                let message = format!(
                    "`{name}` is not supported: path tracing replaces it, which converges to the \
                    same picture"
                );
                self.report(&codes::PBRT_PLUGIN, plugin.span, message);
            }
            "directlighting" | "whitted" => {
                let name = clip(&plugin.text);
                let message = format!(
                    "`{name}` is shown with the light that rough surfaces send \
                     to each other"
                );
                self.approximate(plugin.span, message);
            }
            _ => {
                let instead = "the scene is path-traced";
                self.unsupported("integrator", plugin, &INTEGRATORS, instead);
            }
        }
    }

    /// The filter of the film; that of version 3 is a box by default, of version 4 a Gaussian.
    fn filter(&mut self, filter: Option<&(SpannedText, Parameters)>) {
        let filter = match filter {
            None if self.is_version_3 => PixelFilter::PIXEL,
            None => GAUSSIAN,
            Some((plugin, parameters)) => self.pixel_filter(plugin, parameters),
        };
        if let Mode::Path(path) = &mut self.scene.settings.mode {
            path.filter = filter;
        }
    }

    fn pixel_filter(&mut self, plugin: &SpannedText, parameters: &Parameters) -> PixelFilter {
        let is_old = self.is_version_3;
        let number = |name, default| parameters.number(name).unwrap_or(default);
        let mut radius = |default: f64| {
            let names = match is_old {
                true => ["xwidth", "ywidth"],
                false => ["xradius", "yradius"],
            };
            let [x, y] = names.map(|name| number(name, default));
            if x != y {
                let message = "the filter is as wide along y as along x";
                self.approximate(plugin.span, message);
            }
            x
        };
        match FILTERS.known(&plugin.text) {
            "box" => PixelFilter::Box {
                radius: radius(0.5),
            },
            "triangle" => PixelFilter::Tent {
                radius: radius(2.0),
            },
            // Version 3 has exp(−αx²).
            "gaussian" if is_old => PixelFilter::Gaussian {
                deviation: (0.5 / number("alpha", 2.0).max(1e-6)).sqrt(),
                radius: radius(2.0),
            },
            "gaussian" => PixelFilter::Gaussian {
                deviation: number("sigma", 0.5),
                radius: radius(1.5),
            },
            "mitchell" => PixelFilter::Mitchell {
                b: number("B", 1.0 / 3.0),
                c: number("C", 1.0 / 3.0),
                radius: radius(2.0),
            },
            "sinc" => PixelFilter::Lanczos {
                window: number("tau", 3.0),
                radius: radius(4.0),
            },
            _ => {
                let instead = "a Gaussian one replaces it";
                self.unsupported("filter", plugin, &FILTERS, instead);
                GAUSSIAN
            }
        }
    }

    /// The transform with perpendicular axes of the same lengths. Those of a matrix are rounded; a
    /// skew that is seen is reported.
    fn squared(&mut self, plugin: &SpannedText, from_camera: &AffineTransform) -> AffineTransform {
        let AffineTransform(columns) = from_camera;
        let Some(axes) = from_camera.orthonormal() else {
            return *from_camera;
        };
        let [x, y, z] = std::array::from_fn(|k| axes[k] * columns[k].length());
        let moved = (columns[0] - x).length() + (columns[1] - y).length();
        if moved > SEEN_SKEW * (x.length() + y.length()) {
            self.approximate(
                plugin.span,
                "the skew of the camera's transform is left out",
            );
        }
        if moved <= ROUNDING * x.length() {
            return *from_camera;
        }
        AffineTransform([x, y, z, columns[3]])
    }

    fn view_of(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        from_camera: &AffineTransform,
        film: &CroppedFilm,
    ) {
        let from_camera = self.squared(plugin, from_camera);
        if CAMERAS.find(&plugin.text).is_none() {
            let instead = "a perspective camera replaces it";
            self.unsupported("camera", plugin, &CAMERAS, instead);
        }
        // In version 4 the time for which the shutter is open is the exposure.
        let open = parameters.number("shutteropen").unwrap_or(0.0);
        let close = parameters.number("shutterclose").unwrap_or(1.0);
        if !self.is_version_3 {
            self.exposure *= close - open;
        }
        self.scene.camera = match CAMERAS.known(&plugin.text) {
            "orthographic" => orthographic(parameters, &from_camera, film),
            _ => perspective(parameters, &from_camera, film),
        };
        self.ignored("camera", &plugin.text, (&CAMERAS, parameters));
    }
}

/// The bounds of the screen: left, right, bottom, top. The shorter side spans from −1 to 1.
fn screen(parameters: &Parameters, film: &CroppedFilm) -> [f64; 4] {
    let [width, height] = film.size.map(f64::from);
    let aspect = parameters.number("frameaspectratio");
    let aspect = aspect
        .filter(|aspect| *aspect > 0.0)
        .unwrap_or(width / height);
    let default = match aspect > 1.0 {
        true => [-aspect, aspect, -1.0, 1.0],
        false => [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect],
    };
    match parameters.numbers("screenwindow") {
        Some(&[left, right, bottom, top]) => [left, right, bottom, top],
        _ => default,
    }
}

/// A camera with its screen, times `scale`, at the distance `depth`.
fn camera(
    from_camera: &AffineTransform,
    film: &CroppedFilm,
    [left, right, bottom, top]: [f64; 4],
    (scale, depth): (f64, f64),
) -> Camera {
    let [width, height] = film.size.map(f64::from);
    let [x0, x1, y0, y1] = film.crop.map(f64::from);
    let across = (right - left) / width * scale;
    let upward = (top - bottom) / height * scale;
    // The middle of the part of the film that is shown.
    let middle = Vec3::new(
        left * scale + across * (x0 + x1) / 2.0,
        top * scale - upward * (y0 + y1) / 2.0,
        depth,
    );
    let [columns, _, rows, _] = [
        film.crop[1] - film.crop[0],
        0,
        film.crop[3] - film.crop[2],
        0,
    ];
    Camera {
        eye: from_camera.point(Vec3::ZERO).to_array(),
        center: from_camera.point(middle).to_array(),
        right: from_camera.vector(Vec3::X * across).to_array(),
        up: from_camera.vector(Vec3::Y * upward).to_array(),
        size: [columns, rows],
        lens: Lens::PINHOLE,
        projection: Projection::Perspective,
    }
}

/// A perspective camera, with a lens if it has a radius.
fn perspective(
    parameters: &Parameters,
    from_camera: &AffineTransform,
    film: &CroppedFilm,
) -> Camera {
    let half = parameters.number("halffov").map(|half| 2.0 * half);
    let fov = parameters.number("fov").or(half).unwrap_or(FIELD_OF_VIEW);
    let angle = fov.clamp(1e-3, 179.9).to_radians() / 2.0;
    let radius = parameters.number("lensradius").unwrap_or(0.0).max(0.0);
    let focus = parameters.number("focaldistance").unwrap_or(FOCAL_DISTANCE);
    // Without a lens all distances show the same.
    let depth = if radius > 0.0 { focus.max(1e-6) } else { 1.0 };
    let scale = sin(angle) / cos(angle) * depth;
    let placed = camera(from_camera, film, screen(parameters, film), (scale, depth));
    Camera {
        lens: Lens {
            radius: radius * from_camera.vector(Vec3::X).length(),
            samples: if radius > 0.0 { LENS_SAMPLES } else { 1 },
        },
        ..placed
    }
}

/// An orthographic camera: the screen is as large as its bounds say.
fn orthographic(
    parameters: &Parameters,
    from_camera: &AffineTransform,
    film: &CroppedFilm,
) -> Camera {
    let placed = camera(from_camera, film, screen(parameters, film), (1.0, 1.0));
    // All rays run along the axis, also where the middle of the picture is beside it.
    let eye = Vec3::from_array(placed.center) - from_camera.vector(Vec3::Z);
    Camera {
        eye: eye.to_array(),
        projection: Projection::Orthographic,
        ..placed
    }
}
