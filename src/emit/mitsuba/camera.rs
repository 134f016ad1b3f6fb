//! Writes the camera: a perspective one (any frustum with square pixels, with or without a thin
//! lens) or an orthographic one.

use super::MitsubaWriter;
use crate::export::joined;
use crate::flat::{around, side};
use crate::path_tracer::{CameraFrame, SQUARE, pixel_filter};
use rtc_ir::{EntityField, EntityKind, Projection, ValuePath};
use rtc_math::{PixelFilter, Vec3, length, shortest};

impl MitsubaWriter<'_> {
    /// Mitsuba's camera looks along its z axis, with y up and x to the left.
    pub(super) fn camera(&mut self) {
        let camera = &self.scene.camera;
        let frame = CameraFrame::of(camera);
        self.square_pixels(
            length(Vec3::from_array(camera.right)),
            length(Vec3::from_array(camera.up)),
        );
        // Sensor and projection.
        let [x, y, z] = frame.axes;
        let is_lens = camera.lens.radius > 0.0;
        match camera.projection {
            Projection::Perspective => {
                self.perspective(is_lens, &frame);
                if is_lens {
                    let radius = shortest(camera.lens.radius);
                    self.value(2, "float", "aperture_radius", &radius);
                    self.value(2, "float", "focus_distance", &shortest(frame.distance));
                }
                self.placed([-x, y, z, frame.eye]);
            }
            Projection::Orthographic => self.orthographic(&frame),
        }
        // Medium, clipping planes and film.
        if let Some(medium) = &self.scene.medium {
            self.medium(2, r#"name="medium""#, medium);
        }
        self.clips();
        self.film(camera.size);
    }

    /// The clipping planes of Mitsuba's camera: near at a millionth of the scene radius, far beyond
    /// the squares of planes.
    fn clips(&mut self) {
        let around = around(self.scene);
        self.value(2, "float", "near_clip", &shortest(1e-6 * around.radius));
        self.value(2, "float", "far_clip", &shortest(4.0 * side(around)));
    }

    fn square_pixels(&mut self, right: f64, up: f64) {
        if (right / up - 1.0).abs() > SQUARE {
            let message = "pixels are not square: Mitsuba's are, as high as these";
            let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
            self.beside.reporter.unsupported(message, path);
        }
    }

    /// Starts the sensor; its principal point may be off-centre.
    fn perspective(&mut self, is_lens: bool, frame: &CameraFrame) {
        let kind = if is_lens { "thinlens" } else { "perspective" };
        self.line(1, &format!(r#"<sensor type="{kind}">"#));
        let degrees = self.scene.camera.yfov().map_or(0.0, f64::to_degrees);
        self.value(2, "string", "fov_axis", "y");
        self.value(2, "float", "fov", &shortest(degrees));
        match (frame.is_shifted(), is_lens) {
            (false, _) => {}
            (true, false) => {
                let [x, y] = frame.shift;
                let (x, y) = (shortest(x / 2.0), shortest(-y / 2.0));
                self.value(2, "float", "principal_point_offset_x", &x);
                self.value(2, "float", "principal_point_offset_y", &y);
            }
            (true, true) => {
                let message = "a lens looks past the middle of the picture: Mitsuba's does not";
                let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
                self.beside.reporter.unsupported(message, path);
            }
        }
    }

    /// Mitsuba's orthographic image extends from −1 to 1 horizontally.
    fn orthographic(&mut self, frame: &CameraFrame) {
        if frame.is_slanted() {
            let message = "rays come slantwise through the picture: Mitsuba's come straight";
            let path = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
            self.beside.reporter.unsupported(message, path);
        }
        self.line(1, r#"<sensor type="orthographic">"#);
        let ([x, y, z], [half, _]) = (frame.axes, frame.half);
        self.placed([-x * half, y * half, z, frame.eye]);
    }

    /// The transform to the world, by its columns.
    pub(super) fn placed(&mut self, columns: [Vec3; 4]) {
        self.line(2, r#"<transform name="to_world">"#);
        self.line(3, &matrix(columns));
        self.line(2, "</transform>");
    }

    fn filter(&mut self) {
        let filter = pixel_filter(&self.scene.settings);
        let (plugin, values) = match filter {
            // The radius of a box is always 1/2: Mitsuba refuses one.
            PixelFilter::Box { .. } => ("box", vec![]),
            PixelFilter::Tent { radius } => ("tent", vec![("radius", radius)]),
            PixelFilter::Gaussian { deviation, .. } => ("gaussian", vec![("stddev", deviation)]),
            PixelFilter::Mitchell { b, c, .. } => ("mitchell", vec![("A", b), ("B", c)]),
            PixelFilter::Lanczos { radius, .. } => ("lanczos", vec![("lobes", radius)]),
        };
        // The radii that Mitsuba has.
        let is_same = match filter {
            PixelFilter::Box { radius } => radius == 0.5,
            PixelFilter::Tent { .. } => true,
            PixelFilter::Gaussian { deviation, radius } => radius == 4.0 * deviation,
            PixelFilter::Mitchell { radius, .. } => radius == 2.0,
            PixelFilter::Lanczos { window, radius } => window == radius && radius.fract() == 0.0,
        };
        if !is_same {
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Mode);
            let message = "Mitsuba's filter of this kind has another radius";
            self.beside.reporter.unsupported(message, path);
        }
        self.line(3, &format!(r#"<rfilter type="{plugin}">"#));
        for (name, value) in values {
            match name {
                "lobes" => self.value(4, "integer", name, &shortest(value.round())),
                _ => self.value(4, "float", name, &shortest(value)),
            }
        }
        self.line(3, "</rfilter>");
    }

    fn film(&mut self, [width, height]: [u32; 2]) {
        self.line(2, r#"<film type="hdrfilm">"#);
        self.value(3, "integer", "width", &width.to_string());
        self.value(3, "integer", "height", &height.to_string());
        self.value(3, "string", "pixel_format", "rgb");
        self.value(3, "string", "component_format", "float32");
        self.filter();
        self.line(2, "</film>");
        self.line(2, r#"<sampler type="$sampler">"#);
        self.value(3, "integer", "sample_count", "$spp");
        self.line(2, "</sampler>");
        self.line(1, "</sensor>");
    }
}

/// An affine map given by its columns, as rows.
fn matrix(columns: [Vec3; 4]) -> String {
    let row = |k: usize| {
        let [a, b, c, d] = columns.map(|column| column[k]);
        [a, b, c, d]
    };
    let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]];
    format!(
        r#"<matrix value="{}"/>"#,
        joined(rows.into_iter().flatten(), " ")
    )
}
