//! How the unit normal of a surface changes along it: the derivative of the normal by the point
//! (the Weingarten map; do Carmo, "Differential geometry of curves and surfaces", §3.2). Ray
//! differentials through mirrors and lenses need it.

use crate::ray::Interaction;
use crate::shape::instance::Instance;
use rtc_math::Vec3;

/// The field of unit normals of a shape.
#[derive(Clone, Copy, Debug)]
pub enum NormalField<'shape> {
    /// Of flat parts.
    Flat,
    /// Of a sphere with this radius.
    Sphere(f64),
    /// Of the image of the unit sphere: its centre, and the rows of the inverse map.
    Ellipsoid(Vec3, [Vec3; 3]),
    /// Of a surface of revolution with caps across its axis.
    Revolution {
        /// A point of the axis.
        center: Vec3,
        /// The unit vector of the axis.
        axis: Vec3,
        /// The curvature of its profile: 0 for a straight one.
        profile: f64,
    },
    /// Of the interpolated normals of a mesh.
    Mesh(&'shape Instance),
}

/// The linear map from a step along a surface to the change of its unit normal, by columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalDerivative([Vec3; 3]);

impl NormalDerivative {
    /// Of a flat surface.
    pub(crate) const ZERO: Self = Self([Vec3::ZERO; 3]);

    /// The change of the normal for a step along the surface.
    pub(crate) fn along(&self, step: Vec3) -> Vec3 {
        let [x, y, z] = self.0;
        x * step.x + y * step.y + z * step.z
    }

    /// Of the normal m/|m|, where `change` is the derivative of the vector m by the point.
    pub(super) fn of_direction(m: Vec3, change: impl Fn(Vec3) -> Vec3) -> Self {
        let (length, n) = (m.length(), m.normalize_or_zero());
        let column = |axis: Vec3| {
            let change = change(axis);
            (change - n * n.dot(change)) / length
        };
        Self(Vec3::AXES.map(column)).or_flat()
    }

    /// Itself, or zero where it has no value: at the apex of a cone.
    fn or_flat(self) -> Self {
        match self.0.iter().all(|column| column.is_finite()) {
            true => self,
            false => Self::ZERO,
        }
    }
}

impl NormalField<'_> {
    /// The derivative of the unit normal by the point: of the geometric normal, or of the shading
    /// normal of a mesh.
    pub(crate) fn derivative(&self, at: &Interaction, prim_id: u32) -> NormalDerivative {
        let n = at.normal;
        match *self {
            Self::Flat => NormalDerivative::ZERO,
            Self::Sphere(radius) => {
                NormalDerivative(Vec3::AXES.map(|axis| (axis - n * n.dot(axis)) / radius))
            }
            Self::Ellipsoid(center, inverse) => {
                // The gradient of |M(p − c)|² is 2·Mᵀ·M·(p − c).
                let gradient = |v: Vec3| {
                    let [x, y, z] = inverse;
                    x * x.dot(v) + y * y.dot(v) + z * z.dot(v)
                };
                NormalDerivative::of_direction(gradient(at.point - center), gradient)
            }
            Self::Revolution {
                center,
                axis,
                profile,
            } => {
                // The principal directions are the circle about the axis and the profile.
                let from_center = at.point - center;
                let radial = from_center - axis * axis.dot(from_center);
                let (distance, outward) = (radial.length(), radial.normalize_or_zero());
                let across = n.dot(outward);
                let circle = axis.cross(outward);
                let meridian = n.cross(circle);
                // On a cap `across` is 0, and only a torus has a curved profile.
                let change = |v: Vec3| {
                    circle * (across / distance * circle.dot(v))
                        + meridian * (profile * meridian.dot(v))
                };
                NormalDerivative(Vec3::AXES.map(change)).or_flat()
            }
            Self::Mesh(instance) => instance.normal_derivative(prim_id, at.point),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use crate::shape::cone::Cone;
    use crate::shape::cylinder::Cylinder;
    use crate::shape::ellipsoid::Ellipsoid;
    use crate::shape::geometry::Intersect;
    use crate::shape::sphere::Sphere;
    use crate::shape::torus::Torus;
    use crate::shape::triangle::WatertightRay;

    /// Asserts that the derivative is the difference quotient of the normals of hits.
    fn assert_derivative<S: Intersect>(shape: &S, origin: Vec3, target: Vec3) {
        let hit = |target: Vec3| {
            let direction = (target - origin).normalize();
            let ray = Ray { origin, direction };
            let (t, prim_id) = shape
                .intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY)
                .unwrap();
            shape.interaction(&ray, t, prim_id)
        };
        const STEP: f64 = 1e-5;
        let at = hit(target);
        let derivative = shape.normal_field().unwrap().derivative(&at, 0);
        for axis in Vec3::AXES {
            let [before, after] = [-STEP, STEP].map(|step| hit(target + axis * step));
            let expected = after.normal - before.normal;
            let found = derivative.along(after.point - before.point);
            assert!(
                (expected - found).length() < 1e-3 * STEP,
                "{expected:?} {found:?}"
            );
        }
    }

    #[test]
    fn derivatives_are_those_of_the_normals_of_hits() {
        let (origin, target) = (Vec3::new(3.0, -1.0, 2.0), Vec3::new(0.3, 0.2, 0.1));
        let axis = Vec3::new(0.2, 0.3, 0.9).normalize();
        let sphere = Sphere {
            center: Vec3::new(0.1, 0.0, -0.1),
            radius: 0.7,
        };
        let sphere = crate::shape::sphere::TexturedSphere {
            sphere,
            texture_from_world: Vec3::AXES,
        };
        assert_derivative(&sphere, origin, target);
        let axes = [Vec3::new(0.5, 0.1, 0.0), Vec3::Y, Vec3::new(0.0, 0.2, 0.8)];
        assert_derivative(&Ellipsoid::new(Vec3::ZERO, axes), origin, target);
        assert_derivative(&Cylinder::new(-axis, axis, 2.0, 0.5), origin, target);
        assert_derivative(&Cone::new(-axis, axis * 2.0, 0.8), origin, target);
        assert_derivative(
            &Torus::new(Vec3::ZERO, axis, 0.8, 0.3),
            origin,
            Vec3::new(0.7, 0.0, 0.0),
        );
    }
}
