//! The plan of the path integrator: the materials, lights and features that a picture needs.
//!
//! - [`facts`]: facts before any rule: the surfaces of each material and their texture coordinates.
//! - [`texture`]: the values of a texture within a rectangle of texture coordinates.
//! - [`builder`]: the [`PathPlanBuilder`], the part of the scene that remains in the plan.
//! - [`rules`]: the rules, each with its name, its statement and its proof.
//! - [`dark`]: the proofs that a light illuminates nothing.
//! - [`status`]: the status of each effect, derived from the builder before and after the rules.
//! - [`caustics`]: whether and how the caustics of a scene are found.
//!
//! Rules work on a [`PathPlanBuilder`] that starts with everything the scene requires. An effect is
//! absent if the scene does not require it, pruned if a rule removed it, and needed otherwise. So
//! each status agrees with the work of the integrator.
//!
//! A rule may remove work only if no random number changes its meaning: a light that illuminates
//! nothing keeps its index in the light distribution, and a constant environment map keeps its
//! direction sampling.

mod builder;
mod caustics;
mod dark;
mod facts;
pub(crate) mod rules;
mod status;
mod texture;

pub(super) use builder::PathPlanBuilder;
pub use builder::{RemainingEnvironment, RemainingLight};
pub use caustics::{CausticMaterials, Caustics};
pub(super) use texture::UvRect;

use super::coverage::ShownMap;
use super::effect::{Effect, EffectStatus};
use super::facts as facts_seen;
use super::features::PathFeatures;
use super::layer::Layer;
use super::projection::{ScreenProjection, ScreenRect};
use super::rules::{PATH_RULES, RuleSet};
use super::surface_bounds::surface_bounds;
use super::unseen::WorldSurfaces;
use builder::{AppliedRule, is_among};
use dark::KeptLights;
use facts::MaterialUses;
use rtc_math::{IdTable, Medium, Vec3};
use rtc_valid::{
    Map, Material, MaterialId, PathSettings, Projection, Punctual, Standard, ValidScene,
};
use texture::TextureValues;

/// What the path integrator does: the simplified materials, lights and environment. Scene
/// preparation reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct PathPlan {
    /// The simplified material for each material of the scene.
    pub materials: IdTable<Material, Standard>,
    /// For each material, the maps that are folded into constants.
    folded: IdTable<Material, Vec<ShownMap>>,
    /// The use of each punctual light.
    pub lights: IdTable<Punctual, RemainingLight>,
    /// The use of the environment.
    pub environment: RemainingEnvironment,
    /// The medium around the camera.
    pub medium: Option<Medium>,
    /// The materials of caustics, if these are estimated.
    pub caustics: Option<CausticMaterials>,
    /// Whether the last ray of a path may hit an emitter.
    pub last_ray: bool,
    /// The features that the integrator needs.
    pub features: PathFeatures,
}

impl PathPlan {
    /// Whether a map of a material is constant on all its surfaces, so that scene preparation folds
    /// it into a factor.
    #[must_use]
    pub fn is_folded(&self, material: MaterialId, map: &Map) -> bool {
        is_among(&self.folded[material], map)
    }
}

/// The result of planning path tracing: the plan, and what the rules removed beside it.
pub(super) struct PathPlanning {
    pub(super) plan: PathPlan,
    /// For each surface, whether it is in the world.
    pub(super) surfaces: WorldSurfaces,
    /// The maximum number of bounces.
    pub(super) max_depth: u32,
    pub(super) statuses: Vec<EffectStatus>,
}

