//! Four boxes or triangles against one ray at once, in single precision: what may be hit is never
//! passed over.
//!
//! All is measured in a cube about the geometry, so that no number leaves the range of f32 whatever
//! the scale of the scene. Rays are brought to the cube in f64; a bound on what rounding does to
//! each widens every comparison. The hit itself is decided elsewhere, in f64.

use crate::math::{Lanes, U, Vec3, ldexp};
use crate::render::accel::bounds::Bounds;
use crate::render::ray::Ray;

/// The unit round-off of f32, 2⁻²⁴.
const ROUND: f64 = 0.5 * f32::EPSILON as f64;

/// Directions are at least this steep to every axis; within the cube that moves no ray by more than
/// [`FLOOR`].
const STEEP: f64 = 1.0 / 1_099_511_627_776.0;

/// The least distance that counts.
const FLOOR: f64 = 1.0 / 68_719_476_736.0;

/// Where the cube [−1, 1]³ lies in space.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct QuantizationFrame {
    center: Vec3,
    /// A power of two.
    scale: f64,
    /// How far rounding may have moved a corner, in the cube.
    error_bound: f64,
}

/// Four boxes: for each axis the lower and the upper ends.
pub(in crate::render) type Boxes = [[Lanes; 2]; 3];

/// Four triangles: for each corner its coordinates.
pub(in crate::render) type Corners = [[Lanes; 3]; 3];

