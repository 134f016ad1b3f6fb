//! A conservative f32 ray in the local cube of a BVH. Traversal with it may report false hits but
//! never misses one.
//!
//! All coordinates are relative to a cube around the geometry, so f32 does not overflow at any
//! scale of the scene. The ray is transformed into the cube in f64. Every comparison is widened by
//! a bound on the rounding errors. The hit itself is computed in f64 by the shape.

use crate::ray::Ray;
use rtc_math::{Bounds, U, Vec3, ldexp};

/// The unit round-off of f32, 2⁻²⁴.
const ROUND: f64 = 0.5 * f32::EPSILON as f64;

/// Directions are at least this steep to every axis; within the cube that moves no ray by more than
/// [`MIN_DISTANCE`].
const MIN_SLOPE: f64 = 1.0 / 1_099_511_627_776.0;

/// The least distance that counts.
const MIN_DISTANCE: f64 = 1.0 / 68_719_476_736.0;

/// Relative slack on t: more than the relative error of a root.
const T_SLACK: f64 = 1.0 / 1_048_576.0;

/// The cube is centred on the origin if it is at most this many times as large as one around the
/// geometry.
const OFF_CENTER: f64 = 16.0;

/// The position and scale of the cube [−1, 1]³ in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuantizationFrame {
    center: Vec3,
    /// A power of two.
    scale: f64,
    /// The rounding error of a corner, in the cube.
    error_bound: f64,
}

impl QuantizationFrame {
    /// The cube around some boxes, not much larger than needed; `error_bound` bounds the error of
    /// the coordinates in them.
    ///
    /// Where that costs few bits the cube is centred at the origin: then 32-bit corners stay exact
    /// up to a power of two. Otherwise it is finest where most of the boxes are, around the mean of
    /// their centres.
    pub(crate) fn around(whole: Bounds, mean: impl FnOnce() -> Vec3, error_bound: f64) -> Self {
        let extent_about = |center: Vec3| {
            let far = (whole.min - center).abs().max((whole.max - center).abs());
            far.max_element()
        };
        let is_near = extent_about(Vec3::ZERO) <= OFF_CENTER * extent_about(whole.center());
        let center = if is_near { Vec3::ZERO } else { mean() };
        let extent = extent_about(center);
        let exponent = if extent > 0.0 {
            (libm::ilogb(extent) + 1).clamp(-900, 1000)
        } else {
            0
        };
        let scale = ldexp(1.0, -exponent);
        Self {
            center,
            scale,
            error_bound: error_bound * scale,
        }
    }

    /// A point in the cube.
    pub(in crate::accel) fn enter(&self, point: Vec3) -> Vec3 {
        (point - self.center) * self.scale
    }

    /// The exact original of a coordinate in a cube centred at the origin; `None` for other cubes.
    pub(in crate::accel) fn unit(&self) -> Option<f64> {
        (self.center == Vec3::ZERO).then(|| self.scale.recip())
    }

    /// A box in the cube, rounded outward: its lowest and its highest corner.
    pub(in crate::accel) fn rounded_outward(&self, bounds: Bounds) -> [[f32; 3]; 2] {
        let (min, max) = (self.enter(bounds.min), self.enter(bounds.max));
        [
            min.to_array().map(rounded_down),
            max.to_array().map(|x| -rounded_down(-x)),
        ]
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded down")]
fn rounded_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x {
        nearest.next_down()
    } else {
        nearest
    }
}

/// Why there is no conservative ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RayRejection {
    /// The ray misses the cube.
    Missed,
    /// The arithmetic cannot decide: the ray may hit anything.
    Indeterminate,
}

/// A ray in a cube. Its own t counts from where it comes near the cube, in units in which it moves
/// along its main axis as fast as t.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConservativeRay {
    /// The axes with the main one last, and where it starts along them.
    pub(in crate::accel) axes: [usize; 3],
    pub(in crate::accel) origin: [f32; 3],
    /// Shifted for the nearer and the farther ends of boxes.
    pub(in crate::accel) near_origin: [f32; 3],
    pub(in crate::accel) far_origin: [f32; 3],
    pub(in crate::accel) inverse: [f32; 3],
    /// Whether the upper end of a box is the nearer one.
    pub(in crate::accel) down: [bool; 3],
    /// Its direction along the main axis, ±1, and the slopes of the others along it.
    pub(in crate::accel) main: f32,
    pub(in crate::accel) slopes: [f32; 2],
    /// The error of a coordinate relative to the ray.
    pub(in crate::accel) error: f32,
    /// What 1 of the ray's t is in `self`, and where `self` starts.
    rate: f64,
    start: f64,
}

impl ConservativeRay {
    /// The part of a ray that may be inside a cube.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is meant; errors are bounded"
    )]
    pub(crate) fn new(frame: &QuantizationFrame, ray: &Ray) -> Result<Self, RayRejection> {
        let size = ray.direction.abs();
        let speed = size.max_element();
        let main = if size.x == speed {
            0
        } else {
            2 - usize::from(size.y == speed)
        };
        let mut direction = ray.direction * speed.recip();
        direction[main] = 1.0_f64.copysign(ray.direction[main]);
        let far = frame.enter(ray.origin);
        let distance = far.abs().max_element();
        let rate = speed * frame.scale;
        if !(direction.is_finite() && distance < 1e30 && rate.is_normal()) {
            return Err(RayRejection::Indeterminate);
        }
        // Points of the cube have t between the distance ∓ 1.
        let start = (distance - 2.0).max(0.0);
        let origin = far + direction * start;
        let largest = origin.abs().max_element();
        let base = MIN_DISTANCE + 64.0 * U * (1.0 + distance);
        if largest > 5.0 + base {
            return Err(RayRejection::Missed);
        }
        let steep = direction
            .abs()
            .max(Vec3::splat(MIN_SLOPE))
            .copysign(direction);
        // Twice the rounding of the origin to f32, and once more for the sum.
        let shift = (origin.abs() * (4.0 * ROUND) + 2.0 * base).copysign(direction);
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        let down = direction.is_negative_bitmask();
        Ok(Self {
            // Written out: `map` of an array is a call here.
            origin: [
                origin[axes[0]] as f32,
                origin[axes[1]] as f32,
                origin[axes[2]] as f32,
            ],
            near_origin: (origin + shift).as_vec3().to_array(),
            far_origin: (origin - shift).as_vec3().to_array(),
            inverse: [
                (steep.x as f32).recip(),
                (steep.y as f32).recip(),
                (steep.z as f32).recip(),
            ],
            down: [down & 1 != 0, down & 2 != 0, down & 4 != 0],
            axes,
            main: direction[main] as f32,
            slopes: [direction[axes[0]] as f32, direction[axes[1]] as f32],
            error: (10.0 * ROUND * (1.0 + largest) + 2.0 * base + 2.0 * frame.error_bound) as f32,
            rate,
            start,
        })
    }

    /// The end of the conservative ray for a `t_max` of the ray, rounded up by more than a root may
    /// be wrong.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounded up")]
    pub(crate) fn t_far(&self, t_max: f64) -> f32 {
        let end = t_max * self.rate * (1.0 + T_SLACK) - self.start;
        end as f32 * (1.0 + 2.0 * f32::EPSILON) + self.error
    }

    /// The t up to which the conservative ray is certainly before a `t_max` of the ray.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounded down")]
    pub(in crate::accel) fn t_certain(&self, t_max: f64) -> f32 {
        let end = t_max * self.rate * (1.0 - T_SLACK) - self.start;
        end as f32 * (1.0 - 4.0 * f32::EPSILON) - 2.0 * self.error
    }
}
