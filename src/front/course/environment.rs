//! What surrounds a scene.

use super::decode::{Context, Spanned};
use super::lower::Lowering;
use super::object::solid::euler_axes;
use super::record::{FieldOutcome, keys, record};
use super::rotation::RotationRows;
use super::value::{Channels, FileName, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityKind, Field};
use rtc_source::Span;

record! {
    /// What surrounds the scene: light from every direction where nothing stands. A scene with one is shown by its paths.
    struct Environment, "environment" {
        /// The radiance: red, green, blue, or one number for all; with a `file`, a factor of it.
        color: Spanned<Channels>, default(Channels([1.0; 3])), keys!["color"];
        /// A picture of all directions, Radiance HDR or OpenEXR: longitude across, its middle towards −z, +y up.
        file: Spanned<FileName>, optional, keys!["file"];
        /// The angles in radians by which it is turned: first about x, then y, then z.
        rotation: Spanned<Vector>, optional, keys!["rotation"];
        /// The same as nine numbers, in place of `rotation`: the rows of the rotation from directions of the world to those
        /// of the picture.
        matrix: Spanned<RotationRows>, optional, keys!["matrix"];
    }
}

impl Lowering {
    /// Lowers an environment: its file is wanted.
    pub(super) fn environment(
        &mut self,
        environment: &Spanned<Environment>,
        context: &mut Context<'_>,
    ) {
        let Environment {
            color,
            file,
            rotation,
            matrix,
        } = &environment.value;
        let image = match file {
            FieldOutcome::Read(file) => Some(self.files.environment(&mut self.scene, file)),
            FieldOutcome::Absent => None,
            FieldOutcome::Broken => return,
        };
        let rotation_keys = match (matrix, rotation) {
            (FieldOutcome::Read(matrix), rotation) => {
                if let FieldOutcome::Read(rotation) = rotation {
                    report_two_rotations(rotation.span, context);
                }
                Some(matrix.value.0)
            }
            // Its rows are where the axes come to: the way back from the world.
            (FieldOutcome::Absent, FieldOutcome::Read(rotation)) => {
                Some(euler_axes(rotation.value.0).map(|axis| axis.to_array()))
            }
            (FieldOutcome::Absent, FieldOutcome::Absent) => None,
            (FieldOutcome::Broken, _) | (_, FieldOutcome::Broken) => return,
        };
        self.scene.environment = Some(ir::Environment {
            radiance: color.value.0,
            image,
            image_from_world: rotation_keys,
        });
        self.origin(EntityKind::Environment, 0, Field::Whole, environment.span);
    }
}

/// Says that a matrix counts alone.
fn report_two_rotations(rotation: Option<Span>, context: &mut Context<'_>) {
    let Some(span) = rotation else { return };
    let message = || "the environment is turned once: the `matrix` counts".to_owned();
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "no effect").severity(Severity::Warning)
    });
}
