//! Numbers, vectors and transforms of a Mitsuba scene.

use rtc_math::{Vec3, cos, rotated_about, sin, unit};

/// One number.
pub(super) fn number(text: &str) -> Option<f64> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
}

/// The numbers of a list, between commas or white space.
pub(super) fn numbers(text: &str) -> Option<Vec<f64>> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    words.filter(|word| !word.is_empty()).map(number).collect()
}

/// Three numbers, or one for all three.
pub(super) fn vector(text: &str) -> Option<[f64; 3]> {
    match numbers(text)?[..] {
        [x, y, z] => Some([x, y, z]),
        [all] => Some([all; 3]),
        _ => None,
    }
}

/// An affine map by its columns: the images of the three axes, and the image of the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transform(pub(super) [Vec3; 4]);

impl Transform {
    pub(super) const IDENTITY: Self = Self([Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO]);

    pub(super) fn translation(by: [f64; 3]) -> Self {
        Self([Vec3::X, Vec3::Y, Vec3::Z, Vec3::from_array(by)])
    }

    pub(super) fn scale([x, y, z]: [f64; 3]) -> Self {
        Self([Vec3::X * x, Vec3::Y * y, Vec3::Z * z, Vec3::ZERO])
    }

    /// A rotation about an axis through the origin, by degrees; `None` if the axis is zero.
    pub(super) fn rotation(axis: [f64; 3], degrees: f64) -> Option<Self> {
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

    /// The map from a sensor, which looks along +z with +y up and +x to the left, to the world.
    /// `None` if the points coincide. An `up` that is missing or parallel to the view is replaced.
    pub(super) fn look_at(
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

    /// A matrix of 4 × 4 or 3 × 3 numbers, in rows.
    pub(super) fn matrix(text: &str) -> Option<Self> {
        let numbers = numbers(text)?;
        let side = match numbers.len() {
            16 => 4,
            9 => 3,
            _ => return None,
        };
        let column = |k: usize| {
            let [x, y, z] = std::array::from_fn(|row| numbers[row * side + k]);
            Vec3::new(x, y, z)
        };
        let origin = if side == 4 { column(3) } else { Vec3::ZERO };
        Some(Self([column(0), column(1), column(2), origin]))
    }

    /// The map of a direction.
    pub(super) fn vector(&self, v: Vec3) -> Vec3 {
        let Self([x, y, z, _]) = self;
        *x * v.x + *y * v.y + *z * v.z
    }

    /// The map of a point.
    pub(super) fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.0[3]
    }

    /// The map that applies `first`, then `self`.
    pub(super) fn after(&self, first: &Self) -> Self {
        let Self([x, y, z, origin]) = first;
        Self([
            self.vector(*x),
            self.vector(*y),
            self.vector(*z),
            self.point(*origin),
        ])
    }

    /// The factor by which a similarity scales lengths; `None` for another map.
    pub(super) fn similarity(&self) -> Option<f64> {
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
    pub(super) fn orthonormal(&self) -> Option<[Vec3; 3]> {
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

    pub(super) fn columns(&self) -> [[f64; 3]; 4] {
        self.0.map(|column| column.to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_compose_from_the_first_to_the_last() {
        let first = Transform::translation([1.0, 0.0, 0.0]);
        let second = Transform::rotation([0.0, 0.0, 1.0], 90.0).unwrap();
        let both = second.after(&first);
        assert!(both.point(Vec3::ZERO).distance(Vec3::Y) < 1e-15);
        assert_eq!(Transform::scale([2.0; 3]).similarity(), Some(2.0));
        assert_eq!(Transform::scale([2.0, 1.0, 1.0]).similarity(), None);
    }

    #[test]
    fn a_sensor_looks_along_z_with_x_to_the_left() {
        let camera = Transform::look_at([0.0, 0.0, 5.0], [0.0; 3], Some([0.0, 1.0, 0.0])).unwrap();
        assert_eq!(camera.vector(Vec3::Z), Vec3::NEG_Z);
        assert_eq!(camera.vector(Vec3::X), Vec3::NEG_X);
        assert!(Transform::look_at([0.0; 3], [0.0; 3], None).is_none());
    }

    #[test]
    fn lists_have_commas_or_spaces() {
        assert_eq!(vector("1, 2 3"), Some([1.0, 2.0, 3.0]));
        assert_eq!(vector("2"), Some([2.0; 3]));
        assert_eq!((vector("1 2"), number("inf")), (None, None));
    }
}
