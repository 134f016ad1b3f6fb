//! Punctual lights: rules between their properties.

use super::document::Document;
use super::field::ObjectFields;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_math::shortest;

/// Checks all lights.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    for light in &doc.lights {
        let fields = ObjectFields::new(report.json, *light);
        // A spot light needs its cone angles.
        if fields.is("type", "spot") && !fields.has("spot") {
            let message = "the light has no `spot`".to_owned();
            report.add(
                &codes::GLTF_MISSING,
                "UNDEFINED_PROPERTY",
                fields.at,
                message,
            );
        }
        // Properties of other kinds of light have no effect.
        if let Some(at) = fields
            .node("range")
            .filter(|_| fields.is("type", "directional"))
        {
            let message = "a directional light has no range".to_owned();
            report.add(&codes::GLTF_REMARK, "EXTRA_PROPERTY", at, message);
        }
        if let Some(at) = fields.node("spot").filter(|_| !fields.is("type", "spot")) {
            let message = "only a spot light may have `spot`".to_owned();
            report.add(&codes::GLTF_REMARK, "EXTRA_PROPERTY", at, message);
        }
        // The outer cone must enclose the inner cone.
        let Some(spot) = fields.object("spot") else {
            continue;
        };
        let inner = spot.number_or("innerConeAngle", 0.0);
        let outer = spot.number_or("outerConeAngle", std::f64::consts::FRAC_PI_4);
        if outer <= inner {
            let at = report.json.at_or(spot.at, "outerConeAngle");
            let [inner, outer] = [inner, outer].map(shortest);
            let message = format!(
                "`outerConeAngle` is {outer}; it must be above `innerConeAngle`, which is {inner}"
            );
            report.add(
                &codes::GLTF_VALUE,
                "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
                at,
                message,
            );
        }
    }
}
