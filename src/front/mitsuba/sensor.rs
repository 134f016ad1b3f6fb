//! Integrators, sensors, films and samplers.

use super::Lowering;
use super::clip::ClipPlane;
use super::plugins::{FILTERS, INTEGRATORS, SENSORS};
use super::xml::PluginNode;
use crate::exchange::traced;
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{Camera, EntityKind, Lens, Mode, Projection, Settings};
use rtc_math::{PixelFilter, Vec3, cos, sin};

/// The bounces of paths without a limit: Russian roulette ends almost all of them long before.
const UNLIMITED: u32 = 100;
/// The size of a film without one, in pixels.
const SIZE: [u32; 2] = [768, 576];
/// The samples of a sampler without a count.
const SAMPLES: u32 = 4;
/// The diagonal of 35 mm film, 36 × 24 mm, in millimetres: √(36² + 24²).
const FILM_DIAGONAL: f64 = 43.266_615_305_567_87;
/// The focal length of a sensor without `fov` and `focal_length`, in millimetres.
const FOCAL_LENGTH: f64 = 50.0;
/// The points of a lens that a sample takes: one, as paths are many.
const LENS_SAMPLES: u32 = 2;

/// The filter of a film without one.
const GAUSSIAN: PixelFilter = PixelFilter::Gaussian {
    deviation: 0.5,
    radius: 2.0,
};

/// The camera before a sensor is read.
pub(super) fn default_camera() -> Camera {
    Camera {
        eye: [0.0, 0.0, 0.0],
        center: [0.0, 0.0, 1.0],
        right: [-1.0 / f64::from(SIZE[0]), 0.0, 0.0],
        up: [0.0, 1.0 / f64::from(SIZE[0]), 0.0],
        size: SIZE,
        lens: Lens::PINHOLE,
        projection: Projection::Perspective,
    }
}

/// The settings before an integrator and a sampler are read.
pub(super) fn default_settings() -> Settings {
    let mut settings = traced(SAMPLES, UNLIMITED);
    if let Mode::Path(path) = &mut settings.mode {
        path.filter = GAUSSIAN;
    }
    settings
}

impl<'run> Lowering<'run> {
    /// The depth of an integrator. A path of `max_depth` edges has `max_depth` − 1 bounces.
    pub(super) fn integrator(&mut self, node: &'run PluginNode) {
        self.integrator_of_media(node);
        if node.flag("hide_emitters") == Some(true) {
            self.approximate(node.span, "`hide_emitters` is left out: lights are seen");
        }
        match INTEGRATORS.known(&node.plugin.text) {
            "path" | "volpath" | "volpathmis" | "prb" | "volpath_simple" => {
                let depth = node.number("max_depth").unwrap_or(-1.0);
                if depth >= 0.0 {
                    let depth = node.count("max_depth").unwrap_or(0);
                    self.settings().max_depth = depth.saturating_sub(1);
                }
            }
            // Its light and its samples of the BSDF end at the first surface.
            "direct" => {
                self.settings().max_depth = 1;
            }
            "moment" | "aov" | "stokes" => {
                self.unsupported(node, "the picture of the integrator inside it is made");
                for child in node
                    .children
                    .iter()
                    .filter(|child| child.tag == "integrator")
                {
                    self.integrator(child);
                }
            }
            _ => self.unsupported(node, "the scene is path-traced"),
        }
    }

