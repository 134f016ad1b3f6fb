//! Of coplanar surfaces, the first of the scene is visible.

use super::{film, noise, random, scene, validated};
use rtc::internals::ir::{self, Scene};
use rtc::internals::math::{U, Vec3, pow};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, Intersect, Ray, Shape, World};

/// The common material.
const MATERIAL: &str = "material: {color: [1, 1, 1], ka: 1, kd: 0, ks: 0, n: 1}";

fn world(scene: &Scene) -> World<Shape> {
    let proof = validated(scene);
    World::prepare(&proof, &Plan::new(&proof, RuleSet::NONE))
}

/// Coplanar parts of the plane x + 2y + 3z = 6 with integer vertices; each has a vertex that the
/// others lack.
const PIECES: [&str; 6] = [
    "{type: quad, v0: [-24, 0, 10], v1: [24, -24, 10], v2: [24, 24, -22], v3: [-24, 48, -22]}",
    "{type: quad, v0: [-27, 3, 9], v1: [30, -30, 12], v2: [30, 21, -22], v3: [-27, 54, -25]}",
    "{type: triangle, v0: [-45, 0, 17], v1: [45, -45, 17], v2: [6, 75, -50]}",
    "{type: prism, v0: [-48, 0, 18], v1: [48, -48, 18], v2: [6, 75, -50], up: [-10, -20, -30]}",
    "{type: circle, center: [1, 1, 1], normal: [1, 2, 3], radius: 30}",
    "{type: plane, position: [-1, -1, 3], normal: [-3, -6, -9]}",
];

/// Rays that hit the plane near its middle, from near and far, at steep and grazing angles.
fn aimed(index: u64) -> Ray {
    let [u, v] = [noise(7 * index + 1_000_003), noise(7 * index + 1_000_004)];
    let target = Vec3::new(1.0, 1.0, 1.0)
        + Vec3::new(2.0, -1.0, 0.0) * (4.0 * u)
        + Vec3::new(3.0, 0.0, -1.0) * (3.0 * v);
    let (away, far) = (
        random(index).normalize(),
        pow(1000.0, noise(7 * index + 1_000_005)),
    );
    let height = away.dot(Vec3::new(1.0, 2.0, 3.0).normalize());
    // The prism lies on one side.
    let away = if height < 0.0 { -away } else { away };
    Ray {
        origin: target + away * (20.0 * far),
        direction: -away,
    }
}

#[test]
fn of_coplanar_surfaces_the_first_is_seen_in_any_order() {
    for turn in 0..PIECES.len() {
        let pieces: Vec<_> = (0..PIECES.len())
            .map(|k| PIECES[(k + turn) % PIECES.len()])
            .collect();
        for count in 2..=pieces.len() {
            let object =
                |piece: &&str| format!("- {}, {MATERIAL}}}\n", piece.trim_end_matches('}'));
            let objects = pieces[..count].iter().map(object).collect::<String>();
            let world = world(&scene(&format!("Eye: [0, 0, 100]\nObjects:\n{objects}")));
            let first = |index: &u64| {
                world
                    .closest_hit(&aimed(*index))
                    .map(|hit| hit.surface.index())
                    == Some(0)
            };
            let wrong = (0..20_000).filter(|index| !first(index)).count();
            assert_eq!(wrong, 0, "{:?}", &pieces[..count]);
        }
    }
}

/// A scene of quads.
fn quads(quads: impl IntoIterator<Item = [Vec3; 4]>) -> Scene {
    let mut scene = scene(&format!(
        "Eye: [0, 0, 100]\nObjects:\n- {}, {MATERIAL}}}\n",
        PIECES[0].trim_end_matches('}')
    ));
    let first = scene.surfaces.remove(0);
    let shape = |vertices: [Vec3; 4]| {
        ir::Shape::Quad(ir::Quad {
            vertices: vertices.map(|v| v.to_array()),
        })
    };
    scene.surfaces = quads
        .into_iter()
        .map(|quad| ir::Surface {
            shape: shape(quad),
            ..first.clone()
        })
        .collect();
    scene
}

