//! Glass: materials that files declare transparent by a keyword (`isTransparent`, `type:
//! refraction`) instead of by the weight `kt`.

use super::decode::DecodeContext;
use super::lower::Lowering;
use super::material::{MaterialFinish, PhongMaterial};
use super::record::FieldResult;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, MaterialId};
use rtc_source::Span;

/// A material that transmits light.
pub(super) struct Glass {
    pub(super) id: MaterialId,
    /// The span that declares it transparent.
    pub(super) span: Span,
    /// Whether it shows only the light that it transmits, without its own colour.
    pub(super) is_clear: bool,
}

impl Lowering {
    /// Removes the ambient and diffuse term of clear glass. If the scene follows no refracted rays,
    /// glass keeps them, and that is reported. Call it after the settings are known.
    pub(super) fn glass(&mut self, context: &mut DecodeContext<'_>) {
        let ir::Settings {
            mode, max_depth, ..
        } = &self.scene.settings;
        let (has_recursion, is_phong) = (*max_depth > 0, *mode == ir::Mode::Phong);
        for Glass { id, span, is_clear } in std::mem::take(&mut self.glass) {
            let material = self.scene.materials.get_mut(id.0 as usize);
            match material.and_then(ir::Material::phong_mut) {
                Some(phong) if has_recursion && is_clear => remove_own_color(phong, span, context),
                Some(_) if !has_recursion && is_phong => report_opaque_glass(span, context),
                Some(_) | None => {}
            }
        }
    }
}

/// Whether a keyword declares a material transparent or opaque, and where.
pub(super) fn glass_setting(material: &PhongMaterial) -> Option<(bool, Span)> {
    let PhongMaterial {
        kind,
        is_transparent,
        ..
    } = material;
    match (is_transparent, kind) {
        (FieldResult::Read(is_transparent), _) => {
            Some((is_transparent.value, is_transparent.span?))
        }
        (_, FieldResult::Read(kind)) => {
            Some((kind.value == MaterialFinish::Refraction, kind.span?))
        }
        _ => None,
    }
}

/// Removes the ambient and diffuse term of glass, so that it shows only transmitted light.
fn remove_own_color(phong: &mut ir::Phong, span: Span, context: &mut DecodeContext<'_>) {
    let is_colored = phong.color_map.is_some() || phong.color != [1.0; 3];
    // The validator rejects a negative weight.
    (phong.ka, phong.kd) = (phong.ka.min(0.0), phong.kd.min(0.0));
    if is_colored {
        let message = || "the colour of this glass is ignored".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "its `color`, `ka` and `kd` have no effect")
                .severity(Severity::Warning)
                .hint("`kt: 1` instead adds the transmitted light to its own colour")
        });
    }
}

/// Reports that glass transmits no light, because `MaxRecursionDepth` is 0.
fn report_opaque_glass(span: Span, context: &mut DecodeContext<'_>) {
    let message = || "without a `MaxRecursionDepth` glass is opaque".to_owned();
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "shows only its own colour")
            .severity(Severity::Warning)
            .hint("`MaxRecursionDepth: 5` follows the light through it")
    });
}

/// Makes a surface opaque and reports that its `kt` has no effect.
pub(super) fn make_opaque(phong: &mut ir::Phong, span: Span, context: &mut DecodeContext<'_>) {
    phong.kt = 0.0;
    // The validator rejects a negative index.
    if phong.ior > 0.0 {
        phong.ior = 1.0;
    }
    let message = || "the material has a weight of refraction, but is declared opaque".to_owned();
    context.report(&codes::NO_EFFECT, span, message, |d| {
        d.at(span, "so its `kt` has no effect")
            .severity(Severity::Warning)
    });
}

/// Reports an index of refraction without a weight, and a weight with an index of 0: they have no
/// effect.
pub(super) fn report_index_without_weight(
    material: &PhongMaterial,
    context: &mut DecodeContext<'_>,
) {
    let PhongMaterial { kt, eta, .. } = material;
    if let (true, Some(span)) = (kt.value.0 > 0.0 && eta.value.0 == 0.0, eta.span) {
        let message = || "with an `eta` of 0 the material is opaque".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "so the weight of refraction has no effect")
                .also(kt.span, "the weight")
                .severity(Severity::Warning)
                .hint("the index of glass is 1.5")
        });
    }
    let refracts = eta.value.0 > 0.0 && (eta.value.0 - 1.0).abs() > 1e-9;
    if let (true, None, Some(span)) = (refracts, kt.span, eta.span) {
        let message = || "an index of refraction alone has no effect".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "without a weight")
                .severity(Severity::Warning)
                .hint("add the weight of the light that passes through, `kt: 1` for clear glass")
        });
    }
}
