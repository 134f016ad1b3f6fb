//! Values known otherwise: Lambert, smooth metal and glass, and a table integrated from the
//! formulas of glTF's appendix B.

use super::{albedo, sampled, view};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Bsdf, StandardParameters};
use std::f64::consts::PI;

#[test]
fn without_specular_it_is_lambert() {
    let base_color = Vec3::new(0.9, 0.4, 0.2);
    for multiple_scattering in [false, true] {
        let lambert = StandardParameters {
            base_color,
            specular: 0.0,
            multiple_scattering,
            ..StandardParameters::default()
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
    let mirror = StandardParameters {
        base_color,
        metallic: 1.0,
        roughness: 0.0,
        ..StandardParameters::default()
    };
    let wo = view(0.3);
    let bsdf = Bsdf::new(&mirror, wo);
    let sample = sampled(&bsdf, [0.99, 0.2, 0.7]).unwrap();
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
    let glass = StandardParameters {
        transmission: 1.0,
        roughness: 0.0,
        thin_walled: false,
        ..StandardParameters::default()
    };
    let wo = view(0.5);
    let through = sampled(&Bsdf::new(&glass, wo), [0.5, 0.5, 0.999_999]).unwrap();
    assert!(through.delta && through.wi.z < 0.0);
    assert!((through.wi.x * 1.5 + wo.x).abs() < 1e-12 && (through.wi.y * 1.5 + wo.y).abs() < 1e-12);
    // sin θ > 1/1.5 from within.
    let shut = Bsdf::new(&glass, view(-0.5));
    for k in 0..100 {
        let u = (f64::from(k) + 0.5) / 100.0;
        let sample = sampled(&shut, [u, 0.5, u]).unwrap();
        assert!(sample.wi.z < 0.0, "{sample:?}");
    }
}

#[test]
fn a_thin_wall_lets_light_go_straight_on() {
    let wall = StandardParameters {
        transmission: 1.0,
        roughness: 0.0,
        ..StandardParameters::default()
    };
    let wo = view(0.5);
    let through = sampled(&Bsdf::new(&wall, wo), [0.5, 0.5, 0.999_999]).unwrap();
    assert!(through.delta && (through.wi + wo).length() < 1e-12);
}

#[test]
fn a_body_of_the_index_of_air_is_not_there() {
    let nothing = StandardParameters {
        transmission: 1.0,
        roughness: 0.7,
        ior: 1.0,
        thin_walled: false,
        ..StandardParameters::default()
    };
    let nothing = StandardParameters {
        specular: 0.0,
        multiple_scattering: false,
        ..nothing
    };
    let sample = sampled(&Bsdf::new(&nothing, view(0.4)), [0.5; 3]).unwrap();
    assert!(sample.delta && (sample.wi + view(0.4)).length() < 1e-12);
}

/// Metallic, roughness, and the albedo of the base colour (0.9, 0.4, 0.2) at cosines 1 and 0.5,
/// integrated numerically from the formulas of appendix B, with Smith's height-correlated masking.
const APPENDIX_B: &[(f64, f64, [f64; 3], [f64; 3])] = &[
    (0.0, 0.25, [0.9038, 0.4238, 0.2318], [0.9306, 0.453, 0.2619]),
    (0.0, 0.6, [0.8969, 0.417, 0.225], [0.906, 0.4284, 0.2374]),
    (0.0, 1.0, [0.8762, 0.3963, 0.2043], [0.8806, 0.403, 0.2119]),
    (0.5, 0.25, [0.8999, 0.411, 0.2155], [0.9118, 0.434, 0.2429]),
    (0.5, 0.6, [0.8194, 0.3734, 0.1949], [0.8057, 0.3753, 0.2031]),
    (0.5, 1.0, [0.5762, 0.2595, 0.1329], [0.6432, 0.2925, 0.1522]),
    (1.0, 0.25, [0.8961, 0.3983, 0.1991], [0.893, 0.415, 0.2238]),
    (1.0, 0.6, [0.7419, 0.3298, 0.1649], [0.7053, 0.3222, 0.1689]),
    (1.0, 1.0, [0.2763, 0.1228, 0.0614], [0.4057, 0.182, 0.0925]),
];

#[test]
fn single_scattering_is_that_of_appendix_b() {
    for (metallic, roughness, head_on, slanted) in APPENDIX_B {
        let standard = StandardParameters {
            base_color: Vec3::new(0.9, 0.4, 0.2),
            metallic: *metallic,
            roughness: *roughness,
            multiple_scattering: false,
            ..StandardParameters::default()
        };
        for (expected, cosine) in [(head_on, 1.0), (slanted, 0.5)] {
            let expected = Vec3::from_array(*expected);
            let found = albedo(&standard, view(cosine), 1 << 16);
            // The table has four digits, the last of them uncertain.
            let error = (found - expected).abs().max_element();
            // A base seen from the side would send out more than it gets by appendix B.
            let is_bounded = *metallic < 1.0 && cosine < 1.0;
            let is_less = found.cmple(expected + 3e-4).all() && found.cmpgt(expected * 0.95).all();
            assert!(
                error < 3e-4 || (is_bounded && is_less),
                "{metallic} {roughness} {cosine}: {found}, not {expected}"
            );
        }
    }
}
