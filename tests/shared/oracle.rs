//! What the scenes of the course call for, read off their text by hand: effects needed, and those
//! left out with the rule.

use super::scenes::{course, validated};
use libtest_mimic::Trial;
use rtc::internals::plan::{Effect, EffectState, EffectStatus, Plan, RuleSet};
use rtc::internals::valid::ValidScene;

use Effect::{
    DepthBuffer, DirectLight, GlossyReflection, Highlight, Lens, Mirror, NormalBuffer,
    NormalInterpolation, NormalMapping, Refraction, Shadows, SoftLight, Supersampling, Surfaces,
    Textures,
};

type Row = (
    &'static str,
    &'static [Effect],
    &'static [(Effect, &'static str)],
);

/// The scene, the effects it needs beside surfaces, and the rules that left out what it asks for.
const SCENES: &[Row] = &[
    (
        "scene01-normal.yaml",
        &[NormalBuffer],
        &[(DirectLight, "E-MODE"), (Highlight, "E-MODE")],
    ),
    (
        "scene01-zbuffer.yaml",
        &[DepthBuffer],
        &[(DirectLight, "E-MODE"), (Highlight, "E-MODE")],
    ),
    (
        "blue-earth.yaml",
        &[DirectLight, Textures, Supersampling],
        &[(Shadows, "E-SHADOW-CONVEX"), (Highlight, "E-SPEC")],
    ),
    ("circle.yaml", &[DirectLight, Highlight], &[]),
    ("cylinder.yaml", &[DirectLight, Highlight], &[]),
    ("plane.yaml", &[DirectLight, Highlight], &[]),
    ("torus.yaml", &[DirectLight, Highlight], &[]),
    ("triangle.yaml", &[DirectLight, Highlight], &[]),
    ("tori.yaml", &[DirectLight, Highlight], &[]),
    ("scene01.yaml", &[DirectLight, Highlight], &[]),
    ("scene02.yaml", &[DirectLight, Highlight], &[]),
    (
        "scene01-ss.yaml",
        &[DirectLight, Highlight, Supersampling],
        &[],
    ),
    ("scene01-gooch.yaml", &[DirectLight, Highlight], &[]),
    (
        "mesh.yaml",
        &[
            DirectLight,
            Highlight,
            Mirror,
            NormalInterpolation,
            Supersampling,
        ],
        &[],
    ),
    (
        "scene01-shadows.yaml",
        &[DirectLight, Shadows, Highlight],
        &[],
    ),
    (
        "scene01-lights-shadows.yaml",
        &[DirectLight, Shadows, Highlight],
        &[],
    ),
    (
        "scene01-reflect-lights-shadows.yaml",
        &[DirectLight, Shadows, Highlight, Mirror],
        &[],
    ),
    (
        "scene01-camera-ss-reflect-lights-shadows.yaml",
        &[DirectLight, Shadows, Highlight, Mirror, Supersampling],
        &[],
    ),
    (
        "scene01-texture-ss-reflect-lights-shadows.yaml",
        &[DirectLight, Shadows, Highlight, Mirror, Textures],
        &[],
    ),
    (
        "scene01-dof-ss-reflect-lights-shadows.yaml",
        &[DirectLight, Shadows, Highlight, Mirror, Lens, Supersampling],
        &[],
    ),
    (
        "olympic.yaml",
        &[DirectLight, Shadows, Highlight, Mirror, Supersampling],
        &[],
    ),
    (
        "small.yaml",
        &[DirectLight, Shadows, Highlight, Mirror, Supersampling],
        &[],
    ),
];

/// All effects there are a verdict on, but those that are others in sum.
const EFFECTS: [Effect; 14] = [
    DepthBuffer,
    NormalBuffer,
    DirectLight,
    Shadows,
    SoftLight,
    Highlight,
    Mirror,
    GlossyReflection,
    Refraction,
    Textures,
    NormalInterpolation,
    NormalMapping,
    Lens,
    Supersampling,
];

pub(crate) fn trials() -> Vec<Trial> {
    let trial = |(name, needed, pruned): &Row| {
        let (needed, pruned) = (*needed, *pruned);
        course("plan: effects", name, move |scene| {
            it_calls_for(&validated(scene), needed, pruned);
        })
    };
    SCENES.iter().map(trial).collect()
}

fn it_calls_for(scene: &ValidScene, needed: &[Effect], pruned: &[(Effect, &str)]) {
    let plan = Plan::new(scene, RuleSet::ALL);
    assert!(plan.needs(Surfaces));
    let mut faults = Vec::new();
    for effect in EFFECTS {
        let found = status(&plan, effect);
        let is_needed = found.state == EffectState::Needed;
        let rule = pruned
            .iter()
            .find(|(of, _)| *of == effect)
            .map(|(_, rule)| *rule);
        let wanted = rule.is_none() || rule == found.rule.map(|rule| rule.name());
        if is_needed != needed.contains(&effect) || !wanted {
            faults.push(format!("{found:?}"));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The verdict on an effect of the whole scene.
fn status(plan: &Plan, effect: Effect) -> &EffectStatus {
    let mut all = plan
        .statuses
        .iter()
        .filter(|status| status.effect == effect && status.of.is_none());
    let first = all.next().unwrap();
    assert!(all.next().is_none(), "there is one verdict on {effect:?}");
    first
}
