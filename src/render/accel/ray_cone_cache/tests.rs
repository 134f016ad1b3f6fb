//! A cached cone contains every item that one of its rays hits.

use super::*;
use crate::accel::simd::baseline;
use crate::lanes::four_rays;
use crate::sampler::PathVertexKey;
use crate::shape::geometry::Intersect;
use crate::shape::sphere::{Sphere, TexturedSphere};
use crate::shape::torus::Torus;
use crate::shape::triangle::WatertightRay;
use rayon::prelude::*;

/// The names of the families of scenes, the size of their shapes, and their distance.
const FAMILIES: [(&str, f64, f64); 5] = [
    ("generic", 1.0, 3.0),
    ("close by", 1.0, 1.001),
    ("tiny and far", 1e-3, 1e3),
    ("a planet of 6378 at 150 million", 6378.0, 1.5e8),
    ("a planet of 6378 from its ground", 6_378.0, 6_378.000_001),
];

/// A shape, and a ray of length 1 that grazes it, or passes at random.
struct Case {
    sphere: Sphere,
    torus: Torus,
    ray: Ray,
    key: PathVertexKey,
}

fn vector(key: PathVertexKey, first: u64) -> Vec3 {
    let uniform = |k: u64| key.uniform(first + k) * 2.0 - 1.0;
    Vec3::new(uniform(0), uniform(1), uniform(2))
}

impl Case {
    fn new(family: usize, index: u64) -> Self {
        let (_, size, distance) = FAMILIES[family];
        let key = PathVertexKey::new([u32::try_from(family).unwrap(), 7], index);
        let center = vector(key, 0) * distance;
        let away = vector(key, 3).normalize() * distance * (1.0 + key.uniform(6));
        let origin = center + away;
        // Aim at the silhouette, as seen from about the origin, and just beside it.
        let across = away.any_orthonormal_vector();
        let beside = [0.999, 1.0, 1.0 + 1e-9, 1.001, 4.0][(index % 5) as usize];
        let sine = size / away.length();
        let foot = away * (sine * sine) + across * (size * (1.0 - sine * sine).max(0.0).sqrt());
        let direction = (center + foot * beside - origin).normalize();
        Self {
            sphere: Sphere {
                center,
                radius: size,
            },
            torus: Torus::new(center, vector(key, 7), size * 0.75, size * 0.25),
            ray: Ray { origin, direction },
            key,
        }
    }

    fn balls(&self) -> BoundingSpheres {
        let sphere = TexturedSphere {
            sphere: self.sphere,
            texture_from_world: Vec3::AXES,
        };
        let balls = [sphere.ball(), self.torus.ball()];
        BoundingSpheres::new(balls.into_iter().enumerate())
    }

    /// The bits of the shapes that a ray hits before `t_max`.
    fn hits(&self, ray: &Ray, t_max: f64) -> u64 {
        let watertight = WatertightRay::new(ray);
        let torus = Intersect::intersect(&self.torus, ray, &watertight, t_max).map(|(t, _)| t);
        let hits = [self.sphere.intersect(ray), torus];
        let is_hit = hits.map(|t| u64::from(t.is_some_and(|t| t < t_max)));
        is_hit[0] | is_hit[1] << 1
    }
}

/// Sums the hits and the errors of `intersect4` in the cases of each family.
fn no_fault(what: &str, intersect4: impl Fn(&Case) -> [u64; 2] + Sync) {
    let cases = std::env::var("RTC_RAYS")
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(20_000_u64);
    for (family, (name, ..)) in FAMILIES.into_iter().enumerate() {
        let [hits, faults] = (0..cases)
            .into_par_iter()
            .map(|index| intersect4(&Case::new(family, index)))
            .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        println!("| {what} | {name} | {hits} | {faults} |");
        assert!(
            hits > cases / 32 && faults == 0,
            "{name}: {faults} of {hits}"
        );
    }
}

#[test]
fn no_cone_passes_over_what_one_of_its_rays_hits() {
    no_fault("cones", |case| {
        let balls = case.balls();
        let mut cone = RayCone::EMPTY;
        cone.origin = if case.key.uniform(20) < 0.5 {
            case.ray.origin
        } else {
            cone.origin
        };
        let cone = cone.around(&case.ray, &balls).unwrap();
        let (reach, sine) = (cone.near.sqrt(), cone.alike.sqrt().min(1.0));
        let mut sums = [0; 2];
        for k in 0..16 {
            // At the rim of the cone, towards the shape.
            let towards = (case.sphere.center - case.ray.origin).normalize();
            let aside = (towards + vector(case.key, 30 + 6 * k) * (0.1 * k as f64)).normalize();
            let origin = case.ray.origin + aside.any_orthonormal_vector() * reach * 0.999;
            let direction = (case.ray.direction + aside * sine * 0.9).normalize();
            let ray = Ray { origin, direction };
            if cone.holds(&ray) {
                let hits = case.hits(&ray, f64::INFINITY);
                sums[0] += u64::from(hits != 0);
                sums[1] += u64::from(hits & !cone.items != 0);
            }
        }
        sums
    });
}

