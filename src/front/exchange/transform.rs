//! Affine maps, as the transforms of a scene compose them.

use rtc_ir::{Instance, MeshId, Shape};
use rtc_math::{Vec3, cos, rotated_about, sin, unit};

/// An affine map by its columns: the images of the three axes, and the image of the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AffineTransform(pub(crate) [Vec3; 4]);

impl Default for AffineTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl AffineTransform {
    pub(crate) const IDENTITY: Self = Self([Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]);

    pub(crate) fn translation(by: [f64; 3]) -> Self {
        Self([Vec3::X, Vec3::Y, Vec3::Z, Vec3::from_array(by)])
    }

    pub(crate) fn scale([x, y, z]: [f64; 3]) -> Self {
        Self([Vec3::X * x, Vec3::Y * y, Vec3::Z * z, Vec3::ZERO])
    }

    /// A rotation about an axis through the origin, by degrees; `None` if the axis is zero.
    pub(crate) fn rotation(axis: [f64; 3], degrees: f64) -> Option<Self> {
        let axis = unit(Vec3::from_array(axis))?;
        let angle = degrees.to_radians();
        let turn = |v: Vec3| rotated_about(v, axis, [sin(angle), cos(angle)]);
        Some(Self([
            turn(Vec3::X),
            turn(Vec3::Y),
            turn(Vec3::Z),
            Vec3::ZERO,
        ]))
    }

    /// The map cos θ · 1 + sin θ · \[a\]ₓ + (1 − cos θ) · a aᵀ of an axis a: a rotation about it if
    /// its length is 1 (Rodrigues' formula).
    pub(crate) fn rodrigues(axis: Vec3, degrees: f64) -> Self {
        let angle = degrees.to_radians();
        let (sine, cosine) = (sin(angle), cos(angle));
        let image =
            |v: Vec3| v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
        Self([image(Vec3::X), image(Vec3::Y), image(Vec3::Z), Vec3::ZERO])
    }

    /// The map from a sensor, which looks along +z with +y up and +x to the left, to the world.
    /// `None` if the points coincide. An `up` that is missing or parallel to the view is replaced.
    pub(crate) fn look_at(
        origin: [f64; 3],
        target: [f64; 3],
        up: Option<[f64; 3]>,
    ) -> Option<Self> {
        let origin = Vec3::from_array(origin);
        let z = unit(Vec3::from_array(target) - origin)?;
        let up = up.map_or(Vec3::ZERO, Vec3::from_array);
        let left = |up: Vec3| unit(up.cross(z)).filter(|left| left.is_finite());
        let x = left(up)
            .or_else(|| left(Vec3::Y))
            .or_else(|| left(Vec3::X))?;
        Some(Self([x, z.cross(x), z, origin]))
    }

    /// The map of a direction.
    pub(crate) fn vector(&self, v: Vec3) -> Vec3 {
        let Self([x, y, z, _]) = self;
        *x * v.x + *y * v.y + *z * v.z
    }

