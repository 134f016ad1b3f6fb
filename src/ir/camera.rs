//! The camera: eye, image plane and lens.

use arbitrary::Arbitrary;
use rtc_math::{Vec3, atan2, cos, length, rotated_about, sin, unit, unit_scale};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A camera with any frustum, including sheared ones.
///
/// Sub-sample (i, j) of pixel (x, y), y downwards, looks from the eye through
/// `center + (x + (i+½)/factor − width/2)·right + (height/2 − y − (j+½)/factor)·up`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Camera {
    /// The origin of the rays.
    pub eye: [f64; 3],
    /// The centre of the image, a point of the plane of focus.
    pub center: [f64; 3],
    /// The vector from a pixel to its right neighbour in the image plane.
    pub right: [f64; 3],
    /// The vector from a pixel to its upper neighbour; perpendicular to `right`.
    pub up: [f64; 3],
    /// Width and height of the image in pixels.
    #[schemars(inner(range(min = 1)))]
    pub size: [u32; 2],
    /// The aperture.
    pub lens: Lens,
    /// The projection.
    #[serde(default, skip_serializing_if = "Projection::is_perspective")]
    pub projection: Projection,
}

impl Default for Camera {
    /// One pixel, seen from (0, 0, 1) towards the origin.
    fn default() -> Self {
        Self {
            eye: [0.0, 0.0, 1.0],
            center: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            size: [1, 1],
            lens: Lens::PINHOLE,
            projection: Projection::Perspective,
        }
    }
}

impl Camera {
    /// The size of a pixel in scene units at `distance`, where `height` pixels span the angle
    /// `yfov` (radians).
    #[must_use]
    pub fn pixel(yfov: f64, distance: f64, height: u32) -> f64 {
        2.0 * sin(yfov / 2.0) / cos(yfov / 2.0) * distance / f64::from(height)
    }

    /// The world axis, with sign, that is closest to the up direction.
    #[must_use]
    pub fn upright(&self) -> Vec3 {
        let up = Vec3::from_array(self.up);
        let better = |best: Vec3, axis: Vec3| {
            if up.dot(axis).abs() > up.dot(best).abs() {
                axis
            } else {
                best
            }
        };
        let axis = [Vec3::Z, Vec3::X].into_iter().fold(Vec3::Y, better);
        if up.dot(axis) < 0.0 { -axis } else { axis }
    }

    /// The camera rotated by `angle` (radians) about the line through `through` along the unit
    /// vector `axis`.
    #[must_use]
    pub fn turned(&self, angle: f64, axis: Vec3, through: Vec3) -> Self {
        let turn = |v: Vec3| rotated_about(v, axis, [sin(angle), cos(angle)]);
        let point = |p: [f64; 3]| (through + turn(Vec3::from_array(p) - through)).to_array();
        let step = |s: [f64; 3]| turn(Vec3::from_array(s)).to_array();
        let Self {
            eye,
            center,
            right,
            up,
            size,
            lens,
            projection,
        } = self.clone();
        Self {
            eye: point(eye),
            center: point(center),
            right: step(right),
            up: step(up),
            size,
            lens,
            projection,
        }
    }

    /// The distance from the eye to the image plane.
    #[must_use]
    pub fn distance(&self) -> f64 {
        let [eye, center, right, up] =
            [self.eye, self.center, self.right, self.up].map(Vec3::from_array);
        let [right, up] =
            [right, up].map(|step| unit_scale(step).map_or(Vec3::ZERO, |(scaled, _)| scaled));
        (center - eye)
            .dot(unit(right.cross(up)).unwrap_or(Vec3::ZERO))
            .abs()
    }

