//! Convex solids whose roots are those of a quadratic: spheres, ellipsoids, cylinders, cones and
//! paraboloids.

use super::placed::inverse;
use super::{CertifiedRay, Meeting, RayStart, SurfaceHit, Visit};
use crate::certify::number::CertifiedNumber;
use crate::certify::reason::Doubts;
use crate::certify::vector::CertifiedVector;
use rtc_ir::{Cone, Cylinder, Ellipsoid, InfiniteCylinder, Paraboloid};
use rtc_math::{Vec3, Vector};

/// The parts of a solid.
const SIDE: u8 = 0;
const BASE: u8 = 1;
const TOP: u8 = 2;

/// A sphere.
pub(super) struct CertifiedSphere<'scene> {
    pub(super) center: Vec3,
    pub(super) radius: f64,
    /// The rows of the map from the world to its texture.
    pub(super) texture_from_world: Option<&'scene [[f64; 3]; 3]>,
}

impl CertifiedSphere<'_> {
    /// The roots of |o + t·d − c|² = r²: `t = b ± √(r² − |f + b·d|²)` with `f = o − c` and
    /// `b = −f·d`, as |d| = 1.
    pub(super) fn meet<N: CertifiedNumber>(
        &self,
        ray: &CertifiedRay<N>,
        range: [f64; 2],
        visit: Visit<'_, N>,
    ) {
        let f = ray.origin - Vector::point(self.center);
        let b = -f.dot(ray.direction);
        let foot = f + ray.direction * b;
        let discriminant = N::point(self.radius).square() - foot.square();
        if discriminant.is_negative() {
            return;
        }
        let root = discriminant.sqrt();
        let [first, second] = [b - root, b + root];
        if second.is_negative() {
            return;
        }
        visit(if !discriminant.is_positive() {
            Meeting::Unclear(range, Doubts::SILHOUETTE)
        } else if first.is_positive() {
            Meeting::Hits(SurfaceHit::new(first, SIDE))
        } else if first.is_negative() && second.is_positive() {
            Meeting::Hits(SurfaceHit::new(second, SIDE))
        } else {
            Meeting::Unclear(range, Doubts::CONTACT)
        });
    }

    /// The other root of a ray that starts on the sphere, whose outward normal there is unit:
    /// `t = −2·r·(n·d)`.
    pub(super) fn leave<N: CertifiedNumber>(
        &self,
        ray: &CertifiedRay<N>,
        start: &RayStart<N>,
        visit: Visit<'_, N>,
    ) {
        let slope = start.normal.dot(ray.direction);
        if slope.is_positive() {
            return;
        }
        let t = N::point(-2.0 * self.radius) * slope;
        visit(if slope.is_negative() {
            Meeting::Hits(SurfaceHit::new(t, SIDE))
        } else {
            Meeting::Unclear([0.0, t.high().max(0.0)], Doubts::CONTACT)
        });
    }

    /// The outward unit normal at a hit.
    pub(super) fn normal<N: CertifiedNumber>(&self, ray: &CertifiedRay<N>, t: N) -> Vector<N> {
        let local = ray.origin - Vector::point(self.center) + ray.direction * t;
        local / N::point(self.radius)
    }

    /// The texture coordinates at a normal.
    pub(super) fn uv<N: CertifiedNumber>(&self, normal: Vector<N>) -> Result<[N; 2], Doubts> {
        let rows = self.texture_from_world.copied();
        let rows = rows.map(|rows| rows.map(|row| Vector::point(Vec3::from_array(row))));
        let direction = rows.map(|rows| Vector::from(rows.map(|row| row.dot(normal))));
        uv_of(direction.unwrap_or(normal))
    }
}

/// u = φ/2π and v = 1 − θ/π of a direction, about the third axis.
fn uv_of<N: CertifiedNumber>(Vector { x, y, z }: Vector<N>) -> Result<[N; 2], Doubts> {
    // The angle from the other side has its jump where u has.
    let turns = N::turns(-y, -x);
    let z = z.clamp(-1.0, 1.0);
    let polar = N::turns(((N::ONE - z) * (N::ONE + z)).sqrt(), z);
    let is_known = turns.width() <= 1.0 && polar.width() <= 1.0;
    let (u, v) = (turns + N::point(0.5), N::ONE - N::point(2.0) * polar);
    is_known
        .then(|| [u, v].map(|part| part.clamp(0.0, 1.0)))
        .ok_or(Doubts::SEAM)
}

/// A solid about an axis, or an ellipsoid.
pub(super) struct CertifiedSolid<N> {
    /// A point about in its middle, and more than the distance of its points from there.
    middle: Vec3,
    reach: f64,
    profile: SolidProfile<N>,
}

