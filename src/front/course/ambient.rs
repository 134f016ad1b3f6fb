//! How often the ambient term is added: once, or once per light.

use super::decode::{DecodeContext, Spanned};
use super::keyword::{Keyword, KeywordTable};
use super::lower::Lowering;
use super::record::FieldResult;
use super::settings::Scene;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, Ambient, EntityField, EntityKind};
use rtc_source::Span;

impl Keyword for Ambient {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "perLight",
            Ambient::PerLight,
            "For each light, times its colour.",
        ),
        ("once", Ambient::Once, "Once, whatever lights there are."),
    ];
}

impl Lowering {
    /// Sets how often the ambient term is added. Without the key `Ambient` a JSON scene adds it
    /// once and a YAML scene adds it per light, as the programs of these years did. Call it after
    /// the lights and the objects.
    pub(super) fn ambient(&mut self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let light = scene.ambient_light.read();
        if let Some(Spanned { value, span }) = light {
            self.scene.settings.ambient_light = value.0;
            self.record_span(EntityKind::Settings, 0, EntityField::AmbientLight, *span);
            self.report_ambient_light(scene, *span, context);
        }
        self.scene.settings.ambient = match &scene.ambient {
            FieldResult::Read(Spanned { value, .. }) => *value,
            FieldResult::Absent | FieldResult::Broken if light.is_some() => Ambient::Once,
            FieldResult::Absent | FieldResult::Broken
                if context.is_json() && self.scene.settings.mode == ir::Mode::Phong =>
            {
                Ambient::Once
            }
            FieldResult::Absent | FieldResult::Broken => Ambient::PerLight,
        };
        let is_assumed = light.is_none()
            && scene.ambient.is_absent()
            && self.scene.settings.ambient == Ambient::Once;
        let levels = self.ambient_difference();
        if let (true, true, Some(span)) = (is_assumed, levels > 0.0, scene.lights.span) {
            let message = || "the ambient light of a JSON scene is added once".to_owned();
            context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
                d.at(
                    span,
                    "some programs, and the pictures handed out of textured scenes, add it for \
                     each light, times its colour",
                )
                .severity(match levels > 1.0 {
                    true => Severity::Warning,
                    false => Severity::Note,
                })
                .hint("`\"Ambient\": \"perLight\"` does so, `\"once\"` does as here")
            });
        }
    }

    /// Reports an ambient light that multiplies nothing.
    fn report_ambient_light(
        &self,
        scene: &Scene,
        span: Option<Span>,
        context: &mut DecodeContext<'_>,
    ) {
        let is_per_light = scene
            .ambient
            .read()
            .is_some_and(|own| own.value == Ambient::PerLight);
        let reason = match (&self.scene.settings.mode, is_per_light) {
            (ir::Mode::Phong, false) => return,
            (ir::Mode::Phong, true) => "with `Ambient: perLight` the lights are the ambient light",
            _ => "only `RenderMode: phong` has ambient light",
        };
        let Some(span) = span else { return };
        let message = || "`AmbientLight` has no effect".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| d.at(span, reason));
    }

    /// By how many levels of a byte a pixel can depend on how often the ambient term is added.
    fn ambient_difference(&self) -> f64 {
        let ir::Scene {
            settings,
            lights,
            materials,
            ..
        } = &self.scene;
        if settings.mode != ir::Mode::Phong {
            return 0.0;
        }
        let mut sum = [0.0; 3];
        for light in lights.iter().filter_map(ir::Light::point) {
            sum = [0, 1, 2].map(|channel| sum[channel] + light.color[channel]);
        }
        let difference = |phong: &ir::Phong| {
            let channels = [0, 1, 2].map(|channel| phong.color[channel] * (sum[channel] - 1.0));
            phong.ka * channels.map(f64::abs).into_iter().fold(0.0, f64::max)
        };
        let materials = materials.iter().filter_map(ir::Material::phong);
        255.0 * materials.map(difference).fold(0.0, f64::max)
    }
}
