//! The sphere and the rotation of its texture.

use super::LowerObject;
use crate::course::decode::{Decode, DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, NonNegative, json_number};
use crate::course::record::{FieldResult, record};
use crate::course::rotation::{Quaternion, Rotation};
use crate::course::schema::SchemaDefinitions;
use crate::course::synonym::{POSITION, RADIUS, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir as ir;
use rtc_math::{Vec3, axis_and_angle, rotated_about, rotated_to_z, unit};
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// A sphere.
    struct Sphere, "sphere" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// The centre.
        position: Spanned<Point>, required, &with_canonical(POSITION, "position"), json "position";
        /// The radius, 0 being invisible; or a list of the radius and the axis of rotation of the
        /// texture.
        radius: Spanned<Radius>, required, &with_canonical(RADIUS, "radius"), json "radius";
        /// The angle of rotation of the texture about its axis, in degrees.
        angle: Spanned<Degrees>, default(Degrees(0.0)), &[&["angle"]], json "angle";
        /// The axis through the poles of the texture, about which it is rotated.
        axis: Spanned<Rotation<Vector>>, optional, &[&["axis"], &["rotation"], &["rotationVector"]],
            json "rotation", json "rotationVector";
        /// The rotation of the texture as a quaternion (x, y, z, w) of any length but 0, instead of
        /// an axis and an angle.
        quaternion: Spanned<Quaternion>, optional, &[&["quaternion"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

/// A radius, with or without the axis of the texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Radius {
    pub(crate) length: f64,
    pub(crate) axis: Option<Spanned<Vector>>,
}

impl Decode for Radius {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let tree = context.tree;
        if tree.shape(node) != NodeContent::List {
            return NonNegative::decode(node, context).map(|length| Self {
                length: length.0,
                axis: None,
            });
        }
        let mut items = tree.items(node);
        let (Some(length), Some(axis), None) = (items.next(), items.next(), items.next()) else {
            return context.expected(node, "a number, or a list of a number and an axis");
        };
        let length = NonNegative::decode(length, context);
        let span = Some(tree.span(axis));
        let axis = Vector::decode(axis, context).map(|value| Spanned { value, span });
        Some(Self {
            length: length?.0,
            axis: Some(axis?),
        })
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let length = NonNegative::schema(definitions);
        let pair = json!([length, Vector::schema(definitions)]);
        let list = json!({ "type": "array", "prefixItems": pair, "minItems": 2, "maxItems": 2 });
        json!({ "anyOf": [length, list] })
    }

    fn json(&self) -> Json {
        json_number(self.length)
    }
}

impl LowerObject for Sphere {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Sphere {
            kind,
            position,
            radius,
            angle,
            axis,
            quaternion,
            material,
            shadow,
            velocity,
        } = self;
        let texture_from_world = match quaternion {
            FieldResult::Read(quaternion) => {
                let axis = axis.ok().and_then(|axis| axis.span);
                report_two_rotations(axis.or(angle.span), quaternion, context);
                texture_rotation(quaternion.value)
            }
            FieldResult::Absent | FieldResult::Broken => {
                rotated_to_z(texture_axis(radius, axis, context), angle.value.0)
            }
        };
        let shape = ir::Shape::Sphere(ir::Sphere {
            center: position.value.0,
            radius: radius.value.length,
            texture_from_world,
        });
        let value_spans = [("center", position.span), ("radius", radius.span)];
        if let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context) {
            lowering.add_surface(&props, shape, &value_spans);
        }
    }
}

/// The axis of the texture: +z unless a non-zero axis is given. Reports an axis without effect.
fn texture_axis(
    radius: &Spanned<Radius>,
    axis: &FieldResult<Spanned<Rotation<Vector>>>,
    context: &mut DecodeContext<'_>,
) -> Vec3 {
    // An ignored rotation counts as absent.
    let axis = match axis {
        FieldResult::Read(Spanned {
            value: Rotation(Some(axis)),
            span,
        }) => FieldResult::Read(Spanned {
            value: *axis,
            span: *span,
        }),
        FieldResult::Read(_) | FieldResult::Absent => FieldResult::Absent,
        FieldResult::Broken => FieldResult::Broken,
    };
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
    // `axis` overrides the axis beside the radius.
    let chosen = match (&axis, &radius.value.axis) {
        (FieldResult::Read(axis), inner) => {
            inner.iter().for_each(|inner| {
                no_effect(
                    inner,
                    "the axis beside the radius has no effect with `axis`",
                )
            });
            axis
        }
        (FieldResult::Absent | FieldResult::Broken, Some(axis)) => axis,
        (FieldResult::Absent | FieldResult::Broken, None) => return Vec3::Z,
    };
    unit(Vec3::from_array(chosen.value.0)).unwrap_or_else(|| {
        no_effect(
            chosen,
            "the axis has no direction, so the texture is rotated about [0, 0, 1]",
        );
        Vec3::Z
    })
}

/// The rows of the rotation from directions of the world to those of the texture, for the rotation
/// v ↦ q·v·q* of the texture by a quaternion q; `None` for the identity. q = (s·n, w) rotates about
/// n by the angle with cosine w² − s² and sine 2·w·s.
fn texture_rotation(Quaternion(parts): Quaternion) -> Option<[[f64; 3]; 3]> {
    let largest = parts
        .iter()
        .fold(0.0_f64, |largest, part| largest.max(part.abs()));
    let [x, y, z, w] = parts.map(|part| part / largest);
    let axis = unit(Vec3::new(x, y, z))?;
    let s = axis.dot(Vec3::new(x, y, z));
    let sin_cos = [2.0 * w * s, w * w - s * s].map(|part| part / (w * w + s * s));
    // Through an axis and an angle, so that writing these gives the same bits again.
    let rows = Vec3::AXES.map(|v| rotated_about(v, axis, sin_cos).to_array());
    let (pole, angle) = axis_and_angle(rows);
    rotated_to_z(unit(pole)?, angle)
}

/// Reports a rotation that a quaternion overrides, and a quaternion of length 0.
fn report_two_rotations(
    other: Option<Span>,
    quaternion: &Spanned<Quaternion>,
    context: &mut DecodeContext<'_>,
) {
    let mut no_effect = |span: Option<Span>, message: &str| {
        if let Some(span) = span {
            context.report(
                &codes::NO_EFFECT,
                span,
                || message.to_owned(),
                |d| d.at(span, "no effect").severity(Severity::Warning),
            );
        }
    };
    no_effect(other, "an axis or angle has no effect with `quaternion`");
    if quaternion.value.0 == [0.0; 4] {
        no_effect(quaternion.span, "a quaternion of length 0 is no rotation");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quaternion_turns_the_texture_as_it_turns_a_vector() {
        let half = std::f64::consts::FRAC_PI_4;
        // A rotation by 90° about z maps x to y, for any length of the quaternion.
        for length in [1.0, -3.0, 1e200] {
            let parts = [0.0, 0.0, libm::sin(half) * length, libm::cos(half) * length];
            let [x, y, z] = texture_rotation(Quaternion(parts))
                .unwrap()
                .map(Vec3::from_array);
            let is_near = |a: Vec3, b: Vec3| (a - b).length() < 1e-14;
            assert!(is_near(x, Vec3::Y) && is_near(y, Vec3::NEG_X) && is_near(z, Vec3::Z));
        }
        for identity in [[0.0, 0.0, 0.0, 2.0], [0.0; 4]] {
            assert_eq!(texture_rotation(Quaternion(identity)), None);
        }
    }
}
