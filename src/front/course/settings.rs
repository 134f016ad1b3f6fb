//! The top-level map of the file, and the settings in it.

use super::camera::Camera;
use super::decode::{Decode, DecodeContext, LazyList, Spanned};
use super::environment::Environment;
use super::keyword::{KeywordTable, keyword, keyword_schema};
use super::light::Light;
use super::lower::Lowering;
use super::medium::MediumCoefficients;
use super::number::{Count, Natural, NonNegative, Real, Stops, plain_number};
use super::object::Object;
use super::path_settings::PathParameters;
use super::record::{FieldResult, record};
use super::sampling::SuperSampling;
use super::schema::SchemaDefinitions;
use super::texture::add_uv_down;
use super::value::{AnyScalar, Color, Point, Switch};
use super::view_size::ViewSize;
use rtc_color::Tone;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityField, EntityKind};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A scene of the ray-tracing course.
    struct Scene, "scene" {
        /// The schema of this file for editors; ignored.
        _schema: Spanned<AnyScalar>, optional, &[&["$schema"]], own true;
        /// The camera of old files: it looks at the square from (0, 0, 0) to (400, 400, 0). Newer
        /// files have `Camera`.
        eye: Spanned<Point>, optional, &[&["Eye"]], json "Eye";
        /// The camera: its position, its target, and its image.
        camera: Spanned<Camera>, optional, &[&["Camera"]];
        /// The camera as three keys: its position, its target, and the up vector, whose length is
        /// the size of a pixel; the image has 400 × 400 pixels. Better written as a `Camera`.
        look: [Spanned<Point>; 3], optional, &[&["CameraEye", "CameraLookPoint", "CameraUpVector"]];
        /// The render mode: `phong`, Phong shading; `path`, path tracing (the default with a light
        /// in physical units, an `Environment`, a glTF asset or a `standard` material); `zbuffer`,
        /// distances; `normal`, normals; `gooch`, Gooch shading; `texture`, texture coordinates as
        /// the colours (u, 0, v); `texcoords`, in small letters, as (u, 1 − v, 0).
        mode: Spanned<Mode>, default(Mode::Phong),
            &[&["RenderMode"], &["renderMode"], &["rendermode"]];
        /// Whether surfaces cast shadows.
        shadows: Spanned<bool>, default(false),
            &[&["Shadows"], &["shadows"], &["shadow"]], json "Shadows";
        /// Whether lights with a radius cast soft shadows; `Off` sets their radius to 0. Only with
        /// `Shadows` there are shadows.
        soft_shadows: Spanned<Switch>, optional, &[&["SoftShadows"]], own true;
        /// The maximal number of reflections or refractions after the first hit.
        depth: Spanned<Natural>, default(Natural(0)), &[&["MaxRecursionDepth"], &["MaxIterations"]],
            json "MaxRecursionDepth";
        /// Whether there are mirror reflections: `false` is a `MaxRecursionDepth` of 0, `true` one
        /// of 2 unless it is given.
        reflections: Spanned<bool>, optional, &[&["Reflections"]], own true;
        /// The number of rays along each side of a pixel.
        sampling: Spanned<SuperSampling>, default(SuperSampling::ONE),
            &[&["SuperSampling"], &["SuperSamplingFactor"], &["SuperSamplingRate"],
                &["AntiAliasing"], &["AntiAlias"], &["AA"]],
            json "SuperSamplingFactor", json "AntiAliasing";
        /// Width and height of the image in pixels, beside an `Eye` or the three keys of a camera:
        /// the image begins at the origin and has pixels of size 1. Beside an `Eye` a `Resolution`
        /// keeps the width of 400 units instead. A `Camera` has its own size.
        image_size: Spanned<ViewSize>, optional,
            &[&["ImageSize"], &["Resolution"]], json "ImageSize";
        /// Width over height of the image; has no effect, because pixels are square and the size is
        /// given.
        aspect_ratio: Spanned<Real>, optional, &[&["AspectRatio"]], own true;
        /// The number of samples of each light with a radius; 16 by default.
        light_samples: Spanned<Count>, optional, &[&["LightSamples"]], own true;
        /// Whether `phong` uses toon shading: N·L in the steps 0, 0.25, 0.3 and 1, full highlights
        /// where R·V is at least 0.9, dark outlines; only for directly visible surfaces.
        toon: Spanned<bool>, default(false), &[&["Toon"]], json "Toon";
        /// How often the ambient term of `phong` is added: `perLight` for each light, times its
        /// colour; `once`, independent of the lights. The default is `once` for a JSON scene and
        /// `perLight` for YAML.
        ambient: Spanned<ir::Ambient>, optional, &[&["Ambient"]], json "Ambient", own true;
        /// The colour of the ambient light of `phong`: with it the ambient term is added once,
        /// times this colour.
        ambient_light: Spanned<Color>, optional, &[&["AmbientLight"]], own true;
        /// The colour where the camera sees nothing, in the values of the picture file; black or
        /// the environment by default. Mirrors don't show it.
        background: Spanned<Color>, optional, &[&["Background"], &["BackgroundColor"]], own true;
        /// The colours of `RenderMode: gooch`.
        gooch: Spanned<Gooch>, optional, &[&["GoochParameters"]];
        /// The settings of path tracing.
        paths: Spanned<PathParameters>, optional, &[&["PathParameters"]], own true;
        /// The tone map of a PNG: `none`, linear values; `srgb`, clamped to 1 and sRGB-encoded;
        /// `agx`, AgX; `pbr-neutral`, Khronos PBR Neutral. The default is `srgb` for path tracing,
        /// else `none`. An EXR has linear values.
        tone: Spanned<Tone>, optional, &[&["ToneMap"]], own true;
        /// The exposure of a PNG in stops: each stop doubles the values before the tone map.
        exposure: Spanned<Stops>, default(Stops(0.0)), &[&["Exposure"]], own true;
        /// The environment light.
        environment: Spanned<Environment>, optional, &[&["Environment"]], own true;
        /// The participating medium around the camera, for instance fog. A scene with a medium is
        /// rendered by path tracing. A medium inside an object is the `interior` of its `standard`
        /// material.
        medium: Spanned<MediumCoefficients>, optional, &[&["Medium"], &["medium"]], own true;
        /// The lights.
        lights: Spanned<LazyList<Light>>, default(LazyList::<Light>::none()),
            &[&["Lights"]], json "Lights";
        /// The objects.
        objects: Spanned<LazyList<Object>>, default(LazyList::<Object>::none()),
            &[&["Objects"]], json "Objects";
    }
    lowered_variants { [camera] [eye] [look] }
}

