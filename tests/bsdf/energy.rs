//! No material makes light, a white one loses none, and reflection is the same both ways.

use super::{albedo, lattice, sampled, variety, view};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Anisotropy, Bsdf, Clearcoat, Sheen, StandardParameters};

#[test]
fn a_white_surface_in_a_white_sky_is_white() {
    for m in 0..=2 {
        for r in 0..=10 {
            let (metallic, roughness) = (f64::from(m) / 2.0, f64::from(r) / 10.0);
            for cosine in [1.0, 0.8, 0.5, 0.3, 0.1, 0.03] {
                let standard = StandardParameters {
                    metallic,
                    roughness,
                    ..StandardParameters::default()
                };
                let whole = albedo(&standard, view(cosine), 1 << 14);
                let error = whole.max_element() - 1.0;
                let at = format!("metallic {metallic}, roughness {roughness}, cos {cosine}");
                assert!(error.abs() < 0.005, "{at}: {whole}");
            }
        }
    }
}

#[test]
fn no_material_sends_out_more_than_it_gets() {
    for (name, standard) in variety() {
        // A coat whose normal leans may return a little more: its cosines are not those of the
        // surface.
        let clearcoat = standard.clearcoat.map(|coat| Clearcoat {
            normal: Vec3::Z,
            ..coat
        });
        let white = StandardParameters {
            base_color: Vec3::ONE,
            multiple_scattering: true,
            clearcoat,
            ..standard
        };
        for cosine in [1.0, 0.7, 0.4, 0.1, -0.1, -0.4, -0.7, -1.0] {
            let whole = albedo(&white, view(cosine), 1 << 13);
            let limit = if white.sheen.is_some() { 1.03 } else { 1.01 };
            assert!(
                whole.max_element() < limit && whole.min_element() >= 0.0,
                "{name}, cos {cosine}: {whole}"
            );
        }
    }
}

#[test]
fn smooth_glass_loses_nothing() {
    for (thin_walled, ior) in [(true, 1.5), (false, 1.5), (false, 2.4), (false, 1.0)] {
        let glass = StandardParameters {
            transmission: 1.0,
            roughness: 0.0,
            thin_walled,
            ior,
            ..StandardParameters::default()
        };
        let glass = StandardParameters {
            multiple_scattering: false,
            ..glass
        };
        for cosine in [1.0, 0.6, 0.2, -0.2, -0.6, -1.0] {
            let whole = albedo(&glass, view(cosine), 1 << 12);
            assert!(
                (whole - Vec3::ONE).abs().max_element() < 1e-3,
                "{thin_walled} {ior} {cosine}: {whole}"
            );
        }
    }
}

#[test]
fn rough_glass_loses_nothing() {
    for (thin_walled, ior) in [(true, 1.5), (false, 1.1), (false, 1.5), (false, 2.4)] {
        for roughness in [0.05, 0.2, 0.5, 0.8, 1.0] {
            let glass = StandardParameters {
                transmission: 1.0,
                roughness,
                thin_walled,
                ior,
                ..StandardParameters::default()
            };
            for cosine in [1.0, 0.8, 0.5, 0.2, -0.2, -0.5, -0.8, -1.0] {
                let whole = albedo(&glass, view(cosine), 1 << 14);
                let error = (whole - Vec3::ONE).abs().max_element();
                let at =
                    format!("thin {thin_walled}, index {ior}, roughness {roughness}, cos {cosine}");
                assert!(error < 0.012, "{at}: {whole}");
            }
        }
    }
}

#[test]
fn brushed_metal_loses_nothing() {
    for (roughness, strength) in [(0.0, 1.0), (0.0, 0.5), (0.3, 1.0), (0.3, 0.6), (0.7, 0.8)] {
        for direction in [[1.0, 0.0], [0.6, 0.8], [0.0, 1.0]] {
            let metal = StandardParameters {
                metallic: 1.0,
                roughness,
                anisotropy: Some(Anisotropy {
                    strength,
                    direction,
                }),
                ..StandardParameters::default()
            };
            for cosine in [1.0, 0.8, 0.5, 0.2] {
                let whole = albedo(&metal, view(cosine), 1 << 14);
                let error = (whole - Vec3::ONE).abs().max_element();
                let at =
                    format!("roughness {roughness}, {strength} along {direction:?}, cos {cosine}");
                assert!(error < 0.015, "{at}: {whole}");
            }
        }
    }
}

#[test]
fn without_further_bounces_nothing_sends_out_more_than_it_gets_either() {
    let grazing = [1.0, 0.5, 0.2, 0.1, 0.05, 0.02];
    // The boundary of a plastic has a roughness of its own.
    let materials = variety().into_iter();
    for (name, standard) in materials.filter(|(_, standard)| standard.plastic.is_none()) {
        for roughness in [0.05, standard.roughness, 1.0] {
            let sheen = standard.sheen.map(|sheen| Sheen { roughness, ..sheen });
            let clearcoat = standard.clearcoat.map(|coat| Clearcoat {
                normal: Vec3::Z,
                ..coat
            });
            let single = StandardParameters {
                base_color: Vec3::ONE,
                multiple_scattering: false,
                roughness,
                sheen,
                clearcoat,
                ..standard
            };
            for cosine in grazing {
                let whole = albedo(&single, view(cosine), 1 << 13);
                assert!(
                    whole.max_element() < 1.03,
                    "{name}, {roughness}, cos {cosine}: {whole}"
                );
            }
        }
    }
}