    /// The first sensor; further ones are other views of the same scene.
    pub(super) fn sensor(&mut self, node: &'run PluginNode) {
        // Only the first sensor is used.
        if self.has_sensor {
            self.approximate(
                node.span,
                "a second sensor has no effect: the first one is used",
            );
            return;
        }
        self.has_sensor = true;
        self.record(EntityKind::Camera, 0, node.span);
        // The film gives the size, the sampler the samples.
        let film = node.children.iter().find(|child| child.tag == "film");
        let size = film.map_or(SIZE, |film| self.film(film));
        if let Some(sampler) = node.children.iter().find(|child| child.tag == "sampler") {
            let samples = sampler.count("sample_count").unwrap_or(SAMPLES).max(1);
            if let Mode::Path(path) = &mut self.settings().mode {
                path.samples = samples;
            }
        }
        self.medium_of_sensor(node);
        self.clips = ClipPlane::of(node);
        // Lower the camera.
        let to_world = node.transform("to_world");
        let camera = match SENSORS.known(&node.plugin.text) {
            "orthographic" => orthographic(&to_world, size),
            "thinlens" | "perspective" => self.perspective(node, &to_world, size),
            _ => {
                self.unsupported(node, "a perspective camera replaces it");
                self.perspective(node, &to_world, size)
            }
        };
        // A degenerate transform has no view.
        match camera {
            Some(camera) => {
                let crop = film.and_then(|film| self.crop(film, size));
                self.scene.camera = match crop {
                    Some(crop) => cropped(camera, crop),
                    None => camera,
                };
            }
            None => {
                let message = "the transform of the sensor has no direction";
                let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
                self.sink.push(diagnostic.at(node.span, ""));
            }
        }
    }

    /// The first pixel and the size of the part of a film that is kept; `None` for all of it.
    fn crop(&mut self, film: &PluginNode, [width, height]: [u32; 2]) -> Option<[[u32; 2]; 2]> {
        const NAMES: [&str; 4] = [
            "crop_offset_x",
            "crop_offset_y",
            "crop_width",
            "crop_height",
        ];
        NAMES.iter().find(|name| film.get(name).is_some())?;
        let [x, y, w, h] = NAMES.map(|name| film.count(name));
        let offset = [x.unwrap_or(0), y.unwrap_or(0)];
        let size = [w.unwrap_or(width), h.unwrap_or(height)];
        let is_within = |axis: usize, all: u32| {
            size[axis] > 0 && u64::from(offset[axis]) + u64::from(size[axis]) <= u64::from(all)
        };
        if !is_within(0, width) || !is_within(1, height) {
            let message = "the crop of the film is not within it: the whole film is shown";
            self.approximate(film.span, message);
            return None;
        }
        Some([offset, size])
    }

    fn film(&mut self, film: &PluginNode) -> [u32; 2] {
        let side = |name, default| film.count(name).unwrap_or(default).max(1);
        let filter = film.children.iter().find(|child| child.tag == "rfilter");
        let filter = filter.map_or(GAUSSIAN, |filter| self.filter(filter));
        if let Mode::Path(path) = &mut self.settings().mode {
            path.filter = filter;
        }
        [side("width", SIZE[0]), side("height", SIZE[1])]
    }

    fn filter(&mut self, node: &PluginNode) -> PixelFilter {
        let number = |name, default| node.number(name).unwrap_or(default);
        match FILTERS.known(&node.plugin.text) {
            "box" => PixelFilter::Box {
                radius: number("radius", 0.5),
            },
            "tent" => PixelFilter::Tent {
                radius: number("radius", 1.0),
            },
            "gaussian" => {
                let deviation = number("stddev", 0.5);
                let radius = 4.0 * deviation;
                PixelFilter::Gaussian { deviation, radius }
            }
            "mitchell" => {
                // Version 3 calls the two parameters A and B, older ones B and C.
                let third = 1.0 / 3.0;
                let [b, c] = match node.get("A").is_some() || node.get("C").is_none() {
                    true => [number("A", third), number("B", third)],
                    false => [number("B", third), number("C", third)],
                };
                PixelFilter::Mitchell { b, c, radius: 2.0 }
            }
            "catmullrom" => PixelFilter::CATMULL_ROM,
            "lanczos" => {
                let radius = number("lobes", 3.0);
                PixelFilter::Lanczos {
                    window: radius,
                    radius,
                }
            }
            _ => {
                self.unsupported(node, "a Gaussian filter replaces it");
                GAUSSIAN
            }
        }
    }

