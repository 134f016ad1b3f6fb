//! The whole file, and of it the settings: what a pixel shows and how much work goes into it.

use super::camera::Camera;
use super::decode::{Context, LazyList, Spanned, Value};
use super::environment::Environment;
use super::keyword::{keyword, keyword_schema};
use super::light::Light;
use super::lower::Lowering;
use super::number::{Count, Natural, Real, Stops, plain_number};
use super::object::Object;
use super::path_settings::Paths;
use super::record::{FieldOutcome, keys, record};
use super::sampling::SuperSampling;
use super::schema::Definitions;
use super::value::{AnyScalar, Point, Switch};
use super::view_size::ViewSize;
use rtc_color::Tone;
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityKind, Field};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A scene of the ray-tracing course.
    struct Scene, "scene" {
        /// Where an editor finds the schema of this file; has no other meaning.
        _schema: Spanned<AnyScalar>, optional, keys!["$schema"];
        /// The camera of old files: it looks at the square from (0, 0, 0) to (400, 400, 0). Newer files have `Camera`.
        eye: Spanned<Point>, optional, keys!["Eye"], json "Eye";
        /// The camera: where it stands, what it looks at, and the image it makes.
        camera: Spanned<Camera>, optional, keys!["Camera"];
        /// The camera as three keys: where it stands, what it looks at, and the upward direction, whose length is the size of
        /// a pixel; the image has 400 × 400 pixels. Better written as a `Camera`.
        look: [Spanned<Point>; 3], optional, &[&["CameraEye", "CameraLookPoint", "CameraUpVector"]];
        /// What a pixel shows: `phong` the lit surface, `path` the light along all paths (the default with a light in
        /// physical units, an `Environment`, a glTF asset or a `standard` material), `zbuffer` its distance, `normal` its direction, `gooch` a drawing, `texture` its
        /// texture coordinates as the colours (u, 0, v).
        mode: Spanned<Mode>, default(Mode::Phong), keys!["RenderMode" "renderMode" "rendermode"];
        /// Whether surfaces hide lights from each other.
        shadows: Spanned<bool>, default(false), keys!["Shadows" "shadows" "shadow"], json "Shadows";
        /// Whether lights with a radius make the edges of shadows soft: `Off` makes points of them. There are shadows only
        /// with `Shadows`.
        soft_shadows: Spanned<Switch>, optional, keys!["SoftShadows"];
        /// How many mirror or refraction bounces follow the first hit.
        depth: Spanned<Natural>, default(Natural(0)), keys!["MaxRecursionDepth" "MaxIterations"],
            json "MaxRecursionDepth";
        /// Whether there are mirror images: `false` is a `MaxRecursionDepth` of 0, `true` one of 2 unless it is written.
        reflections: Spanned<bool>, optional, keys!["Reflections"];
        /// How many rays a pixel takes along each of its sides.
        sampling: Spanned<SuperSampling>, default(SuperSampling::ONE),
            keys!["SuperSampling" "SuperSamplingFactor" "SuperSamplingRate" "AntiAliasing" "AntiAlias" "AA"],
            json "SuperSamplingFactor", json "AntiAliasing";
        /// Width and height of the picture in pixels, beside an `Eye` or the three keys of a camera: the image begins at the
        /// origin and has one unit a pixel. A `Camera` has its own size.
        image_size: Spanned<ViewSize>, optional, keys!["ImageSize" "Resolution"], json "ImageSize";
        /// Width over height of the picture; has no effect, because pixels are square and the size is given.
        aspect_ratio: Spanned<Real>, optional, keys!["AspectRatio"];
        /// How many points of each soft light are asked; without it 16 if there is one.
        light_samples: Spanned<Count>, optional, keys!["LightSamples"];
        /// Whether `phong` shows a cartoon: N·L in the steps 0, 0.25, 0.3 and 1, highlights whole where R·V is at least 0.9,
        /// dark outlines; on what is seen directly.
        toon: Spanned<bool>, default(false), keys!["Toon"], json "Toon";
        /// How often the ambient term of `phong` is added: `perLight` for each light, times its
        /// colour, `once` whatever lights there are. Without it `once` in a scene that is JSON,
        /// `perLight` in YAML.
        ambient: Spanned<ir::Ambient>, optional, keys!["Ambient"], json "Ambient";
        /// The colours of `RenderMode: gooch`.
        gooch: Spanned<Gooch>, optional, keys!["GoochParameters"];
        /// How the light along all paths is followed.
        paths: Spanned<Paths>, optional, keys!["PathParameters"];
        /// How a PNG shows linear values: `none` as they are, `srgb` cut off at 1 and coded by sRGB, `agx` AgX,
        /// `pbr-neutral` the PBR Neutral of Khronos; without it `srgb` where paths are traced, else `none`. An EXR holds
        /// them as they are.
        tone: Spanned<Tone>, optional, keys!["ToneMap"];
        /// The exposure of a PNG in stops: each doubles the values before the tone map.
        exposure: Spanned<Stops>, default(Stops(0.0)), keys!["Exposure"];
        /// What surrounds the scene.
        environment: Spanned<Environment>, optional, keys!["Environment"];
        /// The lights.
        lights: Spanned<LazyList<Light>>, default(LazyList::<Light>::none()), keys!["Lights"], json "Lights";
        /// What there is to see.
        objects: Spanned<LazyList<Object>>, default(LazyList::<Object>::none()), keys!["Objects"], json "Objects";
    }
    lowered_variants { [camera] [eye] [look] }
}

