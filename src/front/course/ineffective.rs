//! Reports keys that have no effect because another setting is missing.
//!
//! Each diagnostic is reported once per scene, and only if the key has no effect anywhere in it.

use super::decode::{DecodeContext, Spanned};
use super::lower::Lowering;
use super::material::PhongMaterial;
use super::record::FieldResult;
use super::settings::{Mode, Scene};
use rtc_diag::{Severity, codes};
use rtc_ir as ir;
use rtc_source::Span;

/// The keys of materials and objects whose effect depends on other settings.
#[derive(Default)]
pub(super) struct DependentKeys {
    /// The first `glossySamples` above 1.
    glossy_samples: Option<Span>,
    /// The first `specularMap`, and whether any of them has a `ks` above 0.
    specular_map: Option<(Span, bool)>,
    /// The first `shadow: false`.
    shadow: Option<Span>,
    /// The first point light with an `intensity` instead of a `color`, unless another light has
    /// keys of path tracing alone.
    intensity: PlainIntensity,
}

/// The points with an `intensity` alone.
#[derive(Clone, Copy, Debug, Default)]
enum PlainIntensity {
    /// There are none so far.
    #[default]
    Absent,
    /// Here is the first.
    First(Option<Span>),
    /// Some light cannot be one of Phong shading.
    Unlike,
}

impl DependentKeys {
    pub(super) fn record_material(&mut self, material: &PhongMaterial, ks: f64) {
        let samples = &material.glossy_samples;
        if samples.value.0 > 1 {
            self.glossy_samples = self.glossy_samples.or(samples.span);
        }
        if let FieldResult::Read(Spanned {
            span: Some(span), ..
        }) = material.specular_map
        {
            let (first, has_effect) = self.specular_map.unwrap_or((span, false));
            self.specular_map = Some((first, has_effect || ks > 0.0));
        }
    }

    /// Records a light with an `intensity`; a `plain` one is a point without other keys of path
    /// tracing.
    pub(super) fn record_intensity(&mut self, plain: bool, span: Option<Span>) {
        self.intensity = match (plain, self.intensity) {
            (false, _) | (_, PlainIntensity::Unlike) => PlainIntensity::Unlike,
            (true, PlainIntensity::Absent) => PlainIntensity::First(span),
            (true, first @ PlainIntensity::First(_)) => first,
        };
    }

    pub(super) fn record_shadow(&mut self, shadow: &Spanned<bool>) {
        if !shadow.value {
            self.shadow = self.shadow.or(shadow.span);
        }
    }
}

impl Lowering {
    /// Reports keys that have no effect because another setting is missing. Call it after all
    /// entities are lowered and the mode is resolved.
    pub(super) fn report_ineffective(&self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let is_path = matches!(self.scene.settings.mode, ir::Mode::Path(_));
        let is_uv = matches!(scene.mode.value, Mode::Uv | Mode::UvDown);
        let is_phong = self.scene.settings.mode == ir::Mode::Phong && !is_uv;
        if is_phong {
            self.report_materials(context);
            self.report_light_samples(scene, context);
            if let (Some(span), false) = (self.dependent.shadow, self.scene.settings.shadows) {
                let message = "`shadow: false` has no effect without `Shadows`";
                let hint = "`Shadows: true` turns shadows on";
                report(Some(span), message, hint, Severity::Note, context);
            }
        }
        if !is_path {
            report_lens(scene, context);
            if let FieldResult::Read(paths) = &scene.paths {
                let message = "`PathParameters` has no effect: the scene is not path traced";
                let hint = "`RenderMode: path` selects path tracing";
                report(paths.span, message, hint, Severity::Warning, context);
            }
        }
        self.report_intensity(scene, context);
        if is_path && scene.toon.value {
            let message = "`Toon` has no effect on path tracing";
            let hint = "`RenderMode: phong` has toon shading";
            report(scene.toon.span, message, hint, Severity::Warning, context);
        }
    }

