//! Bounces are cut off once the remaining contribution is below half a level of 8 bits, and not
//! earlier.

use super::scenes::{ball, diffuse, first_light, material, texture, with};
use super::validated;
use rtc::internals::ir::{Phong, Scene, Texture, TextureId};
use rtc::internals::plan::{Plan, Rule, RuleSet};

/// Two spheres that reflect each other without end. A point contributes ks + kt of the radiance it
/// reflects, and at most (ka + kd) · 0.8 + ks = 1.1 of a white light.
fn mirrors() -> Scene {
    let phong = Phong {
        color: [0.8, 0.2, 0.4],
        ka: 0.3,
        kd: 0.7,
        ks: 0.3,
        kt: 0.1,
        ..diffuse()
    };
    let mut scene = with(&[
        (ball([-1.2, 0.0, 0.0], 1.0), phong.clone()),
        (ball([1.2, 0.0, 0.0], 1.0), phong),
    ]);
    scene.settings.max_depth = 60;
    scene
}

fn depth(scene: &Scene) -> u32 {
    Plan::new(&validated(scene), RuleSet::ALL.with(Rule::Cut)).max_depth
}

/// Asserts the number of remaining bounces, and that the rest is below half a level: Σ weightⁱ over
/// all greater i, times the direct contribution of a point.
fn is_cut(scene: &Scene, weight: f64, point: f64) {
    for bounces in [1, 4, 9] {
        let powers = (0..=bounces).fold(1.0, |power, _| power * weight);
        let enough = 0.5 / 255.0 * (1.0 - weight) / (powers * point);
        for (light, wanted) in [(0.999 * enough, bounces), (1.001 * enough, bounces + 1)] {
            let mut scene = scene.clone();
            first_light(&mut scene).color = [0.25 * light, light, 0.5 * light];
            assert_eq!(depth(&scene), wanted, "a light of {light}");
        }
    }
}

#[test]
fn bounces_are_cut_off_where_the_rest_is_half_a_level() {
    is_cut(&mirrors(), 0.4, 1.1);
    // A remainder of exactly half a level is not below it.
    let mut exact = mirrors();
    let phong = Phong {
        color: [1.0; 3],
        ka: 0.25,
        kd: 0.5,
        ks: 0.25,
        kt: 0.25,
        ..diffuse()
    };
    (0..2).for_each(|index| *material(&mut exact, index) = phong.clone());
    first_light(&mut exact).color = [0.5 / 255.0; 3];
    assert_eq!(depth(&exact), 1);
    let mut black = mirrors();
    first_light(&mut black).color = [0.0; 3];
    assert_eq!(depth(&black), 0);
}

#[test]
fn the_brightest_and_the_clearest_material_count_and_all_lights_do() {
    let mut scene = mirrors();
    (material(&mut scene, 0).kt, material(&mut scene, 1).kd) = (0.2, 1.7);
    is_cut(&scene, 0.5, 1.9);
    // Two lights of the same colour count twice.
    let mut scene = mirrors();
    first_light(&mut scene).color = [0.0, 0.01, 0.0];
    let one = depth(&scene);
    first_light(&mut scene).color = [0.0, 0.02, 0.0];
    let double = depth(&scene);
    first_light(&mut scene).color = [0.0, 0.01, 0.0];
    scene.lights.push(scene.lights[0].clone());
    assert!(double > one && depth(&scene) == double);
}

#[test]
fn a_texture_counts_by_its_value_or_as_white_where_it_has_several() {
    let mapped = |last: [u8; 3]| {
        let mut scene = mirrors();
        let texture = texture(&mut scene, [51, 204, 102], last);
        (0..2).for_each(|index| material(&mut scene, index).color_map = Some(texture));
        scene
    };
    is_cut(&mapped([51, 204, 102]), 0.4, 1.1);
    is_cut(&mapped([0; 3]), 0.4, 1.3);
    let specular = |last: [u8; 3]| {
        let mut scene = mapped(last);
        for index in 0..2 {
            let phong = material(&mut scene, index);
            (phong.color_map, phong.specular_map) = (None, phong.color_map);
        }
        scene
    };
    // 51 of 255 of ks.
    is_cut(&specular([51, 204, 102]), 0.16, 0.86);
    is_cut(&specular([0; 3]), 0.4, 1.1);
}

#[test]
fn nothing_is_cut_off_where_bounces_add_as_much_as_the_first_or_have_no_bound() {
    for (ks, kt) in [(0.5, 0.5), (0.9, 0.9)] {
        let mut clear = mirrors();
        (0..2).for_each(|index| {
            (
                material(&mut clear, index).ks,
                material(&mut clear, index).kt,
            ) = (ks, kt)
        });
        assert_eq!(depth(&clear), 60);
    }
    let mut scene = mirrors();
    scene.textures.push(Texture::Uv);
    material(&mut scene, 0).color_map = Some(TextureId(0));
    assert_eq!(depth(&scene), 60);
}