/// What a solid is, with its measures.
enum SolidProfile<N> {
    Cylinder {
        axis: SolidAxis<N>,
        radius: N,
    },
    Infinite {
        axis: SolidAxis<N>,
        radius: N,
    },
    Cone {
        axis: SolidAxis<N>,
        radius: N,
    },
    Paraboloid {
        axis: SolidAxis<N>,
        radius: N,
    },
    Ellipsoid {
        center: Vector<N>,
        inverse: [Vector<N>; 3],
    },
}

/// The axis of a solid: its points have a height along it.
#[derive(Clone, Copy)]
struct SolidAxis<N> {
    base: Vector<N>,
    /// A unit vector.
    axis: Vector<N>,
    height: N,
}

/// A ray as a solid sees it: at `s` it is at `w + x·s` from the axis, at height `h + rise·s`.
struct AxisRay<N> {
    w: Vector<N>,
    x: Vector<N>,
    h: N,
    rise: N,
}

impl<N: CertifiedNumber> SolidAxis<N> {
    fn ray(&self, from: Vector<N>, direction: Vector<N>) -> AxisRay<N> {
        let f = from - self.base;
        let (h, rise) = (f.dot(self.axis), direction.dot(self.axis));
        AxisRay {
            w: f - self.axis * h,
            x: direction - self.axis * rise,
            h,
            rise,
        }
    }
}

impl<N: CertifiedNumber> CertifiedSolid<N> {
    pub(super) fn cylinder(shape: &Cylinder) -> Self {
        let [base, along] = [shape.base, shape.axis].map(Vec3::from_array);
        let axis = SolidAxis {
            base: Vector::point(base),
            axis: Vector::point(along).normalized(),
            height: N::point(shape.height),
        };
        let radius = N::point(shape.radius);
        let middle = base + along.normalize_or_zero() * (0.5 * shape.height);
        let reach = 0.5 * shape.height + shape.radius;
        Self::new(middle, reach, SolidProfile::Cylinder { axis, radius })
    }

    pub(super) fn infinite(shape: &InfiniteCylinder) -> Self {
        let [center, along] = [shape.center, shape.axis].map(Vec3::from_array);
        let axis = SolidAxis {
            base: Vector::point(center),
            axis: Vector::point(along).normalized(),
            height: N::ZERO,
        };
        let radius = N::point(shape.radius);
        Self::new(
            center,
            f64::INFINITY,
            SolidProfile::Infinite { axis, radius },
        )
    }

    pub(super) fn cone(shape: &Cone) -> Self {
        let (axis, middle, reach) = Self::over(shape.base, shape.up, shape.radius);
        let radius = N::point(shape.radius);
        Self::new(middle, reach, SolidProfile::Cone { axis, radius })
    }

    pub(super) fn paraboloid(shape: &Paraboloid) -> Self {
        let (axis, middle, reach) = Self::over(shape.base, shape.up, shape.radius);
        let radius = N::point(shape.radius);
        Self::new(middle, reach, SolidProfile::Paraboloid { axis, radius })
    }

    /// `None` if its axes may lie in a plane.
    pub(super) fn ellipsoid(shape: &Ellipsoid) -> Option<Self> {
        let center = Vec3::from_array(shape.center);
        let axes = shape.axes.map(Vec3::from_array);
        let inverse = inverse(axes.map(Vector::point))?;
        let reach = axes.iter().map(|axis| axis.length()).sum::<f64>();
        let profile = SolidProfile::Ellipsoid {
            center: Vector::point(center),
            inverse,
        };
        Some(Self::new(center, reach, profile))
    }

    /// The axis of a solid over a base.
    fn over(base: [f64; 3], up: [f64; 3], radius: f64) -> (SolidAxis<N>, Vec3, f64) {
        let [base, up] = [base, up].map(Vec3::from_array);
        let along = Vector::point(up);
        let axis = SolidAxis {
            base: Vector::point(base),
            axis: along.normalized(),
            height: along.length(),
        };
        (axis, base + 0.5 * up, 0.5 * up.length() + radius)
    }

    fn new(middle: Vec3, reach: f64, profile: SolidProfile<N>) -> Self {
        let reach = 1.01 * reach;
        Self {
            middle,
            reach,
            profile,
        }
    }

