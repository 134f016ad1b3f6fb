//! The rules on the materials and lights of paths, at the edge of each condition: a scene where the
//! rule holds, and one where a single number is another.

use super::path_rules::{across, add, fires, lamp, placed, traced, white};
use super::proven;
use super::stage::ball;
use rtc::ir::{
    self, Alpha, ImageId, Map, Mode, Pixels, Punctual, Scene, Standard, Texture, TextureId,
};
use rtc::plan::{Effect, Plan, Rule, Rules};

/// A map of the first texture.
const FIRST: Map = Map {
    texture: TextureId(0),
    set: 0,
    texture_from_surface: None,
};

/// A mirror.
fn mirror() -> Standard {
    Standard {
        metallic: 1.0,
        roughness: 0.0,
        ..white()
    }
}

/// A ball under a lamp.
fn lit(material: Standard) -> Scene {
    let mut scene = traced(&[(ball([0.0; 3], 1.0), material)]);
    scene.lights = vec![lamp([3.0, 4.0, 5.0])];
    scene
}

#[test]
fn lights_are_not_aimed_at_where_all_materials_are_mirrors_or_clear_glass() {
    let is_delta = |change: fn(&mut Standard)| {
        let mut material = mirror();
        change(&mut material);
        fires(Rule::PathDelta, &lit(material))
    };
    let glass = |m: &mut Standard| (m.metallic, m.transmission) = (0.0, 1.0);
    let black = |m: &mut Standard| (m.metallic, m.base_color) = (0.0, [0.0, 0.0, 0.0, 1.0]);
    assert!(is_delta(|_| ()) && is_delta(glass) && is_delta(black));
    assert!(is_delta(|m| m.clearcoat = 1.0) && is_delta(|m| m.clearcoat_roughness = 0.5));
    assert!(!is_delta(|m| m.metallic = 0.5));
    assert!(!is_delta(|m| m.roughness = 0.1));
    assert!(!is_delta(|m| (m.metallic, m.transmission) = (0.0, 0.5)));
    assert!(!is_delta(
        |m| (m.metallic, m.base_color) = (0.0, [0.0, 0.0, 0.1, 1.0])
    ));
    assert!(!is_delta(
        |m| (m.clearcoat, m.clearcoat_roughness) = (1.0, 0.5)
    ));
    assert!(!is_delta(|m| m.sheen_color = [0.5; 3]));
    assert!(!is_delta(|m| m.specular_glossiness = Some([0.5; 4])));
    let mut scene = lit(mirror());
    if let Mode::Path(path) = &mut scene.settings.mode {
        path.multiple_scattering = true;
    }
    assert!(
        !fires(Rule::PathDelta, &scene),
        "compensation spreads light"
    );
}

#[test]
fn a_light_is_out_of_reach_where_its_range_ends_before_the_surfaces() {
    let ranged = |end: f64| {
        let mut scene = lit(white());
        let mut light = lamp([0.0, 0.0, 5.0]);
        if let ir::Light::Punctual(Punctual {
            emitter: ir::Emitter::Point { range, .. },
            ..
        }) = &mut light
        {
            *range = Some(end);
        }
        scene.lights = vec![light];
        scene
    };
    // The box of the ball ends four units before the lamp.
    assert!(fires(Rule::PathLightReach, &ranged(3.999)));
    assert!(!fires(Rule::PathLightReach, &ranged(4.001)));
}

/// The number of maps that are left of a material on a triangle with texture coordinates.
fn maps_left(change: impl Fn(&mut Standard, Option<Map>)) -> usize {
    let mut scene = traced(&[]);
    scene.lights = vec![lamp([3.0, 4.0, 5.0])];
    scene.textures = vec![Texture::Uv];
    let mut material = white();
    change(&mut material, Some(FIRST));
    let shape = placed(&mut scene, across());
    add(&mut scene, &shape, &material);
    // The picture keeps its bits.
    fires(Rule::PathMapUnseen, &scene);
    let plan = Plan::new(&proven(&scene), Rules::ALL);
    plan.paths.unwrap().materials[0].maps().count()
}

#[test]
fn maps_that_multiply_0_are_not_looked_up() {
    let rough = |metallic: f64, roughness: f64| {
        maps_left(|m, map| {
            (m.metallic, m.roughness, m.metallic_roughness_map) = (metallic, roughness, map);
        })
    };
    assert_eq!(
        [rough(0.0, 0.0), rough(0.0, 0.5), rough(1.0, 0.0)],
        [0, 1, 1]
    );
    for (weight, left) in [(0.0, 0), (0.5, 1)] {
        assert_eq!(
            maps_left(|m, map| (m.specular, m.specular_map) = (weight, map)),
            left
        );
        let color = [0.0, weight, 0.0];
        let tint = |m: &mut Standard, map| (m.specular_color, m.specular_color_map) = (color, map);
        assert_eq!(
            maps_left(|m, map| {
                m.specular = 1.0;
                tint(m, map);
            }),
            left
        );
        assert_eq!(
            maps_left(|m, map| (m.emissive, m.emissive_map) = (color, map)),
            left
        );
        let through = |m: &mut Standard, map| (m.transmission, m.transmission_map) = (weight, map);
        assert_eq!(maps_left(through), left);
        let coat = |m: &mut Standard, map| (m.clearcoat, m.clearcoat_normal_map) = (weight, map);
        assert_eq!(maps_left(coat), left);
        let gloss = (left == 1).then_some([0.5; 4]);
        let glossy = |m: &mut Standard, map| {
            (m.specular_glossiness, m.specular_glossiness_map) = (gloss, map);
        };
        assert_eq!(maps_left(glossy), left);
    }
    assert_eq!(maps_left(|m, map| m.thickness_map = map), 0);
    assert_eq!(maps_left(|m, map| m.normal_map = map), 1);
    assert_eq!(maps_left(|m, map| (m.unlit, m.normal_map) = (true, map)), 0);
    assert_eq!(
        maps_left(|m, map| (m.unlit, m.base_color_map) = (true, map)),
        1
    );
}

#[test]
fn a_texture_is_opaque_where_all_its_texels_are() {
    let veil = |alpha: u8| {
        let mut scene = traced(&[(ball([0.0; 3], 1.0), white())]);
        let texel = |alpha: u8| [200, 100, 50, alpha];
        scene.images.push(ir::Image {
            name: "veil".to_owned(),
            width: 2,
            height: 1,
            kind: Pixels::Rgba8,
            pixels: [texel(255), texel(alpha)].concat().into(),
        });
        scene.textures = vec![Texture::Image(ImageId(0))];
        let material = Standard {
            alpha: Alpha::Blend,
            base_color_map: Some(FIRST),
            ..white()
        };
        let shape = placed(&mut scene, across());
        add(&mut scene, &shape, &material);
        scene
    };
    assert!(fires(Rule::PathOpaque, &veil(255)));
    assert!(!fires(Rule::PathOpaque, &veil(254)));
    let plan = Plan::new(&proven(&veil(255)), Rules::ALL);
    assert!(
        plan.verdicts
            .iter()
            .all(|verdict| !verdict.because.is_empty())
    );
    let mut verdicts = plan.verdicts.iter();
    let textures = verdicts.find(|verdict| verdict.effect == Effect::Textures);
    assert_eq!(textures.unwrap().facts.len(), 1, "the material with a map");
}
