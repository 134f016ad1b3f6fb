//! The sphere, and the turn of its texture.

use super::decode::{Context, Shared, Spanned, Value};
use super::lower::Lowering;
use super::material::Material;
use super::number::{Positive, Real, json_number};
use super::record::{Found, keys, record};
use super::schema::Definitions;
use super::tree::{NodeId, Shape};
use super::value::{Point, Text, Vector};
use crate::diag::codes;
use crate::ir::{self, Field};
use crate::math::{Vec3, atan2, cos, sin, unit};
use serde_json::{Value as Json, json};

record! {
    /// A sphere.
    struct Sphere, "sphere" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, keys!["position" "center"];
        /// The radius, above 0; or a list of the radius and the axis that its texture is turned about.
        radius: Spanned<Radius>, required, keys!["radius" "r"];
        /// By how many degrees the texture is turned about its axis.
        angle: Spanned<Real>, default(Real(0.0)), keys!["angle"];
        /// The axis that the texture is turned about: its poles lie on it.
        axis: Spanned<Vector>, optional, keys!["axis" "rotation"];
        /// What it is made of.
        material: Spanned<Shared<Material>>, required, keys!["material"];
    }
}

/// A radius, with or without the axis of a texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius {
    pub(super) length: f64,
    pub(super) axis: Option<Spanned<Vector>>,
}

impl Value for Radius {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let tree = context.tree;
        if tree.shape(node) != Shape::List {
            return Positive::decode(node, context).map(|length| Self {
                length: length.0,
                axis: None,
            });
        }
        let mut items = tree.items(node);
        let (Some(length), Some(axis), None) = (items.next(), items.next(), items.next()) else {
            return context.expected(node, "a number, or a list of a number and an axis");
        };
        let length = Positive::decode(length, context);
        let span = Some(tree.span(axis));
        let axis = Vector::decode(axis, context).map(|value| Spanned { value, span });
        Some(Self {
            length: length?.0,
            axis: Some(axis?),
        })
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let length = Positive::schema(definitions);
        let pair = json!([length, Vector::schema(definitions)]);
        json!({ "anyOf": [length, { "type": "array", "prefixItems": pair, "minItems": 2, "maxItems": 2 }] })
    }

    fn json(&self) -> Json {
        json_number(self.length)
    }
}

impl Lowering {
    /// Lowers a sphere.
    pub(super) fn sphere(&mut self, sphere: &Sphere, context: &mut Context<'_>) {
        let Sphere {
            kind,
            position,
            radius,
            angle,
            axis,
            material,
        } = sphere;
        let axis = texture_axis(radius, axis, context);
        let shape = ir::Shape::Sphere(ir::Sphere {
            center: position.value.0,
            radius: radius.value.length,
            texture_from_world: texture_from_world(axis, angle.value.0),
        });
        let places = [
            (Field::SphereCenter, position.span),
            (Field::SphereRadius, radius.span),
        ];
        if let Some(clothes) = self.clothe(kind, material) {
            self.put(&clothes, shape, &places);
        }
    }
}

/// The axis of the texture: +z unless there is another with a direction. What has no effect is
/// noted.
fn texture_axis(
    radius: &Spanned<Radius>,
    axis: &Found<Spanned<Vector>>,
    context: &mut Context<'_>,
) -> Vec3 {
    let mut no_effect = |axis: &Spanned<Vector>, message: &str| {
        axis.span.into_iter().for_each(|span| {
            context.report(
                &codes::NO_EFFECT,
                span,
                || message.to_owned(),
                |d| d.at(span, "no effect"),
            );
        });
    };
    let chosen = match (axis, &radius.value.axis) {
        (Found::Read(axis), inner) => {
            inner.iter().for_each(|inner| {
                no_effect(
                    inner,
                    "the axis beside the radius counts for nothing: `axis` does",
                )
            });
            axis
        }
        (Found::Absent | Found::Broken, Some(axis)) => axis,
        (Found::Absent | Found::Broken, None) => return Vec3::Z,
    };
    unit(Vec3::from_array(chosen.value.0)).unwrap_or_else(|| {
        no_effect(
            chosen,
            "the axis has no direction, so the texture is turned about [0, 0, 1]",
        );
        Vec3::Z
    })
}

/// The rows of the rotation from the world to the texture: the shortest one that takes the unit
/// vector `axis` to +z, then one that lowers φ by `angle` degrees. `None` if nothing turns.
pub(super) fn texture_from_world(axis: Vec3, angle: f64) -> Option<[[f64; 3]; 3]> {
    if axis == Vec3::Z && angle == 0.0 {
        return None;
    }
    let [x, y, z] = shortest_to_z(axis);
    let (c, s) = cos_sin_degrees(angle);
    let rows = [x * c + y * s, y * c - x * s, z];
    (rows != Vec3::AXES).then(|| rows.map(|row| row.to_array()))
}

/// The axis, a unit vector, of a rotation that [`texture_from_world`] gives, and up to rounding the
/// angle in degrees.
pub(super) fn axis_and_angle(rows: [[f64; 3]; 3]) -> (Vec3, f64) {
    let [row, _, axis] = rows.map(Vec3::from_array);
    let [x, y, _] = shortest_to_z(axis);
    (axis, atan2(row.dot(y), row.dot(x)).to_degrees())
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
        assert_eq!(texture_from_world(Vec3::Z, 720.0), None);
        let quarter = texture_from_world(Vec3::Z, 90.0).unwrap();
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
                let rows = texture_from_world(axis, angle).unwrap();
                assert!(
                    apply(rows, axis).distance(Vec3::Z) < 4e-16,
                    "{axis} {rows:?}"
                );
                let [x, y, z] = rows.map(Vec3::from_array);
                assert!(
                    x.cross(y).distance(z) < 1e-15 && (x.length() - 1.0).abs() < 1e-15,
                    "{axis} {rows:?}"
                );
                let back =
                    texture_from_world(axis_and_angle(rows).0, axis_and_angle(rows).1).unwrap();
                let far =
                    (0..3).map(|k| Vec3::from_array(back[k]).distance(Vec3::from_array(rows[k])));
                assert!(far.fold(0.0, f64::max) < 2e-15, "{axis} {angle}");
            }
        }
    }

    #[test]
    fn the_shortest_rotation_leaves_what_is_at_right_angles_to_both() {
        let axis = Vec3::new(0.0, 0.6, 0.8);
        assert_eq!(
            apply(texture_from_world(axis, 0.0).unwrap(), Vec3::X),
            Vec3::X
        );
    }
}
