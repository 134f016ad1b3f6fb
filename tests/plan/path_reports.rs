//! The explanation of a path-traced scene: each effect, its state, the reason, and the scene values
//! that decided.

use super::path_effects::illuminated;
use super::path_materials::FIRST;
use super::path_rules::white;
use super::path_scenes::{cover, path, sky, standard};
use super::validated;
use rtc::internals::ir::{self, Alpha, ImageId, Punctual, PunctualKind, Scene, Standard, Texture};
use rtc::internals::plan::{EffectState, EffectStatus, Plan, Rule, RuleSet};

/// The effects in a state, one line each: the effect, the rule, the reason, the values.
fn report_lines(scene: &Scene, state: EffectState) -> String {
    let line = |status: &EffectStatus| {
        let places = status.facts.iter();
        let places = places.map(|place| format!(" {:?} {}", place.entity, place.index));
        let rule = status.rule.map_or("", Rule::name);
        let (effect, reason) = (status.effect.name(), &status.reason);
        format!("{effect}: {rule} {reason};{}", places.collect::<String>())
    };
    let plan = Plan::new(&validated(scene), RuleSet::ALL);
    let statuses = plan.statuses.iter().filter(|status| status.state == state);
    statuses.map(line).collect::<Vec<_>>().join("\n")
}

/// What [`report_lines`] says of a white ball before a white disc.
const ABSENT: &str = "\
environment:  the scene has no environment;
environment map:  the environment has no image;
emission:  no material emits light;
unlit surfaces:  no material is unlit;
alpha:  all materials are opaque;
blends:  no material is a blend;
light weights:  no light is found both by light sampling and by BSDF sampling;
caustics:  no smooth surface leads light of a sampled light to another;
microfacets:  no material has a microfacet lobe;
compensation:  there is no multiple scattering between microfacets;
clearcoat:  no material has a clearcoat;
sheen:  no material has sheen;
anisotropy:  no material is anisotropic;
iridescence:  no material is iridescent;
translucency:  no material is translucent;
refraction:  no material transmits light;
absorption:  no medium absorbs light;
media:  neither a surface nor the camera is in a medium;
dispersion:  no material disperses light;
textures:  no material has a texture;
corner colours:  no mesh has vertex colours;
corner normals:  no mesh has normals;
normal maps:  no material has a normal map;
lens:  a pinhole camera: the lens radius is 0;";

/// What it says of [`rich`].
const NEEDED: &str = "\
surfaces:  3 of 3 can be hit by a ray; Surface 0
environment:  paths that leave the scene hit the environment light; Environment 0
environment map:  the environment has an image; Environment 0
emission:  1 material; Material 2
direct light:  a surface is illuminated by a light that can be sampled; Light 0
shadows:  a surface may shadow another or itself; Light 0
light weights:  light sampling and BSDF sampling find the same light; Light 0
bounces:  at most 2 bounces; Settings 0
microfacets:  1 material; Material 0
compensation:  there is multiple scattering between microfacets; Settings 0
clearcoat:  2 materials; Material 0 Material 1
textures:  a material has a texture; Material 2
corner colours:  a mesh has vertex colours; Surface 0
corner normals:  a mesh has vertex normals; Surface 0
normal maps:  a material has a normal map; Material 2
lens:  a lens of radius 0.25; Camera 0
supersampling:  4 paths per pixel; Settings 0";

#[test]
fn each_effect_is_told_with_its_reason_and_the_values_that_decided() {
    let plain = illuminated(&white());
    assert_eq!(report_lines(&plain, EffectState::Absent), ABSENT);
    assert_eq!(report_lines(&rich(), EffectState::Needed), NEEDED);
    // The last ray in a scene without emitters hits none.
    let needed = report_lines(&plain, EffectState::Needed);
    assert!(needed.contains("bounces:  at most 1 bounce;"), "{needed}");
}

#[test]
fn what_is_pruned_is_told_with_its_own_rule() {
    // A black light was removed before.
    let rule = "P-ALPHA alpha is 1, or above the cutoff, everywhere on the surfaces";
    let report_lines = report_lines(&rich(), EffectState::Pruned);
    assert_eq!(report_lines, format!("alpha: {rule}; Material 1"));
}

/// A scene that requires nearly everything, and some of it without contribution.
fn rich() -> Scene {
    let coated = Standard {
        clearcoat: 1.0,
        specular: 1.0,
        ..white()
    };
    let mut scene = illuminated(&coated);
    standard(&mut scene.materials[1]).clearcoat = 0.5;
    standard(&mut scene.materials[1]).alpha = Alpha::Blend;
    sky(&mut scene, 1.0, Some([9, 10]));
    scene.textures = vec![Texture::Image(ImageId(0))];
    let with_normals_and_colors = |mesh: &mut ir::Mesh| {
        mesh.normals = vec![[0.0, 0.0, 1.0]; 3].into();
        mesh.colors = vec![[0.5; 4]; 3].into();
    };
    cover(&mut scene, with_normals_and_colors, |m| {
        (m.emissive, m.base_color_map, m.normal_map) = ([1.0; 3], Some(FIRST), Some(FIRST));
    });
    path(&mut scene).multiple_scattering = true;
    scene.camera.lens = ir::Lens {
        radius: 0.25,
        samples: 4,
    };
    scene.lights.push(ir::Light::Punctual(Punctual {
        emitter: PunctualKind::Sun {
            direction: [0.0, 0.0, 1.0],
        },
        intensity: [0.0; 3],
        projected: None,
    }));
    scene
}
