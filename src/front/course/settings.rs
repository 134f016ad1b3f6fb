//! The whole file, and of it the settings: what a pixel shows and how much work goes into it.

use super::camera::Camera;
use super::decode::{Context, Each, Spanned, Value};
use super::light::Light;
use super::lower::Lowering;
use super::number::{Count, Natural, Real, plain_number};
use super::object::Object;
use super::record::{Found, keys, record};
use super::schema::Definitions;
use super::tree::{NodeId, Shape};
use super::value::{Point, Text, word, word_schema};
use crate::diag::codes;
use crate::ir::{self, Field, Noun};
use serde_json::{Value as Json, json};

record! {
    /// A scene of the ray-tracing course.
    struct Scene, "scene" {
        /// Where an editor finds the schema of this file; has no other meaning.
        _schema: Spanned<Text>, optional, keys!["$schema"];
        /// The camera of old files: it looks at the square from (0, 0, 0) to (400, 400, 0). Newer files have `Camera`.
        eye: Spanned<Point>, optional, keys!["Eye"];
        /// The camera: where it stands, what it looks at, and the image it makes.
        camera: Spanned<Camera>, optional, keys!["Camera"];
        /// What a pixel shows: `phong` the lit surface, `zbuffer` its distance, `normal` its direction, `gooch` a drawing.
        mode: Spanned<Mode>, default(Mode::Phong), keys!["RenderMode" "renderMode" "rendermode"];
        /// Whether surfaces hide lights from each other.
        shadows: Spanned<bool>, default(false), keys!["Shadows" "shadows" "shadow"];
        /// How many mirror or refraction bounces follow the first hit.
        depth: Spanned<Natural>, default(Natural(0)), keys!["MaxRecursionDepth" "MaxIterations"];
        /// How many rays a pixel takes along each of its sides.
        sampling: Spanned<SuperSampling>, default(SuperSampling(Count(1))),
            keys!["SuperSampling" "SuperSamplingFactor" "SuperSamplingRate" "AntiAlias"];
        /// The colours of `RenderMode: gooch`.
        gooch: Spanned<Gooch>, optional, keys!["GoochParameters"];
        /// The lights.
        lights: Spanned<Each<Light>>, default(Each::<Light>::none()), keys!["Lights"];
        /// What there is to see.
        objects: Spanned<Each<Object>>, default(Each::<Object>::none()), keys!["Objects"];
    }
    forms { [camera] [eye] }
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

const GOOCH: ir::Gooch = ir::Gooch { b: 0.55, y: 0.3, alpha: 0.25, beta: 0.5 };

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    Phong,
    Zbuffer,
    Normal,
    Gooch,
}

/// The words for the modes.
const MODES: &[(&str, Mode)] = &[
    ("phong", Mode::Phong),
    ("zbuffer", Mode::Zbuffer),
    ("z-buffer", Mode::Zbuffer),
    ("normal", Mode::Normal),
    ("gooch", Mode::Gooch),
];

/// The modes as some files number them.
const NUMBERED: &[(u8, Mode)] = &[(0, Mode::Phong), (1, Mode::Normal), (2, Mode::Zbuffer), (4, Mode::Gooch)];

impl Value for Mode {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let given = plain_number(node, context);
        let numbered = NUMBERED.iter().find(|(number, _)| given == Some(f64::from(*number)));
        numbered.map(|(_, mode)| *mode).or_else(|| word(node, MODES, context))
    }

    fn schema(_: &mut Definitions) -> Json {
        let numbers: Vec<_> =
            NUMBERED.iter().map(|(number, _)| json!({ "const": number, "deprecated": true })).collect();
        let mut schema = word_schema(MODES);
        schema["anyOf"].as_array_mut().into_iter().for_each(|forms| forms.extend(numbers.clone()));
        schema
    }

    fn json(&self) -> Json {
        MODES.iter().find(|(_, mode)| mode == self).map_or(Json::Null, |(word, _)| json!(word))
    }
}

record! {
    /// How many rays a pixel takes.
    struct Grid, "`SuperSampling` map" {
        /// How many rays a pixel takes along each of its sides.
        factor: Spanned<Count>, required, keys!["factor"];
    }
}

/// The number of rays along the side of a pixel, as a map or bare.
#[derive(Clone, Copy, Debug)]
pub(super) struct SuperSampling(Count);

impl Value for SuperSampling {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            Shape::Map => Grid::decode(node, context).map(|grid| Self(grid.factor.value)),
            Shape::Word(_) | Shape::Text(_) | Shape::List => Count::decode(node, context).map(Self),
        }
    }

    fn schema(definitions: &mut Definitions) -> Json {
        json!({ "anyOf": [Count::schema(definitions), Grid::schema(definitions)] })
    }

    fn json(&self) -> Json {
        self.0.json()
    }
}

impl Lowering {
    /// Lowers the settings of the file.
    pub(super) fn settings(&mut self, scene: &Scene, context: &mut Context<'_>) {
        let Scene { mode, shadows, depth, sampling, gooch, .. } = scene;
        self.scene.settings = ir::Settings {
            mode: self.mode(mode.value, gooch, context),
            shadows: shadows.value,
            max_depth: depth.value.0,
            supersampling: sampling.value.0.0,
            pattern: ir::Pattern::Grid,
            light_samples: 1,
        };
        self.origin(Noun::Settings, 0, Field::Mode, mode.span);
        self.origin(Noun::Settings, 0, Field::MaxDepth, depth.span);
        self.origin(Noun::Settings, 0, Field::Supersampling, sampling.span);
    }

    fn mode(&mut self, mode: Mode, gooch: &Found<Spanned<Gooch>>, context: &mut Context<'_>) -> ir::Mode {
        let given = if let Found::Read(gooch) = gooch { Some(gooch) } else { None };
        if let (true, Some(span)) = (mode != Mode::Gooch, given.and_then(|gooch| gooch.span)) {
            let message = || "`GoochParameters` has no effect on this `RenderMode`".to_owned();
            context.report(&codes::NO_EFFECT, span, message, |d| d.at(span, "only for `RenderMode: gooch`"));
        }
        match mode {
            Mode::Phong => ir::Mode::Phong,
            Mode::Zbuffer => ir::Mode::Zbuffer,
            Mode::Normal => ir::Mode::Normal,
            Mode::Gooch => ir::Mode::Gooch(given.map_or(GOOCH, |gooch| self.gooch(&gooch.value))),
        }
    }

    fn gooch(&mut self, gooch: &Gooch) -> ir::Gooch {
        let Gooch { b, y, alpha, beta } = gooch;
        self.origin(Noun::Settings, 0, Field::GoochB, b.span);
        self.origin(Noun::Settings, 0, Field::GoochY, y.span);
        self.origin(Noun::Settings, 0, Field::GoochAlpha, alpha.span);
        self.origin(Noun::Settings, 0, Field::GoochBeta, beta.span);
        ir::Gooch { b: b.value.0, y: y.value.0, alpha: alpha.value.0, beta: beta.value.0 }
    }
}
