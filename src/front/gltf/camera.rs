//! Cameras: perspective or orthographic.

use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_math::shortest;

/// The projection of a camera; it looks along its negative z axis, y is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Projection {
    /// The vertical opening in radians, and width over height if the picture's own does not count.
    Perspective { yfov: f64, aspect: Option<f64> },
    /// Half the width and half the height of the view volume.
    Orthographic { xmag: f64, ymag: f64 },
}

/// The projection of a camera.
pub(super) fn projection(fields: ObjectFields<'_, '_>) -> Option<Projection> {
    let projection = |kind| fields.object(kind).filter(|_| fields.is("type", kind));
    if let Some(projection) = projection("perspective") {
        return Some(Projection::Perspective {
            yfov: projection.number("yfov").filter(|yfov| *yfov > 0.0)?,
            aspect: projection
                .number("aspectRatio")
                .filter(|ratio| *ratio > 0.0),
        });
    }
    let projection = projection("orthographic")?;
    Some(Projection::Orthographic {
        xmag: projection.number("xmag")?,
        ymag: projection.number("ymag")?,
    })
}

/// Checks all cameras.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    for camera in &doc.cameras {
        let fields = ObjectFields::new(report.json, *camera);
        let (perspective, orthographic) =
            (fields.object("perspective"), fields.object("orthographic"));
        // A camera has exactly one projection, which its type names.
        if fields.has("perspective") && fields.has("orthographic") {
            let message = "a camera must be either perspective or orthographic".to_owned();
            report.add(&codes::GLTF_TOGETHER, "ONE_OF_MISMATCH", *camera, message);
        }
        for kind in ["perspective", "orthographic"] {
            if fields.is("type", kind) && !fields.has(kind) {
                let message = format!("the camera has no `{kind}`");
                report.add(&codes::GLTF_MISSING, "UNDEFINED_PROPERTY", *camera, message);
            }
        }
        // The far plane is behind the near plane.
        for part in [perspective, orthographic].into_iter().flatten() {
            if let (Some(near), Some(far)) = (part.number("znear"), part.number("zfar"))
                && far <= near
            {
                let [far, near] = [far, near].map(shortest);
                let message = format!("`zfar` is {far}; it must be above `znear`, which is {near}");
                report.add(
                    &codes::GLTF_VALUE,
                    "CAMERA_ZFAR_LEQUAL_ZNEAR",
                    part.at,
                    message,
                );
            }
        }
        // Check the numbers of each projection.
        if let Some(part) = perspective {
            check_perspective(part, report);
        }
        if let Some(part) = orthographic {
            check_orthographic(part, report);
        }
    }
}

fn check_perspective(part: ObjectFields<'_, '_>, report: &mut AssetReport<'_, '_>) {
    if part.number_or("yfov", 0.0) >= std::f64::consts::PI {
        let message = "the field of view is 180° or more";
        let alias = "CAMERA_YFOV_GEQUAL_PI";
        report.add(&codes::GLTF_MATERIAL_ODD, alias, part.at, message);
    }
}

fn check_orthographic(part: ObjectFields<'_, '_>, report: &mut AssetReport<'_, '_>) {
    let mags = [part.number_or("xmag", 1.0), part.number_or("ymag", 1.0)];
    if mags.contains(&0.0) {
        let message = "the width or the height of the view is 0";
        let alias = "CAMERA_XMAG_YMAG_ZERO";
        report.add(&codes::GLTF_VALUE, alias, part.at, message);
    } else if mags.iter().any(|mag| *mag < 0.0) {
        let message = "a negative `xmag` or `ymag` mirrors the picture";
        let alias = "CAMERA_XMAG_YMAG_NEGATIVE";
        report.add(&codes::GLTF_MATERIAL_ODD, alias, part.at, message);
    }
}