    /// Visits the hits of a ray.
    pub(super) fn meet(
        &self,
        ray: &CertifiedRay<N>,
        range: [f64; 2],
        start: Option<&RayStart<N>>,
        visit: Visit<'_, N>,
    ) {
        // A ray that starts on a convex solid leaves it at once, or crosses it.
        if let Some(start) = start {
            let slope = start.normal.dot(ray.direction);
            if slope.is_positive() {
                return;
            }
            if !slope.is_negative() {
                return visit(Meeting::Unclear([0.0, range[1]], Doubts::CONTACT));
            }
        }
        let part = start.map(|start| start.part);
        self.meet_side(ray, range, part == Some(SIDE), visit);
        if let Some((axis, radius, has_top)) = self.caps() {
            for cap in [BASE, TOP].into_iter().take(1 + usize::from(has_top)) {
                if part != Some(cap) {
                    let height = if cap == BASE { N::ZERO } else { axis.height };
                    self.meet_cap(ray, range, (axis, radius, height, cap), visit);
                }
            }
        }
    }

    /// The axis and the radius of the caps, and whether there are two.
    fn caps(&self) -> Option<(SolidAxis<N>, N, bool)> {
        match self.profile {
            SolidProfile::Cylinder { axis, radius } => Some((axis, radius, true)),
            SolidProfile::Cone { axis, radius } | SolidProfile::Paraboloid { axis, radius } => {
                Some((axis, radius, false))
            }
            SolidProfile::Infinite { .. } | SolidProfile::Ellipsoid { .. } => None,
        }
    }

    /// The ray as the axis sees it, if there is one, and `a`, `b`, `c` of the quadratic
    /// `a·s² + 2·b·s + c`, which is negative inside; `from` is the point at s = 0.
    fn quadratic(&self, from: Vector<N>, direction: Vector<N>) -> (Option<AxisRay<N>>, [N; 3]) {
        match &self.profile {
            SolidProfile::Cylinder { axis, radius } | SolidProfile::Infinite { axis, radius } => {
                let ray = axis.ray(from, direction);
                let c = ray.w.square() - radius.square();
                let coefficients = [ray.x.square(), ray.w.dot(ray.x), c];
                (Some(ray), coefficients)
            }
            SolidProfile::Cone { axis, radius } => {
                let ray = axis.ray(from, direction);
                let slope = *radius / axis.height;
                let (sigma, tau) = (slope * (axis.height - ray.h), slope * ray.rise);
                let a = ray.x.square() - tau.square();
                let b = ray.w.dot(ray.x) + sigma * tau;
                let c = ray.w.square() - sigma.square();
                (Some(ray), [a, b, c])
            }
            SolidProfile::Paraboloid { axis, radius } => {
                let ray = axis.ray(from, direction);
                let latus_rectum = radius.square() / axis.height;
                let b = ray.w.dot(ray.x) + N::point(0.5) * latus_rectum * ray.rise;
                let c = ray.w.square() - latus_rectum * (axis.height - ray.h);
                let a = ray.x.square();
                (Some(ray), [a, b, c])
            }
            SolidProfile::Ellipsoid { center, inverse } => {
                let unit = |v: Vector<N>| Vector::from(inverse.map(|row| row.dot(v)));
                let (f, d) = (unit(from - *center), unit(direction));
                (None, [d.square(), f.dot(d), f.square() - N::ONE])
            }
        }
    }

    /// Visits the hits of the side.
    fn meet_side(
        &self,
        ray: &CertifiedRay<N>,
        range: [f64; 2],
        is_start: bool,
        visit: Visit<'_, N>,
    ) {
        let unclear = || Meeting::Unclear(range, Doubts::SILHOUETTE);
        // From the point near the middle, or from a start on the side, where c is 0.
        let nearest = match is_start {
            true => N::ZERO,
            false => ray.nearest_to(self.middle),
        };
        let (local, [a, b, c]) = self.quadratic(ray.at(nearest), ray.direction);
        let roots = if is_start {
            match a.has_sign() {
                true => [Some(N::point(-2.0) * b / a), None],
                false => return visit(unclear()),
            }
        } else if a.is_zero() {
            match b.has_sign() {
                true => [Some(-c / (N::point(2.0) * b)), None],
                // Parallel to the side.
                false if b.is_zero() => return,
                false => return visit(unclear()),
            }
        } else {
            let discriminant = b.square() - a * c;
            if discriminant.is_negative() {
                return;
            }
            if !(discriminant.is_positive() && a.has_sign()) {
                return visit(unclear());
            }
            let root = discriminant.sqrt();
            [Some((-b - root) / a), Some((root - b) / a)]
        };
        // Keep those in front and between the ends.
        for s in roots.into_iter().flatten() {
            let t = nearest + s;
            let inside = local
                .as_ref()
                .map_or(Some(true), |local| self.is_between(local, s));
            if t.is_negative() || inside == Some(false) {
                continue;
            }
            let ends = [t.low().max(0.0), t.high()];
            visit(match (inside, t.is_positive()) {
                (None, _) => Meeting::Unclear(ends, Doubts::SILHOUETTE),
                (Some(_), false) => Meeting::Unclear(ends, Doubts::CONTACT),
                (Some(_), true) => Meeting::Hits(SurfaceHit::new(t, SIDE)),
            });
        }
    }

