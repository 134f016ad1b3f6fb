//! The effects of each material parameter in a path-traced scene: a change adds the named effects
//! and no others. The picture has exactly these, and the kernel exactly their features.

use super::path_rules::{light_source, traced, white};
use super::scenes::{ball, disc};
use super::validated;
use crate::ray_counts::{contradictions, film};
use rtc::internals::ir::{Alpha, MaterialId, Scene, Standard};
use rtc::internals::plan::{Effect, EffectState, Layer, PathFeatures, Plan, RuleSet};

/// A sphere of a material before a white disc, under a light.
pub(super) fn illuminated(material: &Standard) -> Scene {
    let mut scene = traced(&[
        (ball([0.0; 3], 1.0), material.clone()),
        (disc([0.0, 0.0, -2.0], 3.0), white()),
    ]);
    scene.lights = vec![light_source([3.0, 4.0, 5.0])];
    scene
}

/// The effects that a scene needs, and the features of its kernel. The picture has these effects
/// and no others.
pub(super) fn needs(scene: &Scene) -> (Vec<Effect>, PathFeatures) {
    let proof = validated(scene);
    let contradictions = contradictions(&proof, &film(&proof, RuleSet::ALL).counts);
    assert!(contradictions.is_empty(), "{contradictions:?}");
    let plan = Plan::new(&proof, RuleSet::ALL);
    let needed = plan
        .statuses
        .iter()
        .filter(|v| v.state == EffectState::Needed);
    let effects = needed.map(|status| status.effect).collect();
    (effects, plan.paths.unwrap().features)
}

/// Effects that are not among others.
pub(super) fn beyond(effects: &[Effect], others: &[Effect]) -> Vec<Effect> {
    let is_new = |effect: &&Effect| !others.contains(effect);
    effects.iter().filter(is_new).copied().collect()
}

pub(super) const LIT: PathFeatures = PathFeatures::NEE.with(PathFeatures::SHADOWS);
pub(super) const GLOSSY: PathFeatures = LIT.with(PathFeatures::MICROFACETS);
const GLASS: PathFeatures = GLOSSY.with(PathFeatures::TRANSMISSION);
pub(super) const LAYERED: PathFeatures = LIT.with(PathFeatures::LAYERS);

#[test]
fn a_white_ball_before_a_disc_calls_for_light_shadows_and_a_bounce() {
    let effects = [
        Effect::Surfaces,
        Effect::DirectLight,
        Effect::Shadows,
        Effect::Depth,
        Effect::Supersampling,
    ];
    assert_eq!(needs(&illuminated(&white())), (effects.to_vec(), LIT));
}

/// A name, a change of the white material, the effects that it adds, and the resulting features.
type OfMaterial = (
    &'static str,
    fn(&mut Standard),
    &'static [Effect],
    PathFeatures,
);

/// Clear glass that absorbs light.
fn absorbing(m: &mut Standard) {
    (m.specular, m.transmission, m.thickness) = (1.0, 0.5, 1.0);
    (m.attenuation_distance, m.attenuation_color) = (Some(1.0), [0.5; 3]);
}

