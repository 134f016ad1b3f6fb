//! The solids about an axis, one row each, and the laws that hold for all of them.

use super::{agrees, along_and_from, axis, ray, vector};
use proptest::prelude::*;
use rtc::diag::Sink;
use rtc::emit;
use rtc::ir::Lowered;
use rtc::math::{Vec3, ldexp};
use rtc::pipeline::{self, Options};
use rtc::plan::{Plan, Rules};
use rtc::render::{Geometry, Interaction, Job, PlainShape, Prepare, Ray, Shear, World};
use rtc::source::SourceMap;
use rtc::valid::Proof;

/// Where a solid is: over a disc around `base`, `height` high along a unit axis.
#[derive(Clone, Copy, Debug)]
struct Place {
    base: Vec3,
    axis: Vec3,
    height: f64,
    radius: f64,
}

struct Solid {
    /// Its type and its keys in the scene format.
    words: fn(&Place) -> String,
    /// The signed distance of a point near its surface, by the point's height above the base and
    /// its distance from the axis; of any size elsewhere, and below 0 inside.
    distance: fn(&Place, f64, f64) -> f64,
}

const SOLIDS: &[Solid] = &[
    Solid {
        words: |p| {
            let (height, radius) = (p.height, p.radius);
            let place = format!("position: {}, direction: {}", text(p.base), text(p.axis));
            format!("type: cylinder, {place}, height: {height:?}, radius: {radius:?}")
        },
        distance: |p, z, rho| (rho - p.radius).max(-z).max(z - p.height),
    },
    Solid {
        words: |p| {
            let place = format!(
                "position: {}, up: {}",
                text(p.base),
                text(p.axis * p.height)
            );
            format!("type: cone, {place}, radius: {:?}", p.radius)
        },
        distance: |p, z, rho| {
            let slant = (p.height * p.height + p.radius * p.radius).sqrt();
            ((rho - p.radius * (1.0 - z / p.height)) * p.height / slant).max(-z)
        },
    },
];

fn text(v: Vec3) -> String {
    format!("{:?}", v.to_array())
}

/// A scene of some solids of mirrors, lit from two sides.
fn scene_of(solids: &[String]) -> String {
    let objects = solids.iter().map(|solid| {
        format!(
            "- {{{solid}, material: {{color: [1, 0.5, 0.2], ka: 0.2, kd: 0.6, ks: 0.3, n: 9}}}}\n"
        )
    });
    format!(
        "Camera: {{eye: [0.3, 0.5, 6], center: [0, 0, 0], up: [0, 1, 0], viewSize: [20, 16], fov: 40}}\n\
         Shadows: true\nMaxRecursionDepth: 2\n\
         Lights:\n- {{position: [3, 4, 5], color: [1, 1, 1]}}\n- {{position: [-4, 1, -2], color: [0.3, 0.4, 0.5]}}\n\
         Objects:\n{}",
        objects.collect::<String>()
    )
}

/// The scene of a text that has no mistake.
fn lowered(text: &str) -> Lowered {
    let (mut map, mut sink) = (SourceMap::default(), Sink::default());
    let file = map.add("solids.yaml", text.as_bytes().to_vec());
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    lowered.unwrap_or_else(|| panic!("{text}\n{:?}", sink.kept()))
}

