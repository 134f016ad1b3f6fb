//! Motion blur: each pixel shows what passes for its share of the time, and one moment is a scene
//! that stands still.

use crate::repo::root;
use crate::small::{WHOLE, bits, film, small, validated};
use rtc::internals::ir::{
    Camera, Light, Material, MaterialId, Mode, PathSettings, Phong, PointLight, Projection, Quad,
    Scene, Settings, Shape, Standard, Surface,
};
use rtc::internals::pipeline;
use rtc::internals::plan::{Plan, RuleSet};

/// The speed of the square, in pixels per second.
const SPEED: f64 = 8.0;

/// A square that shines white and moves along x, before an orthographic camera with pixels of size
/// 1. At the time 0 it covers x from −6 to −4.
fn square(mode: Mode) -> Scene {
    let is_path = matches!(mode, Mode::Path(_));
    let camera = Camera {
        eye: [0.0, 0.0, 10.0],
        center: [0.0; 3],
        right: [1.0, 0.0, 0.0],
        up: [0.0, 1.0, 0.0],
        size: [16, 2],
        projection: Projection::Orthographic,
        ..Camera::default()
    };
    let settings = Settings {
        mode,
        supersampling: 16,
        ..Settings::default()
    };
    let mut scene = Scene::new(camera, settings);
    scene.materials = vec![if is_path {
        Material::Standard(Box::new(Standard {
            unlit: true,
            ..Standard::default()
        }))
    } else {
        Material::Phong(Phong {
            ka: 1.0,
            kd: 0.0,
            ..Phong::MATT
        })
    }];
    scene.lights = vec![Light::Point(PointLight {
        position: [0.0, 0.0, 9.0],
        color: [1.0; 3],
        radius: 0.0,
    })];
    let corner = |x: f64, y: f64| [x, y, 0.0];
    let vertices = [
        corner(-6.0, -9.0),
        corner(-4.0, -9.0),
        corner(-4.0, 9.0),
        corner(-6.0, 9.0),
    ];
    scene.surfaces = vec![Surface {
        velocity: [SPEED, 0.0, 0.0].into(),
        ..Surface::new(Shape::Quad(Quad { vertices }), MaterialId(0))
    }];
    scene
}

fn modes() -> [Mode; 2] {
    [
        Mode::Phong,
        Mode::Path(PathSettings {
            samples: 256,
            ..PathSettings::default()
        }),
    ]
}

/// The part of a column that the square covers, on average over a second.
fn share(column: f64) -> f64 {
    const STEPS: u32 = 4096;
    let covered = |step: u32| {
        let left = -6.0 + SPEED * (f64::from(step) + 0.5) / f64::from(STEPS);
        ((left + 2.0).min(column + 1.0) - left.max(column)).max(0.0)
    };
    (0..STEPS).map(covered).sum::<f64>() / f64::from(STEPS)
}

#[test]
fn what_passes_covers_each_pixel_for_its_share_of_the_time() {
    for mode in modes() {
        let film = film(&square(mode.clone()), &WHOLE, 0).image;
        for (index, pixel) in film.pixels.iter().enumerate() {
            let column = (index % 16) as f64 - 8.0;
            let off = (pixel[0] - share(column)).abs();
            assert!(off < 0.03, "{mode:?}, column {column}: {pixel:?}");
        }
    }
}

#[test]
fn one_moment_is_a_scene_that_stands_still() {
    for mode in modes() {
        let mut frozen = square(mode.clone());
        frozen.settings.shutter = [0.25; 2];
        let mut still = square(mode);
        still.surfaces[0].velocity = [0.0; 3].into();
        if let Shape::Quad(quad) = &mut still.surfaces[0].shape {
            quad.vertices.iter_mut().for_each(|vertex| vertex[0] += 2.0);
        }
        assert!(bits(&film(&frozen, &WHOLE, 0)) == bits(&film(&still, &WHOLE, 0)));
    }
}

#[test]
fn the_rules_change_no_bit_of_what_moves() {
    for path in ["scenes/motion.yaml", "tests/render/motion/paths.yaml"] {
        let scene = validated(&small(&root(path)));
        let film = |rules| {
            let plan = Plan::new(&scene, rules);
            assert!(plan.moments >= 16, "{}", plan.moments);
            pipeline::render(&scene, &plan, &WHOLE, 2, &|_| true)
        };
        let [planned, naive] = [RuleSet::ALL, RuleSet::NONE].map(|rules| film(rules).unwrap());
        assert!(bits(&planned.unwrap()) == bits(&naive.unwrap()), "{path}");
    }
}
