//! Invariants of any scene: rules, threads and IR encodings do not change a bit, removed work
//! contributes nothing, and every value is finite. Tests 64 generated scenes, or those of
//! `RTC_SCENES`, for example 0..2000.

use super::dice::Dice;
use super::{bits, film, validated};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Light, LoweredScene, Material, Phong, Scene, SourceSpans};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, Rule, RuleSet};
use rtc::internals::render::{RenderSelection, Values};
use rtc::internals::source::SourceMap;
use std::collections::BTreeSet;
use std::fmt::{Debug, Write as _};

fn is_sound(scene: &Scene) -> bool {
    let lowered = LoweredScene {
        scene: scene.clone(),
        source_spans: SourceSpans::default(),
    };
    pipeline::validate(
        &lowered,
        &Options::default(),
        &mut DiagnosticSink::default(),
    )
    .is_some()
}

fn decoded(encoding: Encoding, scene: &Scene) -> Scene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("scene", codec::encode(encoding, scene).unwrap());
    codec::decode(encoding, file, &map, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// The first invariant that a valid scene violates.
fn broken(scene: &Scene) -> Option<String> {
    let valid = validated(scene);
    let unpruned = film(&valid, RuleSet::NONE, Values::Linear);
    if let Some(index) = unpruned
        .image
        .pixels
        .iter()
        .position(|pixel| !pixel.iter().all(|value| value.is_finite()))
    {
        return Some(format!(
            "pixel {index} is {:?}",
            unpruned.image.pixels[index]
        ));
    }
    let wanted = bits(&unpruned);
    let pruned = film(&valid, RuleSet::ALL, Values::Linear);
    let differing = bits(&pruned)
        .iter()
        .zip(&wanted)
        .filter(|(a, b)| a != b)
        .count();
    if differing > 0 {
        let changes =
            |rule: &Rule| bits(&film(&valid, RuleSet::NONE.with(*rule), Values::Linear)) != wanted;
        let culprits: Vec<_> = Rule::ALL
            .into_iter()
            .filter(changes)
            .map(Rule::name)
            .collect();
        return Some(format!(
            "the rules change {differing} values; by itself does each of {culprits:?}"
        ));
    }
    let (plan, job) = (
        Plan::new(&valid, RuleSet::ALL),
        RenderSelection {
            values: Values::Linear,
            ..RenderSelection::default()
        },
    );
    if let Err(fault) = pipeline::verify(&valid, &plan, &job, 1, &|_| true)
        .unwrap()
        .unwrap()
    {
        return Some(format!("{fault:?}"));
    }
    let alone = pipeline::render(&valid, &plan, &job, 1, &|_| true)
        .unwrap()
        .unwrap();
    if bits(&alone) != wanted || alone.counts != pruned.counts {
        return Some("one thread makes another picture than two".to_owned());
    }
    let other = [Encoding::Json, Encoding::Binary]
        .into_iter()
        .find(|encoding| {
            let other = decoded(*encoding, scene);
            other != *scene
                || bits(&film(&validated(&other), RuleSet::ALL, Values::Linear)) != wanted
        });
    other.map(|encoding| format!("the IR as {encoding:?} is another scene"))
}

/// Reduces a scene that violates an invariant.
fn smallest(mut scene: Scene) -> Scene {
    let breaks = |scene: &Scene| is_sound(scene) && broken(scene).is_some();
    for index in (0..scene.surfaces.len()).rev() {
        let mut less = scene.clone();
        less.surfaces.remove(index);
        scene = if breaks(&less) { less } else { scene };
    }
    for index in (0..scene.lights.len()).rev() {
        let mut less = scene.clone();
        less.lights.remove(index);
        scene = if breaks(&less) { less } else { scene };
    }
    for index in 0..scene.materials.len() {
        let mut less = scene.clone();
        less.materials[index] = Material::Phong(Phong::MATT);
        scene = if breaks(&less) { less } else { scene };
    }
    let cuts: [fn(&mut Scene); 6] = [
        |scene| scene.settings.max_depth = 0,
        |scene| scene.settings.supersampling = 1,
        |scene| scene.settings.light_samples = 1,
        |scene| scene.camera.lens.radius = 0.0,
        |scene| scene.environment = None,
        |scene| {
            scene
                .meshes
                .iter_mut()
                .for_each(|mesh| mesh.normals = Vec::<[f64; 3]>::new().into())
        },
    ];
    for cut in cuts {
        let mut less = scene.clone();
        cut(&mut less);
        scene = if breaks(&less) { less } else { scene };
    }
    scene
}

/// Regression scenes.
const FOUND: [u64; 12] = [
    1243, 1635, 3321, 5438, 11865, 12376, 25322, 38809, 38838, 43900, 44689, 58013,
];

/// The scenes to test.
fn seeds() -> Vec<u64> {
    let Ok(wanted) = std::env::var("RTC_SCENES") else {
        return (0..64).chain(FOUND).collect();
    };
    let ends = wanted
        .split_once("..")
        .and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
    let (from, to) = ends.expect("RTC_SCENES is a range, as 0..2000");
    (from..to).collect()
}

/// Names all scenes that violate an invariant, and prints the first.
#[test]
fn laws_hold_for_scenes_of_all_kinds() {
    let (mut faults, mut first, mut refused) = (String::new(), None, 0);
    let seeds = seeds();
    let scenes = seeds.len();
    for seed in seeds {
        let scene = Dice::new(seed).extreme();
        if !is_sound(&scene) {
            refused += 1;
        } else if let Some(fault) = broken(&scene) {
            writeln!(faults, "scene {seed}: {fault}").unwrap();
            first.get_or_insert(scene);
        }
    }
    assert!(
        8 * refused <= scenes,
        "{refused} of {scenes} scenes are refused"
    );
    let shown = first
        .map(|scene| codec::encode(Encoding::Json, &smallest(scene)).unwrap())
        .unwrap_or_default();
    assert!(
        faults.is_empty(),
        "{faults}{}",
        String::from_utf8_lossy(&shown)
    );
}

/// Kinds of everything that scenes are made of.
const KINDS: [&str; 25] = [
    "Phong",
    "Depth",
    "Normal",
    "Gooch",
    "Path",
    "Perspective",
    "Orthographic",
    "Sphere",
    "Plane",
    "Triangle",
    "Quad",
    "Disc",
    "Cylinder",
    "Cone",
    "Torus",
    "Instance",
    "soft or hard",
    "Sun",
    "Point",
    "Spot",
    "Standard",
    "image",
    "color",
    "tiny",
    "huge",
];

/// The name of a variant.
fn word(value: &dyn Debug) -> String {
    let text = format!("{value:?}");
    text.split([' ', '(']).next().unwrap().to_owned()
}

/// The kinds of what a scene is made of.
fn kinds(scene: &Scene) -> Vec<String> {
    let mut kinds = vec![word(&scene.settings.mode), word(&scene.camera.projection)];
    kinds.extend(scene.surfaces.iter().map(|surface| word(&surface.shape)));
    kinds.extend(scene.lights.iter().map(|light| match light {
        Light::Point(_) => "soft or hard".to_owned(),
        Light::Punctual(light) => word(&light.emitter),
    }));
    kinds.extend(scene.materials.iter().map(|material| word(&material)));
    if let Some(environment) = &scene.environment {
        let has_image = environment.image.is_some();
        kinds.push(if has_image { "image" } else { "color" }.to_owned());
    }
    let steps = scene.camera.right.iter();
    let size = steps.fold(0.0, |size: f64, step| size.max(step.abs()));
    let sizes = [("tiny", size < 1e-30), ("huge", size > 1e30)];
    let sizes = sizes.iter().filter(|kind| kind.1);
    kinds.extend(sizes.map(|kind| kind.0.to_owned()));
    kinds
}

/// Every kind must be generated.
#[test]
fn scenes_of_all_kinds_are_made() {
    let seen: BTreeSet<_> = (0..64)
        .map(|seed| Dice::new(seed).extreme())
        .filter(is_sound)
        .flat_map(|scene| kinds(&scene))
        .collect();
    let missing: Vec<_> = KINDS.iter().filter(|kind| !seen.contains(**kind)).collect();
    assert!(missing.is_empty(), "{missing:?} of {seen:?}");
}
