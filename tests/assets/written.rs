//! A scene of everything that an asset may hold, as a text with files beside it.

use crate::texts::assert_comes_back;
use rtc::internals::color::Tone;
use rtc::internals::emit::course::emit_with_files;
use rtc::internals::front::course;
use rtc::internals::ir::{
    Alpha, Display, Environment, Filter, Image, ImageId, Instance, Light, Map, Material,
    MaterialId, Mesh, MeshId, Mode, PathSettings, Pixels, Projection, Punctual, PunctualKind,
    Sampled, Scene, Settings, Shape, Standard, Surface, Texture, TextureId, VertexColumn, Wrap,
};
use rtc::internals::ir::{Camera, Lens, Pattern};
use serde_json::{Value, json};

/// Three vertices with all that a vertex may have, no number of which is short.
fn mesh(name: &str) -> Mesh {
    fn column<const N: usize>(from: f32) -> VertexColumn<N> {
        let number = |at: usize| (from + at as f32 * 0.37) / 3.0;
        let vertex = |at: usize| std::array::from_fn(|part| number(at * at + 2 * part));
        (0..3).map(vertex).collect::<Vec<[f32; N]>>().into()
    }
    Mesh {
        name: name.to_owned(),
        part: None,
        positions: column(-1.0),
        normals: column(1.0),
        uvs: column(0.1),
        second_uvs: column(-0.3),
        tangents: column(0.5),
        colors: column(0.2),
        triangles: vec![[0, 1, 2], [2, 1, 0]].into(),
    }
}

fn image(name: &str, kind: Pixels) -> Image {
    let bytes = (0..6 * kind.bytes()).map(|at| u8::try_from(at * 37 % 251).unwrap());
    let floats = (0..18_u8).flat_map(|at| (f32::from(at) / 7.0).to_le_bytes());
    Image {
        name: name.to_owned(),
        width: 3,
        height: 2,
        kind,
        pixels: match kind {
            Pixels::Rgb8 | Pixels::Rgba8 => bytes.collect::<Vec<u8>>().into(),
            Pixels::Rgb32f => floats.collect::<Vec<u8>>().into(),
        },
    }
}

/// A material all of whose parameters are other than by default: what is a number becomes 0.7, what
/// is a map looks at a texture.
fn full() -> Standard {
    let map = Map {
        texture: TextureId(0),
        set: 1,
        texture_from_surface: Some([[0.1, -0.2, 0.3], [0.4, 0.5, -0.0]]),
    };
    let mut tree = json!({});
    let schema = course::schema();
    let keys = schema["$defs"]["standard-material"]["properties"]
        .as_object()
        .unwrap();
    for key in keys
        .keys()
        .filter(|key| !["type", "comment"].contains(&key.as_str()))
    {
        tree[key] = match key.as_str() {
            "name" => json!("a \"name\": #1"),
            "blendWith" => json!(0),
            "alpha" => json!({ "mask": 0.3 }),
            "doubleSided" | "unlit" | "blackBack" | "thinDielectric" => json!(true),
            "microfacets" => json!("beckmann"),
            "plastic" => json!("nonlinear"),
            "ior" | "iridescenceIor" => json!(1.4),
            "interior" | "exterior" => {
                json!({ "sigmaA": [0.1, 0.2, 1.0 / 3.0], "sigmaS": [0.5, 0.6, 0.7], "g": -0.3 })
            }
            "iridescenceThickness" => json!([50.0, 1.0 / 3.0]),
            "conductor" => json!({ "eta": [0.1, 0.4, 1.0 / 3.0], "k": [4.0, 2.5, 1.9] }),
            "baseColor" | "specularGlossiness" => json!([0.1, 0.2, 0.3, 0.7]),
            key if key.ends_with("Color") || key == "emissive" => json!([0.1, 0.2, 1.0 / 3.0]),
            key if key.ends_with("Map") => serde_json::to_value(&map).unwrap(),
            _ => json!(0.7),
        };
    }
    serde_json::from_value(tree).unwrap()
}

fn lights() -> Vec<Light> {
    let (position, direction) = ([1.0, 2.0, 1.0 / 3.0], [0.3, -0.4, -0.0]);
    let range = Some(7.7);
    let emitters = [
        PunctualKind::Sun { direction },
        PunctualKind::Point {
            position,
            range: None,
        },
        PunctualKind::Point { position, range },
        PunctualKind::Spot {
            position,
            direction,
            inner_angle: 0.1,
            outer_angle: 0.7,
            range,
        },
    ];
    let punctual = |emitter| {
        Light::Punctual(Punctual {
            emitter,
            intensity: [0.1, 100.0, 1.0 / 3.0],
            projected: None,
        })
    };
    emitters.into_iter().map(punctual).collect()
}

/// Side by side, through a lens.
fn camera() -> Camera {
    Camera {
        eye: [0.0, 0.0, 9.0],
        center: [0.0; 3],
        right: [0.1, 0.0, 0.0],
        up: [0.0, 0.2, 0.0],
        size: [8, 6],
        lens: Lens {
            radius: 0.1,
            samples: 3,
        },
        projection: Projection::Orthographic,
    }
}

