//! Each path rule with two scenes: one where it applies, and one as similar as possible where it
//! does not. The rule is applied to the first only, and no picture changes a bit.

use super::path_materials::FIRST;
use super::path_scenes::sky;
use super::scenes::{ball, base_scene, disc};
use super::validated;
use crate::ray_counts::{difference, film};
use rtc::internals::ir::{
    self, Alpha, Environment, ImageId, Material, MaterialId, Mode, PathSettings, Pixels, Punctual,
    PunctualKind, Scene, Shape, Standard, Surface,
};
use rtc::internals::math::Vec3;
use rtc::internals::plan::{Effect, Plan, Rule, RuleSet};

/// White without reflection, seen from both sides.
pub(super) fn white() -> Standard {
    Standard {
        metallic: 0.0,
        specular: 0.0,
        double_sided: true,
        ..Standard::default()
    }
}

/// A path-traced test scene with surfaces of glTF materials.
pub(super) fn traced(surfaces: &[(Shape, Standard)]) -> Scene {
    let mut scene = base_scene();
    scene.settings.mode = Mode::Path(PathSettings {
        samples: 4,
        multiple_scattering: false,
        ..PathSettings::default()
    });
    for (shape, material) in surfaces {
        add(&mut scene, shape, material);
    }
    scene
}

/// Adds a surface with a material of its own.
pub(super) fn add(scene: &mut Scene, shape: &Shape, material: &Standard) {
    scene.surfaces.push(Surface::new(
        shape.clone(),
        MaterialId(scene.materials.len() as u32),
    ));
    let material = Box::new(material.clone());
    scene.materials.push(Material::Standard(material));
}

/// A white sun.
fn sun(direction: Vec3) -> ir::Light {
    let direction = direction.to_array();
    ir::Light::Punctual(Punctual {
        emitter: PunctualKind::Sun { direction },
        intensity: [1.0; 3],
        projected: None,
    })
}

/// A white light at a point, which falls off with the square of the distance.
pub(super) fn light_source(position: [f64; 3]) -> ir::Light {
    ir::Light::Punctual(Punctual {
        emitter: PunctualKind::Point {
            position,
            range: None,
        },
        intensity: [40.0; 3],
        projected: None,
    })
}

/// Adds a mesh, and returns an instance of it.
pub(super) fn placed(scene: &mut Scene, mesh: ir::Mesh) -> Shape {
    scene.meshes.push(mesh);
    Shape::Instance(ir::Instance {
        mesh: ir::MeshId(scene.meshes.len() as u32 - 1),
        world_from_object: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]],
    })
}

/// A triangle across the view.
pub(super) fn across() -> ir::Mesh {
    ir::Mesh {
        name: "across".to_owned(),
        positions: vec![[-2.0, -2.0, 1.0], [2.0, -2.0, 1.1], [0.0, 2.0, 1.3]].into(),
        uvs: vec![[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]].into(),
        triangles: vec![[0, 1, 2]].into(),
        ..ir::Mesh::default()
    }
}

/// Whether a rule removes an effect from a scene. The picture with it, and with all rules, keeps
/// its bits in any case.
pub(super) fn fires(rule: Rule, scene: &Scene) -> bool {
    let proof = validated(scene);
    let unpruned = film(&proof, RuleSet::NONE);
    for rules in [RuleSet::NONE.with(rule), RuleSet::ALL] {
        assert_eq!(difference(&proof, &unpruned, rules), None, "{rule:?}");
    }
    let plan = Plan::new(&proof, RuleSet::ALL);
    plan.statuses.iter().any(|status| status.rule == Some(rule))
}

#[test]
fn a_solid_alone_casts_no_shadow_unless_rays_get_inside() {
    let alone = |material: Standard| traced(&[(ball([0.0; 3], 1.0), material)]);
    let fires = |material: Standard| fires(Rule::PathShadowAlone, &alone(material));
    assert!(fires(white()));
    let half = [1.0, 1.0, 1.0, 0.5];
    for alpha in [Alpha::Blend, Alpha::Mask(0.7)] {
        let base_color = half;
        assert!(!fires(Standard {
            base_color,
            alpha,
            ..white()
        }));
    }
    let opaque = Alpha::Opaque;
    assert!(fires(Standard {
        base_color: half,
        alpha: opaque,
        ..white()
    }));
}

#[test]
fn alpha_of_corners_is_not_taken_for_1_where_it_is_interpolated() {
    let masked = Standard {
        alpha: Alpha::Mask(1.0),
        ..white()
    };
    let cover = |colors: Vec<[f64; 4]>| {
        let mut scene = traced(&[(disc([0.0; 3], 4.0), white())]);
        let mut mesh = across();
        mesh.colors = colors.into();
        let shape = placed(&mut scene, mesh);
        add(&mut scene, &shape, &masked);
        scene
    };
    assert!(fires(Rule::PathOpaque, &cover(Vec::new())));
    // The weights of some points add up to a little less than 1.
    assert!(!fires(Rule::PathOpaque, &cover(vec![[1.0; 4]; 3])));
}

