//! The capped cylinder: the stretch inside the infinite cylinder and the stretch between its caps,
//! intersected.
//!
//! The ray is first moved to the point nearest to the axis, so that the terms of the quadratic have
//! the size of the radius and not of the distance from the eye; they are those of the cross
//! products with the axis.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::disc::BaselineDisc;
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{Intersect, SolidCrossing};
use crate::shape::interval::{Interval, between_planes, off_surface, roots, size_of_start};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3, Vector, cross, dot, unit};
use std::sync::Arc;

/// A prepared cylinder with two caps.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    base: Vec3,
    /// A unit vector from the base to the top.
    axis: Vec3,
    height: f64,
    radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CylinderFace {
    Side,
    Base,
    Top,
}

impl CylinderFace {
    const ALL: [Self; 3] = [Self::Side, Self::Base, Self::Top];
}

impl Cylinder {
    /// The cylinder over the disc around `base`, `height` along `direction`, which must not be
    /// zero.
    #[must_use]
    pub fn new(base: Vec3, direction: Vec3, height: f64, radius: f64) -> Self {
        Self {
            base,
            axis: unit(direction).unwrap_or(Vec3::Z),
            height,
            radius,
        }
    }

    /// The first root above 0, and its part.
    fn intersection(&self, ray: &Ray) -> Option<(f64, CylinderFace)> {
        self.inside(ray)?.first_in_front()
    }

    /// The stretch of the ray inside.
    fn inside(&self, ray: &Ray) -> Option<Interval<CylinderFace>> {
        let caps = between_planes(
            self.axis,
            self.height,
            ray.origin - self.base,
            ray.direction,
            size_of_start(ray, self.base, self.height + self.radius),
            [CylinderFace::Base, CylinderFace::Top],
        )?;
        self.inside_side(ray, &caps)?.and(caps)
    }

    /// The interval of t inside the infinite cylinder, accurate between the caps.
    fn inside_side(
        &self,
        ray: &Ray,
        caps: &Interval<CylinderFace>,
    ) -> Option<Interval<CylinderFace>> {
        let (f, d) = (ray.origin - self.base, ray.direction);
        let r2 = self.radius * self.radius;
        let (from_axis, across) = (cross(f, self.axis), cross(d, self.axis));
        let a = across.dot(across);
        if a == 0.0 {
            let everywhere = Interval {
                enter: (f64::NEG_INFINITY, CylinderFace::Side),
                leave: (f64::INFINITY, CylinderFace::Side),
            };
            return (from_axis.dot(from_axis) <= r2).then_some(everywhere);
        }
        let slope = from_axis.dot(across);
        let size = size_of_start(ray, self.base, self.height + self.radius);
        let outside = off_surface(from_axis.length() - self.radius, size);
        // Move the ray to the point nearest to the axis, but not beyond the caps.
        let nearest = (-slope / a).max(caps.enter.0).min(caps.leave.0);
        let from_axis = cross(f + d * nearest, self.axis);
        let b = -from_axis.dot(across);
        // Compute the discriminant from the foot of the perpendicular.
        let foot = from_axis + across * (b / a);
        let inside = r2 - foot.dot(foot);
        if inside < 0.0 || inside.is_nan() {
            return None;
        }
        // Solve the quadratic, with c as a product of differences.
        let length = from_axis.length();
        let c = (length - self.radius) * (length + self.radius);
        let (enter, leave) = roots(a, b, c, a * inside);
        let (enter, leave) = (nearest + enter, nearest + leave);
        let inside = Interval {
            enter: (enter, CylinderFace::Side),
            leave: (leave, CylinderFace::Side),
        };
        Some(inside.seen_from(outside, slope))
    }

    /// The point at `t`, moved onto a part.
    fn interaction_on(&self, part: CylinderFace, ray: &Ray, t: f64) -> Interaction {
        // Project the point onto the cap or the side.
        let local = (ray.origin - self.base) + ray.direction * t;
        let along = dot(local, self.axis);
        let (local, normal) = match part {
            CylinderFace::Base => (local - self.axis * along, -self.axis),
            CylinderFace::Top => (local + self.axis * (self.height - along), self.axis),
            CylinderFace::Side => {
                let normal = ray.outward(local - self.axis * along);
                (self.axis * along + normal * self.radius, normal)
            }
        };
        Interaction::new(
            ray,
            self.base + local,
            normal,
            self.base,
            self.height + self.radius,
        )
    }
}

impl Intersect for Cylinder {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.intersection(ray).map(|(t, _)| (t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        if let Some(inside) = self.inside(ray) {
            inside.visit(|part| part as u32, visit);
        }
    }

    fn interaction_on(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        self.interaction_on(CylinderFace::ALL[part as usize], ray, t)
    }

    /// The point at `t`, moved onto the part that was hit.
    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        let part = self
            .intersection(ray)
            .map_or(CylinderFace::Side, |(_, part)| part);
        self.interaction_on(part, ray, t)
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Revolution {
            center: self.base,
            axis: self.axis,
            profile: 0.0,
        })
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Frustum {
            base: self.base,
            axis: self.axis,
            height: self.height,
            radii: [self.radius; 2],
            is_capped: true,
        })
    }

    /// A box around the cylinder.
    fn bounds(&self) -> Option<Bounds> {
        let disc = |center| Bounds::around_disc(center, self.axis, self.radius);
        Some(disc(self.base).union(disc(self.base + self.axis * self.height)))
    }
}

