//! The solids about an axis, one row each, and the laws that hold for all of them.

use super::{agrees, along_and_from, axis, ray, vector};
use proptest::prelude::*;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::emit;
use rtc::internals::ir::LoweredScene;
use rtc::internals::math::{OrthonormalBasis, U, Vec3, ldexp, unit_scale};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{
    BaselineShape, Interaction, Intersect, Prepare, Ray, RenderSelection, WatertightRay, World,
};
use rtc::internals::source::SourceMap;
use rtc::internals::valid::ValidScene;

/// Where a solid is: over a disc around `base`, `height` high along a unit axis.
#[derive(Clone, Copy, Debug)]
struct ValuePath {
    base: Vec3,
    axis: Vec3,
    height: f64,
    radius: f64,
}

struct Solid {
    /// Its type and its keys in the scene format.
    words: fn(&ValuePath) -> String,
    /// The signed distance of a point near its surface, by the point's height above the base and
    /// its distance from the axis; of any size elsewhere, and below 0 inside.
    distance: fn(&ValuePath, f64, f64) -> f64,
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
        words: |p| upright("cone", p),
        distance: |p, z, rho| {
            let slant = (p.height * p.height + p.radius * p.radius).sqrt();
            ((rho - p.radius * (1.0 - z / p.height)) * p.height / slant).max(-z)
        },
    },
    Solid {
        words: |p| upright("paraboloid", p),
        distance: |p, z, rho| {
            let bend = p.radius * p.radius / p.height;
            let gradient = (4.0 * rho * rho + bend * bend).sqrt();
            ((rho * rho - bend * (p.height - z)) / gradient).max(-z)
        },
    },
    Solid {
        words: |p| {
            let (axis, radius) = (text(p.axis), p.radius);
            let place = format!("position: {}, direction: {axis}", text(p.base));
            format!("type: infiniteCylinder, {place}, radius: {radius:?}")
        },
        distance: |p, _, rho| rho - p.radius,
    },
    Solid {
        words: |p| {
            let basis = OrthonormalBasis::around(p.axis);
            let (x, y) = (basis.tangent * p.radius, basis.bitangent * p.radius);
            let columns = [x, y, p.axis * p.height, p.base].map(|column| column.to_array());
            format!("type: ellipsoid, transform: {:?}", columns.as_flattened())
        },
        distance: |p, z, rho| {
            let (r2, h2) = (p.radius * p.radius, p.height * p.height);
            let length = (rho * rho / r2 + z * z / h2).sqrt();
            let gradient = (rho * rho / (r2 * r2) + z * z / (h2 * h2)).sqrt();
            (length - 1.0) * length / gradient
        },
    },
];

/// The words of a solid whose `up` leads from its base to its top.
fn upright(kind: &str, p: &ValuePath) -> String {
    let (base, up) = (text(p.base), text(p.axis * p.height));
    format!(
        "type: {kind}, position: {base}, up: {up}, radius: {:?}",
        p.radius
    )
}

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
fn lowered(text: &str) -> LoweredScene {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = map.add("solids.yaml", text.as_bytes().to_vec());
    let lowered = pipeline::load(file, &mut map, &Options::default(), &mut sink);
    lowered.unwrap_or_else(|| panic!("{text}\n{:?}", sink.kept()))
}

