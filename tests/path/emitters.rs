//! Emissive shapes: light sampling and BSDF sampling find the same light, the first with far less
//! noise.

use super::{JOB, add_light, add_sphere, add_square, lambert, material, mean, scene, validate};
use rtc::internals::ir::{
    Cone, Csg, Cylinder, Disc, Ellipsoid, Environment, InfiniteCylinder, Paraboloid, Plane,
    Punctual, PunctualKind, Quad, Scene, SetStep, Shape, Solid, Sphere, Standard, Surface, Torus,
};
use rtc::internals::math::Vec3;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{Film, SamplingStrategy, World};

const CENTER: [f64; 3] = [0.4, 0.3, 0.6];
const UP: [f64; 3] = [0.3, 0.2, 0.5];

fn ball(x: f64, radius: f64) -> Solid {
    let [a, b, c] = CENTER;
    Solid::Sphere(Sphere {
        center: [a + x, b, c],
        radius,
        texture_from_world: None,
    })
}

/// A solid all of whose operands have the material.
fn solid(operands: Vec<Solid>, steps: Vec<SetStep>) -> Shape {
    Shape::Csg(Csg {
        faces: (0..u32::try_from(operands.len()).unwrap()).collect(),
        operands,
        steps,
    })
}

/// Solids whose boundary is a part of each operand: hollow, cut by a plane, and of all shapes
/// together.
fn solids() -> Vec<Shape> {
    use SetStep::{Difference, Intersection, Operand, Union};
    let plane = Solid::Plane(Plane {
        center: CENTER,
        normal: UP,
    });
    let rod = Solid::InfiniteCylinder(InfiniteCylinder {
        center: CENTER,
        axis: UP,
        radius: 0.2,
    });
    let cone = Solid::Paraboloid(Paraboloid {
        base: CENTER,
        up: UP,
        radius: 0.4,
    });
    vec![
        solid(
            vec![ball(0.0, 0.5), ball(0.3, 0.4)],
            vec![Operand, Operand, Difference],
        ),
        solid(
            vec![ball(0.0, 0.5), plane],
            vec![Operand, Operand, Intersection],
        ),
        solid(
            vec![ball(0.0, 0.5), rod, cone],
            vec![Operand, Operand, Difference, Operand, Union],
        ),
    ]
}

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
        Shape::Quad(Quad {
            vertices: [
                [-1.0, 1.0, 0.2],
                [0.9, 1.2, 0.2],
                [1.0, 0.7, 1.0],
                [-1.0, 1.1, 0.8],
            ],
        }),
        Shape::InfiniteCylinder(InfiniteCylinder {
            center: [0.0, 0.9, 0.6],
            axis: [1.0, 0.1, 0.2],
            radius: 0.2,
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
    for shape in shapes().into_iter().chain(solids()) {
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

/// The standard deviation of a pixel of 16 paths over its mean.
fn noise(scene: &Scene, strategy: SamplingStrategy) -> f64 {
    let mut scene = scene.clone();
    let reference = {
        let rtc::internals::ir::Mode::Path(paths) = &mut scene.settings.mode else {
            unreachable!("scenes of this suite trace paths");
        };
        paths.samples = 1024;
        render_by(&scene, strategy).image.pixels
    };
    if let rtc::internals::ir::Mode::Path(paths) = &mut scene.settings.mode {
        paths.samples = 16;
    }
    let found = render_by(&scene, strategy).image.pixels;
    let pairs = reference.iter().zip(&found);
    let squares = pairs
        .map(|(a, b)| (a[0] - b[0]) * (a[0] - b[0]))
        .sum::<f64>();
    let mean = reference.iter().map(|pixel| pixel[0]).sum::<f64>();
    (squares * reference.len() as f64).sqrt() / mean
}

/// A floor and a ball, and a small lamp of a shape of this size about a point above.
fn small_lamp(shape: Shape) -> Scene {
    let mut scene = scene(16);
    add_square(&mut scene, -0.6, 3.0, lambert([0.7, 0.6, 0.5]));
    scene.camera.eye = [0.0, 0.0, 1.2];
    let lamp = Standard {
        emissive: [400.0; 3],
        double_sided: true,
        ..lambert([0.0; 3])
    };
    add(&mut scene, shape, lamp);
    scene
}

#[test]
fn small_lamps_of_solids_rods_and_patches_are_aimed_at() {
    let lamp = [0.0, 0.0, 1.6];
    let ball = |z: f64, radius: f64| {
        Solid::Sphere(Sphere {
            center: [0.0, 0.0, z],
            radius,
            texture_from_world: None,
        })
    };
    let [x, y, z] = lamp;
    let shapes = [
        solid(
            vec![ball(z, 0.05), ball(z + 0.04, 0.04)],
            vec![SetStep::Operand, SetStep::Operand, SetStep::Difference],
        ),
        Shape::Quad(Quad {
            vertices: [
                [x - 0.05, y, z],
                [x, y + 0.05, z + 0.02],
                [x + 0.05, y, z],
                [x, y - 0.05, z + 0.02],
            ],
        }),
        Shape::InfiniteCylinder(InfiniteCylinder {
            center: lamp,
            axis: [1.0, 0.0, 0.0],
            radius: 0.005,
        }),
    ];
    for shape in shapes {
        let scene = small_lamp(shape.clone());
        let [aimed, by_chance] = [SamplingStrategy::Mis, SamplingStrategy::BsdfSampling]
            .map(|strategy| noise(&scene, strategy));
        assert!(
            aimed < 0.5 && by_chance > 5.0 * aimed,
            "{aimed} {by_chance}: {shape:?}"
        );
    }
}

/// Smooth clear glass without an inside.
fn pane(thin_dielectric: bool) -> Standard {
    Standard {
        metallic: 0.0,
        roughness: 0.0,
        transmission: 1.0,
        thin_dielectric,
        double_sided: true,
        base_color: [0.9, 0.8, 0.7, 1.0],
        ..Standard::default()
    }
}

/// A floor under a small lamp, or another light, behind panes.
fn behind_panes(panes: u32, standard: &Standard, light: impl Fn(&mut Scene)) -> Scene {
    let mut scene = scene(16);
    add_square(&mut scene, -0.6, 3.0, lambert([0.7, 0.6, 0.5]));
    scene.camera.eye = [0.0, 0.0, 1.2];
    for k in 0..panes {
        add_square(&mut scene, 1.3 + 0.1 * f64::from(k), 9.0, standard.clone());
    }
    light(&mut scene);
    scene
}

fn lamp(radiance: f64, radius: f64) -> impl Fn(&mut Scene) {
    move |scene| {
        let lamp = Standard {
            emissive: [radiance; 3],
            ..lambert([0.0; 3])
        };
        add_sphere(scene, [0.0, 0.0, 2.2], radius, lamp);
    }
}

#[test]
fn a_lamp_behind_panes_is_aimed_at_through_them() {
    for (panes, standard) in [
        (1, pane(true)),
        (1, pane(false)),
        (2, pane(true)),
        (2, pane(false)),
    ] {
        let scene = behind_panes(panes, &standard, lamp(400.0, 0.05));
        let [aimed, by_chance] = [SamplingStrategy::Mis, SamplingStrategy::BsdfSampling]
            .map(|strategy| noise(&scene, strategy));
        // Between two panes the lamp is reflected again and again, which stays a matter of chance.
        assert!(
            aimed < 0.5 && by_chance > 5.0 * aimed,
            "{panes} {}: {aimed} {by_chance}",
            standard.thin_dielectric
        );
        // A lamp that paths find by chance, too, has the same light by each strategy.
        let mut scene = behind_panes(panes, &standard, lamp(1.0, 0.6));
        if let rtc::internals::ir::Mode::Path(paths) = &mut scene.settings.mode {
            paths.samples = 512;
        }
        for max_depth in [1, panes, panes + 1, panes + 2, 8] {
            scene.settings.max_depth = max_depth;
            let both = mean(&render_by(&scene, SamplingStrategy::Mis));
            let chance = mean(&render_by(&scene, SamplingStrategy::BsdfSampling));
            let error = (both - chance).abs().max_element();
            assert!(
                error < 0.03 * both.max_element().max(1e-3),
                "{panes} {max_depth}: {both} {chance}"
            );
        }
    }
}

#[test]
fn a_point_and_a_sky_shine_through_a_pane() {
    let point = |scene: &mut Scene| {
        let emitter = PunctualKind::Point {
            position: [0.0, 0.0, 2.2],
            range: None,
        };
        let light = Punctual {
            emitter,
            intensity: [3.0; 3],
            projected: None,
        };
        add_light(scene, light);
    };
    let seen = |panes: u32, light: &dyn Fn(&mut Scene)| {
        mean(&render_by(
            &behind_panes(panes, &pane(true), light),
            SamplingStrategy::Mis,
        ))
    };
    // Hardly tilted, a pane of this index lets 2·n/(n² + 1) through, times its colour.
    let passed = 2.0 * 1.5 / (1.5 * 1.5 + 1.0);
    let expected = Vec3::new(0.9, 0.8, 0.7) * passed;
    let share = seen(1, &point) / seen(0, &point);
    assert!(
        (share / expected - Vec3::ONE).abs().max_element() < 0.02,
        "{share}"
    );
    let sky = |scene: &mut Scene| {
        scene.environment = Some(Environment {
            radiance: [1.0; 3],
            image: None,
            image_from_world: None,
        });
    };
    assert!(seen(1, &sky).min_element() > 0.3);
}
