//! Values known otherwise: Lambert, smooth metal and glass, and a table integrated from the
//! formulas of glTF's appendix B.

use crate::{albedo, view};
use rtc::math::Vec3;
use rtc::render::{Bsdf, Standard};
use std::f64::consts::PI;
use std::path::Path;

#[test]
fn without_specular_it_is_lambert() {
    let base_color = Vec3::new(0.9, 0.4, 0.2);
    for multiple_scattering in [false, true] {
        let lambert = Standard {
            base_color,
            specular: 0.0,
            multiple_scattering,
            ..Standard::default()
        };
        for (o, i) in [(1.0, 1.0), (0.9, 0.1), (0.05, 0.6)] {
            let f = Bsdf::new(&lambert, view(o)).evaluate(view(i)).f;
            assert!(
                (f - base_color / PI).abs().max_element() < 1e-12,
                "{multiple_scattering} {o} {i}: {f}"
            );
        }
    }
}

#[test]
fn a_mirror_of_metal_reflects_by_schlick() {
    let base_color = Vec3::new(0.9, 0.4, 0.2);
    let mirror = Standard {
        base_color,
        metallic: 1.0,
        roughness: 0.0,
        ..Standard::default()
    };
    let wo = view(0.3);
    let bsdf = Bsdf::new(&mirror, wo);
    let sample = bsdf.sample([0.99, 0.2, 0.7]).unwrap();
    assert!(sample.delta && (sample.wi - Vec3::new(-wo.x, -wo.y, wo.z)).length() < 1e-12);
    let expected = base_color + (Vec3::ONE - base_color) * 0.7_f64.powi(5);
    assert!(
        (albedo(&mirror, wo, 1 << 12) - expected)
            .abs()
            .max_element()
            < 1e-3
    );
}

#[test]
fn a_smooth_body_bends_light_by_snell_and_shuts_it_in_beyond_the_critical_angle() {
    let glass = Standard {
        transmission: 1.0,
        roughness: 0.0,
        thin_walled: false,
        ..Standard::default()
    };
    let wo = view(0.5);
    let through = Bsdf::new(&glass, wo).sample([0.999_999, 0.5, 0.5]).unwrap();
    assert!(through.delta && through.wi.z < 0.0);
    assert!((through.wi.x * 1.5 + wo.x).abs() < 1e-12 && (through.wi.y * 1.5 + wo.y).abs() < 1e-12);
    // sin θ > 1/1.5 from within.
    let shut = Bsdf::new(&glass, view(-0.5));
    for k in 0..100 {
        let sample = shut
            .sample([(f64::from(k) + 0.5) / 100.0, 0.5, 0.5])
            .unwrap();
        assert!(sample.wi.z < 0.0, "{sample:?}");
    }
}

#[test]
fn a_thin_wall_lets_light_go_straight_on() {
    let wall = Standard {
        transmission: 1.0,
        roughness: 0.0,
        ..Standard::default()
    };
    let wo = view(0.5);
    let through = Bsdf::new(&wall, wo).sample([0.999_999, 0.5, 0.5]).unwrap();
    assert!(through.delta && (through.wi + wo).length() < 1e-12);
}

#[test]
fn a_body_of_the_index_of_air_is_not_there() {
    let nothing = Standard {
        transmission: 1.0,
        roughness: 0.7,
        ior: 1.0,
        thin_walled: false,
        ..Standard::default()
    };
    let nothing = Standard {
        specular: 0.0,
        multiple_scattering: false,
        ..nothing
    };
    let sample = Bsdf::new(&nothing, view(0.4)).sample([0.5; 3]).unwrap();
    assert!(sample.delta && (sample.wi + view(0.4)).length() < 1e-12);
}

#[test]
fn single_scattering_is_that_of_appendix_b() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/gltf/refs/furnace_table.json");
    let Ok(text) = std::fs::read_to_string(path) else {
        println!("skipped: no ../shared");
        return;
    };
    let table: serde_json::Value = serde_json::from_str(&text).unwrap();
    let column = "glTF 2.0 spec appendix B (height-correlated Smith), exact";
    for row in table.as_array().unwrap() {
        let number = |key: &str| row[key].as_f64().unwrap();
        let standard = Standard {
            base_color: Vec3::new(0.9, 0.4, 0.2),
            metallic: number("metal"),
            roughness: number("rough"),
            multiple_scattering: false,
            ..Standard::default()
        };
        for (key, cosine) in [("mu1.0", 1.0), ("mu0.5", 0.5)] {
            let channel = |k: usize| row[key][column][k].as_f64().unwrap();
            let expected = Vec3::new(channel(0), channel(1), channel(2));
            let found = albedo(&standard, view(cosine), 1 << 16);
            // The table has four digits, the last of them uncertain.
            let error = (found - expected).abs().max_element();
            assert!(
                error < 3e-4,
                "{} {} {key}: {found}, not {expected}",
                row["metal"],
                row["rough"]
            );
        }
    }
}