fn validated(lowered: &LoweredScene) -> ValidScene {
    let mut sink = DiagnosticSink::default();
    let proof = pipeline::validate(lowered, &Options::default(), &mut sink);
    proof.unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// A solid alone in a world.
fn world<S: Prepare>(solid: &Solid, place: &ValuePath) -> World<S> {
    let proof = validated(&lowered(&scene_of(&[(solid.words)(place)])));
    World::prepare(&proof, &Plan::new(&proof, RuleSet::NONE))
}

/// The first hit on a solid alone: t, and the point.
fn hit<S: Intersect>(world: &World<S>, ray: &Ray) -> Option<(f64, Interaction)> {
    let shape = &world.surfaces.first().unwrap().shape;
    let (t, prim_id) = shape.intersect(ray, &WatertightRay::new(ray), f64::INFINITY)?;
    Some((t, shape.interaction(ray, t, prim_id)))
}

/// The distance of a point from a solid.
fn distance(solid: &Solid, place: &ValuePath, point: Vec3) -> f64 {
    let (z, rho) = along_and_from(point - place.base, place.axis);
    (solid.distance)(place, z, rho)
}

prop_compose! {
    fn place()(
        base in vector(1.0), axis in axis(), height in 0.1..3.0_f64, radius in 0.05..2.0_f64
    ) -> ValuePath {
        ValuePath { base, axis: axis.normalize(), height, radius }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_ray_from_outside_finds_the_first_point_of_a_solid(ray in ray(), place in place()) {
        // The ray may start in the one without ends.
        for solid in SOLIDS.iter().filter(|solid| distance(solid, &place, ray.origin) > 0.0) {
            let world = world::<rtc::internals::render::Shape>(solid, &place);
            agrees(&ray, hit(&world, &ray).map(|(t, _)| t), |p| distance(solid, &place, p))?;
        }
    }

    /// From a point of the axis inside.
    #[test]
    fn a_ray_from_inside_finds_where_it_leaves(away in axis(), share in 0.1..0.9_f64, place in place()) {
        let origin = place.base + place.axis * (share * place.height);
        let ray = Ray { origin, direction: away.normalize() };
        for solid in SOLIDS {
            let world = world::<rtc::internals::render::Shape>(solid, &place);
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
            let world = world::<rtc::internals::render::Shape>(solid, &place);
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
            let robust = world::<rtc::internals::render::Shape>(solid, &place);
            let Some((t, at)) = hit(&robust, &ray) else { continue };
            let slope = at.normal.dot(ray.direction).abs();
            let narrow = place.radius.min(place.height) < 0.2;
            // A ray that is off by its rounding may pass an edge.
            let edge = 1e-3;
            let is_clear = |side: f64| distance(solid, &place, at.point + ray.direction * side) < 0.0;
            if slope < 0.25 || narrow || !is_clear(edge) { continue }
            let plain = hit(&world::<BaselineShape<f64>>(solid, &place), &ray).map(|(t, _)| t);
            let single = hit(&world::<BaselineShape<f32>>(solid, &place), &ray).map(|(t, _)| t);
            prop_assert!(plain.is_some_and(|found| (found / t - 1.0).abs() < 1e-9), "{:?} {}", plain, t);
            prop_assert!(single.is_some_and(|found| (found / t - 1.0).abs() < 1e-2), "{:?} {}", single, t);
        }
    }

    /// t stays, and the point is as many times as far.
    #[test]
    fn a_power_of_two_changes_no_bit(ray in ray(), place in place(), exponent in -60..60_i32) {
        let factor = ldexp(1.0, exponent);
        let scaled = ValuePath {
            base: place.base * factor,
            height: place.height * factor,
            radius: place.radius * factor,
            ..place
        };
        let scaled_ray = Ray { origin: ray.origin * factor, direction: ray.direction * factor };
        for solid in SOLIDS {
            let (world, other) = (world::<rtc::internals::render::Shape>(solid, &place), world(solid, &scaled));
            let found = hit(&world, &ray).map(|(t, at)| (t, at.point * factor, at.normal));
            let wanted = hit::<rtc::internals::render::Shape>(&other, &scaled_ray).map(|(t, at)| (t, at.point, at.normal));
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
            let proof = validated(&lowered(&scene_of(&words)));
            let film = |rules| {
                let plan = Plan::new(&proof, rules);
                let film = pipeline::render(&proof, &plan, &RenderSelection::default(), 1, &|_| true);
                film.ok().flatten().expect("nobody stops it")
            };
            let (pruned, naive) = (film(RuleSet::ALL), film(RuleSet::NONE));
            let bits = |pixel: &[f64; 3]| pixel.map(f64::to_bits);
            let same = pruned.image.pixels.iter().map(bits).eq(naive.image.pixels.iter().map(bits));
            prop_assert!(same, "{:?}", words);
            prop_assert!(pruned.counts.rays() <= naive.counts.rays());
        }
    }
}

/// Points of paraboloids with all bits known: on one of bend k, z is height − (x² + y²)/k. With
/// each its place, and its normal of any length.
fn known_points() -> impl Iterator<Item = (ValuePath, Vec3, Vec3)> {
    let sizes = [
        (4.0, 2.0),
        (1024.0, 0.5),
        (1.0 / 1024.0, 2.0),
        (2.0, 1.0 / 65536.0),
    ];
    (0..800_u32).map(move |k| {
        let (height, radius) = sizes[k as usize % 4];
        let share = |salt: u32| f64::from((k * 7919 + salt) % 181) / 256.0 * radius;
        let (x, y, bend) = (share(31), -share(77), radius * radius / height);
        let turn = |v: Vec3| turned(v, k as usize % 3);
        let base = Vec3::new(1.0, -3.0, 0.5) * f64::from(k % 5) * 64.0;
        let point = base + turn(Vec3::new(x, y, height - (x * x + y * y) / bend));
        let axis = turn(Vec3::Z);
        let place = ValuePath {
            base,
            axis,
            height,
            radius,
        };
        (place, point, turn(Vec3::new(2.0 * x, 2.0 * y, bend)))
    })
}

/// The paraboloid, alone in a world.
fn paraboloid(place: &ValuePath) -> World {
    world(&SOLIDS[2], place)
}

#[test]
fn a_ray_to_a_known_point_of_a_paraboloid_has_its_t_and_normal() {
    let mut worst = 0.0_f64;
    for (k, (place, point, gradient)) in known_points().enumerate() {
        let normal = gradient.normalize();
        let away = Vec3::new(0.3, -0.5, 0.2 + (k % 7) as f64);
        let out = away * normal.dot(away).signum();
        // Of few bits, so that the way from there to the point is exact.
        let step = (out * 1024.0).round() * [1.0, 64.0, 4096.0][k % 3] / 1024.0;
        let ray = Ray {
            origin: point + step,
            direction: -step,
        };
        assert_eq!(ray.origin + ray.direction, point);
        let (t, at) = hit(&paraboloid(&place), &ray).unwrap_or_else(|| panic!("{place:?} {ray:?}"));
        let sizes = ray.origin.abs() + place.base.abs() + step.abs();
        let extent = place.height + place.radius;
        let kappa = (normal.abs().dot(sizes) + extent) / normal.dot(step).abs();
        worst = worst.max((t - 1.0).abs() / (U * (1.0 + kappa)));
        // The point rounds, and is off along the ray as t is; the gradient changes twice as much.
        let moved = U * (sizes.element_sum() + kappa * step.length());
        let turn = 8.0 * moved / gradient.length();
        assert!(at.normal.distance(normal) < turn, "{} {normal}", at.normal);
    }
    assert!(worst < 2.0, "{worst} u·(1 + κ)");
}

#[test]
fn a_tangent_ray_hits_a_paraboloid_and_one_beside_it_does_not() {
    let scaled = |v: Vec3| unit_scale(v).expect("it has a length").0;
    // Of the last size, more bits would be needed than there are.
    for (place, point, normal) in known_points().filter(|(place, ..)| place.radius > 0.1) {
        let along = scaled(turned(normal, 1).cross(normal));
        let world = paraboloid(&place);
        let found = |shift: f64| {
            let origin = point - along * 16.0 + scaled(normal) * shift;
            hit(
                &world,
                &Ray {
                    origin,
                    direction: along,
                },
            )
            .map(|(t, _)| t)
        };
        let t = found(0.0);
        assert!(
            t.is_some_and(|t| (t - 16.0).abs() < 1e-6),
            "{t:?} {place:?} {point}"
        );
        let least = 1.0 / 16_777_216.0;
        assert_eq!(found(least), None, "{place:?} {point}");
        assert!(found(-least).is_some(), "{place:?} {point}");
    }
}

/// The components, some places on.
fn turned(v: Vec3, by: usize) -> Vec3 {
    Vec3::new(v[by % 3], v[(by + 1) % 3], v[(by + 2) % 3])
}
