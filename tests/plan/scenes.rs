//! A small test scene: a sphere, a disc and other surfaces, seen from (0, 0, 10) along −z.

use rtc::internals::ir::{
    self, ImageId, Light, Material, MaterialId, Phong, Scene, Shape, Surface, Texture, TextureId,
};

/// Diffuse grey.
pub(super) fn diffuse() -> Phong {
    Phong {
        color: [0.5, 0.6, 0.7],
        ka: 0.2,
        kd: 0.7,
        ks: 0.0,
        kr: None,
        n: 8.0,
        kt: 0.0,
        fresnel: false,
        ior: 1.5,
        glossy_samples: 1,
        color_map: None,
        specular_map: None,
        normal_map: None,
        bump: None,
    }
}

/// With a highlight and reflection.
pub(super) fn shiny() -> Phong {
    Phong {
        ks: 0.5,
        ..diffuse()
    }
}

/// A test scene with shadows and two bounces, a white light at (3, 4, 12), and no surface.
pub(super) fn base_scene() -> Scene {
    Scene {
        camera: ir::Camera {
            eye: [0.0, 0.0, 10.0],
            center: [0.0; 3],
            right: [0.25, 0.0, 0.0],
            up: [0.0, 0.25, 0.0],
            size: [24, 20],
            lens: ir::Lens {
                radius: 0.0,
                samples: 1,
            },
            projection: ir::Projection::Perspective,
        },
        settings: ir::Settings {
            mode: ir::Mode::Phong,
            shadows: true,
            max_depth: 2,
            ..ir::Settings::default()
        },
        lights: vec![light([3.0, 4.0, 12.0])],
        images: Vec::new(),
        textures: Vec::new(),
        meshes: Vec::new(),
        materials: Vec::new(),
        surfaces: Vec::new(),
        names: Vec::new(),
        environment: None,
        medium: None,
        display: ir::Display::default(),
        trees: Vec::new(),
    }
}

/// A white point light.
pub(super) fn light(position: [f64; 3]) -> Light {
    Light::Point(ir::PointLight {
        position,
        color: [1.0; 3],
        radius: 0.0,
    })
}

/// A test scene with the given surfaces, each with its own material.
pub(super) fn with(surfaces: &[(Shape, Phong)]) -> Scene {
    let mut scene = base_scene();
    for (index, (shape, phong)) in (0_u32..).zip(surfaces) {
        scene.materials.push(Material::Phong(phong.clone()));
        scene
            .surfaces
            .push(Surface::new(shape.clone(), MaterialId(index)));
    }
    scene
}

pub(super) fn ball(center: [f64; 3], radius: f64) -> Shape {
    Shape::Sphere(ir::Sphere {
        center,
        radius,
        texture_from_world: None,
    })
}

/// A disc that faces +z.
pub(super) fn disc(center: [f64; 3], radius: f64) -> Shape {
    Shape::Disc(ir::Disc {
        center,
        normal: [0.0, 0.0, 1.0],
        radius,
    })
}

pub(super) fn plane(height: f64) -> Shape {
    Shape::Plane(ir::Plane {
        center: [0.0, height, 0.0],
        normal: [0.0, 1.0, 0.0],
    })
}

/// The material of surface `index`.
pub(super) fn material(scene: &mut Scene, index: usize) -> &mut Phong {
    scene.materials[index].phong_mut().unwrap()
}

/// The first light.
pub(super) fn first_light(scene: &mut Scene) -> &mut ir::PointLight {
    let Light::Point(light) = &mut scene.lights[0] else {
        panic!("the light of the stage is a point")
    };
    light
}

/// Adds a texture of 2 × 2 texels, one value but for the last.
pub(super) fn texture(scene: &mut Scene, value: [u8; 3], last: [u8; 3]) -> TextureId {
    let pixels = [value, value, value, last].concat().into();
    scene.images.push(ir::Image {
        name: "stage".to_owned(),
        width: 2,
        height: 2,
        kind: ir::Pixels::Rgb8,
        pixels,
    });
    scene.textures.push(Texture::Image(ImageId(0)));
    TextureId(0)
}

/// A square mesh in the plane z = 0 with a normal at each corner.
pub(super) fn square(scene: &mut Scene, normals: [[f64; 3]; 4]) {
    let mesh = ir::Mesh {
        name: "square".to_owned(),
        positions: vec![
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ]
        .into(),
        normals: normals.into_iter().collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
        ..ir::Mesh::default()
    };
    scene.meshes.push(mesh);
    let world_from_object = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
    let shape = Shape::Instance(ir::Instance {
        mesh: ir::MeshId(0),
        world_from_object,
    });
    scene.surfaces.push(Surface::new(shape, MaterialId(0)));
}
