//! The quadrilateral: two triangles if it is flat, else the bilinear patch of Reshetov (Ray Tracing
//! Gems, 2019, ch. 8).

use super::ray::PlainRay;
use super::real::{Real, Vector};
use super::roots::quadratic;
use super::triangle::Triangle;
use crate::math::Vec3;
use crate::render::shape::quad;

#[derive(Clone, Copy, Debug)]
pub(in crate::render) enum Quad<R> {
    Flat([Option<Triangle<R>>; 2]),
    Patch([Vector<R>; 4]),
}

impl<R: Real> Quad<R> {
    /// The quadrilateral split, or not, as the robust one is.
    pub(in crate::render) fn new(robust: &quad::Quad, vertices: [Vec3; 4]) -> Self {
        match robust {
            quad::Quad::Flat { halves, .. } => Self::Flat(
                halves.map(|half| half.map(|(triangle, _)| Triangle::new(triangle.vertices()))),
            ),
            quad::Quad::Patch(_) => Self::Patch(vertices.map(Vector::of)),
        }
    }

    pub(super) fn intersect(&self, ray: &PlainRay<R>) -> Option<(R, u32)> {
        match self {
            Self::Flat(halves) => {
                let hits = (0..)
                    .zip(halves)
                    .filter_map(|(prim_id, half)| Some((half.as_ref()?.intersect(ray)?, prim_id)));
                ray.first(hits)
            }
            Self::Patch(vertices) => crossing(*vertices, ray).map(|(t, _)| (t, 0)),
        }
    }

    pub(super) fn normal(&self, ray: &PlainRay<R>, prim_id: u32) -> Vector<R> {
        match self {
            Self::Flat(halves) => {
                let half = halves[prim_id as usize & 1].or(halves[0]);
                half.map_or(-ray.direction, |triangle| triangle.normal())
            }
            Self::Patch(vertices) => {
                let [q00, q10, q11, q01] = *vertices;
                let [u, v] = crossing(*vertices, ray).map_or([R::of(0.5); 2], |(_, uv)| uv);
                lerp(q10 - q00, q11 - q01, v)
                    .cross(lerp(q01 - q00, q11 - q10, u))
                    .normalized()
            }
        }
    }
}

fn lerp<R: Real>(from: Vector<R>, to: Vector<R>, prim_id: R) -> Vector<R> {
    from + (to - from) * prim_id
}

/// The first crossing of a patch that counts, with its u and v.
fn crossing<R: Real>(vertices: [Vector<R>; 4], ray: &PlainRay<R>) -> Option<(R, [R; 2])> {
    let [q00, q10, q11, q01] = vertices.map(|vertex| vertex - ray.origin);
    let d = ray.direction;
    let (left, right) = (q01 - q00, q11 - q10);
    let unit = |x: R| x >= R::of(0.0) && x <= R::of(1.0);
    // Solve a + b·u + c·u² = 0 for the lines of constant u that the ray meets.
    let a = q00.cross(d).dot(left);
    let c = (q10 - q00).cross(q01 - q11).dot(d);
    let b = q10.cross(d).dot(right) - a - c;
    let along = |u: R| {
        // Meet the ray with the line at u.
        let (from, rung) = (lerp(q00, q10, u), lerp(left, right, u));
        let normal = d.cross(rung);
        let (size, across) = (normal.dot(normal), normal.cross(from));
        let (t, v) = (across.dot(rung) / size, across.dot(d) / size);
        (unit(u) && unit(v) && ray.counts(t)).then_some((t, [u, v]))
    };
    let [first, second] = quadratic(c, b, a)?.map(along);
    match (first, second) {
        (Some(first), Some(second)) => Some(if second.0 < first.0 { second } else { first }),
        (first, second) => first.or(second),
    }
}
