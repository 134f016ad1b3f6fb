//! The camera rays of a pixel, by the formulas of `rtc_ir::Camera` in real numbers.

use super::number::CertifiedNumber;
use super::sampling::{CertifiedKey, spiral_turns};
use super::shape::CertifiedRay;
use super::vector::CertifiedVector;
use rtc_ir::{Camera, Pattern, Projection, Scene};
use rtc_math::{Vec3, Vector};

/// A camera, and the arrangement of its samples.
pub(super) struct CertifiedCamera<N> {
    eye: Vector<N>,
    center: Vector<N>,
    right: Vector<N>,
    up: Vector<N>,
    size: [u32; 2],
    factor: u32,
    pattern: Pattern,
    /// The points of the lens from the eye.
    lens: Vec<Vector<N>>,
    projection: Projection,
}

impl<N: CertifiedNumber> CertifiedCamera<N> {
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
            [eye, center, right, up].map(|v| Vector::point(Vec3::from_array(*v)));
        let count = if lens.radius == 0.0 { 1 } else { lens.samples };
        // Point k of Vogel's spiral: r = R·√(k/n)/‖up‖, θ = k golden angles.
        let point = |k: u32| {
            let number = |x: u32| N::point(f64::from(x));
            let share = (number(k) / number(count)).sqrt();
            let r = N::point(lens.radius) * share / up.length();
            let [across, upward] = N::cos_sin(spiral_turns(k, 0)).map(|x| r * x);
            right * across + up * upward
        };
        Self {
            eye,
            center,
            right,
            up,
            size: *size,
            factor: scene.settings.supersampling,
            pattern: scene.settings.pattern,
            lens: (0..count).map(point).collect(),
            projection: *projection,
        }
    }

    /// The rays of all samples of a pixel, each with its key.
    pub(super) fn rays(
        &self,
        pixel: [u32; 2],
    ) -> impl Iterator<Item = (CertifiedRay<N>, CertifiedKey)> {
        let cells = u64::from(self.factor) * u64::from(self.factor);
        let count = self.lens.len() as u64;
        (0..cells).flat_map(move |cell| {
            let target = self.target(pixel, self.place(pixel, cell));
            let lens = self.lens.iter().zip(cell * count..);
            lens.map(move |(lens, sample)| {
                (self.ray(*lens, target), CertifiedKey::new(pixel, sample))
            })
        })
    }

    /// The ray through the middle of a pixel.
    pub(super) fn middle(&self, pixel: [u32; 2]) -> CertifiedRay<N> {
        let none = Vector::point(Vec3::ZERO);
        self.ray(none, self.target(pixel, [N::point(0.5); 2]))
    }

    /// The offset of a sub-sample within its pixel: in the middle of its cell, anywhere in it, or
    /// anywhere in the pixel.
    fn place(&self, pixel: [u32; 2], cell: u64) -> [N; 2] {
        /// Makes the random numbers of sub-samples independent of those of the paths.
        const PATTERN: u64 = u64::MAX;
        let key = CertifiedKey::new(pixel, cell).child(PATTERN);
        let random = || [0, 1].map(|axis| N::point(key.uniform(axis)));
        let factor = u64::from(self.factor);
        let corner = [cell % factor, cell / factor];
        let within = |offset: [N; 2]| {
            [0, 1].map(|k| (N::point(corner[k] as f64) + offset[k]) / N::point(factor as f64))
        };
        match self.pattern {
            Pattern::Grid => within([N::point(0.5); 2]),
            Pattern::Jitter => within(random()),
            Pattern::Random => random(),
        }
    }

    /// `center + (x + place₀ − width/2)·right + (height/2 − y − place₁)·up`.
    fn target(&self, [x, y]: [u32; 2], place: [N; 2]) -> Vector<N> {
        let number = |x: f64| N::point(x);
        let [half_width, half_height] = self.size.map(|side| number(f64::from(side) / 2.0));
        let across = number(f64::from(x)) + place[0] - half_width;
        let upward = half_height - number(f64::from(y)) - place[1];
        self.center + self.right * across + self.up * upward
    }

    /// The ray from a point of the lens through a point of the image.
    fn ray(&self, lens: Vector<N>, target: Vector<N>) -> CertifiedRay<N> {
        let lens = self.eye + lens;
        let origin = match self.projection {
            Projection::Perspective => lens,
            Projection::Orthographic => lens + (target - self.center),
        };
        CertifiedRay::new(origin, (target - origin).normalized(), None)
    }
}
