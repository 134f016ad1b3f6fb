//! What surrounds a scene.

use super::decode::Spanned;
use super::lower::Lowering;
use super::object::solid::turned;
use super::record::{FieldOutcome, keys, record};
use super::value::{Channels, FileName, Vector};
use crate::ir::{self, Field, Noun};

record! {
    /// What surrounds the scene: light from every direction where nothing stands. A scene with one is shown by its paths.
    struct Environment, "environment" {
        /// The radiance: red, green, blue, or one number for all; with a `file`, a factor of it.
        color: Spanned<Channels>, default(Channels([1.0; 3])), keys!["color"];
        /// A picture of all directions, Radiance HDR or OpenEXR: longitude across, its middle towards −z, +y up.
        file: Spanned<FileName>, optional, keys!["file"];
        /// The angles in radians by which it is turned: first about x, then y, then z.
        rotation: Spanned<Vector>, optional, keys!["rotation"];
    }
}

impl Lowering {
    /// Lowers an environment: its file is wanted.
    pub(super) fn environment(&mut self, environment: &Spanned<Environment>) {
        let Environment {
            color,
            file,
            rotation,
        } = &environment.value;
        let image = match file {
            FieldOutcome::Read(file) => Some(self.files.environment(&mut self.scene, file)),
            FieldOutcome::Absent => None,
            FieldOutcome::Broken => return,
        };
        let turn = match rotation {
            // Its rows are where the axes come to: the way back from the world.
            FieldOutcome::Read(rotation) => {
                Some(turned(rotation.value.0).map(|axis| axis.to_array()))
            }
            FieldOutcome::Absent => None,
            FieldOutcome::Broken => return,
        };
        self.scene.environment = Some(ir::Environment {
            radiance: color.value.0,
            image,
            image_from_world: turn,
        });
        self.origin(Noun::Environment, 0, Field::Whole, environment.span);
    }
}
