//! The camera rays of a pixel, by the formulas of `rtc_ir::Camera` in real numbers.

use super::enclosure::{Enclosure, EnclosureVector};
use super::shape::CertifiedRay;
use rtc_ir::{Camera, Projection, Scene};
use rtc_math::{U, Vec3, cos_sin_revolutions, golden_revolutions};

/// A camera, and the arrangement of its samples.
pub(super) struct CertifiedCamera {
    eye: EnclosureVector,
    center: EnclosureVector,
    right: EnclosureVector,
    up: EnclosureVector,
    size: [u32; 2],
    factor: u32,
    /// The points of the lens from the eye.
    lens: Vec<EnclosureVector>,
    projection: Projection,
}

impl CertifiedCamera {
    pub(super) fn new(scene: &Scene) -> Self {
        let Camera {
            eye,
            center,
            right,
            up,
            size,
            lens,
            projection,
        } = &scene.camera;
        let [eye, center, right, up] =
            [eye, center, right, up].map(|v| EnclosureVector::point(Vec3::from_array(*v)));
        let count = if lens.radius == 0.0 { 1 } else { lens.samples };
        // Point k of Vogel's spiral: r = R·√(k/n)/‖up‖, θ = k·π(3 − √5).
        let point = |k: u32| {
            let number = |x: u32| Enclosure::point(f64::from(x));
            let share = (number(k) / number(count)).sqrt();
            let r = Enclosure::point(lens.radius) * share / up.length();
            let (cosine, sine) = cos_sin_revolutions(golden_revolutions(k.into()));
            // The constant is rounded to 2⁻⁶⁴ turns, the functions to 2 u.
            let error = 4.0 * U + f64::from(k) * U / 256.0;
            let [across, upward] = [cosine, sine].map(|x| r * Enclosure::around(x, error));
            right * across + up * upward
        };
        Self {
            eye,
            center,
            right,
            up,
            size: *size,
            factor: scene.settings.supersampling,
            lens: (0..count).map(point).collect(),
            projection: *projection,
        }
    }

    /// The rays of all samples of a pixel.
    pub(super) fn rays(&self, pixel: [u32; 2]) -> impl Iterator<Item = CertifiedRay> {
        let cells = (0..self.factor).flat_map(|row| (0..self.factor).map(move |x| [x, row]));
        cells.flat_map(move |cell| {
            let target = self.target(pixel, cell, self.factor);
            self.lens.iter().map(move |lens| self.ray(*lens, target))
        })
    }

    /// The ray through the middle of a pixel.
    pub(super) fn middle(&self, pixel: [u32; 2]) -> CertifiedRay {
        let none = EnclosureVector::point(Vec3::ZERO);
        self.ray(none, self.target(pixel, [0; 2], 1))
    }

    /// `center + (x + (i + ½)/factor − width/2)·right + (height/2 − y − (j + ½)/factor)·up`.
    fn target(&self, [x, y]: [u32; 2], [i, j]: [u32; 2], factor: u32) -> EnclosureVector {
        let number = |x: f64| Enclosure::point(x);
        let place = |cell: u32| number(f64::from(cell) + 0.5) / number(f64::from(factor));
        let [half_width, half_height] = self.size.map(|side| number(f64::from(side) / 2.0));
        let across = number(f64::from(x)) + place(i) - half_width;
        let upward = half_height - number(f64::from(y)) - place(j);
        self.center + self.right * across + self.up * upward
    }

    /// The ray from a point of the lens through a point of the image.
    fn ray(&self, lens: EnclosureVector, target: EnclosureVector) -> CertifiedRay {
        let lens = self.eye + lens;
        let origin = match self.projection {
            Projection::Perspective => lens,
            Projection::Orthographic => lens + (target - self.center),
        };
        CertifiedRay::new(origin, (target - origin).normalized(), None)
    }
}
