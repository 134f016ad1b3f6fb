//! Rotations by an axis and an angle, used for textures of spheres; and their inverse.

use super::{Vec3, atan2, cos, difference_of_products, dot, sin};

/// `v` turned by an angle in radians about a unit vector, given by its sine and cosine (Rodrigues'
/// formula).
#[must_use]
pub fn rotated_about(v: Vec3, axis: Vec3, [sine, cosine]: [f64; 2]) -> Vec3 {
    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine))
}

/// The rows of a rotation: the shortest one that maps the unit vector `axis` to +z, then one that
/// lowers φ by `angle` degrees. `None` for the identity.
#[must_use]
pub fn rotated_to_z(axis: Vec3, angle: f64) -> Option<[[f64; 3]; 3]> {
    if axis == Vec3::Z && angle == 0.0 {
        return None;
    }
    let [x, y, z] = shortest_to_z(axis);
    let (c, s) = cos_sin_degrees(angle);
    let rows = [x * c + y * s, y * c - x * s, z];
    (rows != Vec3::AXES).then(|| rows.map(|row| row.to_array()))
}

/// The axis, a unit vector, of a rotation that [`rotated_to_z`] gives, and up to rounding the
/// angle in degrees.
#[must_use]
pub fn axis_and_angle(rows: [[f64; 3]; 3]) -> (Vec3, f64) {
    let [row, _, axis] = rows.map(Vec3::from_array);
    let [x, y, _] = shortest_to_z(axis);
    // row = x·cos + y·sin, where x and y are at right angles up to rounding only: a small angle is
    // that far off unless their product is taken off.
    let (across, along, both) = (dot(row, y), dot(row, x), dot(x, y));
    let sine = difference_of_products(across, dot(x, x), along, both);
    let cosine = difference_of_products(along, dot(y, y), across, both);
    (axis, atan2(sine, cosine).to_degrees())
}

/// The rows of the shortest rotation that takes a unit vector to +z; for −z the half turn about x.
fn shortest_to_z(axis: Vec3) -> [Vec3; 3] {
    let Vec3 { x, y, z } = axis;
    let aside = x * x + y * y;
    if aside == 0.0 && z < 0.0 {
        return [Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z];
    }
    // 1/(1 + z), which cancels near −z in this form only.
    let k = if z >= 0.0 {
        1.0 / (1.0 + z)
    } else {
        (1.0 - z) / aside
    };
    [
        Vec3::new(1.0 - k * x * x, -k * x * y, -x),
        Vec3::new(-k * x * y, 1.0 - k * y * y, -y),
        axis,
    ]
}

/// Cosine and sine of an angle in degrees, exact at multiples of 90.
fn cos_sin_degrees(angle: f64) -> (f64, f64) {
    let turned = angle % 360.0;
    let quarters = (turned / 90.0).round();
    let rest = (turned - quarters * 90.0).to_radians();
    let (c, s) = (cos(rest), sin(rest));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a whole number from −4 to 4"
    )]
    match (quarters as i32).rem_euclid(4) {
        0 => (c, s),
        1 => (-s, c),
        2 => (-c, -s),
        _ => (s, -c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(rows: [[f64; 3]; 3], v: Vec3) -> Vec3 {
        Vec3::from_array(rows.map(|row| Vec3::from_array(row).dot(v)))
    }

    #[test]
    fn the_axis_comes_to_z_and_the_angle_lowers_phi() {
        assert_eq!(rotated_to_z(Vec3::Z, 720.0), None);
        let quarter = rotated_to_z(Vec3::Z, 90.0).unwrap();
        assert_eq!(
            apply(quarter, Vec3::Y),
            Vec3::X,
            "φ = 90° becomes 0, to the last bit"
        );
        for axis in [
            Vec3::new(0.0, 3.0, 0.7),
            Vec3::new(1e-9, 0.0, -1.0),
            Vec3::NEG_Z,
            Vec3::new(-1.0, 2.0, -30.0),
        ] {
            let axis = axis.normalize();
            for angle in [0.0, 30.0, -90.0, 3500.0] {
                let rows = rotated_to_z(axis, angle).unwrap();
                assert!(
                    apply(rows, axis).distance(Vec3::Z) < 4e-16,
                    "{axis} {rows:?}"
                );
                let [x, y, z] = rows.map(Vec3::from_array);
                assert!(
                    x.cross(y).distance(z) < 1e-15 && (x.length() - 1.0).abs() < 1e-15,
                    "{axis} {rows:?}"
                );
                let back = rotated_to_z(axis_and_angle(rows).0, axis_and_angle(rows).1).unwrap();
                let far =
                    (0..3).map(|k| Vec3::from_array(back[k]).distance(Vec3::from_array(rows[k])));
                assert!(far.fold(0.0, f64::max) < 2e-15, "{axis} {angle}");
            }
        }
    }

    #[test]
    fn the_shortest_rotation_leaves_what_is_at_right_angles_to_both() {
        let axis = Vec3::new(0.0, 0.6, 0.8);
        assert_eq!(apply(rotated_to_z(axis, 0.0).unwrap(), Vec3::X), Vec3::X);
    }
}