    /// The matrix from world to camera coordinates (the camera looks along −z, y is up), row-major
    /// and for row vectors; `None` if `right` or `up` has no direction, or if the eye is too far
    /// away for 32 bits to hold its position.
    #[must_use]
    pub fn world_to_camera(&self) -> Option<[f32; 16]> {
        let [eye, center, right, up] =
            [self.eye, self.center, self.right, self.up].map(Vec3::from_array);
        let (x, y) = (unit(right)?, unit(up)?);
        let across = x.cross(y);
        let z = if across.dot(center - eye) > 0.0 {
            -across
        } else {
            across
        };
        let axes = [x, y, z];
        let row = |k: usize| axes.map(|axis| axis[k]);
        let translation = axes.map(|axis| -axis.dot(eye));
        let rows = [row(0), row(1), row(2), translation];
        let entry = |at: usize| match at % 4 {
            3 => f64::from(u8::from(at == 15)),
            column => rows[at / 4][column],
        };
        #[expect(
            clippy::cast_possible_truncation,
            reason = "EXR holds these as 32-bit floats"
        )]
        let matrix: [f32; 16] = std::array::from_fn(|at| entry(at) as f32);
        matrix
            .iter()
            .all(|number| number.is_finite())
            .then_some(matrix)
    }

    /// The vertical field of view in radians, in (0, π); `None` for an orthographic camera.
    #[must_use]
    pub fn yfov(&self) -> Option<f64> {
        let half = length(Vec3::from_array(self.up)) * f64::from(self.size[1]) / 2.0;
        let angle = 2.0 * atan2(half, self.distance());
        (self.projection == Projection::Perspective && angle > 0.0 && angle < PI).then_some(angle)
    }

    /// Changes the image size in pixels. The new image shows at least the old one; if the aspect
    /// ratio differs, it shows more at two sides.
    pub fn fit(&mut self, size: [u32; 2]) {
        let ratio = |side: usize| f64::from(self.size[side]) / f64::from(size[side]);
        let ratio = ratio(0).max(ratio(1));
        let scaled = |step: [f64; 3]| step.map(|component| component * ratio);
        (self.right, self.up, self.size) = (scaled(self.right), scaled(self.up), size);
    }

    /// Sets the vertical field of view, in radians, without moving the camera.
    pub fn open(&mut self, yfov: f64) {
        let [_, height] = self.size;
        let scale = Self::pixel(yfov, self.distance(), height) / length(Vec3::from_array(self.up));
        let scaled = |step: [f64; 3]| step.map(|component| component * scale);
        (self.right, self.up) = (scaled(self.right), scaled(self.up));
        self.projection = Projection::Perspective;
    }
}

/// The projection of a camera.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Projection {
    /// Rays start at the eye.
    #[default]
    Perspective,
    /// Parallel rays: each passes through its point of the image in the direction from the eye to
    /// the image centre, and starts at the distance of the eye before the image.
    Orthographic,
}

impl Projection {
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_perspective(&self) -> bool {
        *self == Self::Perspective
    }
}

/// A thin lens; with radius 0 or one sample it is a pinhole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Lens {
    /// The radius of the aperture in scene units, at least 0.
    #[schemars(range(min = 0.0))]
    pub radius: f64,
    /// Aperture samples of each sub-sample, at least 1.
    #[schemars(range(min = 1))]
    pub samples: u32,
}

impl Lens {
    /// No lens: everything is in focus.
    pub const PINHOLE: Self = Self {
        radius: 0.0,
        samples: 1,
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: [0.0, 0.0, 10.0],
            center: [0.0; 3],
            right: [0.5, 0.0, 0.0],
            up: [0.0, 0.5, 0.0],
            size: [8, 4],
            lens: Lens::PINHOLE,
            projection: Projection::Perspective,
        }
    }

    #[test]
    fn an_angle_spans_the_height_of_the_picture() {
        let mut camera = camera();
        camera.open(std::f64::consts::FRAC_PI_2);
        assert!(
            (4.0 * camera.up[1] - 20.0).abs() < 1e-12
                && (camera.right[0] - camera.up[1]).abs() < 1e-12
        );
    }

    #[test]
    fn a_turn_of_a_quarter_and_the_axis_that_is_up() {
        let turned = camera().turned(
            std::f64::consts::FRAC_PI_2,
            Vec3::Y,
            Vec3::new(0.0, 7.0, 0.0),
        );
        let near =
            |a: [f64; 3], b: [f64; 3]| Vec3::from_array(a).distance(Vec3::from_array(b)) < 1e-12;
        assert!(
            near(turned.eye, [10.0, 0.0, 0.0]) && near(turned.right, [0.0, 0.0, -0.5]),
            "{turned:?}"
        );
        assert!(near(turned.up, [0.0, 0.5, 0.0]) && near(turned.center, [0.0; 3]));
        let tilted = Camera {
            up: [0.1, 0.2, -0.4],
            ..camera()
        };
        assert_eq!(
            (camera().upright(), tilted.upright()),
            (Vec3::Y, Vec3::NEG_Z)
        );
    }
}
