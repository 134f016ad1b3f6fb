//! The materials.

use super::decode::{Context, Shared, Spanned};
use super::lower::Lowering;
use super::number::{Count, NonNegative};
use super::record::{Found, keys, missing_keys, record};
use super::value::{Color, Unsupported};
use crate::ir::{self, Field, MaterialId, Noun};

record! {
    /// What a surface is made of: Phong's model with mirror and refraction.
    struct Material, "material" {
        /// The colour: red, green, blue.
        color: Spanned<Color>, optional, keys!["color"];
        /// A picture laid over the surface; this version can't show it. Without `color` the surface is white.
        texture: Spanned<Unsupported>, optional, keys!["texture"];
        /// A picture of bumps; this version can't show it.
        _bump: Spanned<Unsupported>, optional, keys!["bump" "normalMap"];
        /// A picture of highlights; this version can't show it.
        _specular: Spanned<Unsupported>, optional, keys!["specularMap"];
        /// The weight of the ambient light.
        ka: Spanned<NonNegative>, required, keys!["ka"];
        /// The weight of the diffuse light.
        kd: Spanned<NonNegative>, required, keys!["kd"];
        /// The weight of the highlight and of the mirror image.
        ks: Spanned<NonNegative>, required, keys!["ks"];
        /// The exponent of the highlight: the larger, the smaller and sharper.
        n: Spanned<NonNegative>, required, keys!["n"];
        /// The weight of the light that passes through; 0 is opaque.
        kt: Spanned<NonNegative>, default(NonNegative(0.0)), keys!["kt" "refract"];
        /// The index of refraction, for instance 1.5 for glass; 0 is opaque.
        eta: Spanned<NonNegative>, default(NonNegative(1.0)), keys!["eta" "index"];
        /// How many rays sample a blurred mirror image; 1 is a sharp one.
        glossy_samples: Spanned<Count>, default(Count(1)), keys!["glossySamples"];
    }
    forms { [color] }
}

impl Lowering {
    /// Lowers a material, once if aliases share it. `None` if it has neither colour nor texture, which is reported once.
    pub(super) fn material(
        &mut self,
        material: &Spanned<Shared<Material>>,
        context: &mut Context<'_>,
    ) -> Option<MaterialId> {
        let Shared { node, value } = &material.value;
        if let Some(id) = self.shared.get(node) {
            return Some(*id);
        }
        let Material { color, texture, _bump: _, _specular: _, ka, kd, ks, n, kt, eta, glossy_samples } =
            value.as_ref()?;
        let color = match (color, texture) {
            (Found::Read(color), _) => *color,
            (Found::Absent, Found::Read(_) | Found::Broken) => Spanned::unwritten(Color([1.0; 3])),
            (Found::Absent, Found::Absent) => {
                material.span.into_iter().for_each(|span| missing_keys("material", span, &["color"], context));
                return None;
            }
            (Found::Broken, _) => return None,
        };
        let index = self.scene.materials.len();
        let (weight, ratio) = refraction(kt.value.0, eta.value.0);
        self.scene.materials.push(ir::Material::Phong(ir::Phong {
            color: color.value.0,
            ka: ka.value.0,
            kd: kd.value.0,
            ks: ks.value.0,
            n: n.value.0,
            kt: weight,
            eta: ratio,
            glossy_samples: glossy_samples.value.0,
            color_map: None,
            specular_map: None,
            normal_map: None,
            bump: None,
        }));
        for (field, span) in [
            (Field::Whole, material.span),
            (Field::Color, color.span),
            (Field::Ka, ka.span),
            (Field::Kd, kd.span),
            (Field::Ks, ks.span),
            (Field::N, n.span),
            (Field::Kt, kt.span),
            (Field::Eta, eta.span),
            (Field::GlossySamples, glossy_samples.span),
        ] {
            self.origin(Noun::Material, index, field, span);
        }
        let id = MaterialId(u32::try_from(index).unwrap_or(u32::MAX));
        self.shared.insert(*node, id);
        Some(id)
    }
}

/// A weight or an index of 0 means that nothing is refracted; what is negative is left for the proof to refuse.
fn refraction(kt: f64, eta: f64) -> (f64, f64) {
    let weight = if eta == 0.0 { kt.min(0.0) } else { kt };
    let ratio = if eta == 0.0 || (kt == 0.0 && eta > 0.0) { 1.0 } else { eta };
    (weight, ratio)
}
