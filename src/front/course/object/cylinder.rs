//! The cylinder.

use super::Lower;
use super::cube::axes_turned_about;
use crate::course::decode::{Context, Numbers, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Positive, Real};
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::value::{Point, Text, Vector};
use rtc_ir as ir;
use rtc_math::Vec3;

record! {
    /// A cylinder with two caps: the centre of its base, a direction and a height; or the centres of both caps; or, as
    /// some files say it, its middle, a height, and how the x axis is turned to its own.
    struct Cylinder, "cylinder" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"], json "type";
        /// The centre of the base; beside `eulerAxis` the middle of the cylinder.
        position: Spanned<Point>, optional, keys!["position" "center" "origin"], json "origin";
        /// The direction from the base to the top, of any length but 0.
        direction: Spanned<Vector>, optional, keys!["direction" "axis"], json "axis";
        /// From base to top, above 0.
        height: Spanned<Positive>, optional, keys!["height" "h" "length"], json "height";
        /// What the x axis is turned about to be the axis of the cylinder.
        turn_axis: Spanned<Vector>, optional, keys!["eulerAxis"];
        /// By how much, in radians.
        turn_angle: Spanned<Real>, optional, keys!["eulerAngle"];
        /// The centre of a cap.
        ends: [Spanned<Point>; 2], optional, &[&["p1", "p2"], &["center1", "center2"], &["end1", "end2"]], json "p1";
        /// The radius, above 0.
        radius: Spanned<Positive>, required, keys!["radius" "r"], json "radius";
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"], json "material";
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"], json "shadow";
    }
    forms { [position direction height] [ends] [position height turn_axis turn_angle] }
}

impl Lower for Cylinder {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Cylinder {
            kind,
            radius,
            material,
            shadow,
            ..
        } = self;
        let clothes = lowering.clothe(kind, material, shadow, context);
        if let (Some(clothes), Some((base, axis, height))) = (clothes, axis(self)) {
            let shape = ir::Cylinder {
                base: base.value,
                axis: axis.value,
                height: height.value,
                radius: radius.value.0,
            };
            let places = [
                ("base", base.span),
                ("axis", axis.span),
                ("height", height.span),
                ("radius", radius.span),
            ];
            lowering.put(&clothes, ir::Shape::Cylinder(shape), &places);
        }
    }
}

/// The centre of the base, the direction to the top, and the height.
fn axis(cylinder: &Cylinder) -> Option<(Numbers, Numbers, Spanned<f64>)> {
    let Cylinder {
        kind: _,
        position,
        direction,
        height,
        turn_axis,
        turn_angle,
        ends,
        radius: _,
        material: _,
        shadow: _,
    } = cylinder;
    if let (
        FieldOutcome::Read(middle),
        FieldOutcome::Read(height),
        FieldOutcome::Read(axis),
        FieldOutcome::Read(angle),
    ) = (position, height, turn_axis, turn_angle)
    {
        let [along, ..] = axes_turned_about(Vec3::from_array(axis.value.0), angle.value.0);
        let base = Vec3::from_array(middle.value.0) - along * (height.value.0 / 2.0);
        return Some((
            middle.map(|_| base.to_array()),
            axis.map(|_| along.to_array()),
            height.map(|height| height.0),
        ));
    }
    match (position, direction, height, ends) {
        (
            FieldOutcome::Read(position),
            FieldOutcome::Read(direction),
            FieldOutcome::Read(height),
            _,
        ) => Some((
            position.map(|point| point.0),
            direction.map(|vector| vector.0),
            height.map(|height| height.0),
        )),
        (.., FieldOutcome::Read([base, top])) => {
            let axis = Vec3::from_array(top.value.0) - Vec3::from_array(base.value.0);
            Some((
                base.map(|point| point.0),
                top.map(|_| axis.to_array()),
                top.map(|_| axis.length()),
            ))
        }
        _ => None,
    }
}
