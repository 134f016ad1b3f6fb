//! The plain arithmetics: right where rays are benign, wrong where the books are, and warned of
//! there.
//!
//! Scenes of the course are read from `../shared/course`; without them those tests skip with a
//! note.

#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a test says what it skips and stops at a surprise"
)]

use rtc::color::quantize8;
use rtc::diag::Sink;
use rtc::math::{Positive, Vec3};
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Arithmetic, Plan, Rules, Symptom, loss};
use rtc::render::{Film, Geometry, Job, PlainShape, Ray, Real, Shape, Shear};
use rtc::source::{Loader, SourceMap};
use rtc::valid::{self, ValidScene};
use std::path::{Path, PathBuf};
use std::sync::Arc;

fn length(x: f64) -> Positive {
    Positive::new(x).unwrap()
}

/// One shape of each kind within about 2 of the origin, with its name.
fn shapes() -> Vec<(&'static str, valid::Shape)> {
    let (center, axis, radius) = (
        Vec3::new(0.2, -0.3, 0.1),
        Vec3::new(0.3, 0.5, -1.0),
        length(0.9),
    );
    let corners = [
        Vec3::new(-1.0, -1.1, 0.2),
        Vec3::new(1.2, -0.9, 0.1),
        Vec3::new(0.9, 1.0, -0.2),
    ];
    let opposite = corners[0] + corners[2] - corners[1];
    let quad = |last: Vec3| valid::Quad {
        vertices: [corners[0], corners[1], corners[2], last],
    };
    let sides = [
        Vec3::new(1.1, 0.2, 0.0),
        Vec3::new(-0.2, 0.9, 0.1),
        Vec3::new(0.1, 0.0, 1.3),
    ];
    let world_from_object = [sides[0], sides[1], sides[2], center];
    vec![
        (
            "sphere",
            valid::Shape::Sphere(valid::Sphere {
                center,
                radius,
                texture_from_world: None,
            }),
        ),
        (
            "plane",
            valid::Shape::Plane(valid::Plane {
                center,
                normal: axis,
            }),
        ),
        (
            "triangle",
            valid::Shape::Triangle(valid::Triangle {
                vertices: corners,
                uvs: None,
            }),
        ),
        ("flat quad", valid::Shape::Quad(Box::new(quad(opposite)))),
        (
            "patch",
            valid::Shape::Quad(Box::new(quad(opposite + Vec3::Z))),
        ),
        (
            "disc",
            valid::Shape::Disc(valid::Disc {
                center,
                normal: axis,
                radius,
            }),
        ),
        (
            "cylinder",
            valid::Shape::Cylinder(valid::Cylinder {
                base: center,
                axis,
                height: length(1.2),
                radius,
            }),
        ),
        (
            "cone",
            valid::Shape::Cone(valid::Cone {
                base: center,
                up: axis,
                radius,
            }),
        ),
        (
            "torus",
            valid::Shape::Torus(valid::Torus {
                center,
                axis,
                major: radius,
                minor: length(0.35),
            }),
        ),
        (
            "instance",
            valid::Shape::Instance(Box::new(valid::Instance {
                mesh: 0,
                world_from_object,
            })),
        ),
    ]
}

/// A tetrahedron.
fn mesh() -> Arc<valid::Mesh> {
    Arc::new(valid::Mesh {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]
            .map(|corner| corner.to_array())
            .into_iter()
            .collect(),
        triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].into(),
        ..valid::Mesh::default()
    })
}

fn prepare<S: Geometry>(shape: &valid::Shape) -> S {
    S::prepare(shape, &[Arc::new(S::prepare_mesh(&mesh()))]).unwrap()
}

/// Rays from points at 3 to 6 from the origin towards points within 1 of it, with directions of
/// many lengths.
fn rays(count: usize) -> impl Iterator<Item = Ray> {
    let mut state = 1_u64;
    let mut number = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut point = move || Vec3::new(number(), number(), number());
    (0..count).map(move |_| {
        let origin = point().normalize() * (4.5 + 1.5 * point().x);
        Ray {
            origin,
            direction: (point() - origin) * (1.5 + point().x),
        }
    })
}

/// The largest error of t (relative) and of the normal over benign rays: those that meet the shape
/// at more than 15°.
fn worst_error<R: Real>(name: &str, shape: &valid::Shape) -> f64 {
    let (plain, robust) = (prepare::<PlainShape<R>>(shape), prepare::<Shape>(shape));
    let (mut worst, mut hits) = (0.0_f64, 0);
    for ray in rays(2000) {
        let shear = Shear::new(&ray);
        let Some((t, part)) = robust.intersect(&ray, &shear, f64::INFINITY) else {
            continue;
        };
        let right = robust.interaction(&ray, t, part);
        if right.normal.dot(ray.direction.normalize()).abs() < 0.25 {
            continue;
        }
        let (found, part) = plain
            .intersect(&ray, &shear, f64::INFINITY)
            .unwrap_or_else(|| panic!("{name}: {ray:?}"));
        let interaction = plain.interaction(&ray, found, part);
        assert_eq!(
            interaction.start(Vec3::X),
            interaction.point,
            "{name}: rays start off the point"
        );
        worst = worst
            .max((found - t).abs() / t)
            .max(interaction.normal.distance(right.normal));
        hits += 1;
    }
    assert!(hits > 100, "{name}: {hits} rays hit");
    worst
}

