//! The work that the picture of a scene needs: a verdict with its reason for each effect, and the
//! remaining work.
//!
//! A plan changes no bit of the picture. A rule leaves out only what it proves to add exactly
//! nothing: a term with a factor of 0 whose other factors are finite (validation bounds every
//! number by 1e60, so each local term is), a ray that can meet nothing, a sample that equals its
//! neighbour. Sums keep their order. Random numbers are keyed by pixel, sample and path, so leaving
//! out one does not shift the others.

mod body;
mod effect;
pub mod facts;
mod features;
mod findings;
mod layer;
mod light;
mod path;
mod precision;
mod region;
mod rules;
mod shape;
mod space;
mod summary;
mod unseen;
mod verdicts;
mod visibility;
mod window;

pub use effect::{Effect, EffectStatus, State};
pub use features::{Features, PathFeatures, Shapes};
pub use layer::Layer;
pub use path::{Caustics, EnvironmentUse, LightUse, PathPlan};
pub use precision::{Loss, NEAREST, Symptom, loss};
pub use region::{PixelClass, Region};
pub use rules::{Rule, Rules};
pub use unseen::unseen;

use findings::{Facts, Findings};
use light::LightFindings;
use path::Planned;
use rtc_math::Vec3;
use rtc_valid::{Mode, PathSettings, Projection, Shape, ValidScene};
use serde::{Deserialize, Serialize};
use summary::MaterialSummary;
use visibility::Visibility;
use window::{Shown, Window};

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
    pub kept: bool,
    /// Whether it adds more than its ambient term.
    pub direct: bool,
    /// Per surface of the scene, whether something may stand between it and the light.
    pub shadowed: Vec<bool>,
    /// Per surface of the scene, which surfaces may: a bit for each. Empty where there are more than
    /// 64, of which all may.
    pub casters: Vec<u64>,
}

impl LightPlan {
    /// Whether a surface may hide the light from another one.
    #[must_use]
    pub fn may_hide(&self, caster: usize, receiver: usize) -> bool {
        let bits = self.casters.get(receiver);
        bits.is_none_or(|bits| bits >> caster & 1 == 1)
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
    pub region: Region,
    /// The plan of paths, where paths are traced.
    pub paths: Option<PathPlan>,
    /// The verdict on each effect.
    pub verdicts: Vec<EffectStatus>,
}

impl Plan {
    /// Plans the picture with the rules given.
    #[must_use]
    pub fn new(scene: &ValidScene, rules: Rules) -> Self {
        let settings = scene.settings();
        if let Mode::Path(path) = settings.mode {
            return Self::of_paths(scene, path, rules);
        }
        let rules = proven_for(scene, rules);
        let facts = Facts::new(scene, rules);
        let window = Window::new(scene.camera(), facts.is_pinhole());
        let shown = facts
            .bodies
            .iter()
            .map(|body| window.shown(body))
            .collect::<Vec<_>>();
        let asked = if let Mode::Phong = settings.mode {
            settings.max_depth
        } else {
            0
        };
        let anywhere = vec![Shown::Anywhere; shown.len()];
        let seen = if rules.contains(Rule::Cull) {
            &shown
        } else {
            &anywhere
        };
        let visibility = Visibility::new(&facts, &window, seen, asked);
        let lights = LightFindings::new(&facts, &visibility);
        let needed = if rules.contains(Rule::MirrorKs) {
            visibility.depth
        } else {
            asked
        };
        let max_depth = visibility::cut(&facts, needed, rules);
        let is_kept = |surface: usize| {
            visibility.reached[surface] || lights.casts[surface] || !rules.contains(Rule::Cull)
        };
        let surfaces = (0..shown.len()).map(is_kept).collect::<Vec<_>>();
        let findings = Findings {
            facts,
            visibility,
            lights,
            max_depth,
            asked,
        };
        let region = Region::new(&findings, &window, &shown);
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: findings.features(),
            shapes: shapes(scene, &surfaces),
            surfaces,
            max_depth,
            verdicts: verdicts::verdicts(&findings, &region),
            region,
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
            verdicts,
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
            region: Region::default(),
            paths: Some(plan),
            verdicts,
        }
    }

    /// Plans the picture by an arithmetic, with those of the given rules that hold for it: proofs
    /// about shapes hold for the robust one alone.
    #[must_use]
    pub fn by(arithmetic: Arithmetic, scene: &ValidScene, rules: Rules) -> Self {
        let rules = match arithmetic {
            Arithmetic::Robust => rules,
            Arithmetic::Plain | Arithmetic::F32 => rules.of(Rules::AT_HITS),
        };
        Self {
            arithmetic,
            ..Self::new(scene, rules)
        }
    }

    /// The rule that left out an effect, of the whole scene or else of some entity.
    #[must_use]
    pub fn rule_of(&self, effect: Effect) -> Option<Rule> {
        let mut verdicts = self
            .verdicts
            .iter()
            .filter(|verdict| verdict.effect == effect);
        verdicts.find_map(|verdict| verdict.rule)
    }

    /// Whether the picture needs an effect, of whatever entity.
    #[must_use]
    pub fn needs(&self, effect: Effect) -> bool {
        self.verdicts
            .iter()
            .any(|verdict| verdict.effect == effect && verdict.state == State::Needed)
    }
}

/// The rules whose proofs hold for a camera: most assume that all rays start at the eye.
fn proven_for(scene: &ValidScene, rules: Rules) -> Rules {
    match scene.camera().projection {
        Projection::Orthographic => rules.of(Rules::AT_HITS),
        Projection::Perspective => rules,
    }
}

fn shapes(scene: &ValidScene, kept: &[bool]) -> Shapes {
    let is_basic = |shape: &Shape| {
        matches!(
            shape,
            Shape::Sphere(_) | Shape::Plane(_) | Shape::Triangle(_)
        )
    };
    let mut planned = scene.surfaces().iter().zip(kept).filter(|(_, kept)| **kept);
    if planned.all(|(surface, _)| is_basic(&surface.shape)) {
        Shapes::Basic
    } else {
        Shapes::All
    }
}
