//! The BSDF of the glTF material against what must hold for any: energy, reciprocity, densities;
//! and against known values.

#![expect(
    clippy::disallowed_methods,
    reason = "expectations may use std; a test reads what it compares with"
)]

mod density;
mod energy;
mod known;

use rtc::math::Vec3;
use rtc::render::{Anisotropy, Bsdf, Clearcoat, Iridescence, Sheen, StandardParameters};

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

/// How much of a uniform sky the material sends to a viewer, by sampling.
fn albedo(standard: &StandardParameters, wo: Vec3, samples: u32) -> Vec3 {
    let bsdf = Bsdf::new(standard, wo);
    let value = |k: u32| {
        bsdf.sample(lattice_of(k, samples))
            .map_or(Vec3::ZERO, |s| s.f * (s.wi.z.abs() / s.pdf))
    };
    (0..samples).map(value).sum::<Vec3>() / f64::from(samples)
}

/// Materials that between them use every lobe.
#[expect(clippy::too_many_lines, reason = "a table, one row a material")]
fn variety() -> Vec<(&'static str, StandardParameters)> {
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
                ..body
            },
        ),
    ]
}
