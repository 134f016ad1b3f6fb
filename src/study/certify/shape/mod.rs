//! Where a ray meets a shape, by the textbook formulas in real numbers: a hit is certain, or there
//! certainly is none, or the numbers do not tell.
//!
//! [`CertifiedSurface`] holds one shape, or one triangle of a quadrilateral or a mesh. `flat` has
//! planes and what lies in them, `solid` the shapes whose roots are those of a quadratic, `patch`
//! curved quadrilaterals, `torus` the torus; [`CertifiedSurfaces`] finds first hits with a
//! hierarchy of balls.

mod flat;
mod hierarchy;
mod patch;
mod placed;
mod solid;
mod surfaces;
mod torus;

pub(super) use surfaces::{CertifiedSurfaces, FirstHit, Visibility};

use super::number::CertifiedNumber;
use super::reason::Doubts;
use super::vector::CertifiedVector;
use flat::CertifiedTriangle;
use patch::CertifiedPatch;
use rtc_ir::{Phong, Sphere};
use rtc_math::{Vec3, Vector};
use solid::{CertifiedSolid, CertifiedSphere};
use torus::CertifiedTorus;

/// A ray.
pub(super) struct CertifiedRay<N> {
    pub(super) origin: Vector<N>,
    /// A unit vector.
    pub(super) direction: Vector<N>,
    /// Where it starts on a surface.
    start: Option<RayStart<N>>,
    /// A ray about in the middle, with bounds on the distances of the other origins and of the
    /// other directions.
    middle: [(Vec3, f64); 2],
}

/// The start of a ray that lies exactly on a surface.
#[derive(Clone, Copy)]
pub(super) struct RayStart<N> {
    /// The index of the surface.
    pub(super) surface: usize,
    /// Its part.
    pub(super) part: u8,
    /// The geometric normal there.
    pub(super) normal: Vector<N>,
}

impl<N: CertifiedNumber> CertifiedRay<N> {
    /// A ray from a point, which may lie on a surface.
    pub(super) fn new(origin: Vector<N>, direction: Vector<N>, start: Option<RayStart<N>>) -> Self {
        Self {
            origin,
            direction,
            start,
            middle: [origin.middle(), direction.middle()],
        }
    }

    /// The point at `t`.
    pub(super) fn at(&self, t: N) -> Vector<N> {
        self.origin + self.direction * t
    }

    /// A number near the `t` of the point nearest to a point.
    fn nearest_to(&self, point: Vec3) -> N {
        let [(origin, _), (direction, _)] = self.middle;
        let t = (point - origin).dot(direction);
        N::point(if t.is_finite() { t } else { 0.0 })
    }

    /// A range of t that holds all its points inside a ball; `None` if there certainly are none.
    ///
    /// The foot of the perpendicular from the centre to the ray in the middle is computed; the feet
    /// of all rays lie within `slack` of it, with plenty left for the rounding of this test itself.
    #[inline]
    fn range_in(&self, ball: &Ball) -> Option<[f64; 2]> {
        const ROUNDING: f64 = 1e-12;
        const WIDEST: f64 = 0.1;
        let [(origin, origin_radius), (direction, direction_radius)] = self.middle;
        let f = origin - ball.center;
        let distance = f.length();
        let nearest = -f.dot(direction);
        let foot = (f + direction * nearest).length();
        let size = distance + origin.length() + ball.center.length();
        let slack = 4.0 * (origin_radius + distance * direction_radius) + ROUNDING * size;
        // Far from a single ray there is no bound.
        if direction_radius > WIDEST || !slack.is_finite() {
            return Some([0.0, f64::INFINITY]);
        }
        let reach = ball.radius * (1.0 + ROUNDING) + slack;
        let range = [(nearest - reach).max(0.0), nearest + reach];
        let misses = foot > reach || range[1] < 0.0;
        (!misses).then_some(range)
    }
}

/// A sphere that contains a shape.
#[derive(Clone, Copy, Debug)]
struct Ball {
    center: Vec3,
    radius: f64,
}

impl Ball {
    /// A ball around points; `None` without points.
    fn around(points: &[Vec3]) -> Option<Self> {
        let min = points.iter().copied().reduce(Vec3::min)?;
        let max = points.iter().copied().reduce(Vec3::max)?;
        let center = 0.5 * min + 0.5 * max;
        let distance = |point: &Vec3| (*point - center).length();
        let radius = points.iter().map(distance).fold(0.0, f64::max);
        // The bounds of some shapes are rounded.
        let radius = radius + 1e-9 * (radius + center.length());
        Some(Self { center, radius })
    }
}

/// A shape with its formula.
enum Formula<'scene, N> {
    Sphere(CertifiedSphere<'scene>),
    Plane {
        center: Vec3,
        normal: Vec3,
    },
    Triangle(CertifiedTriangle<'scene>),
    Patch(CertifiedPatch),
    Disc {
        center: Vec3,
        normal: Vec3,
        radius: f64,
    },
    Solid(Box<CertifiedSolid<N>>),
    Torus(Box<CertifiedTorus<N>>),
    /// A shape whose formula is not here, by its name.
    Unsupported(&'static str),
}

/// A surface, or one of its triangles.
pub(super) struct CertifiedSurface<'scene, N> {
    formula: Formula<'scene, N>,
    /// `None` for an infinite shape.
    ball: Option<Ball>,
    /// `None` for a material that is not Phong's.
    pub(super) material: Option<&'scene Phong>,
    casts_no_shadow: bool,
}

/// A ray and a surface; a surface that is missed has no meeting.
enum Meeting<N> {
    /// A hit.
    Hits(SurfaceHit<N>),
    /// There may be a hit with t in this range.
    Unclear([f64; 2], Doubts),
}

/// A certain hit.
#[derive(Clone, Copy)]
pub(super) struct SurfaceHit<N> {
    /// The distance.
    pub(super) t: N,
    /// The part of the surface: its side, or a cap.
    pub(super) part: u8,
    /// The coordinates on a patch.
    patch: Option<[N; 2]>,
}

impl<N> SurfaceHit<N> {
    fn new(t: N, part: u8) -> Self {
        let patch = None;
        Self { t, part, patch }
    }
}

/// What is said of a meeting.
type Visit<'visit, N> = &'visit mut dyn FnMut(Meeting<N>);