#[test]
fn an_environment_of_one_value_is_looked_up_once_and_a_black_one_never() {
    let around = |texel: [u8; 4], last: [u8; 4]| {
        let mut scene = traced(&[(ball([0.0; 3], 1.0), white())]);
        scene.images.push(ir::Image {
            name: "sky".to_owned(),
            width: 2,
            height: 2,
            kind: Pixels::Rgba8,
            pixels: [texel, texel, texel, last].concat().into(),
        });
        scene.environment = Some(Environment {
            radiance: [0.5, 1.0, 2.0],
            image: Some(ImageId(0)),
            image_from_world: None,
        });
        scene
    };
    let color = [200, 150, 100, 255];
    let (even, uneven) = (around(color, color), around(color, [200, 150, 101, 255]));
    assert!(fires(Rule::PathEvenSky, &even) && !fires(Rule::PathEvenSky, &uneven));
    let looked_up = |scene| {
        film(&validated(scene), RuleSet::ALL)
            .counts
            .of(Effect::EnvironmentMap)
    };
    assert_eq!(looked_up(&even), 0);
    assert!(looked_up(&uneven) > 0);
    // The alpha of an environment's image has no meaning.
    assert!(fires(Rule::PathDarkSky, &around([0; 4], [0, 0, 0, 255])));
    assert!(!fires(Rule::PathDarkSky, &around([0; 4], [0, 0, 1, 0])));
}

#[test]
fn a_flat_surface_alone_may_stand_in_the_light_of_a_sun_in_its_plane() {
    let lit_from = |normal: Vec3, direction: Vec3| {
        let shape = Shape::Disc(ir::Disc {
            center: [0.0; 3],
            normal: normal.to_array(),
            radius: 2.5,
        });
        let mut scene = traced(&[(shape, white())]);
        // Where coordinates are small, rays start close above the disc.
        (scene.camera.right, scene.camera.up) = ([1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]);
        scene.lights = vec![sun(direction)];
        scene
    };
    for k in 0..16 {
        let normal = Vec3::new(0.3 + 0.01 * f64::from(k), 0.7, 1.0);
        let along = normal.cross(Vec3::new(0.2, 0.9, 0.1));
        assert!(!fires(Rule::PathShadowAlone, &lit_from(normal, along)));
        assert!(fires(
            Rule::PathShadowAlone,
            &lit_from(normal, along + normal * 1e-3)
        ));
    }
}

#[test]
fn what_is_out_of_view_is_left_out_unless_it_may_hide_a_light() {
    let beside = |center: [f64; 3], depth: u32| {
        let mirror = Standard {
            metallic: 1.0,
            ..white()
        };
        let mut scene = traced(&[(ball([0.0; 3], 1.0), white()), (ball(center, 0.2), mirror)]);
        scene.settings.max_depth = depth;
        scene
    };
    // The light is behind the camera, at (3, 4, 12).
    let (apart, between) = ([-3.0, -4.0, 12.0], [2.8, 3.7, 11.2]);
    assert!(fires(Rule::PathCullShadow, &beside(apart, 1)));
    assert!(!fires(Rule::PathCullShadow, &beside(between, 1)));
    assert!(
        !fires(Rule::PathCullShadow, &beside(apart, 2)),
        "a mirrored ray may meet it"
    );
    let by_sun = |center| {
        let mut scene = beside(center, 1);
        scene.lights = vec![sun(Vec3::new(3.0, 4.0, 12.0))];
        scene
    };
    assert!(fires(Rule::PathCullShadow, &by_sun(apart)));
    assert!(!fires(Rule::PathCullShadow, &by_sun(between)));
    let by_two = |light: ir::Light| {
        let mut scene = beside(apart, 1);
        scene.lights = vec![light_source([3.0, 4.0, 12.0]), light];
        scene
    };
    assert!(fires(
        Rule::PathCullShadow,
        &by_two(light_source([9.0, 0.0, 9.0]))
    ));
    let choice = by_two(sun(Vec3::Z));
    assert!(
        !fires(Rule::PathCullShadow, &choice),
        "the scene decides how often the sun is chosen"
    );
}

#[test]
fn light_comes_through_glass_where_no_ray_goes_on() {
    let frosted = Standard {
        transmission: 1.0,
        specular: 1.0,
        roughness: 0.8,
        ..white()
    };
    let mut scene = traced(&[(disc([0.0; 3], 1.0), frosted)]);
    scene.settings.max_depth = 1;
    scene.lights = vec![light_source([0.5, 0.0, -3.0])];
    assert!(fires(Rule::PathLast, &scene));
    let picture = film(&validated(&scene), RuleSet::ALL).image;
    assert!(picture.pixels.iter().any(|pixel| *pixel != [0.0; 3]));
}