record! {
    /// The colours of Gooch shading, from cool to warm.
    struct Gooch, "Gooch parameters" {
        /// The blue of the cool colour.
        b: Spanned<Real>, default(Real(GOOCH.b)), keys!["b"];
        /// The yellow of the warm colour.
        y: Spanned<Real>, default(Real(GOOCH.y)), keys!["y"];
        /// How much of the surface's colour the cool tone takes.
        alpha: Spanned<Real>, default(Real(GOOCH.alpha)), keys!["alpha"];
        /// How much of the surface's colour the warm tone takes.
        beta: Spanned<Real>, default(Real(GOOCH.beta)), keys!["beta"];
    }
}

const GOOCH: ir::Gooch = ir::Gooch {
    b: 0.55,
    y: 0.3,
    alpha: 0.25,
    beta: 0.5,
};

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    Phong,
    Zbuffer,
    Normal,
    Gooch,
    Path,
    Uv,
}

/// The words for the modes.
const MODES: &[(&str, Mode)] = &[
    ("phong", Mode::Phong),
    ("zbuffer", Mode::Zbuffer),
    ("z-buffer", Mode::Zbuffer),
    ("normal", Mode::Normal),
    ("gooch", Mode::Gooch),
    ("path", Mode::Path),
    ("texture", Mode::Uv),
    ("textureCoordinate", Mode::Uv),
];

/// The modes as some files number them.
const NUMBERED: &[(u8, Mode)] = &[
    (0, Mode::Phong),
    (1, Mode::Zbuffer),
    (2, Mode::Normal),
    (4, Mode::Gooch),
];

impl Value for Mode {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let given = plain_number(node, context);
        let numbered = NUMBERED
            .iter()
            .find(|(number, _)| given == Some(f64::from(*number)));
        numbered
            .map(|(_, mode)| *mode)
            .or_else(|| keyword(node, MODES, context))
    }

    fn schema(_: &mut Definitions) -> Json {
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
            .find(|(_, mode)| mode == self)
            .map_or(Json::Null, |(keyword, _)| json!(keyword))
    }
}

/// The bounces of `Reflections: true` where the file does not say how many.
const DEFAULT_REFLECTIONS: u32 = 2;

/// The points asked of each soft light where the file does not say how many.
const SOFT_LIGHT_SAMPLES: u32 = 16;

impl Lowering {
    /// Lowers the settings of the file.
    pub(super) fn settings(&mut self, scene: &Scene, context: &mut Context<'_>) {
        let Scene {
            mode,
            shadows,
            depth,
            sampling,
            gooch,
            light_samples,
            ..
        } = scene;
        let light_samples = light_samples.ok().unwrap_or(Spanned::unwritten(Count(1)));
        report_unused(scene, context);
        self.display(scene);
        self.scene.settings = ir::Settings {
            mode: self.mode(mode.value, gooch, context),
            shadows: shadows.value,
            max_depth: max_depth(scene, context),
            supersampling: sampling.value.factor.0,
            pattern: sampling.value.pattern,
            light_samples: light_samples.value.0,
            toon: scene.toon.value,
            ambient: ir::Ambient::PerLight,
        };
        self.origin(EntityKind::Settings, 0, Field::Mode, mode.span);
        self.origin(EntityKind::Settings, 0, Field::MaxDepth, depth.span);
        let factor = sampling.value.factor_span.or(sampling.span);
        self.origin(EntityKind::Settings, 0, Field::Supersampling, factor);
        self.origin(
            EntityKind::Settings,
            0,
            Field::LightSamples,
            light_samples.span,
        );
    }

