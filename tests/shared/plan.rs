//! The plans of scenes of others: the effects they need, that no rule changes a bit of their
//! pictures or adds a ray, and that removed work contributes nothing.

use super::oracle;
use super::scenes::{COURSE, accepted, course, each, film, read, validated, whole};
use crate::small::bits;
use crate::suite::needs;
use libtest_mimic::Trial;
use rtc::internals::ir::Scene;
use rtc::internals::passes::Overrides;
use rtc::internals::plan::{Plan, RuleSet, hidden_maps};
use rtc::internals::render::{RenderSelection, Values, verify};
use rtc::internals::valid::ValidScene;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = oracle::trials();
    for folder in [COURSE, "wild"] {
        let scenes = ["yaml", "yml"];
        trials.extend(each("plan: law", folder, &scenes, obeys_the_law));
        trials.extend(each(
            "plan: validation",
            folder,
            &scenes,
            is_left_out_rightly,
        ));
    }
    trials.push(course(
        "plan: rays counted elsewhere",
        "scene01-reflect-lights-shadows.yaml",
        takes_the_rays_counted_elsewhere,
    ));
    trials.push(course(
        "plan: rays of the camera alone",
        "scene01.yaml",
        takes_rays_of_the_camera_alone,
    ));
    trials.push(needs(
        "plan: a constant texture on a solid",
        "round-4/promises/plan-constant-texture-on-csg-changes-picture.yaml",
        keeps_a_constant_texture_to_its_parts,
    ));
    trials.push(needs(
        "plan: an eye on a skew cylinder",
        "round-4/promises/eye-on-skew-cylinder-sees-it.yaml",
        sees_nothing,
    ));
    trials
}

fn keeps_a_constant_texture_to_its_parts(path: &Path) {
    obeys_the_law(path);
    is_left_out_rightly(path);
    let told = hidden_maps(&validated(read(path)));
    assert!(matches!(told[..], [map] if map.is_partial), "{told:?}");
}

fn sees_nothing(path: &Path) {
    let film = whole(&validated(read(path)));
    let is_black = |pixel: &&[f64; 3]| **pixel == [0.0; 3];
    let black = film.image.pixels.iter().filter(is_black).count();
    assert_eq!(black, film.image.pixels.len());
}

/// The scene of a file with few pixels, samples and bounces; `None` if it is rejected.
fn small(path: &Path) -> Option<ValidScene> {
    let mut scene = accepted(path)?;
    Overrides {
        size: Some([22, 18]),
        supersampling: Some(scene.settings.supersampling.min(2)),
        depth: Some(scene.settings.max_depth.min(4)),
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene.camera.lens.samples = scene.camera.lens.samples.min(3);
    scene.settings.light_samples = scene.settings.light_samples.min(4);
    Some(validated(scene))
}

/// All rules together change no bit, and add no ray.
fn obeys_the_law(path: &Path) {
    let Some(scene) = small(path) else { return };
    for values in [Values::Linear, Values::Display] {
        let job = RenderSelection {
            values,
            ..RenderSelection::default()
        };
        let [pruned, unpruned] = [RuleSet::ALL, RuleSet::NONE]
            .map(|rules| film(&scene, &Plan::new(&scene, rules), &job));
        assert!(bits(&pruned) == bits(&unpruned), "{values:?}");
        assert!(
            pruned.counts.rays() <= unpruned.counts.rays(),
            "{:?} rays instead of {:?}",
            pruned.counts,
            unpruned.counts
        );
    }
}

fn is_left_out_rightly(path: &Path) {
    let Some(scene) = small(path) else { return };
    let plan = Plan::new(&scene, RuleSet::ALL);
    let verified = verify(&scene, &plan, &RenderSelection::default(), &|_| true);
    assert_eq!(verified.unwrap().map(drop), Ok(()));
}

fn takes_the_rays_counted_elsewhere(mut scene: Scene) {
    // Its 200 × 200 pixels in the middle, 16 rays each, one bounce: counted once by a program of
    // its own.
    scene.camera.size = [200, 200];
    (scene.settings.supersampling, scene.settings.max_depth) = (4, 1);
    let scene = validated(scene);
    let plan = Plan::new(&scene, RuleSet::AT_HITS);
    let counts = film(&scene, &plan, &RenderSelection::default()).counts;
    assert_eq!(counts.rays(), 2_200_208);
}

fn takes_rays_of_the_camera_alone(scene: Scene) {
    let counts = whole(&validated(scene)).counts;
    assert_eq!(counts.rays(), counts.camera);
    assert!(
        counts.camera < 160_000,
        "pixels that show nothing are not traced: {}",
        counts.camera
    );
    assert!(counts.hits > 0);
}