/// Enough surfaces for a hierarchy; at each point the first is visible, in either order.
#[test]
fn of_many_coplanar_quads_the_first_is_seen() {
    let quad = |index: u64| {
        let [u, v] = [noise(index + 77), noise(index + 991)].map(|w| (w * 8.0).round());
        let at = |a: f64, b: f64| Vec3::new(2.0 * a + 3.0 * b, -a, 2.0 - b);
        [
            at(u - 3.0, v - 3.0),
            at(u + 3.0, v - 3.0),
            at(u + 3.0, v + 3.0),
            at(u - 3.0, v + 3.0),
        ]
    };
    let forward: Vec<_> = (0..60).map(quad).collect();
    for all in [forward.clone(), forward.into_iter().rev().collect()] {
        let single: Vec<_> = all.iter().map(|quad| world(&quads([*quad]))).collect();
        let world = world(&quads(all));
        let mut several = 0;
        for index in 0..2000 {
            let ray = aimed(index);
            let mut hit = (0..60).filter(|index| single[*index].closest_hit(&ray).is_some());
            assert_eq!(
                world.closest_hit(&ray).map(|hit| hit.surface.index()),
                hit.next(),
                "ray {index}"
            );
            several += u32::from(hit.next().is_some());
        }
        assert!(several > 500, "{several} rays meet more than one");
    }
}

/// A decal that follows the wall in the scene, but lies in front of it by four times the rounding
/// error.
#[test]
fn a_decal_four_error_bounds_in_front_is_seen() {
    let mut tried = 0;
    for index in 0..1000 {
        let corner = random(3 * index) * pow(10.0, 3.0 * noise(index + 5));
        let (first, second) = (random(3 * index + 1), random(3 * index + 2));
        if first.cross(second).length() < 0.1 {
            continue;
        }
        let normal = first.cross(second).normalize();
        let quad = |lift: f64| {
            [Vec3::ZERO, first, first + second, second].map(|v| corner + v + normal * lift)
        };
        let ray = aimed_at(corner + (first + second) * 0.5, normal, index);
        let wall = world(&quads([quad(0.0)]));
        let Some(hit) = wall.closest_hit(&ray) else {
            continue;
        };
        let at = wall
            .surfaces
            .first()
            .unwrap()
            .shape
            .interaction(&ray, hit.t, hit.prim_id);
        // The error of the surface along its normal, and of the root along the ray.
        let bound = 0.5 * at.offset + 10.0 * U * hit.t * ray.direction.dot(at.normal).abs();
        let hit = world(&quads([quad(0.0), quad(4.0 * bound)]))
            .closest_hit(&ray)
            .unwrap();
        assert_eq!(hit.surface.index(), 1, "case {index}, bound {bound:e}");
        tried += 1;
    }
    assert!(tried > 500, "{tried} decals");
}

/// A ray that hits a point from the side of a normal.
fn aimed_at(target: Vec3, normal: Vec3, index: u64) -> Ray {
    let away = random(index + 9000).normalize();
    let away = if away.dot(normal) < 0.0 { -away } else { away };
    Ray {
        origin: target + away * pow(100.0, noise(index + 31)),
        direction: -away,
    }
}

/// A picture of two overlapping quads has no speckles, without and with shadows and reflections.
#[test]
fn coplanar_quads_do_not_speckle() {
    let material = |color: &str, ks: f64| {
        format!("material: {{color: [{color}], ka: 0.5, kd: 0.5, ks: {ks}, n: 9}}}}")
    };
    let seen = |objects: &[(&str, &str)], ks: f64| -> Film {
        let object = |(piece, color): &(&str, &str)| {
            format!(
                "- {}, {}\n",
                piece.trim_end_matches('}'),
                material(color, ks)
            )
        };
        let objects = objects.iter().map(object).collect::<String>();
        film(
            &scene(&format!(
                "Camera: {{eye: [20, 40, 60], center: [1, 1, 1], up: [0, 1, 0], viewSize: [50, \
                 50], fov: 16}}\n\
                 Shadows: true\nMaxRecursionDepth: 3\nLights:\n- {{position: [9, 70, 80], color: \
                 [1, 1, 1]}}\n\
                 Objects:\n{objects}"
            )),
            RuleSet::ALL,
        )
    };
    for (first, second) in (0..6)
        .flat_map(|a| (0..6).map(move |b| (a, b)))
        .filter(|(a, b)| a != b)
    {
        for ks in [0.0, 0.5] {
            let both = seen(
                &[(PIECES[first], "1, 0, 0"), (PIECES[second], "0, 0, 1")],
                ks,
            );
            let one = seen(&[(PIECES[first], "1, 0, 0")], ks);
            let differ = both.image.pixels.iter().zip(&one.image.pixels);
            let count = differ
                .filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 1e-9))
                .count();
            assert_eq!(count, 0, "{} before {}", PIECES[first], PIECES[second]);
        }
    }
}
