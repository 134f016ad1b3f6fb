//! The path integrator against closed forms, against itself by other ways, and the laws it shares
//! with the others.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod agreement;
mod bodies;
mod caustics;
mod closed;
mod coverage;
mod emitters;
mod furnace;
mod hierarchy;
mod layers;
mod leaves;
mod levels;
mod lights;
mod media;
mod sides;
mod surfaces;

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{
    Alpha, Camera, Environment, Lens, Light, Material, MaterialId, Mode, PathSettings, Phong,
    Projection, Punctual, PunctualKind, Scene, Settings, Shape, SourceSpans, Sphere, Standard,
    Surface, Triangle,
};
use rtc::internals::math::Vec3;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{
    Background, BasicShape, Film, RenderSelection, SamplingStrategy, World,
};
use rtc::internals::valid::{self, ValidScene};

/// A scene of paths: 16 × 16 pixels that look down −z from (0, 0, 4) and see a square of side 2 at
/// the origin.
fn scene(samples: u32) -> Scene {
    let settings = Settings {
        mode: Mode::Path(PathSettings {
            samples,
            multiple_scattering: false,
            ..PathSettings::default()
        }),
        shadows: true,
        max_depth: 8,
        ..Settings::default()
    };
    let camera = Camera {
        eye: [0.0, 0.0, 4.0],
        center: [0.0; 3],
        right: [0.125, 0.0, 0.0],
        up: [0.0, 0.125, 0.0],
        size: [16, 16],
        lens: Lens {
            radius: 0.0,
            samples: 1,
        },
        projection: Projection::Perspective,
    };
    Scene::new(camera, settings)
}

/// Lambert's surface, if the specular reflection is left away.
fn lambert(color: [f64; 3]) -> Standard {
    let [r, g, b] = color;
    Standard {
        base_color: [r, g, b, 1.0],
        metallic: 0.0,
        specular: 0.0,
        ..Standard::default()
    }
}

fn material(scene: &mut Scene, standard: Standard) -> MaterialId {
    scene.materials.push(Material::Standard(Box::new(standard)));
    MaterialId(u32::try_from(scene.materials.len() - 1).unwrap())
}

/// Two triangles around four corners in order.
fn add_quad(scene: &mut Scene, [a, b, c, d]: [[f64; 3]; 4], standard: Standard) {
    let material = material(scene, standard);
    let uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for (vertices, uvs) in [
        ([a, b, c], [uv[0], uv[1], uv[2]]),
        ([a, c, d], [uv[0], uv[2], uv[3]]),
    ] {
        let shape = Shape::Triangle(Triangle {
            vertices,
            uvs: Some(uvs),
        });
        scene.surfaces.push(Surface::new(shape, material));
    }
}

/// A square that faces +z at height z, of half the side given.
fn add_square(scene: &mut Scene, z: f64, half: f64, standard: Standard) {
    let corners = [
        [-half, -half, z],
        [half, -half, z],
        [half, half, z],
        [-half, half, z],
    ];
    add_quad(scene, corners, standard);
}

fn add_sphere(scene: &mut Scene, center: [f64; 3], radius: f64, standard: Standard) {
    let material = material(scene, standard);
    let shape = Shape::Sphere(Sphere {
        center,
        radius,
        texture_from_world: None,
    });
    scene.surfaces.push(Surface::new(shape, material));
}

fn add_light(scene: &mut Scene, light: Punctual) {
    scene.lights.push(Light::Punctual(light));
}

fn sky(radiance: f64) -> Option<Environment> {
    Some(Environment {
        radiance: [radiance; 3],
        image: None,
        image_from_world: None,
    })
}

fn validate(scene: &Scene) -> ValidScene {
    let mut sink = DiagnosticSink::default();
    let proof = valid::validate(
        scene,
        &SourceSpans::default(),
        &valid::ValidationOptions::default(),
        &mut sink,
    );
    proof.unwrap_or_else(|| panic!("{sink:?}"))
}

const JOB: RenderSelection = crate::small::WHOLE;

fn render_by(scene: &Scene, strategy: SamplingStrategy) -> Film {
    let proof = validate(scene);
    World::<BasicShape>::prepare(&proof, &Plan::new(&proof, RuleSet::ALL))
        .render_paths(strategy, &JOB, &|_| true)
        .unwrap()
}

fn render(scene: &Scene) -> Film {
    let proof = validate(scene);
    rtc::internals::render::render(&proof, &Plan::new(&proof, RuleSet::ALL), &JOB, &|_| true)
        .unwrap()
}

fn mean(film: &Film) -> Vec3 {
    let pixels = &film.image.pixels;
    pixels
        .iter()
        .map(|pixel| Vec3::from_array(*pixel))
        .sum::<Vec3>()
        / pixels.len() as f64
}

/// The four pixels in the middle.
fn middle(film: &Film) -> Vec3 {
    let at = |x: usize, y: usize| Vec3::from_array(film.image.pixels[y * 16 + x]);
    (at(7, 7) + at(8, 7) + at(7, 8) + at(8, 8)) / 4.0
}
