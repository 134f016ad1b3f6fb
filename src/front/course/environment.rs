//! The environment light.

use super::decode::{DecodeContext, Spanned};
use super::lower::Lowering;
use super::record::{FieldResult, record};
use super::rotation::{RotationRows, euler_axes};
use super::value::{Channels, FileName, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityField, EntityKind};
use rtc_source::Span;

record! {
    /// The environment: light from every direction that no surface blocks. A scene with an
    /// environment is rendered by path tracing.
    struct Environment, "environment" {
        /// The radiance: red, green, blue, or one number for all; with a `file`, a factor of the
        /// image.
        color: Spanned<Channels>, default(Channels([1.0; 3])), &[&["color"]];
        /// An image of all directions, Radiance HDR, OpenEXR or 8 bits: longitude across, its
        /// middle towards −z, +y up.
        file: Spanned<FileName>, optional, &[&["file"]];
        /// The rotation of the environment by angles in radians: first about x, then y, then z.
        rotation: Spanned<Vector>, optional, &[&["rotation"]];
        /// The rotation as nine numbers, instead of `rotation`: the rows of the matrix from
        /// directions of the world to those of the image.
        matrix: Spanned<RotationRows>, optional, &[&["matrix"]];
    }
}

impl Lowering {
    /// Lowers an environment; its file is added to the pending assets.
    pub(super) fn environment(
        &mut self,
        environment: &Spanned<Environment>,
        context: &mut DecodeContext<'_>,
    ) {
        let Environment {
            color,
            file,
            rotation,
            matrix,
        } = &environment.value;
        let image = match file {
            FieldResult::Read(file) => Some(self.files.environment(&mut self.scene, file)),
            FieldResult::Absent => None,
            FieldResult::Broken => return,
        };
        let rotation_keys = match (matrix, rotation) {
            (FieldResult::Read(matrix), rotation) => {
                if let FieldResult::Read(rotation) = rotation {
                    report_two_rotations(rotation.span, context);
                }
                Some(matrix.value.0)
            }
            // The rotated axes are the columns of world_from_image, and so the rows of its inverse.
            (FieldResult::Absent, FieldResult::Read(rotation)) => {
                Some(euler_axes(rotation.value.0).map(|axis| axis.to_array()))
            }
            (FieldResult::Absent, FieldResult::Absent) => None,
            (FieldResult::Broken, _) | (_, FieldResult::Broken) => return,
        };
        self.scene.environment = Some(ir::Environment {
            radiance: color.value.0,
            image,
            image_from_world: rotation_keys,
        });
        self.record_span(
            EntityKind::Environment,
            0,
            EntityField::Whole,
            environment.span,
        );
    }
}

/// Reports a `rotation` beside a `matrix`, which takes precedence.
fn report_two_rotations(rotation: Option<Span>, context: &mut DecodeContext<'_>) {
    let Some(span) = rotation else { return };
    let message = || "`rotation` has no effect with `matrix`".to_owned();
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "no effect").severity(Severity::Warning)
    });
}
