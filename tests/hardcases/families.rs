//! Families of random rays: the error of t against its condition number κ.

use super::scenes::{cone, cylinder, plane, sphere, torus, triangle, world};
use super::truth::{Report, id, load};
use rtc::ir;
use rtc::math::{U, Vec3};
use rtc::render::Ray;

/// Spheres and planes are right to this many u whatever κ.
const ABSOLUTE: f64 = 64.0;

fn shape(kind: &str, f: &[f64]) -> Option<ir::Shape> {
    let point = |k: usize| [f[k], f[k + 1], f[k + 2]];
    match kind {
        "sphere" => Some(sphere(point(6), f[9])),
        "plane" => Some(plane(point(6), point(9))),
        "triangle" => Some(triangle([point(6), point(9), point(12)])),
        "cylinder" => Some(cylinder(point(6), point(9), f[13], f[12])),
        "cone" => {
            let axis = Vec3::from_array(point(9));
            Some(cone(point(6), (axis * (f[13] / axis.length())).to_array(), f[12]))
        }
        "torus" => Some(torus(point(6), point(9), f[12], f[13])),
        _ => None,
    }
}

#[test]
fn families() {
    let mut report = Report::default();
    for family in load("RTC_HARDCASES_FAMILIES", "hardcases-families.json").unwrap_or_default() {
        let kind = family["shape"].as_str().unwrap();
        if family["precision"] != "f64" {
            continue;
        }
        let rows: Vec<Vec<f64>> = family["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(|row| row.as_array().unwrap().iter().map(super::truth::number).collect())
            .collect();
        if shape(kind, &rows[0]).is_none() {
            println!("skip {}  the shape is not built yet", id(&family));
            continue;
        }
        let (mut wrong, mut worst, mut worst_of_bound) = (0, 0.0_f64, 0.0_f64);
        for row in &rows {
            let [hit, high, low, kappa] = row[row.len() - 4..].try_into().unwrap();
            let ray = Ray { origin: Vec3::from_slice(&row[0..3]), direction: Vec3::from_slice(&row[3..6]) };
            let found = world(shape(kind, row)).nearest(&ray).map(|hit| hit.t);
            match (found, hit == 1.0) {
                (Some(t), true) => {
                    let error = ((t - high) - low).abs() / (U * high.abs());
                    worst = worst.max(error);
                    worst_of_bound = worst_of_bound.max(error / (2.0 * (1.0 + kappa)));
                }
                (None, true) => wrong += usize::from(kappa < 1.0 / (64.0 * U)),
                (Some(_), false) => wrong += 1,
                (None, false) => {}
            }
        }
        let absolute = !matches!(kind, "sphere" | "plane") || worst <= ABSOLUTE;
        let detail = format!("{wrong} wrong, worst {worst:.2} u, {worst_of_bound:.3} of 2(1 + κ)");
        report.line(id(&family), wrong == 0 && worst_of_bound <= 1.0 && absolute, &detail);
    }
    report.finish();
}