#[test]
fn reflection_is_reciprocal() {
    // A coat is left out, and a base without further bounces: their shares depend on the viewer
    // alone by definition.
    for (name, standard) in variety()
        .into_iter()
        .filter(|(_, standard)| standard.clearcoat.is_none() && standard.multiple_scattering)
    {
        for k in 0..200 {
            let [a, b, c] = lattice(k);
            let (wo, wi) = (view(0.02 + 0.98 * a), view(0.02 + 0.98 * b));
            let wi = Vec3::new(wi.x * (2.0 * c - 1.0), wi.y, wi.z).normalize();
            let (there, back) = (
                Bsdf::new(&standard, wo).evaluate(wi).f,
                Bsdf::new(&standard, wi).evaluate(wo).f,
            );
            let error = (there - back).abs().max_element();
            assert!(
                error < 1e-9 * (1.0 + there.max_element()),
                "{name}: {wo} {wi}: {there} {back}"
            );
        }
    }
}

#[test]
fn refraction_is_reciprocal_but_for_the_squeeze_of_angles() {
    let (_, body) = variety()
        .into_iter()
        .find(|(name, _)| *name == "body")
        .unwrap();
    // What makes up for lost light looks at the viewer alone.
    let body = StandardParameters {
        multiple_scattering: false,
        ..body
    };
    let wo = view(0.8);
    for k in 0..200 {
        let [a, b, _] = lattice(k);
        let wi = Vec3::new(0.5 * a - 0.4, 0.5 * b - 0.4, -0.9).normalize();
        let (there, back) = (
            Bsdf::new(&body, wo).evaluate(wi).f,
            Bsdf::new(&body, wi).evaluate(wo).f,
        );
        // Walter's f carries the solid angle of its own far side: f(o→i)·n_o² = f(i→o)·n_i² for
        // basic radiance.
        let error = (there - back * 2.25).abs().max_element();
        assert!(
            error < 1e-9 * (1.0 + there.max_element()),
            "{wo} {wi}: {there} {back}"
        );
    }
}

#[test]
fn a_black_surface_scatters_nothing() {
    let black = StandardParameters {
        base_color: Vec3::ZERO,
        specular: 0.0,
        multiple_scattering: false,
        ..StandardParameters::default()
    };
    assert!((0..100).all(|k| sampled(&Bsdf::new(&black, view(0.5)), lattice(k)).is_none()));
}

#[test]
fn directions_on_the_horizon_give_numbers() {
    for (name, standard) in variety() {
        for (wo, wi) in [
            (Vec3::X, Vec3::Z),
            (Vec3::Z, Vec3::X),
            (Vec3::X, Vec3::NEG_X),
            (Vec3::Z, Vec3::NEG_Z),
        ] {
            let bsdf = Bsdf::new(&standard, wo);
            let value = bsdf.evaluate(wi);
            assert!(
                value.f.is_finite() && value.pdf.is_finite(),
                "{name}: {wo} {wi}: {value:?}"
            );
            for k in 0..100 {
                let sample = sampled(&bsdf, lattice(k));
                assert!(
                    sample.is_none_or(|s| s.f.is_finite() && s.pdf > 0.0 && s.wi.is_finite()),
                    "{name}: {wo}"
                );
            }
        }
    }
}

#[test]
fn a_coat_with_its_back_to_the_viewer_is_not_seen() {
    let bare = StandardParameters {
        roughness: 0.5,
        ..StandardParameters::default()
    };
    let coat = Clearcoat {
        factor: 1.0,
        roughness: 0.1,
        normal: Vec3::new(-1.0, 0.0, 0.1).normalize(),
    };
    let coated = StandardParameters {
        clearcoat: Some(coat),
        ..bare
    };
    let (wo, wi) = (Vec3::new(0.8, 0.0, 0.6), Vec3::new(0.0, 0.6, 0.8));
    assert_eq!(
        Bsdf::new(&coated, wo).evaluate(wi),
        Bsdf::new(&bare, wo).evaluate(wi)
    );
}

/// A coat leans away from the viewer and reflects some of its facets below its own horizon: such a
/// direction is of no lobe.
#[test]
fn a_leaning_coat_is_sampled_as_it_is_evaluated() {
    let coat = Clearcoat {
        factor: 1.0,
        roughness: 1.0,
        normal: Vec3::new(-0.3, -0.2, 1.0).normalize(),
    };
    for (base_color, sheen) in [(0.05, 0.0), (0.0, 1.0), (1.0, 0.5)] {
        let coated = StandardParameters {
            base_color: Vec3::splat(base_color),
            specular: 0.0,
            clearcoat: Some(coat),
            sheen: (sheen > 0.0).then(|| Sheen {
                color: Vec3::splat(sheen),
                roughness: 0.15,
            }),
            ..StandardParameters::default()
        };
        let wo = view(0.6);
        let bsdf = Bsdf::new(&coated, wo);
        // By the midpoint rule over the cosine and the azimuth.
        let steps = 400_u32;
        let middle = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
        let cells = (0..steps * steps).map(|k| [middle(k % steps), middle(k / steps)]);
        let sum: f64 = cells
            .map(|[cosine, turn]| {
                let sine = (1.0 - cosine * cosine).sqrt();
                let (y, x) = (std::f64::consts::TAU * turn).sin_cos();
                bsdf.evaluate(Vec3::new(sine * x, sine * y, cosine)).f.x * cosine
            })
            .sum();
        let expected = sum * std::f64::consts::TAU / f64::from(steps * steps);
        let found = albedo(&coated, wo, 1 << 16).x;
        assert!(
            (found - expected).abs() < 0.01,
            "{base_color} {sheen}: {found}, not {expected}"
        );
    }
}
