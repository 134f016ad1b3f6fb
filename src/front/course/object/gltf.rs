//! A glTF asset and its placement.

use super::LowerObject;
use crate::course::decode::{DecodeContext, Spanned};
use crate::course::lower::Lowering;
use crate::course::number::Degrees;
use crate::course::record::record;
use crate::course::rotation::{Rotation, RotationKeys, world_from_object};
use crate::course::synonym::{
    FILE, POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, SCALE, with_canonical,
};
use crate::course::value::{Angles, AnyScalar, FileName, Point, Scale, Vector};

record! {
    /// A glTF asset with its materials and lights; its cameras are ignored. A scene with an asset
    /// is rendered by path tracing.
    struct Gltf, "glTF asset" {
        /// The type of the object.
        _kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The file, .gltf or .glb, in the folder of the scene file or below it.
        file: Spanned<FileName>, required, &FILE;
        /// The position of the asset's origin.
        position: Spanned<Point>, default(Point([0.0; 3])), &with_canonical(POSITION, "position");
        /// The scale factor, or one factor for each of x, y and z.
        scale: Spanned<Scale>, default(Scale([1.0; 3])), &SCALE;
        /// The rotation about its origin by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
    }
}

impl LowerObject for Gltf {
    fn is_in_file(&self) -> bool {
        true
    }

    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Gltf {
            _kind: _,
            file,
            position,
            scale,
            rotation,
            axis,
            angle,
        } = self;
        let rotation_keys = RotationKeys {
            rotation,
            axis,
            angle,
        };
        if let Some(axes) = rotation_keys.axes(context) {
            let transform = world_from_object(axes, scale.value.0, position.value.0);
            lowering.files.gltf(transform, file);
        }
    }
}
