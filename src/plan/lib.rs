//! The work that the picture of a scene needs: a verdict with its reason for each effect, and the
//! remaining work.
//!
//! A plan changes no bit of the picture. A rule leaves out only what it proves to add exactly
//! nothing: a term with a factor of 0 whose other factors are finite (validation bounds every
//! number by 1e60, so each local term is), a ray that can meet nothing, a sample that equals its
//! neighbour. Sums keep their order. Random numbers are keyed by pixel, sample and path, so leaving
//! out one does not shift the others.

mod effect;
pub mod facts;
mod features;
mod findings;
mod invisible;
mod layer;
mod light;
mod margin;
mod path;
mod pixel_classes;
mod precision;
mod projection;
mod rules;
mod shape;
mod status;
mod summary;
mod surface_bounds;
mod visibility;

pub use effect::{Effect, EffectStatus, State};
pub use features::{Features, PathFeatures, Shapes};
pub use invisible::invisible_surfaces;
pub use layer::Layer;
pub use path::{Caustics, EnvironmentUse, LightUse, PathPlan};
pub use pixel_classes::{PixelClass, PixelClasses};
pub use precision::{Loss, MIN_HIT_DISTANCE, Symptom, loss};
pub use rules::{Rule, Rules};

use findings::{Facts, Findings};
use light::LightFindings;
use path::Planned;
use projection::{ScreenProjection, ScreenRect};
use rtc_math::Vec3;
use rtc_valid::{Mode, PathSettings, Projection, Shape, ValidScene};
use serde::{Deserialize, Serialize};
use summary::MaterialSummary;
use visibility::Visibility;

/// The maximum number of pairs of surfaces or lights that a plan tests for visibility.
const MAX_PAIRS: usize = 500_000;

/// The arithmetic of ray intersection. Shading is always in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum Arithmetic {
    /// f64 with bounds on its errors.
    #[default]
    Robust,
    /// The formulas of textbooks in f64, with a fixed threshold.
    Plain,
    /// The same formulas in f32.
    F32,
}

impl Arithmetic {
    /// All of them, the robust one first.
    pub const ALL: [Self; 3] = [Self::Robust, Self::Plain, Self::F32];

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::Plain => "plain",
            Self::F32 => "f32",
        }
    }
}

/// The remaining terms of a light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightPlan {
    /// Whether it adds anything.
    pub is_used: bool,
    /// Whether it adds more than its ambient term.
    pub direct: bool,
    /// Per surface of the scene, whether something may stand between it and the light.
    pub shadowed: Vec<bool>,
    /// Per surface of the scene, which surfaces may: a bit for each. Empty where there are more than
    /// 64, of which all may.
    pub occluders: Vec<u64>,
}

impl LightPlan {
    /// Whether a surface may hide the light from another one.
    #[must_use]
    pub fn may_occlude(&self, occluder: usize, receiver: usize) -> bool {
        let bits = self.occluders.get(receiver);
        bits.is_none_or(|bits| bits >> occluder & 1 == 1)
    }
}

/// The work that a picture needs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The arithmetic of ray intersection.
    pub arithmetic: Arithmetic,
    /// The rules that were allowed.
    pub rules: Rules,
    /// The features that the integrator needs.
    pub features: Features,
    /// The shapes that rays may meet.
    pub shapes: Shapes,
    /// Per light of the scene.
    pub lights: Vec<LightPlan>,
    /// Per surface of the scene, whether a ray may meet it.
    pub surfaces: Vec<bool>,
    /// Per texture of the scene, its value if it has only one.
    pub constants: Vec<Option<Vec3>>,
    /// Bounces after the first hit that may add something.
    pub max_depth: u32,
    /// The class of each pixel.
    pub pixel_classes: PixelClasses,
    /// The plan of paths, where paths are traced.
    pub paths: Option<PathPlan>,
    /// The verdict on each effect.
    pub statuses: Vec<EffectStatus>,
}