/// A prepared cylinder without ends.
#[derive(Clone, Copy, Debug)]
pub struct InfiniteCylinder(Cylinder);

impl InfiniteCylinder {
    /// The cylinder around the line through `center` along `direction`, which must not be zero.
    #[must_use]
    pub fn new(center: Vec3, direction: Vec3, radius: f64) -> Self {
        Self(Cylinder::new(center, direction, 0.0, radius))
    }

    /// The interval of t inside.
    fn inside(&self, ray: &Ray) -> Option<Interval<CylinderFace>> {
        let whole = Interval {
            enter: (f64::NEG_INFINITY, CylinderFace::Side),
            leave: (f64::INFINITY, CylinderFace::Side),
        };
        self.0.inside_side(ray, &whole)
    }
}

impl Intersect for InfiniteCylinder {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        self.inside(ray)?.first_in_front().map(|(t, _)| (t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        if let Some(inside) = self.inside(ray) {
            inside.visit(|part| part as u32, visit);
        }
    }

    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        self.0.interaction_on(CylinderFace::Side, ray, t)
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        <Cylinder as Intersect>::normal_field(&self.0)
    }

    fn emitter(&self) -> Option<Emitter> {
        let Cylinder {
            base, axis, radius, ..
        } = self.0;
        Some(Emitter::InfiniteCylinder { base, axis, radius }).filter(|_| radius > 0.0)
    }

    fn bounds(&self) -> Option<Bounds> {
        None
    }
}

impl HasBaseline for InfiniteCylinder {
    type Baseline<R: Real> = Box<BaselineInfiniteCylinder<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineInfiniteCylinder(BaselineCylinder::new(
            &self.0,
        ))))
    }
}

impl HasBaseline for Cylinder {
    type Baseline<R: Real> = Box<BaselineCylinder<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineCylinder::new(self)))
    }
}

/// The parts of the baseline: side, base and top.
const PLAIN_PARTS: [u32; 3] = [0, 1, 2];

/// The baseline: the quadratic of ray and point projected across the axis, and two discs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineCylinder<R> {
    base: Vector<R>,
    axis: Vector<R>,
    height: R,
    radius: R,
    caps: [BaselineDisc<R>; 2],
}

impl<R: Real> BaselineCylinder<R> {
    fn new(cylinder: &Cylinder) -> Self {
        let Cylinder {
            base,
            axis,
            height,
            radius,
        } = *cylinder;
        let cap = |center: Vec3, normal: Vec3| BaselineDisc::new(center, normal, radius);
        Self {
            base: Vector::of(base),
            axis: Vector::of(axis),
            height: R::of(height),
            radius: R::of(radius),
            caps: [cap(base, -axis), cap(base + axis * height, axis)],
        }
    }

    /// The roots of the infinite cylinder.
    fn side_roots(&self, ray: &BaselineRay<R>) -> Option<[R; 2]> {
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let (from_axis, across) = (f - self.axis * above, ray.direction - self.axis * rise);
        let b = R::of(2.0) * from_axis.dot(across);
        let c = from_axis.dot(from_axis) - self.radius * self.radius;
        quadratic(across.dot(across), b, c)
    }
}

impl<R: Real> Baseline<R> for BaselineCylinder<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let [side, base, top] = PLAIN_PARTS;
        let f = ray.origin - self.base;
        let (above, rise) = (f.dot(self.axis), ray.direction.dot(self.axis));
        let none = R::of(f64::NAN);
        let within = |t: R| {
            let height = above + rise * t;
            if height >= R::of(0.0) && height <= self.height {
                t
            } else {
                none
            }
        };
        let [first, second] = self.side_roots(ray)?.map(within);
        let [low, high] = self.caps.map(|cap| cap.parameter(ray));
        ray.first([(first, side), (second, side), (low, base), (high, top)])
    }

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        let local = point - self.base;
        match prim_id {
            1 | 2 => self.caps[prim_id as usize - 1].normal(),
            _ => (local - self.axis * local.dot(self.axis)).normalized(),
        }
    }
}

/// The baseline of the infinite cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineInfiniteCylinder<R>(BaselineCylinder<R>);

impl<R: Real> Baseline<R> for BaselineInfiniteCylinder<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let [side, ..] = PLAIN_PARTS;
        let [first, second] = self.0.side_roots(ray)?;
        ray.first([(first, side), (second, side)])
    }

    fn normal(&self, ray: &BaselineRay<R>, point: Vector<R>, part: u32) -> Vector<R> {
        self.0.normal(ray, point, part)
    }
}
