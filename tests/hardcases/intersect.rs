//! Rays against single shapes, chains of rays, and segments to lights.

use super::scenes::{shape, world};
use super::truth::{Report, cases, error, id, number, relative_error, vector, vector_error};
use rtc::internals::math::{U, Vec3};
use rtc::internals::render::{Intersect, Ray, World};
use serde_json::Value;

pub(super) fn ray(value: &Value) -> Ray {
    Ray {
        origin: vector(&value["o"]),
        direction: vector(&value["d"]),
    }
}

/// The world of a case's shapes.
fn shapes_of(value: &Value) -> World {
    let shapes = value.as_array().unwrap().iter();
    world(shapes.map(|value| shape(value).unwrap()))
}

#[test]
fn intersections() {
    let mut report = Report::default();
    for case in cases("intersect") {
        let shape = shape(&case["input"]["shape"]).unwrap();
        let (passed, detail) = intersection(&case, &world([shape]));
        report.line(id(&case), passed, &detail);
    }
    report.finish();
}

fn intersection(case: &Value, world: &World) -> (bool, String) {
    let (expect, tolerance, ray) = (&case["expect"], &case["tol"], ray(&case["input"]["ray"]));
    let hit = world.closest_hit(&ray);
    let wanted = expect["hit"].as_bool().unwrap();
    if hit.is_some() != wanted {
        return (
            case["require"] == "may",
            format!("hit {} instead of {wanted}", hit.is_some()),
        );
    }
    let Some(hit) = hit else {
        return (true, "miss".to_owned());
    };
    let t_error = relative_error(hit.t, &expect["t"]);
    let interaction = world.surfaces[hit.surface]
        .shape
        .interaction(&ray, hit.t, hit.prim_id);
    let flip = |n: Vec3| vector_error(n, &expect["n"]);
    let n_error = match tolerance["n_sign"].as_str().unwrap() {
        "either" => flip(interaction.normal).min(flip(-interaction.normal)),
        _ => flip(interaction.normal),
    } / U;
    let p_error = vector_error(interaction.point, &expect["p"]) / U;
    let within = |error: f64, key: &str| error <= number(&tolerance[key]);
    let passed = within(t_error, "t_u") && within(n_error, "n_abs_u") && within(p_error, "p_abs_u");
    (
        passed,
        format!("t {t_error:.2} u, n {n_error:.2} u, p {p_error:.2} u"),
    )
}

#[test]
fn chains() {
    let mut report = Report::default();
    for case in cases("chain") {
        let world = shapes_of(&case["input"]["shapes"]);
        let first = ray(&case["input"]["ray"]);
        let hit = world.closest_hit(&first).unwrap();
        let interaction = world.surfaces[hit.surface]
            .shape
            .interaction(&first, hit.t, hit.prim_id);
        let tolerance = number(&case["tol"]["t2_abs_u"]) * U;
        let directions = case["input"]["secondary_dirs"].as_array().unwrap();
        for (k, (direction, expect)) in directions
            .iter()
            .zip(case["expect"]["secondary"].as_array().unwrap())
            .enumerate()
        {
            let direction = vector(direction);
            let next = world.closest_hit(&interaction.ray(direction));
            let wanted = expect["hit"].as_bool().unwrap();
            let passed = match next {
                Some(next) if wanted => {
                    let slack = tolerance / number(&expect["n_dot_w"]).abs();
                    next.surface.index() as u64 == expect["shape"].as_u64().unwrap()
                        && error(next.t, &expect["t"]) <= slack
                }
                Some(_) => false,
                None => !wanted,
            };
            report.line(&format!("{}.{k}", id(&case)), passed, &format!("{next:?}"));
        }
    }
    report.finish();
}

#[test]
fn segments_to_lights() {
    let mut report = Report::default();
    for case in cases("occluded") {
        let world = shapes_of(&case["input"]["shapes"]);
        let segments = case["input"]["segments"].as_array().unwrap();
        for (k, (segment, expect)) in segments
            .iter()
            .zip(case["expect"]["occluded"].as_array().unwrap())
            .enumerate()
        {
            let occluded = world.occluded(vector(&segment["from"]), vector(&segment["to"]));
            let passed = occluded == expect.as_bool().unwrap();
            report.line(
                &format!("{}.{k}", id(&case)),
                passed,
                &format!("occluded: {occluded}"),
            );
        }
    }
    report.finish();
}