    /// Whether a point of the side is between the ends; `None` if that is not clear.
    fn is_between(&self, ray: &AxisRay<N>, s: N) -> Option<bool> {
        let axis = match &self.profile {
            SolidProfile::Cylinder { axis, .. }
            | SolidProfile::Cone { axis, .. }
            | SolidProfile::Paraboloid { axis, .. } => axis,
            SolidProfile::Infinite { .. } | SolidProfile::Ellipsoid { .. } => return Some(true),
        };
        let height = ray.h + ray.rise * s;
        // No point of a paraboloid is above its vertex.
        let has_end = !matches!(self.profile, SolidProfile::Paraboloid { .. });
        if height.is_negative() || (has_end && axis.height.is_below(height)) {
            return Some(false);
        }
        let is_below = !has_end || height.is_below(axis.height);
        (height.is_positive() && is_below).then_some(true)
    }

    /// Visits the hit of a cap.
    fn meet_cap(
        &self,
        ray: &CertifiedRay<N>,
        range: [f64; 2],
        (axis, radius, height, part): (SolidAxis<N>, N, N, u8),
        visit: Visit<'_, N>,
    ) {
        let nearest = ray.nearest_to(self.middle);
        let local = axis.ray(ray.at(nearest), ray.direction);
        let (distance, rise) = (height - local.h, local.rise);
        // The ray may be too flat to meet the plane near the solid.
        let steepest = rise.high().max(-rise.low());
        let least = distance.low().max(-distance.high());
        if rise.is_zero() || least > steepest * self.reach * 1.01 {
            return;
        }
        if !rise.has_sign() {
            return visit(Meeting::Unclear(range, Doubts::SILHOUETTE));
        }
        let s = distance / rise;
        let (t, square) = (nearest + s, (local.w + local.x * s).square());
        let limit = radius.square();
        if t.is_negative() || limit.is_below(square) {
            return;
        }
        let ends = [t.low().max(0.0), t.high()];
        visit(if !square.is_below(limit) {
            Meeting::Unclear(ends, Doubts::SILHOUETTE)
        } else if t.is_positive() {
            Meeting::Hits(SurfaceHit::new(t, part))
        } else {
            Meeting::Unclear(ends, Doubts::CONTACT)
        });
    }

    /// The outward unit normal at a hit.
    pub(super) fn normal(&self, ray: &CertifiedRay<N>, hit: &SurfaceHit<N>) -> Vector<N> {
        // A cap has that of its plane.
        if let Some((axis, ..)) = self.caps()
            && hit.part != SIDE
        {
            return if hit.part == BASE {
                -axis.axis
            } else {
                axis.axis
            };
        }
        // Take that of the side at the point, seen from near the middle.
        let nearest = ray.nearest_to(self.middle);
        let s = hit.t - nearest;
        let (from, direction) = (ray.at(nearest), ray.direction);
        let radial = |axis: &SolidAxis<N>| {
            let local = axis.ray(from, direction);
            local.w + local.x * s
        };
        match &self.profile {
            SolidProfile::Cylinder { axis, radius } | SolidProfile::Infinite { axis, radius } => {
                radial(axis) / *radius
            }
            SolidProfile::Cone { axis, radius } => {
                let outward = radial(axis).normalized();
                (outward * axis.height + axis.axis * *radius).normalized()
            }
            SolidProfile::Paraboloid { axis, radius } => {
                let latus_rectum = radius.square() / axis.height;
                (radial(axis) * N::point(2.0) + axis.axis * latus_rectum).normalized()
            }
            SolidProfile::Ellipsoid { center, inverse } => {
                let f = from - *center + direction * s;
                let local = Vector::from(inverse.map(|row| row.dot(f)));
                local.combined(*inverse).normalized()
            }
        }
    }

    /// The texture coordinates of a point of the ellipsoid; others have none here.
    pub(super) fn uv(&self, point: Vector<N>) -> Result<Option<[N; 2]>, Doubts> {
        match &self.profile {
            SolidProfile::Ellipsoid { center, inverse } => {
                let local = Vector::from(inverse.map(|row| row.dot(point - *center)));
                uv_of(local).map(Some)
            }
            SolidProfile::Paraboloid { .. } => Err(Doubts::unsupported("textures")),
            SolidProfile::Cylinder { .. }
            | SolidProfile::Infinite { .. }
            | SolidProfile::Cone { .. } => Ok(None),
        }
    }
}