    /// The map of a point.
    pub(crate) fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.0[3]
    }

    /// The map that applies `first`, then `self`.
    pub(crate) fn after(&self, first: &Self) -> Self {
        let Self([x, y, z, origin]) = first;
        Self([
            self.vector(*x),
            self.vector(*y),
            self.vector(*z),
            self.point(*origin),
        ])
    }

    /// The determinant of the linear part: negative for a map that mirrors.
    pub(crate) fn determinant(&self) -> f64 {
        let Self([x, y, z, _]) = self;
        x.cross(*y).dot(*z)
    }

    /// The inverse map; `None` if the axes do not span space.
    pub(crate) fn inverse(&self) -> Option<Self> {
        let Self([x, y, z, origin]) = self;
        let determinant = self.determinant();
        if !determinant.is_normal() {
            return None;
        }
        let rows = [y.cross(*z), z.cross(*x), x.cross(*y)].map(|row| row / determinant);
        let apply = |v: Vec3| Vec3::from_array(rows.map(|row| row.dot(v)));
        let column = |k: usize| Vec3::from_array(rows.map(|row| row[k]));
        let inverse = Self([column(0), column(1), column(2), -apply(*origin)]);
        inverse
            .0
            .iter()
            .all(|column| column.is_finite())
            .then_some(inverse)
    }

    /// The factor by which a similarity scales lengths; `None` for another map.
    pub(crate) fn similarity(&self) -> Option<f64> {
        let Self([x, y, z, _]) = self;
        let scale = x.length();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * scale.max(1e-30);
        let is_similar = near(y.length(), scale)
            && near(z.length(), scale)
            && near(x.dot(*y) / scale, 0.0)
            && near(y.dot(*z) / scale, 0.0)
            && near(z.dot(*x) / scale, 0.0);
        (is_similar && scale > 0.0).then_some(scale)
    }

    /// The axes, made orthonormal from the third to the first (Gram–Schmidt): the numbers of a text
    /// are rounded. `None` if they do not span space.
    pub(crate) fn orthonormal(&self) -> Option<[Vec3; 3]> {
        let Self([x, y, z, _]) = self;
        let z = unit(*z)?;
        let y = unit(*y - z * z.dot(*y))?;
        let across = y.cross(z);
        let x = if across.dot(*x) < 0.0 {
            -across
        } else {
            across
        };
        Some([x, y, z])
    }

    /// An instance of a mesh, placed by this map.
    pub(crate) fn instance(&self, mesh: MeshId) -> Shape {
        Shape::Instance(Instance {
            mesh,
            world_from_object: self.0.map(|column| column.to_array()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_compose_from_the_first_to_the_last() {
        let first = AffineTransform::translation([1.0, 0.0, 0.0]);
        let second = AffineTransform::rotation([0.0, 0.0, 1.0], 90.0).unwrap();
        let both = second.after(&first);
        assert!(both.point(Vec3::ZERO).distance(Vec3::Y) < 1e-15);
        assert_eq!(AffineTransform::scale([2.0; 3]).similarity(), Some(2.0));
        assert_eq!(AffineTransform::scale([2.0, 1.0, 1.0]).similarity(), None);
    }

    #[test]
    fn the_formula_of_rodrigues_rotates_about_a_unit_axis_and_scales_with_another() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let rotation = AffineTransform::rotation(axis.to_array(), 33.0).unwrap();
        let same = AffineTransform::rodrigues(axis, 33.0);
        for (found, known) in same.0.into_iter().zip(rotation.0) {
            assert!(found.distance(known) < 1e-15);
        }
        // The determinant that Mitsuba 3.9.1 has for this axis.
        let skew = AffineTransform::rodrigues(Vec3::new(1.0, 1.0, 0.0), 33.0);
        assert!(
            (skew.determinant() - 1.506).abs() < 1e-3,
            "{}",
            skew.determinant()
        );
    }

    #[test]
    fn an_inverse_undoes_its_map() {
        let turned = AffineTransform::rotation([1.0, 2.0, 3.0], 40.0).unwrap();
        let map = AffineTransform::translation([1.0, 2.0, 3.0])
            .after(&turned)
            .after(&AffineTransform::scale([-1.0, 2.0, 0.5]));
        let point = Vec3::new(0.3, -4.0, 7.0);
        let back = map.inverse().unwrap().point(map.point(point));
        assert!(back.distance(point) < 1e-12, "{back}");
        assert!((map.determinant() + 1.0).abs() < 1e-12);
        assert!(AffineTransform::scale([1.0, 0.0, 1.0]).inverse().is_none());
    }

    #[test]
    fn a_sensor_looks_along_z_with_x_to_the_left() {
        let camera =
            AffineTransform::look_at([0.0, 0.0, 5.0], [0.0; 3], Some([0.0, 1.0, 0.0])).unwrap();
        assert_eq!(camera.vector(Vec3::Z), Vec3::NEG_Z);
        assert_eq!(camera.vector(Vec3::X), Vec3::NEG_X);
        assert!(AffineTransform::look_at([0.0; 3], [0.0; 3], None).is_none());
    }
}
