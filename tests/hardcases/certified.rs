//! What `rtc certify` says of the distances of rays: where it is certain, the truth is in it.

use super::exact::{Truth, truth};
use super::family::FAMILIES;
use super::intersect::ray;
use super::random::Random;
use super::scenes::{scene, shape};
use super::truth::{Report, cases, id, number};
use rtc::internals::ir::Shape;
use rtc::internals::math::{DoubleDouble, U};
use rtc::internals::render::Ray;
use rtc::internals::study::{CertifiedNumber, DoubleDoubleBall, Enclosure, first_distance};

/// Whether a certain answer holds the truth, to within the rounding of the truth itself; `None` if
/// no answer is certain.
fn holds<N: CertifiedNumber>(shape: &Shape, ray: &Ray, truth: &Truth) -> Option<bool> {
    const ROUNDING: f64 = 1024.0 * U * U;
    let scene = scene([shape.clone()]);
    let found = first_distance::<N>(&scene, [ray.origin, ray.direction]).ok()?;
    Some(match (found, truth.t) {
        (Some(found), Some(t)) => {
            let slack = ROUNDING * t.to_f64() * (1.0 + truth.kappa);
            let above = (t - DoubleDouble::from(found.low())).to_f64();
            let below = (DoubleDouble::from(found.high()) - t).to_f64();
            above >= -slack && below >= -slack
        }
        (None, None) => true,
        (Some(_), None) | (None, Some(_)) => false,
    })
}

#[test]
fn certain_distances_hold_those_of_200_digits() {
    let mut report = Report::default();
    let mut certain = 0;
    for case in cases("intersect") {
        let (expect, ray) = (&case["expect"], ray(&case["input"]["ray"]));
        let part = |key: &str| DoubleDouble::from(number(&expect["t"][key]));
        let is_hit = expect["hit"].as_bool().unwrap();
        let truth = Truth {
            t: is_hit.then(|| part("hi") + part("lo")),
            kappa: 0.0,
        };
        let shape = shape(&case["input"]["shape"]).unwrap();
        let narrow = holds::<Enclosure>(&shape, &ray, &truth);
        let wide = holds::<DoubleDoubleBall>(&shape, &ray, &truth);
        certain += usize::from(wide.is_some());
        let passed = narrow != Some(false) && wide != Some(false);
        report.line(id(&case), passed, &format!("{narrow:?} {wide:?}"));
    }
    report.finish();
    println!("{certain} certain");
    assert!(certain >= 40, "{certain}");
}

#[test]
fn certain_distances_of_families_hold_those_in_double_double() {
    const ROWS: u64 = 40;
    let mut report = Report::default();
    for (kind, name, make) in FAMILIES {
        let (mut narrow, mut wide, mut wrong) = (0, 0, 0);
        for index in 0..ROWS {
            let (shape, ray) = make(&mut Random::at(49, index));
            // The truth itself has 106 bits.
            let truth = truth(&shape, &ray).unwrap();
            if truth.kappa > 1e12 {
                continue;
            }
            let first = holds::<Enclosure>(&shape, &ray, &truth);
            let second = holds::<DoubleDoubleBall>(&shape, &ray, &truth);
            narrow += u32::from(first == Some(true));
            wide += u32::from(second == Some(true));
            wrong += u32::from(first == Some(false)) + u32::from(second == Some(false));
        }
        let detail = format!("{narrow} certain with 53 bits, {wide} with 106");
        report.line(
            &format!("{kind} {name}"),
            wrong == 0 && wide >= narrow,
            &detail,
        );
    }
    report.finish();
}
