//! A camera by its axes and its image.

use rtc_ir::Camera;
use rtc_math::{Vec3, length, unit};

/// The largest relative difference that counts as none: of the sides of a pixel, and of directions.
pub(crate) const SQUARE: f64 = 1e-9;

/// The axes of a camera in the world, and its image in their coordinates.
pub(crate) struct CameraFrame {
    pub(crate) eye: Vec3,
    /// The directions to the right, upwards and of the view, unit vectors.
    pub(crate) axes: [Vec3; 3],
    /// The distance from the eye to the image, in scene units.
    pub(crate) distance: f64,
    /// Half the width and half the height of the image, in scene units.
    pub(crate) half: [f64; 2],
    /// How far the centre of the image is from the axis, to the right and upwards, in half widths
    /// and half heights.
    pub(crate) shift: [f64; 2],
}

impl CameraFrame {
    pub(crate) fn of(camera: &Camera) -> Self {
        let [eye, center, right, up] =
            [camera.eye, camera.center, camera.right, camera.up].map(Vec3::from_array);
        let [x, y] = [right, up].map(|step| unit(step).unwrap_or(Vec3::X));
        let across = unit(x.cross(y)).unwrap_or(Vec3::Z);
        let z = if across.dot(center - eye) < 0.0 {
            -across
        } else {
            across
        };
        let distance = (center - eye).dot(z);
        let [width, height] = camera.size.map(f64::from);
        let half = [length(right) * width / 2.0, length(up) * height / 2.0];
        let middle = center - (eye + z * distance);
        Self {
            eye,
            axes: [x, y, z],
            distance,
            half,
            shift: [middle.dot(x) / half[0], middle.dot(y) / half[1]],
        }
    }

    /// Whether the centre of the image is visibly off the axis.
    pub(crate) fn is_shifted(&self) -> bool {
        /// The largest offset that counts as none, in half image sizes.
        const CENTERED: f64 = 1e-12;
        self.shift.iter().any(|shift| shift.abs() > CENTERED)
    }

    /// Whether parallel rays would cross the image at a slant: they have the direction from the eye
    /// to the centre of the image.
    pub(crate) fn is_slanted(&self) -> bool {
        let [x, y, z] = self.axes;
        let [across, upward] = [0, 1].map(|k| self.shift[k] * self.half[k]);
        let view = unit(x * across + y * upward + z * self.distance);
        view.is_some_and(|view| view.distance(z) > SQUARE)
    }
}