record! {
    /// The colours of Gooch shading, from cool to warm.
    struct Gooch, "Gooch parameters" {
        /// The blue of the cool colour.
        b: Spanned<Real>, default(Real(GOOCH.b)), &[&["b"]];
        /// The yellow of the warm colour.
        y: Spanned<Real>, default(Real(GOOCH.y)), &[&["y"]];
        /// The fraction of the surface's colour in the cool colour.
        alpha: Spanned<Real>, default(Real(GOOCH.alpha)), &[&["alpha"]];
        /// The fraction of the surface's colour in the warm colour.
        beta: Spanned<Real>, default(Real(GOOCH.beta)), &[&["beta"]];
    }
}

const GOOCH: ir::Gooch = ir::Gooch {
    b: 0.55,
    y: 0.3,
    alpha: 0.25,
    beta: 0.5,
};

/// The render modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    Phong,
    Depth,
    Normal,
    Gooch,
    Path,
    Uv,
    /// Texture coordinates as the colours (u, 1 − v, 0).
    UvDown,
}

/// The keywords of the render modes.
const MODES: KeywordTable<Mode> = &[
    (
        "phong",
        Mode::Phong,
        "Phong shading, with shadows, mirror images and glass by rays.",
    ),
    ("zbuffer", Mode::Depth, "Distances: what is near is bright."),
    ("z-buffer", Mode::Depth, ""),
    ("normal", Mode::Normal, "Normals as colours."),
    (
        "gooch",
        Mode::Gooch,
        "Gooch shading, from cool to warm colours.",
    ),
    (
        "path",
        Mode::Path,
        "Path tracing: light that is reflected on and on, in physical units.",
    ),
    (
        "texture",
        Mode::Uv,
        "Texture coordinates as the colours (u, 0, v).",
    ),
    ("textureCoordinate", Mode::Uv, ""),
    ("texCoords", Mode::Uv, ""),
    ("texcoords", Mode::UvDown, ""),
];

/// The numbers of render modes in some files.
const NUMBERED: &[(u8, Mode)] = &[
    (0, Mode::Phong),
    (1, Mode::Depth),
    (2, Mode::Normal),
    (4, Mode::Gooch),
];

impl Decode for Mode {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        let parameters = plain_number(node, context);
        let numbered = NUMBERED
            .iter()
            .find(|(number, _)| parameters == Some(f64::from(*number)));
        numbered
            .map(|(_, mode)| *mode)
            .or_else(|| keyword(node, MODES, context))
    }

    fn schema(_: &mut SchemaDefinitions) -> Json {
        let numbers: Vec<_> = NUMBERED
            .iter()
            .map(|(number, _)| json!({ "const": number, "deprecated": true }))
            .collect();
        let mut schema = keyword_schema(MODES);
        schema["anyOf"]
            .as_array_mut()
            .into_iter()
            .for_each(|variants| variants.extend(numbers.clone()));
        schema
    }

    fn json(&self) -> Json {
        MODES
            .iter()
            .find(|(_, mode, _)| mode == self)
            .map_or(Json::Null, |(keyword, ..)| json!(keyword))
    }
}

