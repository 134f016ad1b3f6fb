//! The ellipsoid: the unit sphere in the coordinates where the ellipsoid is one.
//!
//! The ray is mapped to these coordinates, where the sphere test decides. The map rounds by a few u
//! of the ray's origin, relative to the centre: the offset of new rays covers that.

use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::roots::quadratic;
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::Emitter;
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes, SolidCrossing};
use crate::shape::interval::off_surface;
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::sphere::{Sphere, TexturedSphere};
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3, Vector, cross};
use std::sync::Arc;

/// The sphere of radius 1 about 0, with its texture.
const UNIT_SPHERE: TexturedSphere = TexturedSphere {
    sphere: Sphere {
        center: Vec3::ZERO,
        radius: 1.0,
    },
    texture_from_world: Vec3::AXES,
};

/// A prepared ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    center: Vec3,
    /// The images of the axes of the unit sphere.
    axes: [Vec3; 3],
    /// The rows of the inverse map.
    inverse: [Vec3; 3],
}

impl Ellipsoid {
    /// The image of the unit sphere about `center`; the images of the axes must span space.
    #[must_use]
    pub fn new(center: Vec3, axes: [Vec3; 3]) -> Self {
        let [x, y, z] = axes;
        let volume = cross(x, y).dot(z);
        Self {
            center,
            axes,
            inverse: [cross(y, z), cross(z, x), cross(x, y)].map(|row| row / volume),
        }
    }

    /// The ray in the coordinates of the unit sphere; its `t` are those of the world.
    fn to_unit(self, ray: &Ray) -> Ray {
        let rows = |v: Vec3| Vec3::from_array(self.inverse.map(|row| row.dot(v)));
        Ray {
            origin: rows(ray.origin - self.center),
            direction: rows(ray.direction),
        }
    }

    /// The stretch of a ray of the unit sphere inside; `ray` is the same in the world.
    fn stretch(&self, ray: &Ray, local: &Ray) -> Option<[f64; 2]> {
        let sum = |vectors: [Vec3; 3]| vectors.iter().fold(Vec3::ZERO, |sum, v| sum + v.abs());
        let sizes = ray.origin.abs() + self.center.abs() + sum(self.axes);
        let size = sum(self.inverse).dot(sizes);
        let (f, d) = (local.origin, local.direction);
        let stretch = UNIT_SPHERE.sphere.stretch(local);
        if off_surface(f.length() - 1.0, size) != 0.0 {
            return stretch;
        }
        // From the surface, the point across is the only one ahead.
        let across = -2.0 * f.dot(d) / d.dot(d);
        let leave = stretch.map(|[_, leave]| leave);
        let leave = leave.filter(|leave| *leave > 0.5 * across);
        (across > 0.0).then_some([f64::NEG_INFINITY, leave.unwrap_or(across)])
    }

    /// A vector of the unit sphere in the world.
    fn to_world(self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.axes;
        x * v.x + y * v.y + z * v.z
    }

    /// A normal of the unit sphere, of any length, as one of the ellipsoid.
    fn normal_to_world(self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.inverse;
        x * n.x + y * n.y + z * n.z
    }
}

impl Intersect for Ellipsoid {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, _: f64) -> Option<(f64, u32)> {
        let (local, factor) = self.to_unit(ray).rescaled();
        let ends = self.stretch(ray, &local)?.map(|t| t * factor);
        let t = ends.into_iter().find(|t| *t > 0.0 && t.is_finite())?;
        Some((t, 0))
    }

    fn visit_crossings(&self, ray: &Ray, visit: &mut dyn FnMut(SolidCrossing)) {
        let (local, factor) = self.to_unit(ray).rescaled();
        if let Some([enter, leave]) = self.stretch(ray, &local) {
            SolidCrossing::visit_both((enter * factor, 0), (leave * factor, 0), visit);
        }
    }

    /// The point at `t`, moved onto the unit sphere along its radius.
    fn interaction(&self, ray: &Ray, t: f64, _: u32) -> Interaction {
        let local = self.to_unit(ray);
        let direction = local.outward(local.origin + local.direction * t);
        let point = self.center + self.to_world(direction);
        let normal = ray.outward(self.normal_to_world(direction));
        let sizes = self.axes.map(|axis| axis.abs().element_sum());
        let extent = 2.0 * sizes.iter().sum::<f64>();
        Interaction::new(ray, point, normal, self.center, extent)
    }

    /// The coordinates of the unit sphere: u = φ/2π and v = 1 − θ/π about the third axis.
    fn shading_attributes(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        request: AttributeRequest,
    ) -> ShadingAttributes {
        let [x, y, z] = self.axes;
        // The map of normals is inverted by the transposed map of points.
        let normal = Vec3::new(x.dot(at.normal), y.dot(at.normal), z.dot(at.normal));
        let at = Interaction {
            normal: normal.normalize_or(at.normal),
            ..*at
        };
        let attributes = UNIT_SPHERE.shading_attributes(ray, &at, prim_id, request);
        let to_world = |tangent| self.to_world(tangent).try_normalize();
        ShadingAttributes {
            tangent: attributes.tangent.and_then(to_world),
            ..attributes
        }
    }

    fn uv_derivatives(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        set: usize,
    ) -> Option<[Vec3; 2]> {
        let [x, y, z] = self.axes;
        let normal = Vec3::new(x.dot(at.normal), y.dot(at.normal), z.dot(at.normal));
        let at = Interaction {
            normal: normal.normalize_or(at.normal),
            ..*at
        };
        let derivatives = UNIT_SPHERE.uv_derivatives(ray, &at, prim_id, set)?;
        Some(derivatives.map(|derivative| self.to_world(derivative)))
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        Some(NormalField::Ellipsoid(self.center, self.inverse))
    }

    fn emitter(&self) -> Option<Emitter> {
        Some(Emitter::Ellipsoid {
            center: self.center,
            axes: self.axes,
            inverse: self.inverse,
        })
    }

    fn bounds(&self) -> Option<Bounds> {
        Some(Bounds::around_ellipsoid(self.center, self.axes))
    }
}

impl HasBaseline for Ellipsoid {
    type Baseline<R: Real> = Box<BaselineEllipsoid<R>>;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>> {
        Some(Box::new(BaselineEllipsoid {
            center: Vector::of(self.center),
            rows: self.inverse.map(Vector::of),
        }))
    }
}

/// The baseline, by b² − 4ac.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BaselineEllipsoid<R> {
    center: Vector<R>,
    rows: [Vector<R>; 3],
}

impl<R: Real> BaselineEllipsoid<R> {
    fn to_unit(self, v: Vector<R>) -> Vector<R> {
        let [x, y, z] = self.rows.map(|row| row.dot(v));
        Vector { x, y, z }
    }
}

impl<R: Real> Baseline<R> for BaselineEllipsoid<R> {
    fn intersect(&self, ray: &BaselineRay<R>, _: f64) -> Option<(R, u32)> {
        let f = self.to_unit(ray.origin - self.center);
        let d = self.to_unit(ray.direction);
        let b = R::of(2.0) * f.dot(d);
        let roots = quadratic(d.dot(d), b, f.dot(f) - R::of(1.0))?;
        roots.into_iter().find(|t| ray.counts(*t)).map(|t| (t, 0))
    }

    fn normal(&self, _: &BaselineRay<R>, point: Vector<R>, _: u32) -> Vector<R> {
        let n = self.to_unit(point - self.center);
        let [x, y, z] = self.rows;
        (x * n.x + y * n.y + z * n.z).normalized()
    }
}
