//! Rays of the camera go through the backs of one-sided surfaces; all other rays meet them.

use super::*;
use rtc::internals::ir::{Instance, Mesh, MeshId};
use rtc::internals::render::{AnyWorld, Aov, RenderSelection};

const RED: Vec3 = Vec3::X;
const GREEN: Vec3 = Vec3::Y;

/// What shows its colour as it is.
fn flat(color: Vec3) -> Standard {
    let [r, g, b] = color.to_array();
    Standard {
        unlit: true,
        base_color: [r, g, b, 1.0],
        ..Standard::default()
    }
}

/// A square at height z that fills the view and faces away from it.
fn add_back(scene: &mut Scene, z: f64, standard: Standard) {
    add_quad(
        scene,
        [
            [-3.0, -3.0, z],
            [-3.0, 3.0, z],
            [3.0, 3.0, z],
            [3.0, -3.0, z],
        ],
        standard,
    );
}

/// What is seen of a green wall through what `add` puts before it.
fn before_a_wall(add: impl Fn(&mut Scene)) -> Scene {
    let mut scene = scene(4);
    add(&mut scene);
    add_square(&mut scene, -1.0, 9.0, flat(GREEN));
    scene
}

#[test]
fn a_one_sided_square_is_seen_from_the_front_alone() {
    let front = before_a_wall(|scene| add_square(scene, 0.0, 3.0, flat(RED)));
    let back = before_a_wall(|scene| add_back(scene, 0.0, flat(RED)));
    let both = before_a_wall(|scene| {
        add_back(
            scene,
            0.0,
            Standard {
                double_sided: true,
                ..flat(RED)
            },
        )
    });
    assert_eq!(
        [front, back, both].map(|scene| mean(&render(&scene))),
        [RED, GREEN, RED]
    );
}

#[test]
fn coverage_and_layers_go_by_what_is_seen() {
    let mut scene = scene(4);
    add_back(&mut scene, 0.0, flat(RED));
    let proof = validate(&scene);
    let job = RenderSelection {
        background: Background::Nothing,
        ..JOB
    };
    let film =
        rtc::internals::render::render(&proof, &Plan::new(&proof, RuleSet::ALL), &job, &|_| true)
            .unwrap();
    assert!(film.coverage.iter().all(|share| *share == 0.0) && film.counts.hits == 0);
    // The wall's triangles come third and fourth.
    let proof = validate(&before_a_wall(|scene| add_back(scene, 0.0, flat(RED))));
    let wanted = [Aov::Instance, Aov::Depth];
    let world = AnyWorld::prepare(&proof, &Plan::new(&proof, RuleSet::ALL));
    let layers = world
        .layers(&wanted, &RenderSelection::default(), &|_| true)
        .unwrap();
    assert!(
        layers
            .values
            .chunks(2)
            .all(|pixel| pixel[0] >= 3.0 && (pixel[1] - 5.0).abs() < 1e-5)
    );
}

#[test]
fn its_shadow_stays() {
    let lit = |back: bool| {
        let mut scene = scene(4);
        add_square(&mut scene, 0.0, 3.0, lambert([1.0; 3]));
        add_light(
            &mut scene,
            Punctual {
                emitter: PunctualKind::Sun {
                    direction: [0.0, 0.0, 1.0],
                },
                intensity: [1.0; 3],
                projected: None,
            },
        );
        if back {
            add_back(&mut scene, 1.0, lambert([1.0; 3]));
        }
        middle(&render(&scene)).x
    };
    // What is seen is neither the lit ground nor the lit back of what hides the sun from it.
    assert!(lit(false) > 0.3);
    assert_eq!(lit(true), 0.0);
}

#[test]
fn the_front_of_a_mirrored_instance_is_that_of_its_mesh() {
    // The mesh faces +z; a mirror image in x still does, though it goes round the other way, and
    // one in z does not.
    for (axes, expected) in [
        ([1.0, 1.0], RED),
        ([-1.0, 1.0], RED),
        ([1.0, -1.0], GREEN),
        ([-1.0, -1.0], GREEN),
    ] {
        let scene = before_a_wall(|scene| {
            scene.meshes.push(Mesh {
                positions: vec![
                    [-3.0, -3.0, 0.0],
                    [3.0, -3.0, 0.0],
                    [3.0, 3.0, 0.0],
                    [-3.0, 3.0, 0.0],
                ]
                .into(),
                triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
                ..Mesh::default()
            });
            let world_from_object = [
                [axes[0], 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, axes[1]],
                [0.0; 3],
            ];
            let material = material(scene, flat(RED));
            let shape = Shape::Instance(Instance {
                mesh: MeshId(0),
                world_from_object,
            });
            scene.surfaces.push(Surface::new(shape, material));
        });
        assert_eq!(mean(&render(&scene)), expected, "{axes:?}");
    }
}