fn proven(lowered: &Lowered) -> Proof {
    let mut sink = Sink::default();
    let proof = pipeline::prove(lowered, &Options::default(), &mut sink);
    proof.unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// A solid alone in a world.
fn world<S: Prepare>(solid: &Solid, place: &Place) -> World<S> {
    let proof = proven(&lowered(&scene_of(&[(solid.words)(place)])));
    World::prepare(&proof, &Plan::new(&proof, Rules::NONE))
}

/// The first hit on a solid alone: t, and the point.
fn hit<S: Geometry>(world: &World<S>, ray: &Ray) -> Option<(f64, Interaction)> {
    let shape = &world.surfaces[0].shape;
    let (t, prim_id) = shape.intersect(ray, &Shear::new(ray), f64::INFINITY)?;
    Some((t, shape.interaction(ray, t, prim_id)))
}

/// The distance of a point from a solid.
fn distance(solid: &Solid, place: &Place, point: Vec3) -> f64 {
    let (z, rho) = along_and_from(point - place.base, place.axis);
    (solid.distance)(place, z, rho)
}

prop_compose! {
    fn place()(
        base in vector(1.0), axis in axis(), height in 0.1..3.0_f64, radius in 0.05..2.0_f64
    ) -> Place {
        Place { base, axis: axis.normalize(), height, radius }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_ray_from_outside_finds_the_first_point_of_a_solid(ray in ray(), place in place()) {
        for solid in SOLIDS {
            let world = world::<rtc::render::Shape>(solid, &place);
            agrees(&ray, hit(&world, &ray).map(|(t, _)| t), |p| distance(solid, &place, p))?;
        }
    }

    /// From a point of the axis inside.
    #[test]
    fn a_ray_from_inside_finds_where_it_leaves(away in axis(), share in 0.1..0.9_f64, place in place()) {
        let origin = place.base + place.axis * (share * place.height);
        let ray = Ray { origin, direction: away.normalize() };
        for solid in SOLIDS {
            let world = world::<rtc::render::Shape>(solid, &place);
            let found = hit(&world, &ray).map(|(t, _)| t);
            prop_assert!(found.is_some());
            agrees(&ray, found, |p| -distance(solid, &place, p))?;
        }
    }

    /// The point lies on the surface, the distance grows along the normal as the step does, and
    /// rays that leave find nothing.
    #[test]
    fn points_are_on_the_surface_and_normals_lead_out(ray in ray(), place in place(), away in axis()) {
        const STEP: f64 = 1e-7;
        for solid in SOLIDS {
            let world = world::<rtc::render::Shape>(solid, &place);
            let Some((_, at)) = hit(&world, &ray) else { continue };
            let off = distance(solid, &place, at.point);
            prop_assert!(off.abs() < 1e-14, "{:e} off the surface", off);
            let risen = distance(solid, &place, at.point + at.normal * STEP);
            prop_assert!((risen / STEP - 1.0).abs() < 1e-2, "{} of a step", risen / STEP);
            let out = if away.dot(at.normal) > 0.0 { away } else { -away };
            prop_assert_eq!(hit(&world, &at.ray(out)).map(|(t, _)| t), None);
        }
    }

    #[test]
    fn plain_formulas_find_the_same_where_rays_are_benign(ray in ray(), place in place()) {
        for solid in SOLIDS {
            let robust = world::<rtc::render::Shape>(solid, &place);
            let Some((t, at)) = hit(&robust, &ray) else { continue };
            let slope = at.normal.dot(ray.direction).abs();
            let narrow = place.radius.min(place.height) < 0.2;
            // A ray that is off by its rounding may pass an edge.
            let edge = 1e-3;
            let is_clear = |side: f64| distance(solid, &place, at.point + ray.direction * side) < 0.0;
            if slope < 0.25 || narrow || !is_clear(edge) { continue }
            let plain = hit(&world::<PlainShape<f64>>(solid, &place), &ray).map(|(t, _)| t);
            let single = hit(&world::<PlainShape<f32>>(solid, &place), &ray).map(|(t, _)| t);
            prop_assert!(plain.is_some_and(|found| (found / t - 1.0).abs() < 1e-9), "{:?} {}", plain, t);
            prop_assert!(single.is_some_and(|found| (found / t - 1.0).abs() < 1e-2), "{:?} {}", single, t);
        }
    }

    /// t stays, and the point is as many times as far.
    #[test]
    fn a_power_of_two_changes_no_bit(ray in ray(), place in place(), exponent in -60..60_i32) {
        let factor = ldexp(1.0, exponent);
        let scaled = Place {
            base: place.base * factor,
            height: place.height * factor,
            radius: place.radius * factor,
            ..place
        };
        let scaled_ray = Ray { origin: ray.origin * factor, direction: ray.direction * factor };
        for solid in SOLIDS {
            let (world, other) = (world::<rtc::render::Shape>(solid, &place), world(solid, &scaled));
            let found = hit(&world, &ray).map(|(t, at)| (t, at.point * factor, at.normal));
            let wanted = hit::<rtc::render::Shape>(&other, &scaled_ray).map(|(t, at)| (t, at.point, at.normal));
            prop_assert_eq!(found, wanted);
        }
    }

    #[test]
    fn what_is_written_lowers_to_the_same_scene(place in place()) {
        for solid in SOLIDS {
            let scene = lowered(&scene_of(&[(solid.words)(&place)])).scene;
            let text = emit::course::emit(&scene).map_err(TestCaseError::fail)?;
            prop_assert_eq!(lowered(&text).scene, scene);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Of each solid two, and one of the next.
    #[test]
    fn no_rule_changes_a_bit(places in prop::collection::vec(place(), 3)) {
        for (solid, next) in SOLIDS.iter().zip(SOLIDS.iter().cycle().skip(1)) {
            let words = [(solid.words)(&places[0]), (solid.words)(&places[1]), (next.words)(&places[2])];
            let proof = proven(&lowered(&scene_of(&words)));
            let film = |rules| {
                let plan = Plan::new(&proof, rules);
                let film = pipeline::render(&proof, &plan, &Job::default(), 1, &|_| true);
                film.ok().flatten().expect("nobody stops it")
            };
            let (pruned, naive) = (film(Rules::ALL), film(Rules::NONE));
            let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
            let same = pruned.image.pixels.iter().map(bits).eq(naive.image.pixels.iter().map(bits));
            prop_assert!(same, "{:?}", words);
            prop_assert!(pruned.counts.rays() <= naive.counts.rays());
        }
    }
}