#[test]
fn no_shaft_passes_over_what_one_of_its_segments_hits() {
    no_fault("shafts", |case| {
        let balls = case.balls();
        let length = (case.ray.origin - case.sphere.center).length();
        let size = case.sphere.radius;
        let target = BoundingSphere {
            center: case.ray.origin + case.ray.direction * length * (0.5 + case.key.uniform(21)),
            radius: size * 0.2 * (case.key.uniform(22) - 0.5).max(0.0),
        };
        let shaft = Shaft::EMPTY.around(&balls, 3, case.ray.origin, &target);
        let mut sums = [0; 2];
        for k in 0..16 {
            let towards = (case.sphere.center - case.ray.origin).normalize();
            let aside = (towards.any_orthonormal_vector()
                + vector(case.key, 30 + 6 * k) * (0.1 * k as f64))
                .normalize();
            let origin = case.ray.origin - aside * shaft.near.sqrt().min(size) * 0.999;
            let end = target.center + vector(case.key, 33 + 6 * k).normalize() * target.radius;
            if shaft.holds(3, origin) {
                let ray = Ray {
                    origin,
                    direction: end - origin,
                };
                let hits = case.hits(&ray, 1.0);
                sums[0] += u64::from(hits != 0);
                sums[1] += u64::from(hits & !shaft.items != 0);
            }
        }
        sums
    });
}

/// Four rays, or the starts of four segments, at a time, close together or far apart: with cones,
/// and while the cache is skipped.
#[test]
fn four_lanes_are_told_of_all_that_each_may_hit() {
    let simd = baseline();
    let (mut hits, mut fewer) = (0, 0);
    for index in 0..1000 {
        let case = Case::new((index % 2) as usize, index);
        let (balls, mut bundles) = (case.balls(), RayConeCache::EMPTY);
        let spread = [1e-3, 0.1, 1.0][(index % 3) as usize];
        let target = BoundingSphere {
            center: case.sphere.center * 2.0 - case.ray.origin,
            radius: 0.0,
        };
        for k in 0..16 {
            let rays = [0, 1, 2, 3].map(|lane| {
                let place = 30 + 24 * k + 6 * lane;
                let aside = vector(case.key, place) * spread;
                Ray {
                    origin: case.ray.origin + vector(case.key, place + 3) * spread * 0.1,
                    direction: (case.ray.direction + aside).normalize(),
                }
            });
            let four = four_rays(simd, &rays);
            let (answered, items) = bundles.along_each(simd, &balls, 0, &four, 0b1101);
            assert_eq!(answered, 0b1101);
            let between = bundles.towards_each(&balls, [0, 0, 1], four.origin, 0b1011, || target);
            assert_eq!(between[2], 0);
            for (lane, ray) in rays.iter().enumerate() {
                let segment = Ray {
                    direction: target.center - ray.origin,
                    ..*ray
                };
                let hit_items = case.hits(ray, f64::INFINITY);
                let hidden = case.hits(&segment, 1.0);
                assert!(lane == 1 || hit_items & !items == 0, "{index} {k} {lane}");
                assert!(
                    lane == 2 || hidden & !between[lane] == 0,
                    "{index} {k} {lane}"
                );
                hits += u64::from(hit_items != 0) + u64::from(hidden != 0);
                fewer += u64::from(items != balls.all) + u64::from(between[lane] != balls.all);
            }
        }
    }
    assert!(hits > 10_000 && fewer > 10_000, "{hits} {fewer}");
}

#[test]
fn rays_that_are_not_of_length_one_or_not_finite_have_no_cone() {
    let case = Case::new(0, 0);
    let balls = case.balls();
    let (origin, direction) = (case.ray.origin, case.ray.direction);
    let rays = [
        (origin, direction * 2.0),
        (origin, direction * f64::NAN),
        (origin * f64::INFINITY, direction),
    ];
    for (origin, direction) in rays {
        let ray = Ray { origin, direction };
        assert!(RayCone::EMPTY.around(&ray, &balls).is_none());
        // With a requested cone, and while the cache is skipped.
        let (simd, mut bundles) = (baseline(), RayConeCache::EMPTY);
        let four = four_rays(simd, &[ray, case.ray, case.ray, ray]);
        for pause in [0, ConeSizeHeuristic::PAUSE] {
            bundles.cones[0].near = -1.0;
            bundles.cones[0].pace.pause = pause;
            let (answered, _) = bundles.along_each(simd, &balls, 0, &four, 0b1111);
            assert_eq!(answered, 0b0110);
        }
    }
    assert!(!RayCone::EMPTY.holds(&case.ray));
}

#[test]
fn a_bundle_keeps_only_what_its_rays_can_meet() {
    let ball = |x: f64| BoundingSphere {
        center: Vec3::new(x, 0.0, 0.0),
        radius: 1.0,
    };
    let items = [Some(ball(10.0)), Some(ball(-10.0)), None];
    let balls = BoundingSpheres::new(items.into_iter().enumerate());
    let mut bundles = RayConeCache::EMPTY;
    let ray = Ray {
        origin: Vec3::ZERO,
        direction: Vec3::X,
    };
    assert_eq!(bundles.along(&balls, 0, &ray), Some(0b101));
    let target = BoundingSphere {
        center: Vec3::new(0.0, 9.0, 0.0),
        radius: 0.5,
    };
    let mut towards = |from: Vec3| bundles.towards(&balls, [0, 0, 1], from, || target);
    assert_eq!(towards(Vec3::new(-20.0, -9.0, 0.0)), 0b110);
    assert_eq!(towards(Vec3::new(20.0, -9.0, 0.0)), 0b101);
    assert_eq!(towards(Vec3::new(0.0, 5.0, 0.0)), 0b100);
}
