//! The cube of some files.

use super::{LowerObject, report_negative};
use crate::course::decode::{DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, NonNegative, Real};
use crate::course::object::solid::box_around;
use crate::course::record::{FieldResult, record};
use crate::course::rotation::{Rotation, RotationKeys, axes_rotated_about};
use crate::course::synonym::{POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, with_canonical};
use crate::course::value::{Angles, AnyScalar, Point, Vector};
use rtc_math::Vec3;

record! {
    /// A cube, with or without a rotation. Better written as a `box`.
    struct Cube, "cube" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The centre.
        position: Spanned<Point>, required, &with_canonical(POSITION, "position");
        /// The length of an edge; 0 is invisible.
        length: Spanned<NonNegative>, required, &[&["length"], &["side"], &["size"], &["edge"]];
        /// The rotation about its centre by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation about its centre by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// The axis of rotation.
        euler_axis: Spanned<Vector>, optional, &[&["eulerAxis"]];
        /// The angle of rotation, in radians.
        euler_angle: Spanned<Real>, optional, &[&["eulerAngle"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants {
        [position] [position euler_axis euler_angle] [position rotation] [position rotation angle]
        [position axis angle]
    }
}

impl LowerObject for Cube {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
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
            velocity,
        } = self;
        let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context)
        else {
            return;
        };
        // The axes, rotated by either set of keys.
        let rotation_keys = match (euler_axis, euler_angle) {
            (FieldResult::Read(axis), FieldResult::Read(angle)) => Some(axes_rotated_about(
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
        // The corners and faces.
        let corners = box_around(center, [length.value.0; 3], rotation_keys);
        lowering.add_box(&props, &corners, length.span, context);
    }
}
