//! The BSDF of the glTF material against what must hold for any: energy, reciprocity, densities;
//! and against known values.

#![expect(
    clippy::disallowed_methods,
    reason = "expectations may use std; a test reads what it compares with"
)]

mod density;
mod energy;
mod furnace;
mod known;

use rtc::internals::math::{Microfacets, Plastic, Vec3};
use rtc::internals::render::{
    Anisotropy, Bsdf, BsdfSample, Clearcoat, DiffuseTransmission, Iridescence, PlasticBoundary,
    Sheen, StandardParameters,
};
use std::f64::consts::FRAC_1_PI;
use std::sync::LazyLock;

/// A point of the unit cube out of a rank-1 lattice, by the inverse powers of the plastic number of
/// three dimensions.
fn lattice(k: u32) -> [f64; 3] {
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_970_3,
    ];
    STEPS.map(|step| ((f64::from(k) + 0.5) * step).fract())
}

/// The direction with the cosine given, an odd azimuth away from x.
fn view(cosine: f64) -> Vec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    Vec3::new(0.8 * sine, 0.6 * sine, cosine)
}

/// Point k of n of the unit cube, evenly spread along the first coordinate, by the inverse powers
/// of the plastic number along the others.
fn lattice_of(k: u32, n: u32) -> [f64; 3] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    let place = f64::from(k) + 0.5;
    [
        place / f64::from(n),
        (place * STEPS[0]).fract(),
        (place * STEPS[1]).fract(),
    ]
}

/// A sample by three numbers, of which the last is not always needed.
fn sampled(bsdf: &Bsdf<'_>, [u, v, third]: [f64; 3]) -> Option<BsdfSample> {
    bsdf.sample([u, v], || third)
}

/// How much of a uniform sky the material sends to a viewer, by sampling.
fn albedo(standard: &StandardParameters<'_>, wo: Vec3, samples: u32) -> Vec3 {
    let bsdf = Bsdf::new(standard, wo);
    let value = |k: u32| {
        sampled(&bsdf, lattice_of(k, samples)).map_or(Vec3::ZERO, |s| s.f * (s.wi.z.abs() / s.pdf))
    };
    (0..samples).map(value).sum::<Vec3>() / f64::from(samples)
}

/// The boundary of a plastic of the index 1.49.
fn boundary(which: usize) -> &'static PlasticBoundary {
    static BOUNDARIES: LazyLock<[PlasticBoundary; 3]> = LazyLock::new(|| {
        let of = |inner, roughness, model| PlasticBoundary::new(inner, 1.49, roughness, model);
        [
            of(Plastic::Nonlinear, 0.0, Microfacets::Ggx),
            of(Plastic::Linear, 0.5, Microfacets::Beckmann),
            of(Plastic::Single, 0.5, Microfacets::SeparableGgx),
        ]
    });
    &BOUNDARIES[which]
}

