//! The glTF assets: a file, and its place in the scene.

use super::Lower;
use crate::course::decode::{Context, Spanned};
use crate::course::lower::Lowering;
use crate::course::number::Degrees;
use crate::course::record::{keys, record};
use crate::course::rotation::{Rotation, RotationKeys, world_from_object};
use crate::course::synonym::{
    FILE, POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, SCALE, with_canonical,
};
use crate::course::value::{Angles, AnyScalar, FileName, Point, Scale, Vector};

record! {
    /// A glTF asset, with its own materials and lights; its cameras do not count. A scene with one is shown by its paths.
    struct Gltf, "glTF asset" {
        /// What kind of object this is.
        _kind: Spanned<AnyScalar>, required, keys!["type"];
        /// The file, .gltf or .glb, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, &FILE;
        /// Where the origin of the asset comes to.
        position: Spanned<Point>, default(Point([0.0; 3])), &with_canonical(POSITION, "position");
        /// How many times larger it is than in its file, in all directions or along its x, y and z.
        scale: Spanned<Scale>, default(Scale([1.0; 3])), &SCALE;
        /// The angles in radians by which it is turned about its origin: first about x, then y,
        /// then z; beside `angle` the axis.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis that it is turned about by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// By how many degrees it is turned about its axis.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
    }
}

impl Lower for Gltf {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
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
            let place = world_from_object(axes, scale.value.0, position.value.0);
            lowering.files.gltf(place, file);
        }
    }
}
