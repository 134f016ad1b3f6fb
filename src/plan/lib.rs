//! The plan of a picture: which effects a scene needs, with a reason for each, and the smallest
//! amount of work that renders the same picture.
//!
//! # Data flow
//!
//! A [`ValidScene`] goes in, a [`Plan`] comes out; the renderer prepares its world from both.
//!
//! 1. Facts: the bounds of each surface ([`surface_bounds`]), its screen rectangle
//!    ([`projection`]), summaries of its material, constant textures ([`findings::SceneFacts`]).
//! 2. Rules ([`Rule`], `rtc explain E-SPEC` prints one): each proves that some work contributes
//!    exactly zero. For the Whitted integrator they are spread over [`visibility`] (which surfaces
//!    rays can hit), [`light`] (which lights and shadow rays contribute) and [`pixel_classes`]
//!    (which pixels are empty or uniform). For path tracing they are the items of [`path::rules`],
//!    applied to a builder until nothing changes.
//!    A rule drops a surface or a light only with a token that its proof alone makes: [`unseen`],
//!    [`dark`].
//! 3. Features ([`WhittedFeatures`], [`PathFeatures`]): the smallest set of compile-time features of the
//!    integrator that the remaining work needs.
//! 4. Status ([`EffectStatus`]): for each [`Effect`], whether it is needed, pruned or absent, the
//!    reason, the rule, and the scene values that decide. `rtc compile --explain` prints them, and
//!    `rtc render --verify-effects` checks at every pixel that the removed work contributes
//!    nothing.
//!
//! # Guarantees
//!
//! A plan does not change a bit of the picture. A rule removes only work that provably contributes
//! exactly zero: a term with a factor of 0 whose other factors are finite (validation bounds every
//! number by 1e60, so each local term is), a ray that cannot hit anything, a sample that equals its
//! neighbour. The order of summation does not change. Random numbers are keyed by pixel, sample and
//! path, so removing one sample does not shift the others. The only exception is [`Rule::Cut`],
//! which is off by default.
//!
//! All geometric proofs are conservative: they hold with a margin far above the rounding error of
//! rays ([`margin`]). They hold for the robust arithmetic and for perspective cameras; for others,
//! only the rules of [`RuleSet::AT_HITS`] are used.
//!
//! # Other functions
//!
//! [`loss`] estimates whether another arithmetic would be visibly less precise,
//! [`invisible_surfaces`] lists the surfaces that no ray can hit, and [`facts`] converts lights and
//! materials to the models of each integrator.

mod coverage;
mod dark;
mod effect;
pub mod facts;
mod features;
mod findings;
mod hidden_maps;
mod invisible;
mod layer;
mod light;
mod margin;
mod missed_caustics;
mod motion;
mod path;
mod pixel_classes;
mod precision;
mod projection;
mod rules;
mod shape;
mod status;
mod summary;
mod surface_bounds;
mod unsampled;
mod unseen;
mod visibility;

pub use coverage::{MapPresence, ShownMap, UvCoverage};
pub use effect::{Effect, EffectState, EffectStatus};
pub use features::{FeatureSet, PathFeatures, ShapeSet, WhittedFeatures};
pub use hidden_maps::{HiddenMap, hidden_maps};
pub use invisible::invisible_surfaces;
pub use layer::Layer;
pub use missed_caustics::{FocusedLight, focused_light};
pub use path::{CausticMaterials, Caustics, PathPlan, RemainingEnvironment, RemainingLight};
pub use pixel_classes::{PixelClass, PixelClassGrid};
pub use precision::{MIN_HIT_DISTANCE, PrecisionArtifact, PrecisionLoss, loss};
pub use rules::{Rule, RuleSet};
pub use summary::ConstantTextures;
pub use unsampled::unsampled_solid;

use findings::{RuleResults, SceneFacts};
use light::LightRuleResults;
use path::PathPlanning;
use projection::{ScreenProjection, ScreenRect};
use rtc_math::IdTable;
use rtc_valid::{CourseLight, Mode, PathSettings, Projection, Shape, ValidScene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use summary::MaterialSummary;
use unseen::{Unseen, WorldSurfaces};
use visibility::VisibleSurfaces;

/// The maximum number of surface–surface or surface–light pairs that a plan tests for visibility.
const MAX_PAIRS: usize = 500_000;

/// The arithmetic of ray intersection. Shading is always in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub enum Arithmetic {
    /// f64 with bounds on its errors.
    #[default]
    Robust,
    /// Textbook formulas in f64, with a fixed epsilon.
    Plain,
    /// The same formulas in f32.
    F32,
}

impl Arithmetic {
    /// All arithmetics, the robust one first.
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

/// The terms of a light that remain in the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightPlan {
    /// Whether any term remains.
    pub is_used: bool,
    /// Whether more than its ambient term remains.
    pub direct: bool,
    /// For each surface of the scene, whether it may be in shadow.
    pub shadowed: Vec<bool>,
    /// For each surface of the scene, the bit set of its possible occluders. Empty if the scene has
    /// more than 64 surfaces: then any surface may occlude.
    pub occluders: Vec<u64>,
}

impl LightPlan {
    /// Whether one surface may occlude the light from another.
    #[must_use]
    pub fn may_occlude(&self, occluder: usize, receiver: usize) -> bool {
        let bits = self.occluders.get(receiver);
        bits.is_none_or(|bits| bits >> occluder & 1 == 1)
    }
}