#[test]
fn a_mirror_shows_the_back() {
    let mut scene = scene(4);
    add_square(
        &mut scene,
        0.0,
        3.0,
        Standard {
            roughness: 0.0,
            ..Standard::default()
        },
    );
    // Behind the eye, and facing away from the mirror.
    add_square(&mut scene, 6.0, 30.0, flat(RED));
    assert!((mean(&render(&scene)) - RED).abs().max_element() < 1e-9);
}

#[test]
fn what_transmits_is_seen_from_background() {
    let pane = Standard {
        transmission: 1.0,
        metallic: 0.0,
        roughness: 0.0,
        ior: 1.0,
        ..flat(GREEN)
    };
    let mut scene = scene(4);
    scene.environment = sky(1.0);
    add_back(
        &mut scene,
        0.0,
        Standard {
            unlit: false,
            ..pane
        },
    );
    assert!((mean(&render(&scene)) - GREEN).abs().max_element() < 1e-9);
}

#[test]
fn a_ray_behind_a_veil_is_still_one_of_the_camera() {
    let scene = before_a_wall(|scene| {
        let hole = Standard {
            base_color: [1.0, 1.0, 1.0, 0.0],
            alpha: Alpha::Mask(0.5),
            ..flat(RED)
        };
        add_square(scene, 1.0, 3.0, hole);
        add_back(scene, 0.5, flat(RED));
        add_back(scene, 0.0, flat(RED));
    });
    assert_eq!(mean(&render(&scene)), GREEN);
}

/// The corners of an octahedron, which are the normals of a ball there.
const CORNERS: [[f64; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
];

/// The octahedron with normals of its own.
fn octahedron(normals: [[f64; 3]; 6]) -> Mesh {
    let triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Mesh {
        positions: CORNERS.to_vec().into(),
        normals: normals.to_vec().into(),
        triangles: triangles.into(),
        ..Mesh::default()
    }
}

/// The inside of a mesh, under a sky.
fn inside(mesh: Mesh, standard: Standard) -> Scene {
    let mut scene = scene(16);
    (scene.settings.max_depth, scene.environment) = (50, sky(1.0));
    (scene.camera.eye, scene.camera.center) = ([0.1, 0.05, -0.02], [0.3, 0.2, -0.4]);
    scene.meshes.push(mesh);
    let world_from_object = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
    let material = material(&mut scene, standard);
    let shape = Shape::Instance(Instance {
        mesh: MeshId(0),
        world_from_object,
    });
    scene.surfaces.push(Surface::new(shape, material));
    scene
}

/// Lights outside of the octahedron.
fn add_lights(scene: &mut Scene) {
    let suns = [[3.0, 4.0, 5.0], [-1.0, 0.2, 0.1], [0.3, -1.0, -0.4]]
        .map(|direction| PunctualKind::Sun { direction });
    let point = PunctualKind::Point {
        position: [0.5, 0.6, 0.2],
        range: None,
    };
    for emitter in suns.into_iter().chain([point]) {
        let intensity = [5.0; 3];
        add_light(
            scene,
            Punctual {
                emitter,
                intensity,
                projected: None,
            },
        );
    }
}

/// The inside of an octahedron with the normals of a ball, or others, under lights and a sky
/// outside: no path takes light from the side of a face where it does not go on.
#[test]
fn no_light_enters_a_closed_smooth_mesh() {
    let tilted = [
        [1.0, 0.8, 0.0],
        [-1.0, 0.5, 0.9],
        [0.7, 1.0, 0.0],
        [0.0, -1.0, 0.9],
        [0.9, 0.0, 1.0],
        [0.6, 0.7, -1.0],
    ];
    let mirror = Standard {
        roughness: 0.0,
        ..Standard::default()
    };
    for normals in [CORNERS, tilted] {
        for standard in [lambert([0.9; 3]), mirror.clone()] {
            let standard = Standard {
                double_sided: true,
                ..standard
            };
            let mut scene = inside(octahedron(normals), standard);
            add_lights(&mut scene);
            let film = render(&scene);
            let counts = film.counts;
            assert!(
                counts.hits == 16 * 256 && counts.mirror > 16 * 256,
                "{counts:?}"
            );
            let values = film.image.pixels.iter().flatten();
            assert_eq!(values.filter(|value| **value != 0.0).count(), 0);
        }
    }
}
