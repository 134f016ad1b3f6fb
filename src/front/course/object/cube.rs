//! The cube of some files, and what it shares with other solids that are turned or have a depth.

use super::{Lower, negative};
use crate::course::decode::{Context, SharedValue, Spanned, Value};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, NonNegative, Real, json_number};
use crate::course::object::solid::around;
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::schema::Definitions;
use crate::course::synonym::{PLACE, ROTATION, TURN_ANGLE, TURN_AXIS, led_by};
use crate::course::turn::{Rotation, Turn};
use crate::course::value::{Angles, Point, Text, Vector};
use rtc_math::{Vec3, cos, sin, turned_about, unit, unit_scale};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A cube, turned or not. Better written as a `box`.
    struct Cube, "cube" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, &led_by(PLACE, "position");
        /// The length of a side; nothing shows at 0.
        length: Spanned<NonNegative>, required, keys!["length" "side" "size" "edge"];
        /// The angles in radians by which it is turned about its centre: first about x, then y,
        /// then z; beside `angle` the axis.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis through its centre that it is turned about by `angle`.
        axis: Spanned<Vector>, optional, &TURN_AXIS;
        /// By how many degrees it is turned about its axis.
        angle: Spanned<Degrees>, optional, &TURN_ANGLE;
        /// What it is turned about.
        turn_axis: Spanned<Vector>, optional, keys!["eulerAxis"];
        /// By how much, in radians.
        turn_angle: Spanned<Real>, optional, keys!["eulerAngle"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
    forms {
        [position] [position turn_axis turn_angle] [position rotation] [position rotation angle] [position axis angle]
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
            turn_axis,
            turn_angle,
            material,
            shadow,
        } = self;
        let Some(clothes) = lowering.clothe(kind, material, shadow, context) else {
            return;
        };
        let turn = match (turn_axis, turn_angle) {
            (FieldOutcome::Read(axis), FieldOutcome::Read(angle)) => Some(axes_turned_about(
                Vec3::from_array(axis.value.0),
                angle.value.0,
            )),
            _ => {
                let turn = Turn {
                    rotation,
                    axis,
                    angle,
                };
                turn.axes(context)
            }
        };
        let Some(turn) = turn else { return };
        if length.value.0 < 0.0 {
            negative(length, "side", context);
            return;
        }
        let center = Vec3::from_array(position.value.0);
        let corners = around(center, [length.value.0; 3], turn);
        lowering.cuboid(&clothes, &corners, length.span, context);
    }
}

/// The third edge of a box: an edge as it is, or a length.
#[derive(Clone, Copy, Debug)]
pub(in crate::course) enum ThirdEdge {
    Edge([f64; 3]),
    Length(f64),
}

impl ThirdEdge {
    /// The edge, beside the two others.
    pub(super) fn edge(self, up: Vec3, side: Vec3) -> Vec3 {
        // Powers of two are taken out of both, so that no product leaves the range of f64.
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

/// Where the axes come to, turned by an angle in radians about an axis; as they are if it has no
/// direction.
pub(in crate::course) fn axes_turned_about(axis: Vec3, angle: f64) -> [Vec3; 3] {
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
        let [x, y, z] = axes_turned_about(Vec3::Z * 3.0, std::f64::consts::FRAC_PI_2);
        let is_near = |a: Vec3, b: Vec3| (a - b).length() < 1e-15;
        assert!(is_near(x, Vec3::Y) && is_near(y, Vec3::NEG_X) && is_near(z, Vec3::Z));
        assert_eq!(axes_turned_about(Vec3::ZERO, 1.0), Vec3::AXES);
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
