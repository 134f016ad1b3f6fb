//! Random materials of all parameters, from outside and from inside: in a uniform sky of radiance 1
//! none is brighter than 1.

use super::{albedo, view};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rtc::internals::math::{ComplexIndex, Microfacets, Plastic, Vec3};
use rtc::internals::render::{
    Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, PlasticBoundary, Sheen,
    StandardParameters,
};

/// What interpolated tables and a finite number of samples may add: a view of some thousand is off
/// by more than 0.03, at grazing angles of drawn-out facets.
const LIMIT: f64 = 1.06;

/// What the fitted sheen of cloth may add.
const SHEEN: f64 = 0.03;

/// The cosines of the views, from both sides.
const COSINES: [f64; 6] = [1.0, 0.6, 0.25, 0.08, -0.5, -0.9];

/// A number in [0, 1], often one of its ends.
fn unit() -> BoxedStrategy<f64> {
    prop_oneof![1 => Just(0.0), 1 => Just(1.0), 3 => 0.0..1.0].boxed()
}

fn color() -> BoxedStrategy<Vec3> {
    let any = [unit(), unit(), unit()].prop_map(Vec3::from_array);
    prop_oneof![2 => Just(Vec3::ONE), 1 => any].boxed()
}

/// A layer, or none.
fn layer<T: Clone + std::fmt::Debug + 'static>(
    of: impl Strategy<Value = T> + 'static,
) -> BoxedStrategy<Option<T>> {
    prop_oneof![2 => Just(None), 1 => of.prop_map(Some)].boxed()
}

fn facets() -> BoxedStrategy<Microfacets> {
    let kinds = [
        Microfacets::Ggx,
        Microfacets::Ggx,
        Microfacets::SeparableGgx,
        Microfacets::Beckmann,
    ];
    prop::sample::select(kinds.to_vec()).boxed()
}

fn turned() -> BoxedStrategy<[f64; 2]> {
    (0.0..std::f64::consts::TAU)
        .prop_map(|angle: f64| [angle.cos(), angle.sin()])
        .boxed()
}

/// The boundary of a plastic but for its index and roughness, which are those of the material.
fn plastic() -> BoxedStrategy<Option<Plastic>> {
    let kinds = [Plastic::Linear, Plastic::Nonlinear, Plastic::Single];
    layer(prop::sample::select(kinds.to_vec()))
}

/// A material of random parameters.
pub(super) fn material() -> BoxedStrategy<StandardParameters<'static>> {
    let base = (color(), unit(), unit(), unit(), 0..4_u8, 1.0..3.0_f64);
    let reflection = (unit(), color(), 0.0..3.0_f64, facets(), plastic());
    let walls = (any::<bool>(), any::<bool>(), any::<bool>());
    let metal = layer(prop::sample::select(vec![
        ComplexIndex {
            eta: Vec3::new(0.14, 0.37, 1.44),
            k: Vec3::new(3.98, 2.38, 1.6),
        },
        ComplexIndex {
            eta: Vec3::splat(1.6),
            k: Vec3::splat(0.4),
        },
    ]));
    let layers = (
        layer((unit(), turned())),
        layer((unit(), unit(), -0.4..0.4_f64, -0.4..0.4_f64)),
        layer((color(), unit())),
        layer((unit(), 1.0..2.5_f64, 0.0..1200.0_f64)),
        layer((unit(), color())),
    );
    let all = (base, reflection, walls, metal, layers);
    let made = all.prop_map(|(base, reflection, walls, metal, layers)| {
        let (base_color, metallic, roughness, transmission, kind, ior) = base;
        let (specular, specular_color, strong, facets, plastic) = reflection;
        let (thin_walled, has_two_faces, multiple_scattering) = walls;
        let (anisotropy, clearcoat, sheen, iridescence, leaf) = layers;
        // An index is that of air or infinite now and then.
        let ior = match kind {
            0 => 1.0,
            1 if plastic.is_none() => 0.0,
            _ => ior,
        };
        let boundary = plastic.map(|plastic| {
            &*Box::leak(Box::new(PlasticBoundary::new(
                plastic, ior, roughness, facets,
            )))
        });
        StandardParameters {
            base_color,
            metallic,
            roughness,
            ior,
            conductor: metal,
            facets,
            plastic: boundary,
            specular,
            specular_color: specular_color * strong,
            transmission,
            thin_walled,
            has_two_faces: has_two_faces && thin_walled,
            anisotropy: anisotropy.map(|(strength, direction)| Anisotropy {
                strength,
                direction,
            }),
            clearcoat: clearcoat.map(|(factor, roughness, x, y)| Clearcoat {
                factor,
                roughness,
                normal: Vec3::new(x, y, 1.0).normalize(),
            }),
            sheen: sheen.map(|(color, roughness)| Sheen { color, roughness }),
            iridescence: iridescence.map(|(factor, ior, thickness)| Iridescence {
                factor,
                ior,
                thickness,
            }),
            diffuse_transmission: leaf.map(|(factor, color)| DiffuseTransmission { factor, color }),
            multiple_scattering,
        }
    });
    made.boxed()
}

/// The brightest channel from a view; a doubtful number is taken again of more samples.
fn brightest(standard: &StandardParameters<'_>, cosine: f64, limit: f64) -> f64 {
    let counts = [1 << 11, 1 << 14, 1 << 17];
    let mut found = 0.0;
    for count in counts {
        found = albedo(standard, view(cosine), count).max_element();
        if found <= limit {
            break;
        }
    }
    found
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_material_of_any_parameters_is_brighter_than_its_furnace(standard in material()) {
        let limit = LIMIT + if standard.sheen.is_some() { SHEEN } else { 0.0 };
        for cosine in COSINES {
            let found = brightest(&standard, cosine, limit);
            prop_assert!(found <= limit, "cos {cosine}: {found}");
        }
    }
}