#[test]
fn veils_dim_a_light_alike_with_a_veiled_solid_that_is_left_out() {
    let veil = |alpha: f64| Standard {
        base_color: [1.0, 1.0, 1.0, alpha],
        alpha: Alpha::Blend,
        ..white()
    };
    let hidden = ball([-3.0, -4.0, 12.0], 0.2);
    let mut scene = traced(&[(ball([0.0; 3], 1.0), white()), (hidden, veil(0.5))]);
    for (height, alpha) in [(2.0, 0.3), (0.0, 0.45), (3.0, 0.17), (1.0, 0.61)] {
        let mut mesh = across();
        let raised = mesh.positions.iter().map(|[x, y, z]| [x, y, z + height]);
        mesh.positions = raised.collect();
        let shape = placed(&mut scene, mesh);
        add(&mut scene, &shape, &veil(alpha));
    }
    scene.settings.max_depth = 1;
    scene.lights = vec![light_source([0.5, 0.0, 12.0])];
    let plan = Plan::new(&validated(&scene), RuleSet::ALL);
    assert!(
        !plan.surfaces[1],
        "it is out of view, and off the way of the light"
    );
    fires(Rule::PathCullShadow, &scene);
}

#[test]
fn a_solid_hides_no_light_unless_the_camera_or_the_light_is_inside() {
    let from = |eye: f64, light: f64| {
        let mut scene = traced(&[(ball([0.0; 3], 1.0), white())]);
        scene.camera.eye[2] = eye;
        scene.camera.center[2] = eye - 10.0;
        scene.lights = vec![light_source([0.0, 0.0, light])];
        fires(Rule::PathShadowAlone, &scene)
    };
    assert!(from(10.0, 12.0) && from(1.1, -1.1));
    assert!(!from(10.0, 0.9) && !from(0.9, 12.0) && !from(10.0, -0.9));
}

#[test]
fn a_flat_surface_hides_a_lamp_in_its_plane() {
    let lit_from = |at: [f64; 3]| {
        let mut scene = traced(&[(disc([0.0; 3], 2.0), white())]);
        scene.lights = vec![light_source(at)];
        fires(Rule::PathShadowAlone, &scene)
    };
    assert!(lit_from([3.0, 1.0, 0.1]) && lit_from([3.0, 1.0, -0.1]));
    assert!(!lit_from([3.0, 1.0, 0.0]));
}

#[test]
fn a_lens_sees_what_is_out_of_the_view_of_a_pinhole() {
    let unlit = Standard {
        unlit: true,
        ..white()
    };
    let seen_by = |radius: f64| {
        let beside = ball([2.2, 0.0, 5.0], 0.3);
        let mut scene = traced(&[
            (disc([0.0; 3], 4.0), unlit.clone()),
            (beside, unlit.clone()),
        ]);
        scene.camera.lens = ir::Lens { radius, samples: 4 };
        fires(Rule::PathCull, &scene);
        Plan::new(&validated(&scene), RuleSet::ALL).surfaces[1]
    };
    assert!(!seen_by(0.0) && seen_by(1.0));
}

#[test]
fn half_a_million_pairs_are_tested_and_no_more() {
    // Numbers of visible and invisible surfaces, and a light.
    let leaves_out = |seen: u32, unseen: u32| {
        let mut scene = traced(&[]);
        scene.settings.max_depth = 1;
        scene.lights = vec![light_source([0.0, 0.0, 12.0])];
        for index in 0..seen + unseen {
            let at = f64::from(index % 1000) * 1e-3;
            let (x, z) = if index < seen {
                (at, 0.0)
            } else {
                (at - 9.0, 12.0)
            };
            add(&mut scene, &ball([x, 0.0, z], 1e-4), &white());
        }
        let plan = Plan::new(&validated(&scene), RuleSet::ALL);
        plan.surfaces.iter().filter(|is_left| !**is_left).count()
    };
    assert_eq!(leaves_out(1000, 500), 500);
    assert_eq!(leaves_out(1000, 501), 0);
}

#[test]
fn a_pane_that_takes_no_bounce_is_seen_through_at_depth_0() {
    let pane = Standard {
        thin_dielectric: true,
        transmission: 1.0,
        transmission_map: Some(FIRST),
        roughness: 0.0,
        specular: 1.0,
        ..white()
    };
    let mut scene = traced(&[(ball([0.0; 3], 1.0), pane)]);
    (scene.settings.max_depth, scene.lights) = (0, Vec::new());
    sky(&mut scene, 1.0, Some([50, 200]));
    scene.textures = vec![ir::Texture::Image(ImageId(0))];
    // In a scene that names a medium, if only a clear one.
    scene.medium = Some(ir::Medium {
        sigma_a: [0.0; 3],
        sigma_s: [0.0; 3],
        g: 0.0,
    });
    let proof = validated(&scene);
    let unpruned = film(&proof, RuleSet::NONE);
    assert_eq!(difference(&proof, &unpruned, RuleSet::ALL), None);
    // Without the medium the ball is black.
    scene.medium = None;
    let opaque = film(&validated(&scene), RuleSet::NONE);
    assert_ne!(unpruned.image.pixels, opaque.image.pixels);
}