    /// A perspective camera or a thin lens. The image plane is at the focus distance.
    fn perspective(
        &mut self,
        node: &PluginNode,
        to_world: &AffineTransform,
        size: [u32; 2],
    ) -> Option<Camera> {
        let eye = &to_world.0[3];
        let [left, up, forward] = to_world.orthonormal()?;
        let size_in_pixels = size.map(f64::from);
        let [width, height] = size_in_pixels;
        let is_lens = node.plugin.text == "thinlens";
        let focus = node
            .number("focus_distance")
            .filter(|_| is_lens)
            .unwrap_or(1.0);
        let pixel = pixel_tangent(node, size_in_pixels) * focus;
        let shift = |name, pixels: f64| node.number(name).unwrap_or(0.0) * pixels * pixel;
        // A positive offset moves the picture to the left and up, so the view goes right and down
        // (measured with Mitsuba 3.9.1).
        let center = *eye + forward * focus
            - left * shift("principal_point_offset_x", width)
            - up * shift("principal_point_offset_y", height);
        let radius = node
            .number("aperture_radius")
            .filter(|_| is_lens)
            .unwrap_or(0.0);
        Some(Camera {
            eye: eye.to_array(),
            center: center.to_array(),
            right: (-left * pixel).to_array(),
            up: (up * pixel).to_array(),
            size,
            lens: Lens {
                radius,
                samples: if radius > 0.0 { LENS_SAMPLES } else { 1 },
            },
            projection: Projection::Perspective,
        })
    }
}

/// The side of a pixel of a perspective picture at the distance 1, where the picture has this size
/// in pixels.
pub(super) fn pixel_tangent(node: &PluginNode, [width, height]: [f64; 2]) -> f64 {
    let diagonal = (width * width + height * height).sqrt();
    let axis = node
        .string("fov_axis")
        .map_or("x", |axis| axis.text.as_str());
    let (half_tangent, span) = match (node.number("fov"), axis) {
        (Some(fov), "y") => (tangent(fov / 2.0), height),
        (Some(fov), "smaller") => (tangent(fov / 2.0), width.min(height)),
        (Some(fov), "larger") => (tangent(fov / 2.0), width.max(height)),
        (Some(fov), "diagonal") => (tangent(fov / 2.0), diagonal),
        (Some(fov), _) => (tangent(fov / 2.0), width),
        (None, _) => {
            let focal = node.string("focal_length").map(|focal| focal.text.as_str());
            let focal = focal.map(|focal| focal.trim_end_matches("mm").trim());
            let focal = focal.and_then(|focal| focal.parse::<f64>().ok());
            let focal = focal.unwrap_or(FOCAL_LENGTH);
            (FILM_DIAGONAL / 2.0 / focal, diagonal)
        }
    };
    2.0 * half_tangent / span
}

/// The part of a picture whose first pixel and size are given, as a camera.
fn cropped(camera: Camera, [offset, size]: [[u32; 2]; 2]) -> Camera {
    let by = |axis: usize| {
        let middle = f64::from(offset[axis]) + f64::from(size[axis]) / 2.0;
        middle - f64::from(camera.size[axis]) / 2.0
    };
    let [right, up] = [camera.right, camera.up].map(Vec3::from_array);
    let moved = right * by(0) - up * by(1);
    let from = |point: [f64; 3]| (Vec3::from_array(point) + moved).to_array();
    Camera {
        // The rays of an orthographic camera stay parallel.
        eye: match camera.projection {
            Projection::Orthographic => from(camera.eye),
            Projection::Perspective => camera.eye,
        },
        center: from(camera.center),
        size,
        ..camera
    }
}

/// The tangent of an angle in degrees.
pub(super) fn tangent(degrees: f64) -> f64 {
    let angle = degrees.to_radians();
    sin(angle) / cos(angle)
}

/// The picture of an orthographic sensor is 2 wide, scaled by `to_world`.
fn orthographic(to_world: &AffineTransform, size: [u32; 2]) -> Option<Camera> {
    let AffineTransform([x, _, z, eye]) = to_world;
    let [left, up, forward] = to_world.orthonormal()?;
    let pixel = x.length() * 2.0 / f64::from(size[0]);
    Some(Camera {
        eye: eye.to_array(),
        center: (*eye + forward * z.length()).to_array(),
        right: (-left * pixel).to_array(),
        up: (up * pixel).to_array(),
        size,
        lens: Lens::PINHOLE,
        projection: Projection::Orthographic,
    })
}
