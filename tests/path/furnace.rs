//! Closed balls of random materials in a sky of radiance 1, seen from outside and from inside: none
//! is brighter than its furnace, however long its paths are.

use super::{add_sphere, mean, render, scene, sky};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rtc::internals::ir::{Conductor, Mode, PathSettings, Projection, Scene, Standard};
use rtc::internals::math::{Microfacets, Plastic};

/// What tables and noise may add.
const LIMIT: f64 = 1.05;

fn unit() -> BoxedStrategy<f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 3 => 0.0..1.0].boxed()
}

fn color() -> BoxedStrategy<[f64; 3]> {
    let any = [unit(), unit(), unit()];
    prop_oneof![2 => Just([1.0; 3]), 1 => any].boxed()
}

/// A number that is 0 in half of the materials.
fn layer() -> BoxedStrategy<f64> {
    prop_oneof![1 => Just(0.0), 1 => unit()].boxed()
}

/// A material of all parameters that have no map.
fn material() -> BoxedStrategy<Standard> {
    let kinds = (
        prop::sample::select(vec![
            Microfacets::Ggx,
            Microfacets::SeparableGgx,
            Microfacets::Beckmann,
        ]),
        prop::sample::select(vec![
            Plastic::None,
            Plastic::None,
            Plastic::Linear,
            Plastic::Nonlinear,
            Plastic::Single,
        ]),
        prop::sample::select(vec![
            None,
            None,
            Some(Conductor {
                eta: [0.14, 0.37, 1.44],
                k: [3.98, 2.38, 1.6],
            }),
        ]),
        (any::<bool>(), any::<bool>(), any::<bool>()),
    );
    let base = (color(), unit(), unit(), 1.0..2.6_f64);
    let dielectric = (unit(), color(), 0.0..3.0_f64, layer(), layer());
    let layers = (
        (layer(), unit()),
        (layer(), color(), unit()),
        (layer(), unit()),
        (layer(), 1.0..2.5_f64, 0.0..1200.0_f64),
        (layer(), color()),
    );
    let all = (kinds, base, dielectric, layers).prop_map(|(kinds, base, dielectric, layers)| {
        let (microfacets, plastic, conductor, [bounds_a_volume, thin_dielectric, absorbs]) =
            (kinds.0, kinds.1, kinds.2, <[bool; 3]>::from(kinds.3));
        let ([r, g, b], metallic, roughness, ior) = base;
        let (specular, tint, strong, transmission, dispersion) = dielectric;
        let (coat, sheen, brushed, film, leaf) = layers;
        Standard {
            base_color: [r, g, b, 1.0],
            metallic,
            roughness,
            ior,
            microfacets,
            plastic,
            conductor,
            specular,
            specular_color: tint.map(|channel| channel * strong),
            transmission,
            dispersion,
            thickness: f64::from(u8::from(bounds_a_volume)),
            thin_dielectric,
            attenuation_distance: absorbs.then_some(0.5),
            attenuation_color: [0.9, 1.0, 0.5],
            clearcoat: coat.0,
            clearcoat_roughness: coat.1,
            sheen_color: sheen.1.map(|channel| channel * sheen.0),
            sheen_roughness: sheen.2,
            anisotropy: brushed.0,
            anisotropy_rotation: brushed.1,
            iridescence: film.0,
            iridescence_ior: film.1,
            iridescence_thickness: [0.5 * film.2, film.2],
            diffuse_transmission: leaf.0,
            diffuse_transmission_color: leaf.1,
            double_sided: true,
            ..Standard::default()
        }
    });
    all.boxed()
}

/// A ball of a material that fills the view, in a furnace.
fn furnace(standard: &Standard, samples: u32) -> Scene {
    let mut scene = scene(samples);
    scene.settings.mode = Mode::Path(PathSettings {
        samples,
        multiple_scattering: true,
        ..PathSettings::default()
    });
    scene.settings.max_depth = 64;
    scene.environment = sky(1.0);
    scene.camera.size = [4, 4];
    (scene.camera.right, scene.camera.up) = ([0.3, 0.0, 0.0], [0.0, 0.3, 0.0]);
    scene.camera.projection = Projection::Orthographic;
    add_sphere(&mut scene, [0.0; 3], 1.0, standard.clone());
    scene
}

/// The mean of a furnace's picture; a doubtful one is taken again of more samples.
fn seen(standard: &Standard, is_inside: bool) -> f64 {
    let mut found = 0.0;
    for samples in [16, 256, 4096] {
        let mut scene = furnace(standard, samples);
        if is_inside {
            (scene.camera.eye, scene.camera.center) = ([0.0, 0.0, 0.3], [0.1, 0.2, 0.0]);
        }
        found = mean(&render(&scene)).max_element();
        if found <= limit(standard, is_inside) {
            break;
        }
    }
    found
}

/// In a body of the index n, light from outside is n² as bright.
fn limit(standard: &Standard, is_inside: bool) -> f64 {
    let is_body = standard.transmission > 0.0 && standard.thickness > 0.0;
    let widest = standard.ior + (standard.ior - 1.0) * 0.025 * standard.dispersion;
    match is_inside && is_body {
        true => LIMIT * widest * widest,
        false => LIMIT,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_ball_is_brighter_than_its_furnace(standard in material()) {
        for is_inside in [false, true] {
            let found = seen(&standard, is_inside);
            prop_assert!(found <= limit(&standard, is_inside), "inside {is_inside}: {found}");
        }
    }
}

/// A body that transmits half of its light made 54 times as much of it, and a plastic that lets
/// light through 5 times.
#[test]
fn mixtures_with_glass_and_plastic_keep_what_they_get() {
    let glass = Standard {
        metallic: 0.0,
        roughness: 0.0,
        transmission: 1.0,
        thickness: 1.0,
        ..Standard::default()
    };
    for transmission in [0.1, 0.5, 0.9] {
        for roughness in [0.0, 0.5] {
            let half = Standard {
                transmission,
                roughness,
                ..glass.clone()
            };
            let found = seen(&half, false);
            assert!(
                (0.97..=LIMIT).contains(&found),
                "{transmission} {roughness}: {found}"
            );
        }
    }
    for diffuse_transmission in [0.5, 1.0] {
        let leaf = Standard {
            roughness: 0.4,
            transmission: 0.0,
            plastic: Plastic::Nonlinear,
            diffuse_transmission,
            ..glass.clone()
        };
        let found = seen(&leaf, false);
        assert!(
            (0.75..=LIMIT).contains(&found),
            "{diffuse_transmission}: {found}"
        );
    }
}

#[test]
fn brushed_rough_glass_loses_hardly_any_light() {
    for (roughness, anisotropy) in [(0.05, 1.0), (0.3, 0.7), (0.6, 1.0)] {
        let brushed = Standard {
            metallic: 0.0,
            transmission: 1.0,
            thickness: 1.0,
            roughness,
            anisotropy,
            ..Standard::default()
        };
        let found = seen(&brushed, false);
        assert!(
            (0.95..=LIMIT).contains(&found),
            "{roughness} {anisotropy}: {found}"
        );
    }
}
