//! Approved plans: for each generated scene, the needed effects, the rules that removed the others,
//! and a hash of its plans with all rules, with every other one and with none. `RTC_UPDATE=1 cargo
//! test --test suites plan::` rewrites `tests/plan/approved.txt`.

use super::dice::Dice;
use super::{root, validated};
use rtc::internals::ir::{Cone, Cylinder, Disc, Scene, Shape, Sphere, Torus};
use rtc::internals::plan::{Arithmetic, EffectState, Plan, Rule, RuleSet, loss};
use std::fmt::Write as _;
use std::fs;
use xxhash_rust::xxh3::xxh3_64;

const SCENES: u64 = 250;

/// A generated scene; in turn unchanged, with tiny round shapes, seen from so far that rounding
/// dominates, with a single surface from afar, and with supersampling through a pinhole.
fn scene(seed: u64) -> Scene {
    let mut scene = Dice::new(seed).scene();
    match seed % 4 {
        1 => scene.surfaces.iter_mut().for_each(|surface| {
            let shape = &mut surface.shape;
            if let Shape::Sphere(Sphere { radius, .. }) | Shape::Disc(Disc { radius, .. }) = shape {
                *radius *= 1e-4;
            } else if let Shape::Cylinder(Cylinder { radius, .. })
            | Shape::Cone(Cone { radius, .. })
            | Shape::Torus(Torus { minor: radius, .. }) = shape
            {
                *radius *= 1e-3;
            }
        }),
        2 if seed % 8 == 2 => {
            scene.camera.eye[0] += 1e15;
            scene.camera.center[0] += 1e15;
        }
        2 if seed % 8 == 6 => {
            scene.surfaces.drain(1..);
            scene.camera.eye[2] += 1e4;
        }
        3 => (scene.camera.lens.radius, scene.settings.supersampling) = (0.0, 3),
        _ => {}
    }
    scene
}

fn line(seed: u64) -> String {
    let scene = validated(&scene(seed));
    let plan = Plan::new(&scene, RuleSet::ALL);
    let is_other = |rule: &Rule| (*rule as u64 ^ seed).is_multiple_of(2);
    let others = Rule::ALL
        .into_iter()
        .filter(is_other)
        .fold(RuleSet::NONE, RuleSet::with);
    let mut all = format!(
        "{plan:?}{:?}{:?}",
        Plan::new(&scene, others),
        Plan::new(&scene, RuleSet::NONE)
    );
    for arithmetic in [Arithmetic::Plain, Arithmetic::F32] {
        let _ = write!(
            all,
            "{:?}{:?}",
            Plan::with_arithmetic(arithmetic, &scene, RuleSet::ALL),
            loss(&scene, arithmetic)
        );
    }
    let pixels = (0..9).flat_map(|y| (0..11).map(move |x| [x, y]));
    all += &format!(
        "{:?}",
        pixels
            .map(|pixel| plan.pixel_classes.class_of(pixel))
            .collect::<Vec<_>>()
    );
    let mut line = format!("{seed:3} {:016x}", xxh3_64(all.as_bytes()));
    for status in plan.statuses.iter().filter(|status| status.of.is_none()) {
        match (status.state, status.rule) {
            (EffectState::Needed, _) => line += &format!(", {}", status.effect.name()),
            (EffectState::Pruned, Some(rule)) => line += &format!(", {}", rule.name()),
            (EffectState::Pruned | EffectState::Absent, _) => {}
        }
    }
    line
}

#[test]
#[expect(clippy::disallowed_methods, reason = "it keeps its table")]
fn plans_are_as_approved() {
    let found = (0..SCENES)
        .map(|seed| line(seed) + "\n")
        .collect::<String>();
    let path = root("tests/plan/approved.txt");
    if std::env::var_os("RTC_UPDATE").is_some() {
        fs::write(path, found).unwrap();
        return;
    }
    let approved = fs::read_to_string(path).unwrap();
    let differ = |(found, approved): &(&str, &str)| found != approved;
    let first = found.lines().zip(approved.lines()).find(differ);
    assert!(
        found == approved,
        "the first that differs, found and approved: {first:#?}"
    );
}

/// A hash does not say what differs, so the readable part is spelled out.
#[test]
fn effects_and_states_are_named_as_in_the_books() {
    let plan = Plan::new(&validated(&Dice::new(0).scene()), RuleSet::ALL);
    let mut names = plan
        .statuses
        .iter()
        .filter(|status| status.of.is_none())
        .map(|status| status.effect.name());
    let wanted = "depth buffer, normal buffer, surfaces, direct light, shadows, soft light, \
     highlight, bounces, mirror, \
                  glossy mirror, refraction, textures, corner normals, normal maps, lens, \
                  supersampling";
    assert!(names.by_ref().eq(wanted.split(", ")));
    assert_eq!(
        [
            EffectState::Needed,
            EffectState::Pruned,
            EffectState::Absent
        ]
        .map(EffectState::name),
        ["needed", "pruned", "absent"]
    );
    assert!(
        Rule::ALL
            .iter()
            .all(|rule| rule.text().ends_with('.') && rule.text().len() > 20)
    );
}
