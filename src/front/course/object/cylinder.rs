//! The cylinder.

use super::LowerObject;
use super::cone::AxisKeys;

use crate::course::decode::{DecodeContext, SharedValue, Spanned, SpannedVector};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Positive, Real};
use crate::course::record::{FieldResult, record};
use crate::course::rotation::axes_rotated_about;
use crate::course::synonym::{AXIS, ENDS, HEIGHT, POSITION, RADIUS, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_ir as ir;
use rtc_math::{Vec3, length};

record! {
    /// A cylinder with two caps. It is given by the centre of its base, a direction and a height;
    /// by the centres of both caps; by the centre of its base and the vector to the top; or, in
    /// some files, by its middle, a height, and the rotation from the x axis to its axis.
    struct Cylinder, "cylinder" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// The centre of the base; beside `eulerAxis` the middle of the cylinder.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position"), json "origin";
        /// The direction from the base to the top, of any length but 0.
        direction: Spanned<Vector>, optional, &with_canonical(AXIS, "direction"), json "axis";
        /// From base to top, above 0.
        height: Spanned<Positive>, optional, &HEIGHT, json "height";
        /// From the base to the top; its length is the height.
        up: Spanned<Vector>, optional, &[&["up"]];
        /// The axis of the rotation from the x axis to the axis of the cylinder.
        euler_axis: Spanned<Vector>, optional, &[&["eulerAxis"]];
        /// The angle of that rotation, in radians.
        euler_angle: Spanned<Real>, optional, &[&["eulerAngle"]];
        /// The centre of a cap.
        ends: [Spanned<Point>; 2], optional, &ENDS, json "p1";
        /// The radius; 0 is invisible.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius"), json "radius";
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants {
        [position direction height] [ends] [position up] [position height euler_axis euler_angle]
    }
}

impl LowerObject for Cylinder {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Cylinder {
            kind,
            radius,
            material,
            shadow,
            velocity,
            ..
        } = self;
        let props = lowering.surface_props(kind, material, (shadow, velocity), context);
        if let (Some(props), Some((base, axis, height))) = (props, axis(self)) {
            let shape = ir::Cylinder {
                base: base.value,
                axis: axis.value,
                height: height.value,
                radius: radius.value.0,
            };
            let value_spans = [
                ("base", base.span),
                ("axis", axis.span),
                ("height", height.span),
                ("radius", radius.span),
            ];
            lowering.add_surface(&props, ir::Shape::Cylinder(shape), &value_spans);
        }
    }
}

/// The centre of the base, the direction to the top, and the height.
fn axis(cylinder: &Cylinder) -> Option<(SpannedVector, SpannedVector, Spanned<f64>)> {
    let Cylinder {
        kind: _,
        position,
        direction,
        height,
        up,
        euler_axis,
        euler_angle,
        ends,
        radius: _,
        material: _,
        shadow: _,
        velocity: _,
    } = cylinder;
    // The older form rotates the axis about its middle.
    if let (
        FieldResult::Read(middle),
        FieldResult::Read(height),
        FieldResult::Read(axis),
        FieldResult::Read(angle),
    ) = (position, height, euler_axis, euler_angle)
    {
        let [along, ..] = axes_rotated_about(Vec3::from_array(axis.value.0), angle.value.0);
        let base = Vec3::from_array(middle.value.0) - along * (height.value.0 / 2.0);
        return Some((
            middle.map(|_| base.to_array()),
            axis.map(|_| along.to_array()),
            height.map(|height| height.0),
        ));
    }
    // The common form has a base, a direction and a height.
    if let (FieldResult::Read(position), FieldResult::Read(direction), FieldResult::Read(height)) =
        (position, direction, height)
    {
        return Some((
            position.map(|point| point.0),
            direction.map(|vector| vector.0),
            height.map(|height| height.0),
        ));
    }
    // The other forms give the vector from base to top.
    let axis_keys = AxisKeys {
        position,
        up,
        direction,
        height,
        ends,
    };
    let (base, up) = axis_keys.base_and_up()?;
    let height = up.map(|up| length(Vec3::from_array(*up)));
    Some((base, up, height))
}

record! {
    /// A cylinder without ends.
    struct InfiniteCylinder, "infinite cylinder" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// A point of the axis.
        position: Spanned<Point>, required, &with_canonical(POSITION, "position");
        /// The direction of the axis, of any length but 0.
        direction: Spanned<Vector>, required, &with_canonical(AXIS, "direction");
        /// The radius; 0 is invisible.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius");
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

impl LowerObject for InfiniteCylinder {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Self {
            kind,
            position,
            direction,
            radius,
            material,
            shadow,
            velocity,
        } = self;
        let shape = ir::InfiniteCylinder {
            center: position.value.0,
            axis: direction.value.0,
            radius: radius.value.0,
        };
        let value_spans = [
            ("center", position.span),
            ("axis", direction.span),
            ("radius", radius.span),
        ];
        if let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context) {
            lowering.add_surface(&props, ir::Shape::InfiniteCylinder(shape), &value_spans);
        }
    }
}