impl Plan {
    /// Plans the picture with the rules given.
    #[must_use]
    pub fn new(scene: &ValidScene, rules: Rules) -> Self {
        let settings = scene.settings();
        if let Mode::Path(path) = settings.mode {
            return Self::of_paths(scene, path, rules);
        }
        let rules = rules_for_camera(scene, rules);
        let facts = Facts::new(scene, rules);
        let projection = ScreenProjection::new(scene.camera(), facts.is_pinhole());
        let screen_rects = facts
            .surface_bounds
            .iter()
            .map(|bounds| projection.screen_rect(bounds))
            .collect::<Vec<_>>();
        let requested = if let Mode::Phong = settings.mode {
            settings.max_depth
        } else {
            0
        };
        let anywhere = vec![ScreenRect::Unknown; screen_rects.len()];
        let seen = if rules.contains(Rule::Cull) {
            &screen_rects
        } else {
            &anywhere
        };
        let visibility = Visibility::new(&facts, &projection, seen, requested);
        let lights = LightFindings::new(&facts, &visibility);
        let needed = if rules.contains(Rule::MirrorKs) {
            visibility.depth
        } else {
            requested
        };
        let max_depth = visibility::truncated_depth(&facts, needed, rules);
        let is_kept = |surface: usize| {
            visibility.visible[surface] || lights.occludes[surface] || !rules.contains(Rule::Cull)
        };
        let surfaces = (0..screen_rects.len()).map(is_kept).collect::<Vec<_>>();
        let findings = Findings {
            facts,
            visibility,
            lights,
            max_depth,
            requested,
        };
        let pixel_classes = PixelClasses::new(&findings, &projection, &screen_rects);
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: findings.features(),
            shapes: shapes(scene, &surfaces),
            surfaces,
            max_depth,
            statuses: status::statuses(&findings, &pixel_classes),
            pixel_classes,
            lights: findings.lights.plans,
            constants: findings.facts.constants,
            paths: None,
        }
    }

    /// Plans traced paths.
    fn of_paths(scene: &ValidScene, path: PathSettings, rules: Rules) -> Self {
        let Planned {
            plan,
            surfaces,
            max_depth,
            statuses,
        } = path::plan(scene, path, rules);
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: Features::EVERYTHING,
            shapes: shapes(scene, &surfaces),
            lights: Vec::new(),
            surfaces,
            constants: vec![None; scene.textures().len()],
            max_depth,
            pixel_classes: PixelClasses::default(),
            paths: Some(plan),
            statuses,
        }
    }

    /// Plans the picture by an arithmetic, with those of the given rules that hold for it: proofs
    /// about shapes hold for the robust one alone.
    #[must_use]
    pub fn with_arithmetic(arithmetic: Arithmetic, scene: &ValidScene, rules: Rules) -> Self {
        let rules = match arithmetic {
            Arithmetic::Robust => rules,
            Arithmetic::Plain | Arithmetic::F32 => rules.intersection(Rules::AT_HITS),
        };
        Self {
            arithmetic,
            ..Self::new(scene, rules)
        }
    }

    /// The rule that left out an effect, of the whole scene or else of some entity.
    #[must_use]
    pub fn rule_of(&self, effect: Effect) -> Option<Rule> {
        let mut statuses = self
            .statuses
            .iter()
            .filter(|status| status.effect == effect);
        statuses.find_map(|status| status.rule)
    }

    /// Whether the picture needs an effect, of whatever entity.
    #[must_use]
    pub fn needs(&self, effect: Effect) -> bool {
        self.statuses
            .iter()
            .any(|status| status.effect == effect && status.state == State::Needed)
    }
}

/// The rules whose proofs hold for a camera: most assume that all rays start at the eye.
fn rules_for_camera(scene: &ValidScene, rules: Rules) -> Rules {
    match scene.camera().projection {
        Projection::Orthographic => rules.intersection(Rules::AT_HITS),
        Projection::Perspective => rules,
    }
}

fn shapes(scene: &ValidScene, is_used: &[bool]) -> Shapes {
    let is_basic = |shape: &Shape| {
        matches!(
            shape,
            Shape::Sphere(_) | Shape::Plane(_) | Shape::Triangle(_)
        )
    };
    let mut planned = scene
        .surfaces()
        .iter()
        .zip(is_used)
        .filter(|(_, is_used)| **is_used);
    if planned.all(|(surface, _)| is_basic(&surface.shape)) {
        Shapes::Basic
    } else {
        Shapes::All
    }
}
