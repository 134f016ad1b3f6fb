//! Alpha, textures, corners' colours, normal maps, dispersion, and the orthographic camera.

use super::{add_light, add_quad, add_square, lambert, material, mean, middle, render, scene, sky};
use rtc::internals::ir::{
    Alpha, Filter, Image, ImageId, Instance, Map, Mesh, MeshId, Pixels, Projection, Punctual,
    PunctualKind, Sampled, Scene, Shape, Standard, Surface, Texture, TextureId, Wrap,
};
use rtc::internals::math::Vec3;

/// A texture of the pixels given, sampled without blending.
fn add_texture(scene: &mut Scene, [width, height]: [u32; 2], pixels: &[[u8; 4]]) -> Option<Map> {
    let pixels = pixels.as_flattened().to_vec().into();
    scene.images.push(Image {
        name: String::new(),
        width,
        height,
        kind: Pixels::Rgba8,
        pixels,
    });
    let image = ImageId(u32::try_from(scene.images.len() - 1).unwrap());
    scene.textures.push(Texture::Sampled(Sampled {
        image,
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Nearest,
    }));
    let texture = TextureId(u32::try_from(scene.textures.len() - 1).unwrap());
    Some(Map {
        texture,
        set: 0,
        texture_from_surface: None,
    })
}

/// A square between the eye and a white sky.
fn before_the_sky(standard: Standard, samples: u32) -> Scene {
    let mut scene = scene(samples);
    scene.environment = sky(1.0);
    add_square(&mut scene, 0.0, 3.0, standard);
    scene
}

#[test]
fn blending_covers_by_its_share() {
    let veil = Standard {
        base_color: [0.0, 0.0, 0.0, 0.25],
        alpha: Alpha::Blend,
        ..lambert([0.0; 3])
    };
    let found = mean(&render(&before_the_sky(veil, 256)));
    assert!((found.x - 0.75).abs() < 0.01, "{found}");
    let opaque = Standard {
        base_color: [0.0, 0.0, 0.0, 0.25],
        ..lambert([0.0; 3])
    };
    assert_eq!(mean(&render(&before_the_sky(opaque, 4))), Vec3::ZERO);
}

#[test]
fn a_mask_covers_where_alpha_reaches_the_cutoff() {
    for (cutoff, expected) in [(0.25, 0.0), (0.2501, 1.0)] {
        let mask = Standard {
            base_color: [0.0, 0.0, 0.0, 0.25],
            alpha: Alpha::Mask(cutoff),
            ..lambert([0.0; 3])
        };
        assert_eq!(
            mean(&render(&before_the_sky(mask, 4))),
            Vec3::splat(expected)
        );
    }
}

#[test]
fn veils_dim_shadows() {
    let mut scene = scene(64);
    add_square(&mut scene, 0.0, 1.0, lambert([1.0; 3]));
    add_light(
        &mut scene,
        Punctual {
            emitter: PunctualKind::Sun {
                direction: [0.0, 3.0, 1.0],
            },
            intensity: [1.0; 3],
            projected: None,
        },
    );
    let lit = middle(&render(&scene));
    let veil = Standard {
        base_color: [0.0, 0.0, 0.0, 0.25],
        alpha: Alpha::Blend,
        ..lambert([0.0; 3])
    };
    // A wall beside the view, between the square and the sun.
    add_quad(
        &mut scene,
        [
            [-9.0, 1.5, 0.0],
            [9.0, 1.5, 0.0],
            [9.0, 1.5, 9.0],
            [-9.0, 1.5, 9.0],
        ],
        veil,
    );
    let dimmed = middle(&render(&scene));
    assert!(
        (dimmed - lit * 0.75).abs().max_element() < 1e-12,
        "{dimmed} {lit}"
    );
}

#[test]
fn base_colours_are_decoded_and_v_runs_down() {
    let mut scene = before_the_sky(Standard::default(), 1);
    scene.settings.max_depth = 0;
    scene.surfaces.clear();
    let map = add_texture(&mut scene, [1, 2], &[[128, 0, 0, 255], [0, 0, 255, 255]]);
    let unlit = Standard {
        base_color_map: map,
        unlit: true,
        ..Standard::default()
    };
    add_square(&mut scene, 0.0, 3.0, unlit);
    let film = render(&scene);
    // The square's first corner, (0, 0) of the texture, is below.
    let (top, bottom) = (film.image.pixels[0], film.image.pixels[255]);
    assert_eq!(top, [0.0, 0.0, 1.0]);
    assert!(
        (bottom[0] - 0.215_860_5).abs() < 1e-6 && bottom[2] == 0.0,
        "{bottom:?}"
    );
}

