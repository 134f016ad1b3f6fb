//! The glTF assets: a file, and its place in the scene.

use super::Lower;
use crate::course::decode::{Context, Spanned};
use crate::course::lower::Lowering;
use crate::course::number::Degrees;
use crate::course::record::{keys, record};
use crate::course::synonym::{FILE, PLACE, ROTATION, SCALE, TURN_ANGLE, TURN_AXIS, led_by};
use crate::course::turn::{Rotation, Turn, placed};
use crate::course::value::{Angles, FileName, Point, Scale, Text, Vector};

record! {
    /// A glTF asset, with its own materials and lights; its cameras do not count. A scene with one is shown by its paths.
    struct Gltf, "glTF asset" {
        /// What kind of object this is.
        _kind: Spanned<Text>, required, keys!["type"];
        /// The file, .gltf or .glb, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, &FILE;
        /// Where the origin of the asset comes to.
        position: Spanned<Point>, default(Point([0.0; 3])), &led_by(PLACE, "position");
        /// How many times larger it is than in its file, in all directions or along its x, y and z.
        scale: Spanned<Scale>, default(Scale([1.0; 3])), &SCALE;
        /// The angles in radians by which it is turned about its origin: first about x, then y,
        /// then z; beside `angle` the axis.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis that it is turned about by `angle`.
        axis: Spanned<Vector>, optional, &TURN_AXIS;
        /// By how many degrees it is turned about its axis.
        angle: Spanned<Degrees>, optional, &TURN_ANGLE;
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
        let turn = Turn {
            rotation,
            axis,
            angle,
        };
        if let Some(axes) = turn.axes(context) {
            let place = placed(axes, scale.value.0, position.value.0);
            lowering.files.gltf(place, file);
        }
    }
}
