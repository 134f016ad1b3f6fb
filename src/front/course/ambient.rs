//! How often the ambient term is added: once, or once per light.

use super::decode::{Context, Spanned};
use super::keyword::Keyword;
use super::lower::Lowering;
use super::record::FieldOutcome;
use super::settings::Scene;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, Ambient};

impl Keyword for Ambient {
    const KEYWORDS: &'static [(&'static str, Self)] =
        &[("perLight", Ambient::PerLight), ("once", Ambient::Once)];
}

impl Lowering {
    /// Sets how often the ambient term is added. Without the key `Ambient` a JSON scene adds it
    /// once and a YAML scene adds it per light, as the programs of these years did. Call it after
    /// the lights and the objects.
    pub(super) fn ambient(&mut self, scene: &Scene, context: &mut Context<'_>) {
        self.scene.settings.ambient = match &scene.ambient {
            FieldOutcome::Read(Spanned { value, .. }) => *value,
            FieldOutcome::Absent | FieldOutcome::Broken
                if is_json(context) && self.scene.settings.mode == ir::Mode::Phong =>
            {
                Ambient::Once
            }
            FieldOutcome::Absent | FieldOutcome::Broken => Ambient::PerLight,
        };
        let is_assumed = scene.ambient.is_absent() && self.scene.settings.ambient == Ambient::Once;
        if let (true, true, Some(span)) = (is_assumed, self.shows_ambient(), scene.lights.span) {
            let message = || "the ambient light of a JSON scene is added once".to_owned();
            context.report(&codes::TWO_READINGS, span, message, |d| {
                d.at(
                    span,
                    "some programs add it for each light, times its colour",
                )
                .severity(Severity::Note)
                .hint("`\"Ambient\": \"perLight\"` does so, `\"once\"` does as here")
            });
        }
    }

    /// Whether the image depends on how often the ambient term is added.
    fn shows_ambient(&self) -> bool {
        let ir::Scene {
            settings,
            lights,
            materials,
            ..
        } = &self.scene;
        let mut sum = [0.0; 3];
        for light in lights.iter().filter_map(ir::Light::point) {
            sum = [0, 1, 2].map(|channel| sum[channel] + light.color[channel]);
        }
        let mut phong = materials.iter().filter_map(ir::Material::phong);
        settings.mode == ir::Mode::Phong && sum != [1.0; 3] && phong.any(|phong| phong.ka > 0.0)
    }
}

/// Whether the scene is written as JSON: an opening brace, then a key in quotes.
fn is_json(context: &Context<'_>) -> bool {
    let text = context.tree.written(context.tree.root());
    let inside = text.strip_prefix('{').map(str::trim_start);
    inside.is_some_and(|inside| inside.starts_with('"'))
}
