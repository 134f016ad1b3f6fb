//! The hierarchy of a world finds what its surfaces find one by one, and veils in it let through
//! what veils beside it do.

use super::{
    JOB, add_light, add_sphere, add_square, lambert, material, mean, render, scene, sky, validate,
};
use rtc::internals::ir::{
    Alpha, Instance, Mesh, MeshId, Punctual, PunctualKind, Scene, Shape, Standard, Surface,
};
use rtc::internals::math::{Vec3, cos, sin};
use rtc::internals::plan::{Arithmetic, Plan, RuleSet};
use rtc::internals::render::{Hit, Intersect, Ray, Shape as Prepared, WatertightRay, World};

/// Numbers in [−1, 1), always the same.
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A wavy square of side 2 in so many rows.
pub(super) fn waves(rows: u32) -> Mesh {
    let share = |k: u32| f64::from(k) / f64::from(rows) * 2.0 - 1.0;
    let corner = |k: u32| {
        let (x, y) = (share(k % (rows + 1)), share(k / (rows + 1)));
        [x, y, 0.3 * sin(5.0 * x) * cos(4.0 * y)]
    };
    let cell = |k: u32| {
        let at = k % rows + k / rows * (rows + 1);
        [
            [at, at + 1, at + rows + 2],
            [at, at + rows + 2, at + rows + 1],
        ]
    };
    let positions = (0..(rows + 1) * (rows + 1)).map(corner).collect();
    Mesh {
        positions,
        triangles: (0..rows * rows).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

pub(super) fn place(
    scene: &mut Scene,
    mesh: u32,
    world_from_object: [[f64; 3]; 4],
    standard: Standard,
) {
    let material = material(scene, standard);
    let shape = Shape::Instance(Instance {
        mesh: MeshId(mesh),
        world_from_object,
    });
    scene.surfaces.push(Surface::new(shape, material));
}

/// What the surfaces say one by one: the nearest hit, and of several at one t that of the first
/// surface.
fn one_by_one(world: &World<Prepared>, ray: &Ray) -> Option<Hit> {
    let watertight = WatertightRay::new(ray);
    let hits = world.surfaces.entries().filter_map(|(surface, found)| {
        let (t, prim_id) = found.shape.intersect(ray, &watertight, f64::INFINITY)?;
        Some(Hit {
            t,
            surface,
            prim_id,
        })
    });
    hits.min_by(|a, b| a.t.total_cmp(&b.t))
}

#[test]
fn the_world_finds_what_its_surfaces_find() {
    let mut scene = scene(1);
    scene.meshes = vec![waves(12), waves(70), waves(300)];
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let at = |[x, y, z]: [[f64; 3]; 3], origin| [x, y, z, origin];
    // Once and several times, two at the very same place, mirrored, small, and too many triangles
    // to be merged.
    for origin in [[0.0; 3], [0.5, 0.2, -0.4], [0.5, 0.2, -0.4]] {
        place(&mut scene, 0, at(axes, origin), lambert([0.5; 3]));
    }
    place(
        &mut scene,
        0,
        at(
            [[0.0, -0.02, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, -0.03]],
            [0.3; 3],
        ),
        lambert([0.5; 3]),
    );
    place(
        &mut scene,
        1,
        at(
            [[0.6, 0.5, 0.0], [-0.5, 0.6, 0.3], [0.2, 0.0, 1.0]],
            [0.1, 0.0, 1.0],
        ),
        lambert([0.5; 3]),
    );
    place(&mut scene, 2, at(axes, [0.0, 0.0, -0.9]), lambert([0.5; 3]));
    place(&mut scene, 2, at(axes, [0.2, 0.1, -1.0]), lambert([0.5; 3]));
    super::add_sphere(&mut scene, [-0.5, -0.5, 0.2], 0.4, lambert([0.5; 3]));
    let proof = validate(&scene);
    let world = World::<Prepared>::prepare(&proof, &Plan::new(&proof, RuleSet::NONE));
    let (mut number, mut hits, mut ties) = (numbers(7), 0, 0);
    for _ in 0..20_000 {
        let mut cube = || Vec3::new(number(), number(), number());
        let (origin, target) = (cube() * 3.0, cube());
        let ray = Ray {
            origin,
            direction: target - origin,
        };
        let (found, expected) = (world.closest_hit(&ray), one_by_one(&world, &ray));
        assert_eq!(found, expected, "{ray:?}");
        hits += u32::from(found.is_some());
        ties += u32::from(found.is_some_and(|hit| hit.surface.index() == 1));
        let t = found.map_or(f64::INFINITY, |hit| hit.t);
        if (t - 1.0).abs() > 1e-9 {
            assert_eq!(world.occluded(origin, target), t < 1.0, "{ray:?}");
        }
        // A shadow ray that ends on the surface is not hidden by it.
        if found.is_some() {
            let end = |t: f64| origin + ray.direction * t;
            assert!(!world.occluded(origin, end(t)), "{ray:?}");
            assert!(world.occluded(origin, end(t * (1.0 + 1e-9))), "{ray:?}");
        }
    }
    assert!(hits > 5000 && ties > 100, "{hits} {ties}");
}

#[test]
fn veils_of_meshes_let_through_what_veils_of_triangles_do() {
    let veil = |red: f64| Standard {
        base_color: [red, 0.5, 0.5, 0.5],
        alpha: Alpha::Blend,
        ..lambert([0.5; 3])
    };
    let pictures = [false, true].map(|as_meshes| {
        let mut scene = scene(16);
        scene.environment = sky(0.5);
        let emitter = PunctualKind::Sun {
            direction: [0.1, 0.2, 1.0],
        };
        add_light(
            &mut scene,
            Punctual {
                emitter,
                intensity: [2.0; 3],
                projected: None,
            },
        );
        add_square(&mut scene, 0.0, 1.0, lambert([0.8; 3]));
        let flat = Mesh {
            positions: vec![
                [-1.0, -1.0, 0.0],
                [1.0, -1.0, 0.0],
                [1.0, 1.0, 0.0],
                [-1.0, 1.0, 0.0],
            ]
            .into(),
            uvs: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
            ..Mesh::default()
        };
        scene.meshes = vec![flat];
        for (z, red) in [(0.25, 0.2), (0.5, 0.5), (0.75, 0.9)] {
            let axes = [
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.0, 0.0, z],
            ];
            match as_meshes {
                true => place(&mut scene, 0, axes, veil(red)),
                false => add_square(&mut scene, z, 1.0, veil(red)),
            }
        }
        render(&scene).image.pixels
    });
    let [triangles, meshes] = &pictures;
    for (index, (a, b)) in triangles.iter().zip(meshes).enumerate() {
        let off = (Vec3::from_array(*a) - Vec3::from_array(*b))
            .abs()
            .max_element();
        assert!(off < 1e-9, "pixel {index}: {a:?} and {b:?}");
    }
}

fn blended(opacity: f64) -> Standard {
    Standard {
        base_color: [0.5, 0.5, 0.5, opacity],
        alpha: Alpha::Blend,
        ..lambert([0.5; 3])
    }
}

/// A square in the sun, below veils of a mesh.
fn below_veils(count: u32) -> Scene {
    let mut scene = scene(4);
    let emitter = PunctualKind::Sun {
        direction: [0.3, 0.4, 1.0],
    };
    add_light(
        &mut scene,
        Punctual {
            emitter,
            intensity: [2.0; 3],
            projected: None,
        },
    );
    add_square(&mut scene, 0.0, 2.0, lambert([0.8; 3]));
    let corners = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.5, 0.0]];
    scene.meshes = vec![Mesh {
        positions: corners.into(),
        triangles: vec![[0, 1, 2]].into(),
        ..Mesh::default()
    }];
    let mut next = numbers(7);
    for _ in 0..count {
        let axes = [
            [2.0, 0.0, next()],
            [0.0, 2.0, next()],
            [0.0, 0.0, 1.0],
            [next() * 0.5, next() * 0.5, 1.5 + 0.5 * next()],
        ];
        place(&mut scene, 0, axes, blended(0.2 + 0.1 * next()));
    }
    scene
}

/// The plan proves one of two blended materials opaque; the transmittances of the other are
/// multiplied in the same order as without the plan.
#[test]
fn a_veil_that_is_opaque_changes_no_order() {
    let mut scene = below_veils(24);
    add_sphere(&mut scene, [5.0, 5.0, 0.0], 0.5, blended(1.0));
    let proof = validate(&scene);
    let [pruned, unpruned] = [RuleSet::ALL, RuleSet::NONE].map(|rules| {
        let plan = Plan::new(&proof, rules);
        rtc::internals::render::render(&proof, &plan, &JOB, &|_| true).unwrap()
    });
    assert!(pruned.image.pixels == unpruned.image.pixels);
}

/// The plain arithmetics flatten no mesh.
#[test]
fn veils_let_light_through_in_every_arithmetic() {
    let proof = validate(&below_veils(2));
    let [robust, plain, _] = Arithmetic::ALL.map(|arithmetic| {
        let plan = Plan::with_arithmetic(arithmetic, &proof, RuleSet::ALL);
        mean(&rtc::internals::render::render(&proof, &plan, &JOB, &|_| true).unwrap())
    });
    assert!(
        (plain - robust).abs().max_element() < 1e-6,
        "{plain} {robust}"
    );
}
