//! Refraction, the highlight's power, and long paths in a mirror box.

use super::scenes::{plane, world};
use super::truth::{Report, cases, id, number, relative_error, vector, vector_error};
use rtc::internals::math::U;
use rtc::internals::render::{Intersect, Ray, highlight, reflect, refract};

#[test]
fn refraction() {
    let mut report = Report::default();
    for case in cases("refract") {
        let (d, n) = (
            vector(&case["input"]["d"]).normalize(),
            vector(&case["input"]["n"]).normalize(),
        );
        let eta = |key: &str| number(&case["input"][key]);
        let refracted = refract(d, n, eta("eta_i"), eta("eta_t"));
        let internal = case["expect"]["tir"].as_bool().unwrap();
        let may = case["require"] == "may";
        let tolerance = |key: &str| case["tol"].get(key).map_or(f64::INFINITY, number);
        let mirror = vector_error(reflect(d, n), &case["expect"]["reflect"]) / U;
        let (passed, detail) = match refracted {
            Some(direction) if !internal => {
                let error = vector_error(direction, &case["expect"]["dir"]) / U;
                (
                    may || error <= tolerance("dir_abs_u"),
                    format!("direction {error:.2} u"),
                )
            }
            Some(_) => (may, "refracted instead of reflected".to_owned()),
            None => (may || internal, "total internal reflection".to_owned()),
        };
        report.line(
            id(&case),
            passed && mirror <= 8.0,
            &format!("{detail}, mirror {mirror:.2} u"),
        );
    }
    report.finish();
}

#[test]
fn powers_of_the_highlight() {
    let mut report = Report::default();
    for case in cases("phong_pow") {
        let value = highlight(
            number(&case["input"]["r_dot_v"]),
            number(&case["input"]["n"]),
        );
        let expect = &case["expect"]["value"];
        let relative = relative_error(value, expect);
        let absolute = (value - number(&expect["hi"])).abs();
        let tolerance = |key: &str| case["tol"].get(key).map_or(0.0, number);
        let passed = relative <= tolerance("rel_u") || absolute <= tolerance("abs");
        report.line(id(&case), passed, &format!("{value:e}: {relative:.2} u"));
    }
    report.finish();
}

#[test]
fn a_mirror_box_keeps_its_rays() {
    let walls = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let planes = walls
        .into_iter()
        .flat_map(|n| [plane(n, n), plane(n.map(|c| -c), n)]);
    let world = world(planes);
    let mut report = Report::default();
    for case in cases("mirror_box") {
        let mut ray = Ray {
            origin: vector(&case["input"]["o"]),
            direction: vector(&case["input"]["d"]),
        };
        let expected = case["expect"]["bounces"].as_array().unwrap();
        let last = expected
            .iter()
            .map(|bounce| number(&bounce["bounce"]) as u64)
            .max()
            .unwrap();
        for bounce in 1..=last {
            let Some(hit) = world.closest_hit(&ray) else {
                report.line(id(&case), false, &format!("escaped at bounce {bounce}"));
                break;
            };
            let interaction =
                world.surfaces[hit.surface]
                    .shape
                    .interaction(&ray, hit.t, hit.prim_id);
            if let Some(expect) = expected
                .iter()
                .find(|expect| number(&expect["bounce"]) as u64 == bounce)
            {
                let error = vector_error(interaction.point, &expect["p"]);
                let passed = error <= 2.2e-15 * bounce as f64;
                report.line(
                    &format!("{}.{bounce}", id(&case)),
                    passed,
                    &format!("point {:.1} u", error / U),
                );
            }
            let unit = reflect(ray.direction.normalize(), interaction.normal);
            ray = interaction.ray(unit * ray.direction.length());
        }
    }
    report.finish();
}