/// The recursion depth of `Reflections: true`.
const DEFAULT_REFLECTIONS: u32 = 2;

/// The default number of samples of a light with a radius.
const SOFT_LIGHT_SAMPLES: u32 = 16;

impl Lowering {
    /// Lowers the settings of the file.
    pub(super) fn settings(&mut self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let Scene {
            mode,
            shadows,
            depth,
            sampling,
            gooch,
            light_samples,
            ..
        } = scene;
        let light_samples = light_samples
            .ok()
            .unwrap_or(Spanned::without_span(Count(1)));
        // Report what has no effect, and lower the settings.
        report_unused(scene, context);
        let one_eye = Spanned::without_span(NonNegative(0.0));
        let camera = scene.camera.read().map(|camera| &camera.value);
        let stereo = camera.map_or(one_eye, |camera| camera.stereo);
        let stereo_view = camera.map(|camera| camera.stereo_view.value);
        let shutter = camera.map(|camera| camera.shutter);
        self.display(scene);
        self.scene.settings = ir::Settings {
            mode: self.mode(mode.value, gooch, context),
            shadows: shadows.value,
            max_depth: max_depth(scene, context),
            supersampling: sampling.value.factor.0,
            pattern: sampling.value.pattern,
            light_samples: light_samples.value.0,
            toon: scene.toon.value,
            stereo: stereo.value.0,
            stereo_view: stereo_view.unwrap_or_default(),
            shutter: shutter.map_or(ir::Settings::default().shutter, |shutter| shutter.value.0),
            background: scene.background.read().map(|color| color.value.0),
            ..ir::Settings::default()
        };
        // Record the origin of each value.
        self.record_span(EntityKind::Settings, 0, EntityField::Mode, mode.span);
        self.record_span(EntityKind::Settings, 0, EntityField::Stereo, stereo.span);
        let shutter = shutter.and_then(|shutter| shutter.span);
        self.record_span(EntityKind::Settings, 0, EntityField::Shutter, shutter);
        let background = scene.background.read().and_then(|color| color.span);
        self.record_span(EntityKind::Settings, 0, EntityField::Background, background);
        self.record_span(EntityKind::Settings, 0, EntityField::MaxDepth, depth.span);
        let factor = sampling.value.factor_span.or(sampling.span);
        self.record_span(EntityKind::Settings, 0, EntityField::Supersampling, factor);
        self.record_span(
            EntityKind::Settings,
            0,
            EntityField::LightSamples,
            light_samples.span,
        );
    }

    /// Applies `SoftShadows`, and sets the default number of light samples if there are soft
    /// lights. Call it after the lights are lowered.
    pub(super) fn resolve_soft_lights(&mut self, scene: &Scene, context: &mut DecodeContext<'_>) {
        let points = || self.scene.lights.iter().filter_map(ir::Light::point);
        let soft = points().any(|light| light.radius > 0.0);
        if let FieldResult::Read(switch) = &scene.soft_shadows {
            report_missing_shadows(switch, &scene.shadows, context);
            if !switch.value.0 {
                self.remove_light_radii();
                return;
            }
        }
        if soft && scene.light_samples.is_absent() {
            self.scene.settings.light_samples = SOFT_LIGHT_SAMPLES;
        }
    }

    /// Sets the radius of all lights to 0. The validator rejects a negative radius.
    fn remove_light_radii(&mut self) {
        for light in &mut self.scene.lights {
            if let ir::Light::Point(light) = light {
                light.radius = light.radius.min(0.0);
            }
        }
    }

    /// Applies `RenderMode: texture` and `texcoords`: the texture coordinates become the ambient
    /// colour of all surfaces, under a single white light. Call it after the lights and the objects
    /// are lowered.
    pub(super) fn show_uv(&mut self, scene: &Scene) {
        let color_map = Some(match scene.mode.value {
            Mode::Uv => self.files.uv(&mut self.scene),
            Mode::UvDown => add_uv_down(&mut self.scene),
            Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch | Mode::Path => return,
        });
        for material in &mut self.scene.materials {
            *material = ir::Material::Phong(ir::Phong {
                ka: 1.0,
                kd: 0.0,
                color_map,
                ..ir::Phong::MATT
            });
        }
        let position = self.scene.camera.eye;
        self.scene.lights = vec![ir::Light::Point(ir::PointLight {
            position,
            color: [1.0; 3],
            radius: 0.0,
        })];
        let settings = &mut self.scene.settings;
        (settings.shadows, settings.toon, settings.max_depth) = (false, false, 0);
        settings.ambient = ir::Ambient::PerLight;
    }