/// A square mesh of two triangles with what `fill` adds to its corners.
fn add_mesh(scene: &mut Scene, standard: Standard, x: [f64; 3], fill: impl Fn(&mut Mesh)) {
    let mut mesh = Mesh {
        positions: vec![
            [-3.0, -3.0, 0.0],
            [3.0, -3.0, 0.0],
            [3.0, 3.0, 0.0],
            [-3.0, 3.0, 0.0],
        ]
        .into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
        ..Mesh::default()
    };
    fill(&mut mesh);
    scene.meshes.push(mesh);
    let mesh = MeshId(u32::try_from(scene.meshes.len() - 1).unwrap());
    let world_from_object = [x, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
    let material = material(scene, standard);
    scene.surfaces.push(Surface::new(
        Shape::Instance(Instance {
            mesh,
            world_from_object,
        }),
        material,
    ));
}

#[test]
fn colours_of_corners_and_the_second_set_of_coordinates_count() {
    let mut scene = scene(1);
    let mut map = add_texture(&mut scene, [2, 1], &[[0, 0, 0, 255], [255, 255, 255, 255]]);
    map.as_mut().unwrap().set = 1;
    let unlit = Standard {
        base_color_map: map,
        unlit: true,
        ..Standard::default()
    };
    add_mesh(&mut scene, unlit, [1.0, 0.0, 0.0], |mesh| {
        mesh.uvs = vec![[0.25, 0.5]; 4].into();
        mesh.second_uvs = vec![[0.75, 0.5]; 4].into();
        mesh.colors = vec![[0.5, 0.25, 0.125, 1.0]; 4].into();
    });
    assert!((mean(&render(&scene)) - Vec3::new(0.5, 0.25, 0.125)).length() < 1e-12);
}

/// The light of a sun from the direction given on a square whose normal map leans by 3:4 along the
/// axis given.
fn leaning(axis: usize, sun: [f64; 3], x: [f64; 3], tangents: bool) -> f64 {
    let mut scene = scene(1);
    let mut texel = [128, 128, 230, 255];
    texel[axis] = 204;
    let map = add_texture(&mut scene, [1, 1], &[texel]);
    let standard = Standard {
        normal_map: map,
        ..lambert([1.0; 3])
    };
    add_mesh(&mut scene, standard, x, |mesh| {
        mesh.uvs = vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].into();
        if tangents {
            mesh.normals = vec![[0.0, 0.0, 1.0]; 4].into();
            mesh.tangents = vec![[1.0, 0.0, 0.0, 1.0]; 4].into();
        }
    });
    add_light(
        &mut scene,
        Punctual {
            emitter: PunctualKind::Sun { direction: sun },
            intensity: [std::f64::consts::PI; 3],
            projected: None,
        },
    );
    middle(&render(&scene)).x
}

#[test]
fn normal_maps_lean_along_growing_u_and_against_v() {
    let plain = [1.0, 0.0, 0.0];
    for tangents in [false, true] {
        assert!(
            (leaning(0, [0.6, 0.0, 0.8], plain, tangents) - 1.0).abs() < 0.01,
            "{tangents}"
        );
        assert!(
            (leaning(1, [0.0, 0.6, 0.8], plain, tangents) - 1.0).abs() < 0.01,
            "{tangents}"
        );
        assert!(
            (leaning(0, [-0.6, 0.0, 0.8], plain, tangents) - 0.28).abs() < 0.01,
            "{tangents}"
        );
    }
}

/// The light of a sun on a square, 6 wide, whose height grows by the scale along the axis of its
/// texture coordinates.
fn sloping(axis: usize, bump_scale: f64, sun: [f64; 3], x: [f64; 3]) -> f64 {
    let mut scene = scene(1);
    scene.textures.push(Texture::Uv);
    let mut rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    rows.swap(0, axis);
    let map = Map::from(TextureId(0)).texture_from_surface(rows);
    let standard = Standard {
        bump_map: Some(map),
        bump_scale,
        ..lambert([1.0; 3])
    };
    add_mesh(&mut scene, standard, x, |mesh| {
        mesh.uvs = vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].into();
    });
    let sun = PunctualKind::Sun { direction: sun };
    let light = Punctual {
        emitter: sun,
        intensity: [std::f64::consts::PI; 3],
        projected: None,
    };
    add_light(&mut scene, light);
    middle(&render(&scene)).x
}

