//! Emissive shapes: light sampling and BSDF sampling find the same light, the first with far less
//! noise.

use super::{JOB, add_sphere, add_square, lambert, material, mean, scene, validate};
use rtc::internals::ir::{
    Cone, Cylinder, Disc, Ellipsoid, Paraboloid, Quad, Scene, Shape, Sphere, Standard, Surface,
    Torus,
};
use rtc::internals::math::Vec3;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, SamplingStrategy, World};

const CENTER: [f64; 3] = [0.4, 0.3, 0.6];
const UP: [f64; 3] = [0.3, 0.2, 0.5];

/// Each shape that light sampling finds, not too small for BSDF sampling.
fn shapes() -> Vec<Shape> {
    let radius = 0.4;
    vec![
        Shape::Sphere(Sphere {
            center: CENTER,
            radius,
            texture_from_world: None,
        }),
        Shape::Quad(Quad {
            vertices: [
                [-1.0, 1.0, 0.2],
                [0.9, 1.0, 0.2],
                [1.0, 1.0, 1.0],
                [-1.0, 1.0, 0.8],
            ],
        }),
        Shape::Disc(Disc {
            center: CENTER,
            normal: UP,
            radius,
        }),
        Shape::Cylinder(Cylinder {
            base: CENTER,
            axis: UP,
            height: 0.7,
            radius,
        }),
        Shape::Cone(Cone {
            base: CENTER,
            up: UP,
            radius,
        }),
        Shape::Paraboloid(Paraboloid {
            base: CENTER,
            up: UP,
            radius,
        }),
        Shape::Torus(Torus {
            center: CENTER,
            axis: UP,
            major: 0.5,
            minor: 0.2,
        }),
        Shape::Ellipsoid(Ellipsoid {
            center: CENTER,
            axes: [[0.7, 0.0, 0.0], [0.2, 0.3, 0.0], [0.0, 0.1, 0.4]],
        }),
    ]
}

fn add(scene: &mut Scene, shape: Shape, standard: Standard) {
    let material = material(scene, standard);
    scene.surfaces.push(Surface::new(shape, material));
}

/// A glossy floor and a ball in the light of one shape.
fn room(samples: u32, shape: Shape) -> Scene {
    let mut scene = scene(samples);
    let floor = Standard {
        metallic: 0.5,
        roughness: 0.6,
        ..lambert([0.7, 0.6, 0.5])
    };
    add_square(&mut scene, -0.6, 3.0, floor);
    add_sphere(&mut scene, [-0.6, -0.3, 0.0], 0.4, lambert([0.8; 3]));
    let light = Standard {
        emissive: [4.0, 3.0, 2.0],
        ..lambert([0.2; 3])
    };
    add(&mut scene, shape, light);
    scene
}

fn render_by(scene: &Scene, strategy: SamplingStrategy) -> Film {
    let proof = validate(scene);
    World::<rtc::internals::render::Shape>::prepare(&proof, &Plan::new(&proof, RuleSet::ALL))
        .render_paths(strategy, &JOB, &|_| true)
        .unwrap()
}

#[test]
fn all_strategies_find_the_light_of_each_shape() {
    for shape in shapes() {
        let scene = room(256, shape.clone());
        let both = mean(&render_by(&scene, SamplingStrategy::Mis));
        for strategy in [SamplingStrategy::Nee, SamplingStrategy::BsdfSampling] {
            let found = mean(&render_by(&scene, strategy));
            let error = ((found - both) / both).abs().max_element();
            assert!(
                error < 0.015,
                "{strategy:?}: {found}, both: {both}, {shape:?}"
            );
        }
    }
}

#[test]
fn a_lamp_of_any_size_gives_the_light_of_its_power() {
    // The irradiance of a small sphere is π L (r/d)² cos: its emission makes up for its size.
    let lit = |radius: f64| {
        let mut scene = scene(16);
        add_square(&mut scene, -0.6, 3.0, lambert([0.7; 3]));
        let light = Standard {
            emissive: [1.0 / (radius * radius); 3],
            ..lambert([0.0; 3])
        };
        let center = [0.0, 0.0, 3.0];
        let shape = Sphere {
            center,
            radius,
            texture_from_world: None,
        };
        scene.camera.eye = [0.0, 0.0, 1.5];
        add(&mut scene, Shape::Sphere(shape), light);
        mean(&render_by(&scene, SamplingStrategy::Mis))
    };
    let expected = lit(1.0);
    for radius in [1e-1, 1e-2, 1e-4] {
        let error = (lit(radius) / expected - Vec3::ONE).abs().max_element();
        assert!(error < 0.01, "{radius}: {error}");
    }
}

#[test]
fn a_lamp_inside_a_glowing_sphere_is_in_its_furnace() {
    // Every direction from inside meets the sphere of radiance 1; a surface of albedo 0.5 that
    // sees nothing else shines by half of it.
    for strategy in [
        SamplingStrategy::Mis,
        SamplingStrategy::Nee,
        SamplingStrategy::BsdfSampling,
    ] {
        let mut scene = scene(256);
        add_sphere(&mut scene, [0.0; 3], 0.8, lambert([0.5; 3]));
        let glow = Standard {
            emissive: [1.0; 3],
            ..lambert([0.0; 3])
        };
        let shape = Sphere {
            center: [0.0; 3],
            radius: 10.0,
            texture_from_world: None,
        };
        scene.camera.right = [0.02, 0.0, 0.0];
        scene.camera.up = [0.0, 0.02, 0.0];
        add(&mut scene, Shape::Sphere(shape), glow);
        let found = mean(&render_by(&scene, strategy));
        assert!(
            (found - Vec3::splat(0.5)).abs().max_element() < 0.002,
            "{strategy:?}: {found}"
        );
    }
}