    fn mode(
        &mut self,
        mode: Mode,
        gooch: &FieldResult<Spanned<Gooch>>,
        context: &mut DecodeContext<'_>,
    ) -> ir::Mode {
        let parameters = if let FieldResult::Read(gooch) = gooch {
            Some(gooch)
        } else {
            None
        };
        if let (true, Some(span)) = (mode != Mode::Gooch, parameters.and_then(|gooch| gooch.span)) {
            let message = || "`GoochParameters` has no effect on the `RenderMode`".to_owned();
            context.report(&codes::NO_EFFECT, span, message, |d| {
                d.at(span, "only for `RenderMode: gooch`")
            });
        }
        match mode {
            Mode::Phong | Mode::Uv | Mode::UvDown => ir::Mode::Phong,
            Mode::Depth => ir::Mode::Depth,
            Mode::Normal => ir::Mode::Normal,
            Mode::Path => ir::Mode::Path(ir::PathSettings::default()),
            Mode::Gooch => {
                ir::Mode::Gooch(parameters.map_or(GOOCH, |gooch| self.gooch(&gooch.value)))
            }
        }
    }

    fn gooch(&mut self, gooch: &Gooch) -> ir::Gooch {
        let Gooch { b, y, alpha, beta } = gooch;
        self.record_span(EntityKind::Settings, 0, EntityField::GoochB, b.span);
        self.record_span(EntityKind::Settings, 0, EntityField::GoochY, y.span);
        self.record_span(EntityKind::Settings, 0, EntityField::GoochAlpha, alpha.span);
        self.record_span(EntityKind::Settings, 0, EntityField::GoochBeta, beta.span);
        ir::Gooch {
            b: b.value.0,
            y: y.value.0,
            alpha: alpha.value.0,
            beta: beta.value.0,
        }
    }
}

/// Reports settings without effect in render modes that show only the first hit.
fn report_unused(scene: &Scene, context: &mut DecodeContext<'_>) {
    let Scene {
        mode,
        shadows,
        depth,
        reflections,
        sampling,
        ..
    } = scene;
    match mode.value {
        Mode::Phong | Mode::Path => return,
        Mode::Depth | Mode::Normal | Mode::Gooch | Mode::Uv | Mode::UvDown => {}
    }
    // Gooch shading: programs differ about shadows.
    if let (Mode::Gooch, true, Some(span)) = (mode.value, shadows.value, shadows.span) {
        let message = || "`gooch` casts no shadows here".to_owned();
        context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
            d.at(span, "in some programs a shadow removes the highlight")
                .also(mode.span, "the mode")
                .hint("`RenderMode: phong` has shadows; `Shadows: false` turns them off")
        });
    }
    // The other settings.
    let reflections = reflections.ok();
    let rays = sampling.value.factor.0;
    for (is_set, span, what) in [
        (
            shadows.value && mode.value != Mode::Gooch,
            shadows.span,
            "shadows",
        ),
        (scene.toon.value, scene.toon.span, "cartoon"),
        (depth.value.0 > 0, depth.span, "mirror images"),
        (
            reflections.is_some_and(|value| value.value),
            reflections.and_then(|value| value.span),
            "mirror images",
        ),
        (
            rays > 1 && mode.value == Mode::Depth,
            sampling.span,
            "supersampling",
        ),
    ] {
        if let (true, Some(span)) = (is_set, span) {
            let message = || format!("the `RenderMode` has no {what}");
            context.report(&codes::NO_EFFECT, span, message, |d| {
                d.at(span, "no effect").also(mode.span, "the mode")
            });
        }
    }
}

/// Reports `SoftShadows` without `Shadows`.
fn report_missing_shadows(
    switch: &Spanned<Switch>,
    shadows: &Spanned<bool>,
    context: &mut DecodeContext<'_>,
) {
    if let (Some(span), None) = (switch.span, shadows.span) {
        let message = || "`SoftShadows` without `Shadows` casts no shadows".to_owned();
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "no effect")
                .severity(Severity::Warning)
                .hint("some programs cast shadows always; `Shadows: true` does so here")
        });
    }
}

/// The maximal recursion depth, which some files only switch on or off.
fn max_depth(scene: &Scene, context: &mut DecodeContext<'_>) -> u32 {
    let Scene {
        depth, reflections, ..
    } = scene;
    let FieldResult::Read(Spanned {
        value: reflect,
        span: Some(span),
    }) = reflections
    else {
        return depth.value.0;
    };
    context.record_spelling("Reflections", "MaxRecursionDepth", *span);
    match (reflect, depth.span) {
        (true, Some(_)) => depth.value.0,
        (true, None) => DEFAULT_REFLECTIONS,
        (false, _) => 0,
    }
}