#[test]
fn a_bump_map_leans_away_from_growing_heights_by_their_slope() {
    let (plain, mirrored) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    // 4.5 over a width of 6 is a slope of 3:4.
    for (axis, scale, sun, x, known) in [
        (0, -4.5, [0.6, 0.0, 0.8], plain, 1.0),
        (0, 4.5, [0.6, 0.0, 0.8], plain, 0.28),
        (0, 4.5, [0.6, 0.0, 0.8], mirrored, 1.0),
        (1, 4.5, [0.0, 0.6, 0.8], plain, 1.0),
        (1, 0.0, [0.0, 0.6, 0.8], plain, 0.8),
    ] {
        let found = sloping(axis, scale, sun, x);
        assert!((found - known).abs() < 1e-6, "{found}, not {known}");
    }
}

#[test]
fn a_mirrored_instance_mirrors_its_normal_map() {
    let mirrored = [-1.0, 0.0, 0.0];
    for tangents in [false, true] {
        assert!(
            (leaning(0, [-0.6, 0.0, 0.8], mirrored, tangents) - 1.0).abs() < 0.01,
            "{tangents}"
        );
        assert!(
            (leaning(1, [0.0, 0.6, 0.8], mirrored, tangents) - 1.0).abs() < 0.01,
            "{tangents}"
        );
    }
}

#[test]
fn normals_made_against_the_winding_are_turned_round() {
    let seen = |z: f64| {
        let mut scene = scene(4);
        add_mesh(&mut scene, lambert([1.0; 3]), [1.0, 0.0, 0.0], |mesh| {
            mesh.normals = vec![[0.0, 0.0, z]; 4].into()
        });
        add_light(
            &mut scene,
            Punctual {
                emitter: PunctualKind::Sun {
                    direction: [0.8, 0.0, 0.6],
                },
                intensity: [1.0; 3],
                projected: None,
            },
        );
        render(&scene).image
    };
    assert_eq!(seen(-1.0), seen(1.0));
    assert!(seen(1.0).pixels.iter().all(|pixel| pixel[0] > 0.1));
}

#[test]
fn a_mirror_whose_normal_map_leans_too_far_shows_its_horizon() {
    let mut scene = scene(4);
    scene.environment = sky(1.0);
    // By 60°: from straight above it mirrors what is 30° below its surface.
    let map = add_texture(&mut scene, [1, 1], &[[238, 128, 191, 255]]);
    let mirror = Standard {
        roughness: 0.0,
        normal_map: map,
        ..Standard::default()
    };
    add_mesh(&mut scene, mirror, [1.0, 0.0, 0.0], |mesh| {
        mesh.uvs = vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].into();
    });
    assert!((mean(&render(&scene)) - Vec3::ONE).abs().max_element() < 1e-9);
}

#[test]
fn dispersion_keeps_white_white() {
    let glass = Standard {
        metallic: 0.0,
        roughness: 0.0,
        transmission: 1.0,
        thickness: 1.0,
        dispersion: 2.0,
        ..Standard::default()
    };
    let mut scene = scene(512);
    scene.environment = sky(1.0);
    scene.settings.max_depth = 32;
    super::add_sphere(&mut scene, [0.0; 3], 0.8, glass);
    let found = mean(&render(&scene));
    assert!((found - Vec3::ONE).abs().max_element() < 0.02, "{found}");
}

#[test]
fn rays_of_an_orthographic_camera_run_side_by_side() {
    // A square far behind the plane of the image is as large as one in it.
    let seen = |z: f64| {
        let mut scene = scene(1);
        scene.camera.projection = Projection::Orthographic;
        add_square(
            &mut scene,
            z,
            0.5,
            Standard {
                unlit: true,
                ..Standard::default()
            },
        );
        mean(&render(&scene)).x
    };
    assert_eq!(seen(0.0), 0.25);
    assert_eq!(seen(-50.0), 0.25);
}
