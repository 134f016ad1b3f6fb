//! Whole pictures against what must be true of them: no acne, no cracks, and the outline of a far
//! planet to the pixel.
//!
//! Scenes of the course are read from `../shared/course`; without them those tests skip with a
//! note.

#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a test says what it skips and stops at a surprise"
)]

use rtc::diag::Sink;
use rtc::image::Image;
use rtc::ir::{self, Lowered, Scene};
use rtc::math::{Double, Vec3, view_basis};
use rtc::passes::Overrides;
use rtc::pipeline::{self, Options};
use rtc::plan::{Plan, Rules};
use rtc::render::{Counts, Film, Geometry, Job, Shape, World, camera_ray, image_point};
use rtc::source::{Loader, SourceMap};
use rtc::valid::{self, ValidScene};
use std::path::Path;

fn proven(scene: Scene) -> ValidScene {
    let (mut sink, options) = (Sink::default(), Options::default());
    let lowered = Lowered {
        scene,
        origins: ir::Origins::default(),
    };
    pipeline::prove(&lowered, &options, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

/// A scene of the course, or `None` with a note.
fn course(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/course/scenes")
        .join(name);
    if !path.exists() {
        println!("skipped: {} is not here", path.display());
        return None;
    }
    let (mut map, mut sink, options) = (SourceMap::default(), Sink::default(), Options::default());
    let file = Loader.file(&path, &mut map).unwrap();
    let lowered = pipeline::load(file, &mut map, &options, &mut sink).unwrap();
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    Some(lowered.scene)
}

fn film(scene: &ValidScene) -> Film {
    pipeline::render(
        scene,
        &Plan::new(scene, Rules::ALL),
        &Job::default(),
        0,
        &|_| true,
    )
    .unwrap()
    .unwrap()
}

/// Pixels that differ by more than a quarter of the range from eight neighbours that agree: acne
/// and cracks.
fn outliers(film: &Film) -> usize {
    const LARGE: f64 = 0.25;
    const SMALL: f64 = 0.1;
    let (width, height) = (film.image.width as usize, film.image.height as usize);
    let pixel = |x: usize, y: usize| film.image.pixels[y * width + x];
    let differ = |a: [f64; 3], b: [f64; 3], limit: f64| (0..3).any(|k| (a[k] - b[k]).abs() > limit);
    let alone = |x: usize, y: usize| {
        let around = || {
            (0..9)
                .filter(|k| *k != 4)
                .map(|k| pixel(x + k % 3 - 1, y + k / 3 - 1))
        };
        let first = pixel(x - 1, y - 1);
        around().all(|other| !differ(other, first, SMALL)) && differ(pixel(x, y), first, LARGE)
    };
    (1..height - 1)
        .flat_map(|y| (1..width - 1).map(move |x| (x, y)))
        .filter(|(x, y)| alone(*x, *y))
        .count()
}

#[test]
fn curved_shapes_show_neither_acne_nor_cracks() {
    for name in [
        "tori.yaml",
        "torus.yaml",
        "cylinder.yaml",
        "circle.yaml",
        "olympic.yaml",
    ] {
        let Some(mut scene) = course(name) else {
            return;
        };
        let [width, height] = scene.camera.size;
        let size = Some([800, 800 * height / width]);
        // Reflections of the rings in themselves are finer than a pixel; nine rays tell such a line
        // from acne.
        Overrides {
            size,
            supersampling: Some(3),
            ..Overrides::default()
        }
        .apply(&mut scene);
        let count = outliers(&film(&proven(scene)));
        assert_eq!(count, 0, "{name}: isolated pixels");
    }
}

#[test]
fn one_wrong_pixel_is_counted() {
    let image = Image {
        width: 5,
        height: 5,
        pixels: vec![[0.5; 3]; 25],
    };
    let mut film = Film {
        image,
        coverage: vec![1.0; 25],
        counts: Counts::default(),
    };
    assert_eq!(outliers(&film), 0);
    film.image.pixels[12] = [0.5, 0.0, 0.5];
    assert_eq!(outliers(&film), 1);
}

/// The earth of the course: radius 6 378.1 at 149 597 890, seen from 384 000 away.
fn earth() -> Scene {
    let (eye, center) = (
        Vec3::new(192_201.5, 0.0, 149_264_987.0),
        Vec3::new(0.0, 0.0, 149_597_890.0),
    );
    let (right, up) = view_basis(center - eye, Vec3::new(0.0, 40.0, 0.0)).unwrap();
    let phong = ir::Phong {
        ka: 0.2,
        kd: 0.7,
        ..ir::Phong::MATT
    };
    let sphere = ir::Sphere {
        center: center.to_array(),
        radius: 6378.1,
        texture_from_world: None,
    };
    Scene {
        camera: ir::Camera {
            eye: eye.to_array(),
            center: center.to_array(),
            right: right.to_array(),
            up: up.to_array(),
            size: [400, 400],
            lens: ir::Lens {
                radius: 0.0,
                samples: 1,
            },
            projection: ir::Projection::Perspective,
        },
        settings: ir::Settings {
            mode: ir::Mode::Phong,
            shadows: true,
            max_depth: 0,
            supersampling: 1,
            pattern: ir::Pattern::Grid,
            light_samples: 1,
        },
        lights: vec![ir::Light::Point(ir::PointLight {
            position: [0.0; 3],
            color: [1.0; 3],
            radius: 0.0,
        })],
        images: Vec::new(),
        textures: Vec::new(),
        meshes: Vec::new(),
        materials: vec![ir::Material::Phong(phong)],
        surfaces: vec![ir::Surface {
            shape: ir::Shape::Sphere(sphere),
            material: ir::MaterialId(0),
        }],
        names: Vec::new(),
        environment: None,
    }
}

#[test]
fn the_outline_of_a_far_planet_is_exact_to_the_pixel() {
    let scene = proven(earth());
    let world = World::<Shape>::prepare(&scene, &Plan::new(&scene, Rules::ALL));
    let camera = scene.camera();
    let valid::Shape::Sphere(sphere) = &scene.surfaces()[0].shape else {
        panic!("the earth is a sphere")
    };
    let mut seen = 0;
    for (x, y) in (0..400).flat_map(|y| (0..400).map(move |x| (x, y))) {
        let ray = camera_ray(camera.eye, image_point(camera, [x, y], [0.5; 2]));
        // b² − a·c in twice the precision: c cancels 4 of its 32 digits.
        let dot = |a: [Double; 3], b: [Double; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let f = [0, 1, 2].map(|k| Double::difference(ray.origin[k], sphere.center[k]));
        let d = [0, 1, 2].map(|k| Double::from(ray.direction[k]));
        let radius = Double::from(sphere.radius.get());
        let (a, b, c) = (dot(d, d), dot(f, d), dot(f, f) - radius * radius);
        let wanted = (b * b - a * c).rounded() >= 0.0;
        assert_eq!(world.nearest(&ray).is_some(), wanted, "pixel {x}, {y}");
        seen += u32::from(wanted);
    }
    assert!(
        (60_000..90_000).contains(&seen),
        "the planet fills {seen} pixels"
    );
}

#[test]
fn the_day_side_of_a_far_planet_is_lit_all_over() {
    let scene = proven(earth());
    let world = World::<Shape>::prepare(&scene, &Plan::new(&scene, Rules::ALL));
    let camera = scene.camera();
    let film = film(&scene);
    let mut lit = 0;
    for (x, y) in (0..400).flat_map(|y| (0..400).map(move |x| (x, y))) {
        let ray = camera_ray(camera.eye, image_point(camera, [x, y], [0.5; 2]));
        let Some(hit) = world.nearest(&ray) else {
            continue;
        };
        let at = world.surfaces[hit.surface]
            .shape
            .interaction(&ray, hit.t, hit.part);
        let to_sun = -at.point.normalize();
        let wanted = 0.2 + 0.7 * at.normal.dot(to_sun).max(0.0);
        let value = film.image.pixels[(y * 400 + x) as usize][0];
        assert!(
            (value - wanted).abs() < 1e-9,
            "pixel {x}, {y}: {value} instead of {wanted}"
        );
        lit += u32::from(wanted > 0.2);
    }
    assert!(lit > 10_000, "{lit} pixels are lit");
}