    /// Reports that the `intensity` of a light alone makes the scene path traced, or that the light
    /// fades.
    fn report_intensity(&self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let PlainIntensity::First(Some(span)) = self.dependent.intensity else {
            return;
        };
        let is_other = |light: &ir::Light| {
            let ir::Light::Punctual(light) = light else {
                return false;
            };
            !matches!(light.emitter, ir::PunctualKind::Point { .. })
        };
        let is_expected = matches!(scene.mode.value, Mode::Path | Mode::Uv | Mode::UvDown);
        let is_asked_for = is_expected || !scene.paths.is_absent();
        if is_asked_for || self.is_physical(is_other) {
            return;
        }
        let message = match self.scene.settings.mode {
            ir::Mode::Path(_) => "a light with an `intensity` makes the scene path traced",
            ir::Mode::Phong | ir::Mode::Gooch(_) => "a light with an `intensity` fades",
            ir::Mode::Depth | ir::Mode::Normal => return,
        };
        let message = || message.to_owned();
        context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
            d.at(span, "in candela: it fades with the square of the distance")
                .hint(
                    "a light of Phong shading has a `color`, and does not fade; `RenderMode: path` \
                     says that path tracing is meant",
                )
        });
    }

    fn report_materials(&self, context: &mut DecodeContext<'_>) {
        let is_glossy =
            |phong: &ir::Phong| phong.glossy_samples > 1 && phong.most_mirror_weight() > 0.0;
        let has_bounces = self.scene.settings.max_depth > 0;
        let mut materials = self.scene.materials.iter().filter_map(ir::Material::phong);
        if !(has_bounces && materials.any(is_glossy)) {
            let message = "`glossySamples` has no effect without a mirror reflection";
            let hint = match has_bounces {
                true => "`kr`, or else `ks`, is the weight of the mirror reflection",
                false => "`MaxRecursionDepth: 1` shows mirror reflections",
            };
            let span = self.dependent.glossy_samples;
            report(span, message, hint, Severity::Warning, context);
        }
        if let Some((span, false)) = self.dependent.specular_map {
            let message = "`specularMap` has no effect with a `ks` of 0";
            let hint = "the map multiplies `ks`: write `ks: 1`";
            report(Some(span), message, hint, Severity::Warning, context);
        }
    }

    fn report_light_samples(&self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let mut points = self.scene.lights.iter().filter_map(ir::Light::point);
        let is_off = scene
            .soft_shadows
            .read()
            .is_some_and(|switch| !switch.value.0);
        if is_off || points.any(|light| light.radius > 0.0) {
            return;
        }
        if let Some(samples) = scene
            .light_samples
            .read()
            .filter(|samples| samples.value.0 > 1)
        {
            let message = "`LightSamples` has no effect without a light that has a `radius`";
            let hint = "a `radius` of a light makes its shadows soft";
            report(samples.span, message, hint, Severity::Warning, context);
        }
    }
}

/// Reports a lens without a radius, and a radius with a single sample.
fn report_lens(scene: &Scene, context: &mut DecodeContext<'_>) {
    let FieldResult::Read(camera) = &scene.camera else {
        return;
    };
    let (radius, samples) = (
        &camera.value.aperture_radius,
        &camera.value.aperture_samples,
    );
    if radius.value.0 == 0.0 && samples.value.0 > 1 {
        let severity = match radius.span {
            Some(_) => Severity::Note,
            None => Severity::Warning,
        };
        let message = "`apertureSamples` has no effect without an `apertureRadius` above 0";
        let hint = "`apertureRadius` is the radius of the lens in scene units";
        report(samples.span, message, hint, severity, context);
    }
    if radius.value.0 > 0.0 && samples.value.0 == 1 {
        let message = "`apertureRadius` has no effect with one sample of the lens";
        let hint = "`apertureSamples: 16` blurs objects out of focus";
        report(radius.span, message, hint, Severity::Warning, context);
    }
}

fn report(
    span: Option<Span>,
    message: &str,
    hint: &str,
    severity: Severity,
    context: &mut DecodeContext<'_>,
) {
    if let Some(span) = span {
        context.report(
            &codes::NO_EFFECT,
            span,
            || message.to_owned(),
            |d| d.at(span, "no effect").severity(severity).hint(hint),
        );
    }
}