/// Plans path tracing of a scene.
pub(super) fn plan(scene: &ValidScene, path: PathSettings, rules: RuleSet) -> PathPlanning {
    // Gather the facts.
    let (uses, surface_bounds, textures) = (
        MaterialUses::of(scene),
        surface_bounds(scene),
        TextureValues::new(scene),
    );
    let punctual = facts_seen::light::punctual(scene.lights());
    let camera = scene.camera();
    let is_pinhole = camera.lens.radius.get() == 0.0;
    let screen_rects: Vec<_> = match camera.projection {
        Projection::Perspective => {
            let projection = ScreenProjection::new(camera, is_pinhole, path.reach());
            surface_bounds
                .iter()
                .map(|bounds| projection.screen_rect(bounds))
                .collect()
        }
        Projection::Orthographic | Projection::Stereo(_) => {
            vec![ScreenRect::Unknown; surface_bounds.len()]
        }
    };
    // Start with everything that the scene requires.
    let materials = scene.materials().iter();
    let materials = materials.map(facts_seen::material::standard).collect();
    let caustics = CausticMaterials::of(&materials);
    let requested = PathPlanBuilder {
        scene,
        path,
        uses: &uses,
        textures: &textures,
        surface_bounds: &surface_bounds,
        screen_rects: &screen_rects,
        punctual: &punctual,
        materials,
        caustics: &caustics,
        folded: vec![Vec::new(); scene.materials().len()].into(),
        lights: KeptLights::all(punctual.len()),
        environment: if scene.environment().radiance == Vec3::ZERO {
            RemainingEnvironment::Nothing
        } else {
            RemainingEnvironment::All
        },
        medium: scene.medium(),
        surfaces: WorldSurfaces::all(surface_bounds.len()),
        max_depth: scene.settings().max_depth,
        last_ray: true,
        nee: true,
        shadows: true,
    };
    // Apply the rules, and derive the status of each effect.
    let mut reduced = requested.clone();
    let applied = apply(&mut reduced, rules);
    let statuses = status::statuses(&requested, &reduced, &applied);
    // Take the plan from the remaining parts.
    let plan = PathPlan {
        features: features(&reduced, rules),
        folded: reduced.folded,
        lights: IdTable::clone(&reduced.lights),
        environment: reduced.environment,
        medium: reduced.medium,
        // Chains of smooth surfaces are followed in a vacuum only.
        caustics: (path.caustics && !facts_seen::material::has_media(scene))
            .then(|| caustics.clone()),
        last_ray: reduced.last_ray,
        materials: reduced.materials,
    };
    PathPlanning {
        plan,
        surfaces: reduced.surfaces,
        max_depth: reduced.max_depth,
        statuses,
    }
}

/// Applies the rules until none changes anything. Every change removes something, so the loop
/// terminates.
fn apply(builder: &mut PathPlanBuilder<'_>, rules: RuleSet) -> Vec<AppliedRule> {
    let mut applied = Vec::new();
    loop {
        let before = applied.len();
        for (rule, item) in PATH_RULES {
            if rules.contains(*rule) {
                applied.extend(builder.apply(*rule, item));
            }
        }
        if applied.len() == before {
            return applied;
        }
    }
}

/// The features that the integrator needs.
fn features(builder: &PathPlanBuilder<'_>, rules: RuleSet) -> PathFeatures {
    if rules == RuleSet::NONE {
        return PathFeatures::EVERYTHING;
    }
    let requires = |effects: &[Effect]| effects.iter().any(|effect| builder.requires(*effect));
    let all = [
        (
            PathFeatures::ALPHA,
            requires(&[Effect::Alpha, Effect::Blend]),
        ),
        (PathFeatures::NEE, requires(&[Effect::DirectLight])),
        (PathFeatures::MICROFACETS, requires(&[Effect::Microfacets])),
        (PathFeatures::TRANSMISSION, builder.transmits()),
        (
            PathFeatures::LAYERS,
            requires(&Layer::ALL.map(Effect::Layer)),
        ),
        (PathFeatures::SHADOWS, requires(&[Effect::Shadows])),
        (PathFeatures::MEDIA, requires(&[Effect::Media])),
    ];
    let needed = all.into_iter().filter(|(_, is_asked)| *is_asked);
    needed.fold(PathFeatures::NONE, |features, (feature, _)| {
        features.with(feature)
    })
}
