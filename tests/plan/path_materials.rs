//! The rules on the materials and lights of paths, at the edge of each condition: a scene where the
//! rule holds, and one where a single number is another.

use super::path_rules::{across, add, fires, light_source, placed, traced, white};
use super::scenes::ball;
use super::validated;
use crate::ray_counts::film;
use rtc::internals::ir::{
    self, Alpha, ImageId, Map, Mode, Pixels, Punctual, Scene, Standard, Texture, TextureId,
};
use rtc::internals::plan::{Effect, Plan, Rule, RuleSet};
use std::ops::Range;

/// A map of the first texture.
pub(super) const FIRST: Map = Map {
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

/// A sphere under a light.
fn illuminated(material: Standard) -> Scene {
    let mut scene = traced(&[(ball([0.0; 3], 1.0), material)]);
    scene.lights = vec![light_source([3.0, 4.0, 5.0])];
    scene
}

#[test]
fn lights_are_not_aimed_at_where_all_materials_are_mirrors_or_clear_glass() {
    let is_delta = |change: fn(&mut Standard)| {
        let mut material = mirror();
        change(&mut material);
        fires(Rule::PathDelta, &illuminated(material))
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
    let mut scene = illuminated(mirror());
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
        let mut scene = illuminated(white());
        let mut light = light_source([0.0, 0.0, 5.0]);
        if let ir::Light::Punctual(Punctual {
            emitter: ir::PunctualKind::Point { range, .. },
            ..
        }) = &mut light
        {
            *range = Some(end);
        }
        scene.lights = vec![light];
        scene
    };
    // The bounding box of the sphere ends four units before the light.
    assert!(fires(Rule::PathLightReach, &ranged(3.999)));
    assert!(!fires(Rule::PathLightReach, &ranged(4.001)));
}

/// The number of remaining maps of a material on a triangle with texture coordinates.
fn maps_left(change: impl Fn(&mut Standard, Option<Map>)) -> usize {
    maps_left_after(2, change)
}

/// Like [`maps_left`], for paths with some bounces.
fn maps_left_after(bounces: u32, change: impl Fn(&mut Standard, Option<Map>)) -> usize {
    let mut scene = traced(&[]);
    scene.settings.max_depth = bounces;
    scene.lights = vec![light_source([3.0, 4.0, 5.0])];
    scene.textures = vec![Texture::Uv];
    let mut material = white();
    change(&mut material, Some(FIRST));
    let shape = placed(&mut scene, across());
    add(&mut scene, &shape, &material);
    // The picture keeps its bits.
    fires(Rule::PathMapUnseen, &scene);
    let plan = Plan::new(&validated(&scene), RuleSet::ALL);
    plan.paths
        .unwrap()
        .materials
        .first()
        .unwrap()
        .maps()
        .count()
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
fn maps_that_only_light_needs_are_not_looked_up_where_no_path_goes_on() {
    const MAP: Option<Map> = Some(FIRST);
    let change = |m: &mut Standard, _| {
        (m.metallic_roughness_map, m.normal_map) = (MAP, MAP);
        (m.clearcoat, m.clearcoat_map, m.clearcoat_normal_map) = (1.0, MAP, MAP);
        (m.emissive, m.emissive_map, m.base_color_map) = ([1.0; 3], MAP, MAP);
    };
    assert_eq!(maps_left_after(1, change), 6);
    assert_eq!(maps_left_after(0, change), 2, "emission, and alpha");
    assert_eq!(maps_left(|m, map| m.clearcoat_map = map), 0);
}

/// A ball, and a material with a map of two texels on a triangle before it.
fn mapped([first, second]: [[u8; 4]; 2], change: impl Fn(&mut Standard)) -> Scene {
    let mut scene = illuminated(white());
    scene.images.push(ir::Image {
        name: "mapped".to_owned(),
        width: 2,
        height: 1,
        kind: Pixels::Rgba8,
        pixels: [first, second].concat().into(),
    });
    scene.textures = vec![Texture::Image(ImageId(0))];
    let mut material = white();
    change(&mut material);
    let shape = placed(&mut scene, across());
    add(&mut scene, &shape, &material);
    scene
}

/// A weight, with a map of it, and the channels of the map that count.
type Weight = (fn(&mut Standard), Range<usize>);

const WEIGHTS: [Weight; 9] = [
    (|m| (m.specular, m.specular_map) = (1.0, Some(FIRST)), 3..4),
    (
        |m| (m.emissive, m.emissive_map) = ([1.0; 3], Some(FIRST)),
        0..3,
    ),
    (
        |m| (m.clearcoat, m.clearcoat_map) = (1.0, Some(FIRST)),
        0..1,
    ),
    (
        |m| (m.sheen_color, m.sheen_color_map) = ([1.0; 3], Some(FIRST)),
        0..3,
    ),
    (
        |m| (m.anisotropy, m.anisotropy_map) = (1.0, Some(FIRST)),
        2..3,
    ),
    (
        |m| (m.iridescence, m.iridescence_map) = (1.0, Some(FIRST)),
        0..1,
    ),
    (
        |m| (m.diffuse_transmission, m.diffuse_transmission_map) = (1.0, Some(FIRST)),
        3..4,
    ),
    (
        |m| (m.transmission, m.transmission_map) = (1.0, Some(FIRST)),
        0..1,
    ),
    // The back of a slightly transmissive solid is visible.
    (
        |m| {
            (m.transmission, m.transmission_map) = (1.0, Some(FIRST));
            m.double_sided = false;
        },
        0..1,
    ),
];

#[test]
fn a_weight_is_0_where_its_map_is_0_in_the_channels_that_count() {
    for (row, (change, channels)) in WEIGHTS.into_iter().enumerate() {
        for channel in 0..4 {
            let mut texel = [0; 4];
            texel[channel] = 255;
            let mut scene = mapped([texel; 2], change);
            // Its back is before the camera.
            scene.meshes[0].triangles = vec![[0, 2, 1]].into();
            let is_zero = !channels.contains(&channel);
            assert_eq!(fires(Rule::PathZero, &scene), is_zero, "{row}: {channel}");
        }
    }
    let scene = mapped([[0; 4]; 2], |m| m.specular_map = Some(FIRST));
    assert!(!fires(Rule::PathZero, &scene), "the weight is 0 already");
}

#[test]
fn an_unlit_material_keeps_its_colour_its_alpha_and_its_sides() {
    let texels = [[200, 100, 50, 255], [100, 200, 50, 255]];
    let unlit = |change: fn(&mut Standard)| {
        let mut scene = mapped(texels, |m| {
            (m.unlit, m.base_color) = (true, [0.9, 0.8, 0.7, 0.5]);
            (m.base_color_map, m.normal_map) = (Some(FIRST), Some(FIRST));
            change(m);
        });
        scene.meshes[0].triangles = vec![[0, 2, 1]].into();
        assert!(fires(Rule::PathUnlitMaterial, &scene));
        film(&validated(&scene), RuleSet::ALL).image.pixels
    };
    let (both, one) = (unlit(|_| ()), unlit(|m| m.double_sided = false));
    assert_ne!(both, one, "its back is before the camera");
    assert_eq!(
        both,
        unlit(|m| (m.double_sided, m.transmission) = (false, 1.0))
    );
    assert_ne!(both, unlit(|m| m.alpha = Alpha::Blend));
}

#[test]
fn a_texture_is_opaque_where_all_its_texels_are() {
    let veil = |alpha: u8| {
        let texel = |alpha: u8| [200, 100, 50, alpha];
        mapped([texel(255), texel(alpha)], |m| {
            (m.alpha, m.base_color_map) = (Alpha::Blend, Some(FIRST));
        })
    };
    assert!(fires(Rule::PathOpaque, &veil(255)));
    assert!(!fires(Rule::PathOpaque, &veil(254)));
    let plan = Plan::new(&validated(&veil(255)), RuleSet::ALL);
    assert!(plan.statuses.iter().all(|status| !status.reason.is_empty()));
    let mut statuses = plan.statuses.iter();
    let textures = statuses.find(|status| status.effect == Effect::Textures);
    assert_eq!(textures.unwrap().facts.len(), 1, "the material with a map");
}

#[test]
fn a_mask_is_opaque_where_all_texels_are_above_its_cutoff_by_a_margin() {
    let half = f64::from(128.0_f32 / 255.0);
    let is_opaque = |factor: f64, alphas: [u8; 2], cutoff: f64| {
        let scene = mapped(alphas.map(|alpha| [200, 100, 50, alpha]), |m| {
            (m.base_color[3], m.alpha) = (factor, Alpha::Mask(cutoff));
            m.base_color_map = Some(FIRST);
        });
        fires(Rule::PathOpaque, &scene)
    };
    // Filtering blends unequal texels, with rounding.
    for factor in [1.0, 0.5] {
        let edge = factor * half;
        assert!(is_opaque(factor, [128, 255], edge - 2e-6));
        assert!(!is_opaque(factor, [128, 255], edge - 1e-6));
        assert!(!is_opaque(factor, [128, 255], edge - 5e-7));
        assert!(!is_opaque(factor, [128, 255], edge + 0.01));
        assert!(is_opaque(factor, [128, 128], edge));
        assert!(!is_opaque(factor, [128, 128], edge + 1e-9));
    }
}

#[test]
fn a_map_without_texture_coordinates_is_1() {
    let veil = |with: &[bool]| {
        let mut scene = mapped([[255, 255, 255, 128]; 2], |m| {
            (m.alpha, m.base_color_map) = (Alpha::Mask(0.9), Some(FIRST));
        });
        scene.surfaces.truncate(1);
        for has_uvs in with {
            let mut mesh = across();
            if !has_uvs {
                mesh.uvs = Vec::<[f64; 2]>::new().into();
            }
            let shape = placed(&mut scene, mesh);
            scene
                .surfaces
                .push(ir::Surface::new(shape, ir::MaterialId(1)));
        }
        fires(Rule::PathOpaque, &scene)
    };
    assert!(veil(&[false]) && veil(&[false, false]));
    assert!(!veil(&[true]) && !veil(&[true, false]) && !veil(&[false, true]));
}
