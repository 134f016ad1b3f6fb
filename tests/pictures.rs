//! Whole pictures against what must be true of them: the outline of a far planet to the pixel, and
//! its day side without acne.

#![expect(clippy::unwrap_used, reason = "a test stops at a surprise")]

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{self, LoweredScene, Scene};
use rtc::internals::math::{DoubleDouble, Vec3, view_basis};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{
    Film, Intersect, RenderSelection, Shape, World, camera_ray, image_point,
};
use rtc::internals::valid::{self, ValidScene};

fn validated(scene: Scene) -> ValidScene {
    let (mut sink, options) = (DiagnosticSink::default(), Options::default());
    let lowered = LoweredScene {
        scene,
        source_spans: ir::SourceSpans::default(),
    };
    pipeline::validate(&lowered, &options, &mut sink).unwrap_or_else(|| panic!("{:?}", sink.kept()))
}

fn film(scene: &ValidScene) -> Film {
    pipeline::render(
        scene,
        &Plan::new(scene, RuleSet::ALL),
        &RenderSelection::default(),
        0,
        &|_| true,
    )
    .unwrap()
    .unwrap()
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
            ..ir::Settings::default()
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
        surfaces: vec![ir::Surface::new(
            ir::Shape::Sphere(sphere),
            ir::MaterialId(0),
        )],
        names: Vec::new(),
        environment: None,
        medium: None,
        display: ir::Display::default(),
        trees: Vec::new(),
    }
}

#[test]
fn the_outline_of_a_far_planet_is_exact_to_the_pixel() {
    let scene = validated(earth());
    let world = World::<Shape>::prepare(&scene, &Plan::new(&scene, RuleSet::ALL));
    let camera = &world.camera;
    let valid::Shape::Sphere(sphere) = &scene.surfaces()[0].shape else {
        panic!("the earth is a sphere")
    };
    let mut seen = 0;
    for (x, y) in (0..400).flat_map(|y| (0..400).map(move |x| (x, y))) {
        let ray = camera_ray(camera.eye, image_point(camera, [x, y], [0.5; 2]));
        // b² − a·c in twice the precision: c cancels 4 of its 32 digits.
        let dot =
            |a: [DoubleDouble; 3], b: [DoubleDouble; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let f = [0, 1, 2].map(|k| DoubleDouble::difference(ray.origin[k], sphere.center[k]));
        let d = [0, 1, 2].map(|k| DoubleDouble::from(ray.direction[k]));
        let radius = DoubleDouble::from(sphere.radius.get());
        let (a, b, c) = (dot(d, d), dot(f, d), dot(f, f) - radius * radius);
        let wanted = (b * b - a * c).to_f64() >= 0.0;
        assert_eq!(world.closest_hit(&ray).is_some(), wanted, "pixel {x}, {y}");
        seen += u32::from(wanted);
    }
    assert!(
        (60_000..90_000).contains(&seen),
        "the planet fills {seen} pixels"
    );
}

#[test]
fn the_day_side_of_a_far_planet_is_lit_all_over() {
    let scene = validated(earth());
    let world = World::<Shape>::prepare(&scene, &Plan::new(&scene, RuleSet::ALL));
    let camera = &world.camera;
    let film = film(&scene);
    let mut lit = 0;
    for (x, y) in (0..400).flat_map(|y| (0..400).map(move |x| (x, y))) {
        let ray = camera_ray(camera.eye, image_point(camera, [x, y], [0.5; 2]));
        let Some(hit) = world.closest_hit(&ray) else {
            continue;
        };
        let at = world.surfaces[hit.surface]
            .shape
            .interaction(&ray, hit.t, hit.prim_id);
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
