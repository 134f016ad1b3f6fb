//! The cube of some files, and the third edge of a box.

use super::{Lower, report_negative};
use crate::course::decode::{Context, SharedValue, Spanned, Value};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, NonNegative, Real, json_number};
use crate::course::object::solid::box_around;
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::rotation::{Rotation, RotationKeys};
use crate::course::schema::Definitions;
use crate::course::synonym::{POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, with_canonical};
use crate::course::value::{Angles, AnyScalar, Point, Vector};
use rtc_math::{Vec3, cos, sin, turned_about, unit, unit_scale};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A cube, with or without a rotation. Better written as a `box`.
    struct Cube, "cube" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, &with_canonical(POSITION, "position");
        /// The length of an edge; 0 is invisible.
        length: Spanned<NonNegative>, required, keys!["length" "side" "size" "edge"];
        /// The rotation about its centre by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation about its centre by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// The axis of rotation.
        euler_axis: Spanned<Vector>, optional, keys!["eulerAxis"];
        /// The angle of rotation, in radians.
        euler_angle: Spanned<Real>, optional, keys!["eulerAngle"];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
    variants {
        [position] [position euler_axis euler_angle] [position rotation] [position rotation angle]
        [position axis angle]
    }
}

impl Lower for Cube {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Cube {
            kind,
            position,
            length,
            rotation,
            axis,
            angle,
            euler_axis,
            euler_angle,
            material,
            shadow,
        } = self;
        let Some(props) = lowering.surface_props(kind, material, shadow, context) else {
            return;
        };
        let rotation_keys = match (euler_axis, euler_angle) {
            (FieldOutcome::Read(axis), FieldOutcome::Read(angle)) => Some(axes_rotated_about(
                Vec3::from_array(axis.value.0),
                angle.value.0,
            )),
            _ => {
                let rotation_keys = RotationKeys {
                    rotation,
                    axis,
                    angle,
                };
                rotation_keys.axes(context)
            }
        };
        let Some(rotation_keys) = rotation_keys else {
            return;
        };
        if length.value.0 < 0.0 {
            report_negative(length, "side", context);
            return;
        }
        let center = Vec3::from_array(position.value.0);
        let corners = box_around(center, [length.value.0; 3], rotation_keys);
        lowering.add_box(&props, &corners, length.span, context);
    }
}

/// The third edge of a box: a vector or a length.
#[derive(Clone, Copy, Debug)]
pub(in crate::course) enum ThirdEdge {
    Edge([f64; 3]),
    Length(f64),
}

impl ThirdEdge {
    /// The vector of the edge, from the two other edges.
    pub(super) fn edge(self, up: Vec3, side: Vec3) -> Vec3 {
        // Both are scaled by powers of two, so that no product leaves the range of f64.
        let [up, side] =
            [up, side].map(|edge| unit_scale(edge).map_or(Vec3::ZERO, |(scaled, _)| scaled));
        match self {
            Self::Edge(edge) => Vec3::from_array(edge),
            Self::Length(length) => unit(up.cross(side)).map_or(Vec3::ZERO, |n| n * length),
        }
    }
}

impl Value for ThirdEdge {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if context.tree.is_list(node) {
            Vector::decode(node, context).map(|edge| Self::Edge(edge.0))
        } else {
            Real::decode(node, context).map(|length| Self::Length(length.0))
        }
    }

    fn schema(definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [Vector::schema(definitions), Real::schema(definitions)] })
    }

    fn json(&self) -> Json {
        match self {
            Self::Edge(edge) => edge.map(json_number).to_vec().into(),
            Self::Length(length) => json_number(*length),
        }
    }
}

/// The axes rotated by an angle in radians about an axis; unchanged if the axis is zero.
pub(in crate::course) fn axes_rotated_about(axis: Vec3, angle: f64) -> [Vec3; 3] {
    let turns = [sin(angle), cos(angle)];
    unit(axis).map_or(Vec3::AXES, |axis| {
        Vec3::AXES.map(|v| turned_about(v, axis, turns))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let [x, y, z] = axes_rotated_about(Vec3::Z * 3.0, std::f64::consts::FRAC_PI_2);
        let is_near = |a: Vec3, b: Vec3| (a - b).length() < 1e-15;
        assert!(is_near(x, Vec3::Y) && is_near(y, Vec3::NEG_X) && is_near(z, Vec3::Z));
        assert_eq!(axes_rotated_about(Vec3::ZERO, 1.0), Vec3::AXES);
    }

    #[test]
    fn a_depth_is_an_edge_or_at_right_angles_to_the_others() {
        let (up, side) = (Vec3::Y * 2.0, Vec3::X * 5.0);
        assert_eq!(ThirdEdge::Length(3.0).edge(up, side), Vec3::Z * -3.0);
        assert_eq!(
            ThirdEdge::Edge([1.0, 2.0, 3.0]).edge(up, side),
            Vec3::new(1.0, 2.0, 3.0)
        );
        assert_eq!(ThirdEdge::Length(3.0).edge(up, up), Vec3::ZERO);
    }
}
