//! Many lights, one of which is chosen by a tree, against few, which are chosen by their power.

use super::{JOB, add_light, add_quad, add_sphere, add_square, lambert, mean, scene, validate};
use rtc::internals::ir::{Punctual, PunctualKind, Scene};
use rtc::internals::math::Vec3;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{RenderSelection, SamplingSeeds};

const GROUPS: usize = 16;

/// A floor and a ball among 64 points and 32 shining squares (which are 128 lights), with the light
/// of one group, which are 8, or of all.
fn room(group: Option<usize>) -> Scene {
    let mut scene = scene(64);
    add_square(&mut scene, -1.0, 3.0, lambert([0.7, 0.6, 0.5]));
    add_sphere(&mut scene, [0.3, 0.2, 0.0], 0.6, lambert([0.8; 3]));
    let shines = |light: usize| group.is_none_or(|group| light % GROUPS == group);
    for light in 0..64 {
        let [i, j] = [light % 8, light / 8].map(|i| i as f64 / 3.5 - 1.0);
        let strength = (1 + light % 5) as f64;
        let height = 0.2 * (light % 7) as f64 - 0.9;
        if shines(light) {
            let position = [2.0 * i, 2.0 * j, height];
            add_light(
                &mut scene,
                Punctual {
                    emitter: PunctualKind::Point {
                        position,
                        range: None,
                    },
                    intensity: [0.02 * strength, 0.03, 0.01 * strength],
                    projected: None,
                },
            );
        }
        if light.is_multiple_of(2) {
            let emission = if shines(light / 2) { strength } else { 0.0 };
            let [x, y, z] = [1.9 * i, 1.9 * j, height + 0.3];
            let corner = |u: f64, v: f64| [x + 0.1 * u, y + 0.1 * v, z + 0.05 * u * i];
            let corners = [
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            let mut square = lambert([0.0; 3]);
            square.emissive = [emission, 0.5 * emission, emission];
            add_quad(&mut scene, corners, square);
        }
    }
    scene
}

fn seen(scene: &Scene, seed: u64) -> Vec3 {
    let proof = validate(scene);
    let job = RenderSelection {
        seeds: SamplingSeeds {
            pixel: seed,
            lens: seed,
            path: seed,
        },
        ..JOB
    };
    let plan = Plan::new(&proof, RuleSet::ALL);
    mean(&rtc::internals::render::render(&proof, &plan, &job, &|_| true).unwrap())
}

#[test]
fn many_lights_together_bring_what_they_bring_in_groups() {
    const SEEDS: u64 = 16;
    let (all, groups) = (room(None), (0..GROUPS).map(|group| room(Some(group))));
    let groups = groups.collect::<Vec<_>>();
    let difference = |seed| {
        let sum = groups.iter().map(|group| seen(group, seed)).sum::<Vec3>();
        (seen(&all, seed + SEEDS) - sum) / sum
    };
    let found = (1..=SEEDS).map(difference).collect::<Vec<_>>();
    let mean = found.iter().copied().sum::<Vec3>() / SEEDS as f64;
    let square = |difference: &Vec3| (*difference - mean) * (*difference - mean);
    let variance = found.iter().map(square).sum::<Vec3>() / (SEEDS * (SEEDS - 1)) as f64;
    let deviation = variance.map(f64::sqrt);
    // The noise is small enough to show a hundredth of the light that is lost or found twice.
    assert!(deviation.max_element() < 0.004, "{deviation}");
    let off = mean.abs().max_element();
    assert!(off < 2.5 * deviation.max_element(), "{mean} ± {deviation}");
}