/// The plan of a picture: the work that remains after all rules.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The arithmetic of ray intersection.
    pub arithmetic: Arithmetic,
    /// The rules that may be applied.
    pub rules: RuleSet,
    /// The features that the integrator needs.
    pub features: WhittedFeatures,
    /// The shapes that rays may hit.
    pub shapes: ShapeSet,
    /// The plan of each light of the scene.
    pub lights: IdTable<CourseLight, LightPlan>,
    /// For each surface of the scene, whether a ray may hit it.
    pub surfaces: Vec<bool>,
    /// The values of the constant textures of the scene.
    pub constants: ConstantTextures,
    /// The number of bounces after the first hit that may contribute.
    pub max_depth: u32,
    /// The classes of the pixels.
    pub pixel_classes: PixelClassGrid,
    /// The moments of the shutter at which samples are taken; 1 if nothing moves.
    pub moments: u32,
    /// The plan of the path integrator, if it is used.
    pub paths: Option<PathPlan>,
    /// The status of each effect.
    pub statuses: Vec<EffectStatus>,
}

impl Plan {
    /// Plans a picture with the given rules.
    #[must_use]
    pub fn new(scene: &ValidScene, rules: RuleSet) -> Self {
        let settings = scene.settings();
        if let Mode::Path(path) = settings.mode {
            return Self::of_paths(scene, path, rules);
        }
        // Gather the facts, and project the bounds of all surfaces.
        let rules = rules_for_camera(scene, rules);
        let facts = SceneFacts::new(scene, rules);
        let projection = ScreenProjection::new(scene.camera(), facts.is_pinhole(), 0.0);
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
        // Find the surfaces that rays can hit, and the lights that contribute to them.
        let anywhere = vec![ScreenRect::Unknown; screen_rects.len()];
        let seen = if rules.contains(Rule::Cull) {
            &screen_rects
        } else {
            &anywhere
        };
        let visibility = VisibleSurfaces::new(&facts, &projection, seen, requested);
        let lights = LightRuleResults::new(&facts, &visibility);
        // Bound the number of bounces.
        let needed = if rules.contains(Rule::MirrorKs) {
            visibility.depth
        } else {
            requested
        };
        let max_depth = visibility::truncated_depth(&facts, needed, rules);
        let findings = RuleResults {
            facts,
            visibility,
            lights,
            max_depth,
            requested,
        };
        // Remove the surfaces that no ray can hit.
        let mut surfaces = WorldSurfaces::all(screen_rects.len());
        for unseen in Unseen::by_any_ray(&findings) {
            surfaces.drop_surface(unseen);
        }
        // Classify the pixels.
        let pixel_classes = PixelClassGrid::new(&findings, &projection, &screen_rects);
        let moments = motion::moments(scene);
        let mut statuses = status::statuses(&findings, &pixel_classes);
        statuses.extend(motion::status(scene, moments));
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: findings.features(),
            shapes: shapes(scene, &surfaces),
            surfaces: surfaces.to_vec(),
            max_depth,
            statuses,
            moments,
            pixel_classes,
            lights: findings.lights.plans,
            constants: findings.facts.constants,
            paths: None,
        }
    }

    /// Plans path tracing.
    fn of_paths(scene: &ValidScene, path: PathSettings, rules: RuleSet) -> Self {
        let rules = if scene.moves() {
            rules.intersection(RuleSet::AT_ANY_PLACE)
        } else {
            rules
        };
        let PathPlanning {
            plan,
            surfaces,
            max_depth,
            mut statuses,
        } = path::plan(scene, path, rules);
        let moments = motion::moments(scene);
        statuses.extend(motion::status(scene, moments));
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: WhittedFeatures::EVERYTHING,
            shapes: shapes(scene, &surfaces),
            lights: IdTable::default(),
            surfaces: surfaces.to_vec(),
            constants: ConstantTextures::none(scene),
            max_depth,
            pixel_classes: PixelClassGrid::default(),
            moments,
            paths: Some(plan),
            statuses,
        }
    }

    /// Plans a picture for an arithmetic. Only the rules that hold for this arithmetic are used:
    /// proofs about shapes hold only for the robust one.
    #[must_use]
    pub fn with_arithmetic(arithmetic: Arithmetic, scene: &ValidScene, rules: RuleSet) -> Self {
        let rules = match arithmetic {
            Arithmetic::Robust => rules,
            Arithmetic::Plain | Arithmetic::F32 => rules.intersection(RuleSet::AT_HITS),
        };
        Self {
            arithmetic,
            ..Self::new(scene, rules)
        }
    }

    /// The rule that removed an effect, from the whole scene or from a single entity.
    #[must_use]
    pub fn rule_of(&self, effect: Effect) -> Option<Rule> {
        let mut statuses = self
            .statuses
            .iter()
            .filter(|status| status.effect == effect);
        statuses.find_map(|status| status.rule)
    }

    /// Whether the picture needs an effect, for the whole scene or any entity.
    #[must_use]
    pub fn needs(&self, effect: Effect) -> bool {
        self.statuses
            .iter()
            .any(|status| status.effect == effect && status.state == EffectState::Needed)
    }
}

/// The rules that hold for a camera and its shutter: most proofs assume that all camera rays start
/// at the eye, and that nothing moves.
fn rules_for_camera(scene: &ValidScene, rules: RuleSet) -> RuleSet {
    if scene.moves() {
        return rules.intersection(RuleSet::AT_HITS);
    }
    match scene.camera().projection {
        Projection::Orthographic | Projection::Stereo(_) => rules.intersection(RuleSet::AT_HITS),
        Projection::Perspective => rules,
    }
}

fn shapes(scene: &ValidScene, is_used: &[bool]) -> ShapeSet {
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
        ShapeSet::Basic
    } else {
        ShapeSet::All
    }
}