fn settings() -> Settings {
    Settings {
        mode: Mode::Path(PathSettings {
            samples: 7,
            multiple_scattering: false,
            ..PathSettings::default()
        }),
        shadows: true,
        max_depth: 5,
        supersampling: 2,
        pattern: Pattern::Jitter,
        light_samples: 1,
        toon: false,
        background: Some([0.3, 0.2, 0.1]),
        ..Settings::default()
    }
}

/// A turned mesh of a material, by their indices.
fn surface(mesh: u32, material: u32) -> Surface {
    Surface::new(
        Shape::Instance(Instance {
            mesh: MeshId(mesh),
            world_from_object: [
                [0.0, 1.1, 0.0],
                [-0.9, 0.0, 0.0],
                [0.0, 0.0, 1.0 / 3.0],
                [5.0, 6.0, 7.0],
            ],
        }),
        MaterialId(material),
    )
}

/// A material, a full one that is a blend with it, one with a map, and the default one.
fn materials() -> Vec<Material> {
    let plain = Map {
        texture: TextureId(1),
        set: 0,
        texture_from_surface: None,
    };
    let simple = Standard {
        base_color_map: Some(plain),
        alpha: Alpha::Blend,
        ..Standard::default()
    };
    let other = Standard {
        metallic: 0.5,
        ..Standard::default()
    };
    [other, full(), simple, Standard::default()]
        .map(|own| Material::Standard(Box::new(own)))
        .to_vec()
}

/// Both ways to look at an image.
fn textures() -> Vec<Texture> {
    let sampled = |image, wrap, filter| {
        Texture::Sampled(Sampled {
            image: ImageId(image),
            wrap,
            filter,
        })
    };
    vec![
        sampled(0, [Wrap::Mirror, Wrap::Clamp], Filter::Nearest),
        sampled(1, [Wrap::Repeat; 2], Filter::Linear),
    ]
}

/// A scene that has all there is.
fn everything() -> Scene {
    let flat = Mesh {
        normals: VertexColumn::default(),
        ..mesh("")
    };
    Scene {
        lights: lights(),
        images: vec![
            image("a/b.jpg", Pixels::Rgba8),
            image("", Pixels::Rgb8),
            image("sky", Pixels::Rgb32f),
        ],
        textures: textures(),
        meshes: vec![mesh("first"), flat],
        materials: materials(),
        surfaces: vec![surface(0, 1), surface(1, 2), surface(0, 2), surface(1, 3)],
        names: ["", "a: b", "", ""].map(str::to_owned).to_vec(),
        environment: Some(Environment {
            radiance: [0.5, 0.6, 1.0 / 3.0],
            image: Some(ImageId(2)),
            image_from_world: Some([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]]),
        }),
        display: Display {
            exposure: -10.0 / 3.0,
            tone: Some(Tone::PbrNeutral),
        },
        ..Scene::new(camera(), settings())
    }
}

#[test]
fn all_that_a_scene_may_hold_comes_back() {
    let scene = everything();
    assert_comes_back(&scene);
    let text = emit_with_files(&scene, Some("x.files")).unwrap().text;
    let schema = course::schema();
    let keys = schema["$defs"]["standard-material"]["properties"]
        .as_object()
        .unwrap();
    for key in keys.keys().filter(|key| *key != "comment") {
        assert!(
            text.contains(&format!("      {key}: ")),
            "`{key}` is not other than by default"
        );
    }
    let strict = jsonschema::validator_for(&schema).unwrap();
    let tree: Value = serde_yaml::from_str(&text).unwrap();
    assert!(
        strict.is_valid(&tree),
        "{:?}",
        strict.iter_errors(&tree).next()
    );
}

#[test]
fn columns_of_either_precision_come_back() {
    let mut scene = everything();
    let wide = |own: &VertexColumn<3>| {
        own.iter()
            .map(|[x, y, z]| [x / 3.0, y, z])
            .collect::<Vec<_>>()
    };
    scene.meshes[0].positions = wide(&scene.meshes[0].positions).into();
    scene.meshes[1].colors = scene.meshes[1].colors.iter().collect();
    assert!(matches!(scene.meshes[0].positions, VertexColumn::Double(_)));
    assert_comes_back(&scene);
}

#[test]
fn without_a_folder_no_file_is_promised() {
    let refused = emit_with_files(&everything(), None).unwrap_err();
    assert!(refused.contains("-o FILE"), "{refused}");
    let mut scene = everything();
    scene.surfaces[0].shape = scene.surfaces[1].shape.clone();
    scene.meshes[1].triangles = Vec::new().into();
    let refused = emit_with_files(&scene, Some("x.files")).unwrap_err();
    assert!(refused.contains("no triangles"), "{refused}");
}

#[test]
fn what_is_the_same_is_one_file() {
    let mut scene = everything();
    scene.images[1] = Image {
        name: "b".to_owned(),
        ..scene.images[0].clone()
    };
    scene.meshes[1] = scene.meshes[0].clone();
    let files = emit_with_files(&scene, Some("x.files")).unwrap().files;
    let names: Vec<_> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names.len(), 3, "{names:?}");
    assert!(names[0].starts_with("x.files/b-") && names[0].ends_with(".png"));
    assert!(names[1].starts_with("x.files/first-") && names[1].ends_with(".ply"));
    assert!(names[2].starts_with("x.files/sky-") && names[2].ends_with(".exr"));
}