/// Materials that between them use every lobe.
#[expect(clippy::too_many_lines, reason = "a table, one row a material")]
fn variety() -> Vec<(&'static str, StandardParameters<'static>)> {
    let plain = StandardParameters {
        roughness: 0.5,
        base_color: Vec3::new(0.9, 0.4, 0.2),
        ..StandardParameters::default()
    };
    let coat = Clearcoat {
        factor: 0.8,
        roughness: 0.3,
        normal: Vec3::new(0.1, -0.2, 0.9).normalize(),
    };
    let sheen = Sheen {
        color: Vec3::new(0.2, 0.5, 0.9),
        roughness: 0.4,
    };
    let film = Iridescence {
        factor: 0.7,
        ior: 1.3,
        thickness: 420.0,
    };
    let leaf = DiffuseTransmission {
        factor: 0.6,
        color: Vec3::new(0.3, 0.8, 1.0),
    };
    let (cosine, sine) = (0.3, 0.91_f64.sqrt());
    let brushed = Anisotropy {
        strength: 0.7,
        direction: [cosine, sine],
    };
    let body = StandardParameters {
        transmission: 1.0,
        thin_walled: false,
        ..plain
    };
    vec![
        ("plain", plain),
        (
            "single scatter",
            StandardParameters {
                multiple_scattering: false,
                ..plain
            },
        ),
        (
            "plastic",
            StandardParameters {
                roughness: 0.0,
                ior: 1.49,
                plastic: Some(boundary(0)),
                ..plain
            },
        ),
        (
            "rough plastic",
            StandardParameters {
                ior: 1.49,
                facets: Microfacets::Beckmann,
                plastic: Some(boundary(1)),
                ..plain
            },
        ),
        (
            "plastic without reflections inside",
            StandardParameters {
                ior: 1.49,
                facets: Microfacets::SeparableGgx,
                plastic: Some(boundary(2)),
                ..plain
            },
        ),
        (
            "brushed metal of Beckmann",
            StandardParameters {
                metallic: 1.0,
                facets: Microfacets::Beckmann,
                anisotropy: Some(brushed),
                multiple_scattering: false,
                ..plain
            },
        ),
        (
            "rough glass of Beckmann",
            StandardParameters {
                roughness: 0.8,
                facets: Microfacets::Beckmann,
                multiple_scattering: false,
                ..body
            },
        ),
        (
            "metal",
            StandardParameters {
                metallic: 1.0,
                ..plain
            },
        ),
        (
            "half metal",
            StandardParameters {
                metallic: 0.5,
                roughness: 0.8,
                ..plain
            },
        ),
        (
            "specular",
            StandardParameters {
                specular: 0.5,
                specular_color: Vec3::new(1.0, 4.0, 0.2),
                ..plain
            },
        ),
        (
            "brushed",
            StandardParameters {
                metallic: 1.0,
                anisotropy: Some(brushed),
                ..plain
            },
        ),
        (
            "coated",
            StandardParameters {
                clearcoat: Some(coat),
                ..plain
            },
        ),
        (
            "cloth",
            StandardParameters {
                sheen: Some(sheen),
                ..plain
            },
        ),
        (
            "film",
            StandardParameters {
                iridescence: Some(film),
                ..plain
            },
        ),
        (
            "wall",
            StandardParameters {
                transmission: 0.6,
                ..plain
            },
        ),
        (
            "leaf",
            StandardParameters {
                diffuse_transmission: Some(leaf),
                ..plain
            },
        ),
        (
            "leaf of one scatter",
            StandardParameters {
                diffuse_transmission: Some(leaf),
                sheen: Some(sheen),
                multiple_scattering: false,
                ..plain
            },
        ),
        ("body", body),
        (
            "diamond",
            StandardParameters {
                ior: 2.4,
                roughness: 0.6,
                ..body
            },
        ),
        (
            "all",
            StandardParameters {
                metallic: 0.2,
                transmission: 0.5,
                anisotropy: Some(brushed),
                clearcoat: Some(coat),
                sheen: Some(sheen),
                iridescence: Some(film),
                diffuse_transmission: Some(leaf),
                ..body
            },
        ),
    ]
}

/// `KHR_materials_diffuse_transmission`: the diffuse BRDF of the base colour, mixed with a diffuse
/// BTDF of the colour of transmission.
#[test]
fn a_leaf_mixes_lambert_before_it_and_behind_it() {
    let (base_color, color) = (Vec3::new(0.9, 0.4, 0.2), Vec3::new(0.3, 0.8, 1.0));
    for (factor, transmission, metallic) in [(0.0, 0.0, 0.0), (0.25, 0.0, 0.0), (1.0, 0.6, 0.5)] {
        let matt = StandardParameters {
            base_color,
            metallic,
            transmission,
            specular: 0.0,
            ..StandardParameters::default()
        };
        let leaf = StandardParameters {
            diffuse_transmission: Some(DiffuseTransmission { factor, color }),
            ..matt
        };
        // Seen from either side, and lit from either.
        for (o, i) in [(0.9, 0.2), (0.9, -0.2), (-0.3, -0.7), (-0.3, 0.7)] {
            let f = |material| Bsdf::new(material, view(o)).evaluate(view(i)).f;
            let diffuse = color * factor * (1.0 - metallic) * (1.0 - transmission);
            let expected = if o * i < 0.0 {
                f(&matt) + diffuse * FRAC_1_PI
            } else {
                let before = base_color * factor * (1.0 - metallic) * (1.0 - transmission);
                f(&matt) - before * FRAC_1_PI
            };
            let error = (f(&leaf) - expected).abs().max_element();
            assert!(
                error < 1e-3,
                "{factor} {transmission} {metallic} {o} {i}: {error}"
            );
        }
    }
}

/// What a white leaf does not reflect it transmits, under its boundary too.
#[test]
fn a_white_leaf_in_a_white_sky_is_white_on_both_sides() {
    for (factor, roughness) in [(0.3, 0.1), (0.3, 0.7), (1.0, 0.4)] {
        let leaf = StandardParameters {
            roughness,
            diffuse_transmission: Some(DiffuseTransmission {
                factor,
                color: Vec3::ONE,
            }),
            ..StandardParameters::default()
        };
        for cosine in [0.9, 0.3, -0.6] {
            let whole = albedo(&leaf, view(cosine), 1 << 14);
            let error = (whole - Vec3::ONE).abs().max_element();
            assert!(error < 0.005, "{factor} {roughness} {cosine}: {whole}");
        }
    }
}