impl QuantizationFrame {
    /// The cube around some boxes, not far larger than needed and finest where most of them are;
    /// `error_bound` bounds the error of the corners of what is in them.
    pub(in crate::render) fn around(
        boxes: impl Iterator<Item = Bounds> + Clone,
        error_bound: f64,
    ) -> Self {
        let count = boxes.clone().count() as f64;
        let center = boxes
            .clone()
            .map(|bounds| bounds.center() / count)
            .sum::<Vec3>();
        let largest = |bounds: Bounds| {
            (bounds.min - center)
                .abs()
                .max((bounds.max - center).abs())
                .max_element()
        };
        let extent = boxes.map(largest).fold(0.0, f64::max);
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

    fn enter(&self, point: Vec3) -> Vec3 {
        (point - self.center) * self.scale
    }

    /// Four boxes, rounded outward; those beyond the count given are met by no ray.
    pub(in crate::render) fn boxes(&self, bounds: &[Bounds]) -> Boxes {
        let mut ends = [[[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]]; 3];
        for (lane, bounds) in bounds.iter().enumerate() {
            let (min, max) = (self.enter(bounds.min), self.enter(bounds.max));
            for (axis, [low, high]) in ends.iter_mut().enumerate() {
                (low[lane], high[lane]) = (rounded_down(min[axis]), -rounded_down(-max[axis]));
            }
        }
        ends.map(|ends| ends.map(Lanes::from_array))
    }

    /// Four triangles, or fewer.
    pub(in crate::render) fn corners(&self, triangles: &[[Vec3; 3]]) -> Corners {
        let mut places = [[[0.0; 4]; 3]; 3];
        for (lane, triangle) in triangles.iter().enumerate() {
            for (places, corner) in places.iter_mut().zip(triangle) {
                let corner = self.enter(*corner).as_vec3().to_array();
                places
                    .iter_mut()
                    .zip(corner)
                    .for_each(|(lanes, place)| lanes[lane] = place);
            }
        }
        places.map(|places| places.map(Lanes::from_array))
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

/// Why there is no beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) enum NoBeam {
    /// The ray misses the cube.
    Missed,
    /// The arithmetic can't tell: anything may be hit.
    Untold,
}

/// A ray in a cube. Its own t counts from where it comes near the cube, in units in which it moves
/// along its main axis as fast as t.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Beam {
    /// The axes with the main one last, and where it starts along them.
    axes: [usize; 3],
    origin: [Lanes; 3],
    /// Shifted for the nearer and the farther ends of boxes.
    near_origin: [Lanes; 3],
    far_origin: [Lanes; 3],
    inverse: [Lanes; 3],
    /// 1 where the upper end of a box is the nearer one.
    down: [usize; 3],
    /// Its direction along the main axis, ±1, and the slopes of the others along it.
    main: Lanes,
    slopes: [Lanes; 2],
    /// The error of a coordinate relative to the ray.
    error: f32,
    /// What 1 of the ray's t is in `self`, and where `self` starts.
    rate: f64,
    start: f64,
}

impl Beam {
    /// The part of a ray that may be inside a cube.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "single precision is meant; errors are bounded"
    )]
    pub(in crate::render) fn new(frame: &QuantizationFrame, ray: &Ray) -> Result<Self, NoBeam> {
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
            return Err(NoBeam::Untold);
        }
        // Points of the cube have t between the distance ∓ 1.
        let start = (distance - 2.0).max(0.0);
        let origin = far + direction * start;
        let largest = origin.abs().max_element();
        let base = FLOOR + 64.0 * U * (1.0 + distance);
        if largest > 5.0 + base {
            return Err(NoBeam::Missed);
        }
        let steep = direction.abs().max(Vec3::splat(STEEP)).copysign(direction);
        // Twice what rounding to f32 moves the origin by, once more for the sum.
        let shift = (origin.abs() * (4.0 * ROUND) + 2.0 * base).copysign(direction);
        let splat = |value: f64| Lanes::splat(value as f32);
        let splats = |v: Vec3| [splat(v.x), splat(v.y), splat(v.z)];
        let [x, y, z] = splats(steep);
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        let down = direction.is_negative_bitmask() as usize;
        Ok(Self {
            origin: axes.map(|axis| splat(origin[axis])),
            near_origin: splats(origin + shift),
            far_origin: splats(origin - shift),
            inverse: [x.recip(), y.recip(), z.recip()],
            down: [down & 1, down >> 1 & 1, down >> 2],
            axes,
            main: splat(direction[main]),
            slopes: [splat(direction[axes[0]]), splat(direction[axes[1]])],
            error: (10.0 * ROUND * (1.0 + largest) + 2.0 * base + 2.0 * frame.error_bound) as f32,
            rate,
            start,
        })
    }

    /// The end of the beam for a `t_max` of the ray, rounded up by more than a root may be wrong.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "rounded up")]
    pub(in crate::render) fn limit(&self, t_max: f64) -> f32 {
        const ROUNDED: f64 = 1.0 + 1.0 / 1_048_576.0;
        (t_max * self.rate * ROUNDED - self.start) as f32 * (1.0 + 2.0 * f32::EPSILON) + self.error
    }

    /// Which of four boxes the beam may meet before `limit`, as bits, and where.
    ///
    /// As in Ize, "Robust BVH ray traversal" (JCGT 2, 2013): the far end grows by more than the
    /// relative errors of both.
    #[inline]
    pub(in crate::render) fn meet(&self, boxes: &Boxes, limit: f32) -> (u32, Lanes) {
        const GROWN: f32 = 1.0 + 16.0 * f32::EPSILON;
        let near = |axis: usize| {
            (boxes[axis][self.down[axis] & 1] - self.near_origin[axis]) * self.inverse[axis]
        };
        let far = |axis: usize| {
            (boxes[axis][!self.down[axis] & 1] - self.far_origin[axis]) * self.inverse[axis]
        };
        let enter = near(0).max(near(1)).max(near(2).max(Lanes::ZERO));
        let leave = far(0).min(far(1)).min(far(2)) * GROWN;
        (enter.cmple(leave.min(Lanes::splat(limit))).bitmask(), enter)
    }

    /// Which of four triangles the beam may hit before `limit`, as bits.
    ///
    /// The signs of the edge functions, after the shear that turns the ray into the main axis, are
    /// those of exact arithmetic where they exceed a bound on their error: a triangle with two
    /// sure signs that differ is missed.
    #[inline]
    pub(in crate::render) fn may_hit(&self, corners: &Corners, limit: f32) -> u32 {
        let error = Lanes::splat(self.error);
        let [x, y, z] = self.axes;
        let sheared = |corner: &[Lanes; 3]| {
            let along = (corner[z] - self.origin[2]) * self.main;
            let across =
                |axis: usize, k: usize| (corner[axis] - self.origin[k]) - along * self.slopes[k];
            [across(x, 0), across(y, 1), along]
        };
        let [a, b, c] = [
            sheared(&corners[0]),
            sheared(&corners[1]),
            sheared(&corners[2]),
        ];
        // The edge functions.
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        // Products of coordinates of size m with errors e: 4·m·e + 2·e², and 3 roundings of each
        // product.
        let size_of = |corner: [Lanes; 3]| corner[0].abs().max(corner[1].abs());
        let size = size_of(a).max(size_of(b)).max(size_of(c)) + error;
        let bound = size * (size * (8.0 * f32::EPSILON) + error * 6.0);
        let (min, max) = (u.min(v).min(w), u.max(v).max(w));
        let outside = min.cmplt(-bound) & max.cmpgt(bound);
        let (nearest, farthest) = (a[2].min(b[2]).min(c[2]), a[2].max(b[2]).max(c[2]));
        let beyond =
            (nearest - error).cmpgt(Lanes::splat(limit)) | (farthest + error).cmplt(Lanes::ZERO);
        !(outside | beyond).bitmask() & 0b1111
    }
}
