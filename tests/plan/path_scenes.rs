//! The effects of each value of a path-traced scene other than materials: a change of one value
//! adds and removes the named effects and no others.

use super::path_effects::{GLOSSY, LAYERED, LIT, beyond, illuminated, needs};
use super::path_materials::FIRST;
use super::path_rules::{across, add, placed, white};
use rtc::internals::ir::{
    self, Environment, ImageId, Material, Mode, PathSettings, Pixels, Scene, Shape, Standard,
    Texture,
};
use rtc::internals::plan::{Effect, Layer, PathFeatures};

/// A name, a change of the scene, the effects that it adds and removes, and the resulting features.
type OfScene = (
    &'static str,
    fn(&mut Scene),
    [&'static [Effect]; 2],
    PathFeatures,
);

pub(super) fn path(scene: &mut Scene) -> &mut PathSettings {
    let Mode::Path(path) = &mut scene.settings.mode else {
        panic!("the scene is traced");
    };
    path
}

pub(super) fn standard(material: &mut Material) -> &mut Standard {
    let Material::Standard(standard) = material else {
        panic!("the material is that of glTF");
    };
    standard
}

/// The material of the ball.
fn material(scene: &mut Scene) -> &mut Standard {
    standard(&mut scene.materials[0])
}

/// An environment with an image of two texels, or without an image.
pub(super) fn sky(scene: &mut Scene, radiance: f64, texels: Option<[u8; 2]>) {
    let image = |[first, second]: [u8; 2]| ir::Image {
        name: "sky".to_owned(),
        width: 2,
        height: 1,
        kind: Pixels::Rgb8,
        pixels: [[first; 3], [second; 3]].concat().into(),
    };
    scene.images = texels.map(image).into_iter().collect();
    scene.environment = Some(Environment {
        radiance: [radiance; 3],
        image: texels.map(|_| ImageId(0)),
        image_from_world: None,
    });
}

/// A triangle before the ball: a mesh that is changed, of a material that is changed.
pub(super) fn cover(scene: &mut Scene, mesh: fn(&mut ir::Mesh), change: fn(&mut Standard)) {
    let (mut triangle, mut material) = (across(), white());
    mesh(&mut triangle);
    change(&mut material);
    let shape = placed(scene, triangle);
    add(scene, &shape, &material);
}

/// A material with maps of a texture of two texels on a triangle.
fn mapped(scene: &mut Scene, texels: [u8; 2], change: fn(&mut Standard)) {
    sky(scene, 0.0, Some(texels));
    scene.environment = None;
    scene.textures = vec![Texture::Image(ImageId(0))];
    cover(scene, |_| (), change);
}

const OF_SCENES: [OfScene; 30] = [
    (
        "no bounce",
        |s| s.settings.max_depth = 0,
        [&[], &[Effect::DirectLight, Effect::Shadows, Effect::Depth]],
        PathFeatures::NONE,
    ),
    (
        "one bounce, after which nothing shines",
        |s| s.settings.max_depth = 1,
        [&[], &[Effect::Depth]],
        LIT,
    ),
    (
        "one bounce, after which a ball shines",
        |s| (s.settings.max_depth, material(s).emissive) = (1, [1.0; 3]),
        [&[Effect::Emission, Effect::Mis], &[]],
        LIT,
    ),
    (
        "no bounce, but a ball that shines",
        |s| (s.settings.max_depth, material(s).emissive) = (0, [1.0; 3]),
        [
            &[Effect::Emission],
            &[Effect::DirectLight, Effect::Shadows, Effect::Depth],
        ],
        PathFeatures::NONE,
    ),
    (
        "no bounce, and a coat",
        |s| (s.settings.max_depth, material(s).clearcoat) = (0, 1.0),
        [&[], &[Effect::DirectLight, Effect::Shadows, Effect::Depth]],
        PathFeatures::NONE,
    ),
    (
        "one path per pixel",
        |s| path(s).samples = 1,
        [&[], &[Effect::Supersampling]],
        LIT,
    ),
    (
        "a lens",
        |s| {
            s.camera.lens = ir::Lens {
                radius: 0.1,
                samples: 4,
            }
        },
        [&[Effect::Lens], &[]],
        LIT,
    ),
    (
        "no light",
        |s| s.lights.clear(),
        [&[], &[Effect::DirectLight, Effect::Shadows, Effect::Depth]],
        PathFeatures::NONE,
    ),
    (
        "a black lamp",
        |s| {
            if let ir::Light::Punctual(light_source) = &mut s.lights[0] {
                light_source.intensity = [0.0; 3];
            }
        },
        [&[], &[Effect::DirectLight, Effect::Shadows, Effect::Depth]],
        PathFeatures::NONE,
    ),
    (
        "no surface",
        |s| s.surfaces.clear(),
        [
            &[],
            &[
                Effect::Surfaces,
                Effect::DirectLight,
                Effect::Shadows,
                Effect::Depth,
            ],
        ],
        PathFeatures::NONE,
    ),
    (
        "mirrors",
        |s| {
            let mirror = Standard {
                metallic: 1.0,
                roughness: 0.0,
                ..white()
            };
            for material in &mut s.materials {
                *standard(material) = mirror.clone();
            }
        },
        [
            &[Effect::Microfacets],
            &[Effect::DirectLight, Effect::Shadows],
        ],
        PathFeatures::MICROFACETS,
    ),
    (
        "compensation of what has no facets",
        |s| path(s).multiple_scattering = true,
        [&[], &[]],
        LIT,
    ),
    (
        "compensation",
        |s| (path(s).multiple_scattering, material(s).specular) = (true, 1.0),
        [&[Effect::Microfacets, Effect::Compensation], &[]],
        GLOSSY,
    ),
    (
        "an even environment",
        |s| sky(s, 1.0, None),
        [&[Effect::Environment], &[]],
        LIT,
    ),
    (
        "an environment with an image",
        |s| sky(s, 1.0, Some([9, 10])),
        [
            &[Effect::Environment, Effect::EnvironmentMap, Effect::Mis],
            &[],
        ],
        LIT,
    ),
    (
        "an environment with an even image",
        |s| sky(s, 1.0, Some([9, 9])),
        [&[Effect::Environment, Effect::Mis], &[]],
        LIT,
    ),
    (
        "an environment with a black image",
        |s| sky(s, 1.0, Some([0, 0])),
        [&[], &[]],
        LIT,
    ),
    (
        "a black environment with an image",
        |s| sky(s, 0.0, Some([9, 10])),
        [&[], &[]],
        LIT,
    ),
    (
        "a mesh that shines",
        |s| cover(s, |_| (), |m| m.emissive = [1.0; 3]),
        [&[Effect::Emission, Effect::Mis], &[]],
        LIT,
    ),
    (
        "an unlit mesh",
        |s| cover(s, |_| (), |m| (m.unlit, m.emissive) = (true, [1.0; 3])),
        [&[Effect::Unlit], &[]],
        LIT,
    ),
    (
        "a triangle that shines",
        |s| {
            let vertices = [[-2.0, -2.0, 1.0], [2.0, -2.0, 1.1], [0.0, 2.0, 1.3]];
            let triangle = Shape::Triangle(ir::Triangle {
                vertices,
                uvs: None,
            });
            add(
                s,
                &triangle,
                &Standard {
                    emissive: [1.0; 3],
                    ..white()
                },
            );
        },
        [&[Effect::Emission, Effect::Mis], &[]],
        LIT,
    ),
    (
        "normals",
        |s| {
            cover(
                s,
                |mesh| mesh.normals = vec![[0.0, 0.0, 1.0]; 3].into(),
                |_| (),
            )
        },
        [&[Effect::NormalInterpolation], &[]],
        LIT,
    ),
    (
        "normals of what is unlit",
        |s| {
            cover(
                s,
                |mesh| mesh.normals = vec![[0.0, 0.0, 1.0]; 3].into(),
                |m| m.unlit = true,
            )
        },
        [&[Effect::Unlit], &[]],
        LIT,
    ),
    (
        "normals where no path goes on",
        |s| {
            cover(
                s,
                |mesh| mesh.normals = vec![[0.0, 0.0, 1.0]; 3].into(),
                |m| m.emissive = [1.0; 3],
            );
            s.settings.max_depth = 0;
        },
        [
            &[Effect::Emission],
            &[Effect::DirectLight, Effect::Shadows, Effect::Depth],
        ],
        PathFeatures::NONE,
    ),
    (
        "colours",
        |s| cover(s, |mesh| mesh.colors = vec![[0.5; 4]; 3].into(), |_| ()),
        [&[Effect::VertexColors], &[]],
        LIT,
    ),
    (
        "a texture",
        |s| mapped(s, [9, 10], |m| m.base_color_map = Some(FIRST)),
        [&[Effect::Textures], &[]],
        LIT,
    ),
    (
        "an even texture",
        |s| mapped(s, [9, 9], |m| m.base_color_map = Some(FIRST)),
        [&[], &[]],
        LIT,
    ),
    (
        "a normal map",
        |s| mapped(s, [200, 210], |m| m.normal_map = Some(FIRST)),
        [&[Effect::NormalMapping], &[]],
        LIT,
    ),
    (
        "an even normal map",
        |s| mapped(s, [200, 200], |m| m.normal_map = Some(FIRST)),
        [&[Effect::NormalMapping], &[]],
        LIT,
    ),
    (
        "a normal map of a coat",
        |s| {
            mapped(s, [200, 210], |m| {
                (m.clearcoat, m.clearcoat_normal_map) = (1.0, Some(FIRST))
            })
        },
        [
            &[Effect::Layer(Layer::Clearcoat), Effect::NormalMapping],
            &[],
        ],
        LAYERED,
    ),
];

#[test]
fn each_value_of_a_scene_brings_and_takes_its_effects() {
    let (before, _) = needs(&illuminated(&white()));
    for (name, change, [more, less], features) in OF_SCENES {
        let mut scene = illuminated(&white());
        change(&mut scene);
        let (after, of_kernel) = needs(&scene);
        assert_eq!(beyond(&after, &before), more, "{name}");
        assert_eq!(beyond(&before, &after), less, "{name}");
        assert_eq!(of_kernel, features, "{name}");
    }
}