    /// Makes points of soft lights if the file says so, and else asks enough points of each, unless
    /// the file says how many; after the lights.
    pub(super) fn resolve_soft_lights(&mut self, scene: &Scene, context: &mut Context<'_>) {
        let points = || self.scene.lights.iter().filter_map(ir::Light::point);
        let soft = points().any(|light| light.radius > 0.0);
        if let FieldOutcome::Read(switch) = &scene.soft_shadows {
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

    /// Makes points of soft lights; a negative radius is left for the proof to refuse.
    fn remove_light_radii(&mut self) {
        for light in &mut self.scene.lights {
            if let ir::Light::Point(light) = light {
                light.radius = light.radius.min(0.0);
            }
        }
    }

    /// Shows the texture coordinates of all surfaces if the file says so: their colour by one light
    /// of ambient light alone; after the lights and the objects.
    pub(super) fn show_uv(&mut self, scene: &Scene) {
        if scene.mode.value != Mode::Uv {
            return;
        }
        let color_map = Some(self.files.uv(&mut self.scene));
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
        gooch: &FieldOutcome<Spanned<Gooch>>,
        context: &mut Context<'_>,
    ) -> ir::Mode {
        let given = if let FieldOutcome::Read(gooch) = gooch {
            Some(gooch)
        } else {
            None
        };
        if let (true, Some(span)) = (mode != Mode::Gooch, given.and_then(|gooch| gooch.span)) {
            let message = || "`GoochParameters` has no effect on this `RenderMode`".to_owned();
            context.report(&codes::NO_EFFECT, span, message, |d| {
                d.at(span, "only for `RenderMode: gooch`")
            });
        }
        match mode {
            Mode::Phong | Mode::Uv => ir::Mode::Phong,
            Mode::Zbuffer => ir::Mode::Zbuffer,
            Mode::Normal => ir::Mode::Normal,
            Mode::Path => ir::Mode::Path(ir::PathSettings::default()),
            Mode::Gooch => ir::Mode::Gooch(given.map_or(GOOCH, |gooch| self.gooch(&gooch.value))),
        }
    }

    fn gooch(&mut self, gooch: &Gooch) -> ir::Gooch {
        let Gooch { b, y, alpha, beta } = gooch;
        self.origin(EntityKind::Settings, 0, Field::GoochB, b.span);
        self.origin(EntityKind::Settings, 0, Field::GoochY, y.span);
        self.origin(EntityKind::Settings, 0, Field::GoochAlpha, alpha.span);
        self.origin(EntityKind::Settings, 0, Field::GoochBeta, beta.span);
        ir::Gooch {
            b: b.value.0,
            y: y.value.0,
            alpha: alpha.value.0,
            beta: beta.value.0,
        }
    }
}

/// Says which settings do nothing in modes that show the first surface alone.
fn report_unused(scene: &Scene, context: &mut Context<'_>) {
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
        Mode::Zbuffer | Mode::Normal | Mode::Gooch | Mode::Uv => {}
    }
    if let (Mode::Gooch, true, Some(span)) = (mode.value, shadows.value, shadows.span) {
        let message = || "`gooch` casts no shadows here".to_owned();
        context.report(&codes::TWO_READINGS, span, message, |d| {
            d.at(span, "in some programs a shadow takes the highlight away")
                .also(mode.span, "the mode")
                .hint("`RenderMode: phong` has shadows; `Shadows: false` says that none are meant")
        });
    }
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
            rays > 1 && mode.value == Mode::Zbuffer,
            sampling.span,
            "supersampling",
        ),
    ] {
        if let (true, Some(span)) = (is_set, span) {
            let message = || format!("this `RenderMode` has no {what}");
            context.report(&codes::NO_EFFECT, span, message, |d| {
                d.at(span, "no effect").also(mode.span, "the mode")
            });
        }
    }
}

/// Says that a switch for soft shadows casts none by itself.
fn report_missing_shadows(
    switch: &Spanned<Switch>,
    shadows: &Spanned<bool>,
    context: &mut Context<'_>,
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

/// The bounces, which some files only turn on or off.
fn max_depth(scene: &Scene, context: &mut Context<'_>) -> u32 {
    let Scene {
        depth, reflections, ..
    } = scene;
    let FieldOutcome::Read(Spanned {
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