const OF_MATERIALS: [OfMaterial; 24] = [
    (
        "emission",
        |m| m.emissive = [1.0; 3],
        &[Effect::Emission, Effect::Mis],
        LIT,
    ),
    (
        "unlit, and what that hides",
        |m| (m.unlit, m.clearcoat, m.emissive) = (true, 1.0, [1.0; 3]),
        &[Effect::Unlit],
        LIT,
    ),
    (
        "alpha of a half",
        |m| (m.alpha, m.base_color[3]) = (Alpha::Blend, 0.5),
        &[Effect::Alpha],
        LIT.with(PathFeatures::ALPHA),
    ),
    ("alpha of 1", |m| m.alpha = Alpha::Blend, &[], LIT),
    (
        "a mask at its cutoff",
        |m| (m.alpha, m.base_color[3]) = (Alpha::Mask(0.5), 0.5),
        &[],
        LIT,
    ),
    (
        "a mask below it",
        |m| (m.alpha, m.base_color[3]) = (Alpha::Mask(0.6), 0.5),
        &[Effect::Alpha],
        LIT.with(PathFeatures::ALPHA),
    ),
    (
        "specular",
        |m| m.specular = 0.5,
        &[Effect::Microfacets],
        GLOSSY,
    ),
    (
        "metallic",
        |m| m.metallic = 0.5,
        &[Effect::Microfacets],
        GLOSSY,
    ),
    (
        "glossiness",
        |m| m.specular_glossiness = Some([0.5; 4]),
        &[Effect::Microfacets],
        GLOSSY,
    ),
    (
        "a film",
        |m| (m.iridescence, m.iridescence_thickness) = (0.5, [0.0, 1e2]),
        &[Effect::Microfacets, Effect::Layer(Layer::Iridescence)],
        GLOSSY.with(PathFeatures::LAYERS),
    ),
    (
        "a film of no thickness",
        |m| (m.iridescence, m.iridescence_thickness) = (0.5, [0.0; 2]),
        &[],
        LIT,
    ),
    (
        "transmission",
        |m| (m.specular, m.transmission) = (1.0, 0.5),
        &[Effect::Microfacets, Effect::Refraction],
        GLASS,
    ),
    (
        "absorption",
        absorbing,
        &[Effect::Microfacets, Effect::Refraction, Effect::Volume],
        GLASS,
    ),
    (
        "absorption without a distance",
        |m| {
            absorbing(m);
            m.attenuation_distance = None;
        },
        &[Effect::Microfacets, Effect::Refraction],
        GLASS,
    ),
    (
        "absorption of no colour",
        |m| {
            absorbing(m);
            m.attenuation_color = [1.0; 3];
        },
        &[Effect::Microfacets, Effect::Refraction],
        GLASS,
    ),
    (
        "absorption in a thin wall",
        |m| {
            absorbing(m);
            m.thickness = 0.0;
        },
        &[Effect::Microfacets, Effect::Refraction],
        GLASS,
    ),
    (
        "absorption in a body that no light enters",
        |m| {
            absorbing(m);
            m.transmission = 0.0;
        },
        &[Effect::Microfacets],
        GLOSSY,
    ),
    (
        "dispersion",
        |m| (m.specular, m.transmission, m.dispersion) = (1.0, 0.5, 1.0),
        &[Effect::Microfacets, Effect::Refraction, Effect::Dispersion],
        GLASS,
    ),
    (
        "dispersion of what no light enters",
        |m| m.dispersion = 1.0,
        &[],
        LIT,
    ),
    (
        "a coat",
        |m| m.clearcoat = 0.5,
        &[Effect::Layer(Layer::Clearcoat)],
        LAYERED,
    ),
    (
        "sheen",
        |m| m.sheen_color = [0.5; 3],
        &[Effect::Layer(Layer::Sheen)],
        LAYERED,
    ),
    (
        "anisotropy",
        |m| (m.metallic, m.anisotropy) = (1.0, 0.5),
        &[Effect::Microfacets, Effect::Layer(Layer::Anisotropy)],
        GLOSSY.with(PathFeatures::LAYERS),
    ),
    (
        "translucency",
        |m| m.diffuse_transmission = 0.5,
        &[
            Effect::Layer(Layer::DiffuseTransmission),
            Effect::Refraction,
        ],
        LAYERED.with(PathFeatures::TRANSMISSION),
    ),
    (
        "absorption behind a translucent wall",
        |m| {
            absorbing(m);
            (m.specular, m.transmission, m.diffuse_transmission) = (0.0, 0.0, 0.5);
        },
        &[
            Effect::Layer(Layer::DiffuseTransmission),
            Effect::Refraction,
            Effect::Volume,
        ],
        LAYERED.with(PathFeatures::TRANSMISSION),
    ),
];

#[test]
fn each_parameter_of_a_material_brings_its_effects() {
    let (before, _) = needs(&illuminated(&white()));
    for (name, change, effects, features) in OF_MATERIALS {
        let mut material = white();
        change(&mut material);
        let (after, of_kernel) = needs(&illuminated(&material));
        assert_eq!(beyond(&after, &before), effects, "{name}");
        assert_eq!(beyond(&before, &after), [], "{name}");
        assert_eq!(of_kernel, features, "{name}");
    }
}

#[test]
fn a_blend_has_the_effects_of_both_materials_unless_its_weight_is_0() {
    let (before, _) = needs(&illuminated(&white()));
    let blended = |weight: f64| {
        let mut scene = illuminated(&white());
        // The ball has the last material, after that which it is blended with.
        let metal = Standard {
            metallic: 1.0,
            ..white()
        };
        let blend = Standard {
            blend_with: Some(MaterialId(2)),
            blend_weight: weight,
            ..white()
        };
        scene.materials.push(metal.into());
        scene.materials.push(blend.into());
        scene.surfaces[0].material = MaterialId(3);
        needs(&scene)
    };
    let (both, features) = blended(0.5);
    let added = [Effect::Blend, Effect::Microfacets];
    assert_eq!(beyond(&both, &before), added);
    assert_eq!(features, GLOSSY.with(PathFeatures::ALPHA));
    assert_eq!(blended(0.0), (before, LIT));
}
