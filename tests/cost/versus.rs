//! Comparisons of a scene with its reference.

use super::error::picture;
use super::*;
use rtc::internals::study::SceneComparison;

/// The spheres in a picture of 96 × 64 pixels, the right one with the second material, in a colour.
fn balls(supersampling: u32, color: [f64; 3]) -> Scene {
    let size = ("\"size\": [48, 32]", "\"size\": [96, 64]");
    let mut scene = scene(&[size, ("0.8", "0.4")]);
    scene.settings.supersampling = supersampling;
    scene.surfaces[1].material = scene.surfaces[2].material;
    scene.surfaces[2].material = scene.surfaces[0].material;
    scene.materials[1].phong_mut().unwrap().color = color;
    scene
}

const BLUE: [f64; 3] = [0.5, 0.6, 0.7];

fn against(scene: &Scene, reference: &Scene, seed: u64) -> SceneComparison {
    let about = || StudyProvenance {
        scene: "balls".to_owned(),
        ..StudyProvenance::default()
    };
    let found = on_bench(
        0,
        || 1.0,
        |runtime| {
            let scenes = [scene, reference];
            study::versus(
                scenes,
                [about(), about()],
                Effort(30_000_000),
                seed,
                runtime,
            )
        },
    );
    found.unwrap()
}

#[test]
fn a_scene_does_not_differ_from_itself() {
    let scene = balls(2, BLUE);
    let found = against(&scene, &scene, 1);
    assert_eq!((found.rendered, found.tested), (0.0, 24));
    assert_eq!((found.time.value, found.ratio_of_rays()), (1.0, 1.0));
    assert!(
        found.different.is_empty() && found.noise[0] > 0.1,
        "{found:?}"
    );
    let table = study::versus_table(&found);
    assert!(table.contains("the same, to the last bit") && table.contains("No tile of 24"));
}

/// More samples change the noise but not the mean: one of ten comparisons may report a difference.
#[test]
fn other_noise_is_no_difference() {
    let (few, many) = (balls(1, BLUE), balls(3, BLUE));
    let mut alarms = 0;
    for seed in 1..=10 {
        let found = against(&few, &many, seed);
        assert!(found.rendered > 0.3, "{found:?}");
        assert!(found.error.value < 0.3 * found.rendered, "{found:?}");
        assert!(
            found.ratio_of_noise() > 1.2 && found.ratio_of_rays() < 0.9,
            "{found:?}"
        );
        assert!(
            (found.time.value - found.ratio_of_rays()).abs() < 1e-9,
            "{found:?}"
        );
        alarms += usize::from(!found.different.is_empty());
    }
    assert!(alarms <= 1, "{alarms} of 10");
}

/// The right sphere is a little darker: the reported tiles are there, and the difference is the
/// true one.
#[test]
fn a_change_is_seen_where_it_is() {
    let (before, after) = (balls(2, BLUE), balls(2, [0.5, 0.55, 0.7]));
    let reference = {
        let fine = |scene| {
            [picture(
                scene,
                Setting::of(scene).with(Parameter::Supersampling, 24),
            )]
        };
        study::rmse(&fine(&after), &fine(&before))
    };
    // Two of ten 95 % intervals may miss it.
    let all: Vec<_> = (1..=10)
        .map(|seed| against(&after, &before, seed))
        .collect();
    let holds =
        |found: &&SceneComparison| found.error.low <= reference && reference <= found.error.high;
    let held = all.iter().filter(holds).count();
    let errors: Vec<_> = all.iter().map(|found| found.error).collect();
    assert!(held >= 8, "{reference}: {errors:?}");
    let found = &all[0];
    assert!(found.error.relative() < 0.3, "{found:?}");
    // The sphere differs most, and other tiles by its reflections; the far corners do not differ.
    let [x, y] = found.different[0].at;
    assert!(
        (48..=64).contains(&x) && (16..=32).contains(&y),
        "{found:?}"
    );
    assert!(found.different.len() < found.tested, "{found:?}");
    assert!(
        found.different.iter().all(|tile| tile.at != [0, 0]),
        "{found:?}"
    );
}