#[test]
fn benign_rays_meet_the_same_shapes_by_any_arithmetic() {
    for (name, shape) in shapes() {
        let (double, single) = (
            worst_error::<f64>(name, &shape),
            worst_error::<f32>(name, &shape),
        );
        println!("{name:<10} plain {double:.1e}, f32 {single:.1e}");
        // Near the apex a small step turns the normal; the roots of the quartic lose most of the
        // digits of f32.
        let bar = match name {
            "cone" => 1e-3,
            "torus" => 0.1,
            _ => 1e-4,
        };
        assert!(
            double < 1e-9 && single < bar,
            "{name}: {double:e} {single:e}"
        );
        assert!(single > 1e-9, "{name}: f32 is no f32");
    }
}

#[test]
fn hits_within_the_threshold_are_ignored_whatever_the_length_of_the_direction() {
    let plain = prepare::<PlainShape<f64>>(&shapes()[1].1);
    let above = |height: f64, size: f64| {
        let normal = Vec3::new(0.3, 0.5, -1.0).normalize();
        let ray = Ray {
            origin: Vec3::new(0.2, -0.3, 0.1) + normal * height,
            direction: -normal * size,
        };
        plain
            .intersect(&ray, &Shear::new(&ray), f64::INFINITY)
            .is_some()
    };
    for size in [1e-3, 1.0, 1e6] {
        assert!(!above(0.9e-5, size) && above(1.1e-5, size), "{size}");
    }
}

fn course() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/course/scenes");
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

/// A scene at no more than `side` pixels wide or high, one sample each.
fn small(path: &Path, side: u32) -> ValidScene {
    let (mut map, mut sink, options) = (SourceMap::default(), Sink::default(), Options::default());
    let file = Loader.file(path, &mut map).unwrap();
    let mut lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    let [width, height] = lowered.scene.camera.size;
    let size = [width, height].map(|pixels| (pixels * side).div_ceil(width.max(height)));
    let overrides = Overrides {
        size: Some(size),
        supersampling: Some(1),
        ..Overrides::default()
    };
    overrides.apply(&mut lowered.scene);
    pipeline::prove(&lowered, &options, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

fn film(scene: &ValidScene, arithmetic: Arithmetic) -> Film {
    pipeline::render(
        scene,
        &Plan::by(arithmetic, scene, Rules::ALL),
        &Job::default(),
        0,
        &|_| true,
    )
    .unwrap()
    .unwrap()
}

/// The share of pixels that differ in 8 bits.
fn difference(a: &Film, b: &Film) -> f64 {
    let pairs = || a.image.pixels.iter().zip(&b.image.pixels);
    pairs()
        .filter(|(a, b)| a.map(quantize8) != b.map(quantize8))
        .count() as f64
        / pairs().count() as f64
}

#[test]
fn the_day_side_of_a_far_planet_goes_dark_in_f32_alone() {
    let Some(course) = course() else { return };
    let scene = small(&course.join("blue-earth.yaml"), 80);
    let robust = film(&scene, Arithmetic::Robust);
    let darker = |film: &Film| {
        let brightness = |pixel: &[f64; 3]| pixel.iter().sum::<f64>();
        let pairs = robust.image.pixels.iter().zip(&film.image.pixels);
        let day = pairs
            .filter(|(robust, _)| brightness(robust) > 0.3)
            .map(|(a, b)| brightness(b) < 0.6 * brightness(a));
        let dark = day.collect::<Vec<_>>();
        dark.iter().filter(|dark| **dark).count() as f64 / dark.len() as f64
    };
    assert_eq!(darker(&film(&scene, Arithmetic::Plain)), 0.0);
    let share = darker(&film(&scene, Arithmetic::F32));
    assert!((0.3..0.7).contains(&share), "{share}");
    let warning = loss(&scene, Arithmetic::F32).unwrap();
    assert!(
        warning.symptom == Symptom::SelfHit && warning.error > 1.0,
        "{warning:?}"
    );
}

#[test]
fn a_scene_of_the_course_without_shadows_is_the_same_by_any_arithmetic() {
    let Some(course) = course() else { return };
    let scene = small(&course.join("scene01.yaml"), 160);
    let robust = film(&scene, Arithmetic::Robust);
    assert_eq!(difference(&robust, &film(&scene, Arithmetic::Plain)), 0.0);
    let share = difference(&robust, &film(&scene, Arithmetic::F32));
    assert!(share > 0.0 && share < 1e-3, "{share}");
}

#[test]
fn what_shows_is_warned_of_and_what_is_equal_is_not() {
    let Some(course) = course() else { return };
    let mut scenes = course
        .read_dir()
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect::<Vec<_>>();
    scenes.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "yaml")
    });
    scenes.sort();
    for path in scenes {
        let scene = small(&path, 64);
        let robust = film(&scene, Arithmetic::Robust);
        for arithmetic in [Arithmetic::Plain, Arithmetic::F32] {
            let differs = difference(&robust, &film(&scene, arithmetic));
            let warning = loss(&scene, arithmetic);
            let name = path.file_stem().unwrap().to_string_lossy();
            let excess = warning.map_or(0.0, |loss| loss.excess);
            println!(
                "{name:<45} {arithmetic:<6?} {:8.3} % excess {excess:.1e} {:?}",
                100.0 * differs,
                warning.map(|w| w.symptom)
            );
            assert!(
                differs <= 0.01 || warning.is_some(),
                "{name} {arithmetic:?}: no warning, {differs} differ"
            );
            assert!(
                differs > 0.0 || warning.is_none(),
                "{name} {arithmetic:?}: {warning:?}, and nothing differs"
            );
        }
    }
}
