//! The glTF assets: a file, and its place in the scene.

use super::Lower;
use super::solid::turned;
use crate::course::decode::{Context, Spanned};
use crate::course::lower::Lowering;
use crate::course::record::{keys, record};
use crate::course::turn::Rotation;
use crate::course::value::{Angles, FileName, Point, Scale, Text};
use rtc_math::Vec3;

record! {
    /// A glTF asset, with its own materials and lights; its cameras do not count. A scene with one is shown by its paths.
    struct Gltf, "glTF asset" {
        /// What kind of object this is.
        _kind: Spanned<Text>, required, keys!["type"];
        /// The file, .gltf or .glb, beside the scene file or in a folder below it.
        file: Spanned<FileName>, required, keys!["file"];
        /// Where the origin of the asset comes to.
        position: Spanned<Point>, default(Point([0.0; 3])), keys!["position"];
        /// How many times larger it is than in its file, in all directions or along its x, y and z.
        scale: Spanned<Scale>, default(Scale([1.0; 3])), keys!["scale"];
        /// The angles in radians by which it is turned about its origin: first about x, then y, then z.
        rotation: Spanned<Rotation<Angles>>, default(Rotation(Some(Angles([0.0; 3])))), keys!["rotation"];
    }
}

impl Lower for Gltf {
    fn lower(&self, lowering: &mut Lowering, _: &mut Context<'_>) {
        let Gltf {
            _kind: _,
            file,
            position,
            scale,
            rotation,
        } = self;
        let [x, y, z] = rotation
            .value
            .0
            .map_or(Vec3::AXES, |angles| turned(angles.0));
        let [sx, sy, sz] = scale.value.0;
        let columns = [x * sx, y * sy, z * sz].map(|axis| axis.to_array());
        lowering
            .files
            .gltf([columns[0], columns[1], columns[2], position.value.0], file);
    }
}
