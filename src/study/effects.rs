//! The cost of each effect of a scene: the scene is rendered with and without it, in the same
//! setting.

use super::metrics::rmse;
use super::outcome::Rays;
use super::race::{Runner, race};
use super::setting::Setting;
use super::statistics::{Estimate, Rng};
use super::subject::{Stopped, Subject};
use crate::ir::{Light, Material, Mode, Phong, Scene};
use serde::{Deserialize, Serialize};

/// A scene without one of its effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct EffectCost {
    /// The effect.
    pub effect: String,
    /// The rays without it, of the part rendered.
    pub rays: Rays,
    /// The ratio of rays, without it to with it.
    pub ray_ratio: f64,
    /// The ratio of processor times, without it to with it.
    pub ratio: Estimate,
    /// The difference of the picture without it, in grey levels.
    pub difference: f64,
}

/// A function that removes an effect from a scene.
type Without = (&'static str, fn(&mut Scene));

const EFFECTS: [Without; 6] = [
    ("shadows", |scene| scene.settings.shadows = false),
    ("mirrors and refraction", |scene| {
        scene.settings.max_depth = 0
    }),
    ("depth of field", |scene| scene.camera.lens.radius = 0.0),
    ("highlights and mirrors", |scene| {
        phongs(scene).for_each(|phong| phong.ks = 0.0)
    }),
    ("soft lights", |scene| {
        scene.lights.iter_mut().for_each(without_radius)
    }),
    ("textures", |scene| phongs(scene).for_each(without_maps)),
];

fn phongs(scene: &mut Scene) -> impl Iterator<Item = &mut Phong> {
    scene.materials.iter_mut().filter_map(Material::phong_mut)
}

fn without_radius(light: &mut Light) {
    if let Light::Point(light) = light {
        light.radius = 0.0;
    }
}

fn without_maps(phong: &mut Phong) {
    (
        phong.color_map,
        phong.specular_map,
        phong.normal_map,
        phong.bump,
    ) = (None, None, None, None);
}

/// The effects of a scene, each with its cost in a setting.
pub(super) fn costs(
    subject: &Subject<'_>,
    setting: Setting,
    budget: u64,
    rng: &mut Rng,
) -> Result<Vec<EffectCost>, Stopped> {
    if !matches!(subject.scene.settings.mode, Mode::Phong) {
        return Ok(Vec::new());
    }
    let with = Runner {
        subject: subject.clone(),
        setting,
    };
    let mut names = Vec::new();
    let mut runners = vec![with];
    for (name, without) in EFFECTS {
        let mut scene = subject.scene.clone();
        without(&mut scene);
        if scene != subject.scene {
            names.push(name);
            let setting = Setting {
                depth: scene.settings.max_depth,
                ..setting
            };
            runners.push(Runner {
                subject: subject.with_scene(scene),
                setting,
            });
        }
    }
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let race = race(&runners, budget, rng)?;
    let (with, without) = race
        .runs
        .split_first()
        .expect("the scene as it is runs first");
    let all = Rays::from(with.shot.counts).all().max(1) as f64;
    let cost = |(name, run): (&str, &super::race::TimedRun)| EffectCost {
        effect: name.to_owned(),
        rays: run.shot.counts.into(),
        ray_ratio: Rays::from(run.shot.counts).all() as f64 / all,
        ratio: run.ratio,
        difference: rmse(&with.shot.tiles, &run.shot.tiles),
    };
    // An effect that changes neither picture nor work is absent.
    let costs = names.into_iter().zip(without).map(cost);
    Ok(costs
        .filter(|cost| cost.difference > 0.0 || cost.ray_ratio != 1.0)
        .collect())
}
