//! Scenes that are built in code: they are those of files, and so is what is wrong with them.

#[path = "../examples/build.rs"]
#[expect(dead_code, reason = "the test calls what main does")]
pub(crate) mod build;

use rtc::{
    Alpha, Camera, Diagnostic, Environment, Filter, Format, Light, Material, MaterialRef, Mesh,
    Options, Phong, Scene, SceneBuilder, Severity, Shape, Standard, Texture, TextureMap, Transform,
};
use std::fs;
use std::path::Path;

fn camera() -> Camera {
    Camera::look_at([1.0, 2.0, 9.0], [0.2, 0.1, 0.0])
        .fov(35.0)
        .size(24, 18)
}

/// The camera and the lights of `camera` and `lit`.
const HEAD: &str = "\
Camera: {eye: [1, 2, 9], center: [0.2, 0.1, 0], up: [0, 1, 0], viewSize: [24, 18], fov: 35}
Lights:
- {position: [5, 6, 9], color: [0.9, 0.8, 0.7]}
";

fn lit() -> SceneBuilder {
    let mut builder = SceneBuilder::new(camera());
    builder.light(Light::plain([5.0, 6.0, 9.0], [0.9, 0.8, 0.7], 0.0));
    builder
}

/// A scene text, beside which lie these files.
fn read(text: &str, files: &[&str]) -> Scene {
    let file = |name: &&str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        ((*name).to_owned(), fs::read(path.join(name)).unwrap())
    };
    let scene = ("a.yaml".to_owned(), text.as_bytes().to_vec());
    let files = files.iter().map(file).chain([scene]);
    Scene::from_files("a.yaml", files).unwrap()
}

/// The linear values of the picture.
fn values(scene: &Scene) -> Vec<[f64; 3]> {
    let options = Options::new().format(Format::Exr).samples(4);
    scene.render(&options).unwrap().pixels().to_vec()
}

fn assert_equal(built: SceneBuilder, text: &str, files: &[&str]) {
    let (built, read) = (built.build().unwrap(), read(text, files));
    let values = [&built, &read].map(values);
    assert!(values[0] == values[1], "{:?}", read.check());
    let first = values[0][0];
    assert!(
        values[0].iter().any(|value| *value != first),
        "something is seen"
    );
}

#[test]
fn shapes_are_those_of_a_text() {
    let text = HEAD.to_owned()
        + "\
Shadows: true
MaxRecursionDepth: 2
SuperSamplingFactor: 2
Objects:
- {type: plane, position: [0, -1, 0], normal: [0, 1, 0.1], material: &m
   {color: [0.8, 0.7, 0.6], ka: 0.1, kd: 0.6, ks: 0.2, n: 9}}
- {type: sphere, position: [-1, 0, 0], radius: 0.5, material: *m}
- {type: triangle, v0: [0, 0, 0], v1: [1, 0, 0], v2: [0, 1, 0.2], material: *m}
- {type: quad, v0: [1, 0, 0], v1: [2, 0, 0], v2: [2, 1, 0], v3: [1, 1, 0], material: *m}
- {type: circle, center: [-2, 1, 0], normal: [0.3, 0.4, 1], radius: 0.4, material: *m}
- {type: cylinder, position: [0, 1, -1], direction: [1, 0, 0], height: 1, radius: 0.2, material: *m}
- {type: cone, position: [-2, -1, 0], up: [0, 0.9, 0], radius: 0.4, material: *m}
- {type: paraboloid, position: [2, -1, 1], up: [0, 0.9, 0], radius: 0.4, material: *m}
- {type: torus, position: [0, -0.7, 2], direction: [0, 1, 0.2], radius: 0.5, alpha: 0.2, material: *m}
- {type: infiniteCylinder, position: [-3, 0, -2], direction: [0, 1, 0], radius: 0.2, material: *m}
- {type: sphere, position: [3, 0, 0], radius: 0.4, shadow: false, velocity: [0, 0.5, 0], material: *m}
- type: difference
  a: {type: intersection, of: [
    {type: sphere, position: [2, 1, 2], radius: 0.5, material: *m},
    {type: plane, position: [2, 1.2, 2], normal: [0, 1, 0], material: *m}]}
  b: {type: cylinder, position: [2, 0, 2], direction: [0, 1, 0], height: 3, radius: 0.2,
     material: {color: [1, 0, 0], ka: 0.3, kd: 0.7, ks: 0, n: 1}}
";
    let mut builder = lit();
    builder.shadows(true);
    builder.depth(2);
    builder.supersampling(2);
    let phong = Phong::default()
        .color([0.8, 0.7, 0.6])
        .ka(0.1)
        .kd(0.6)
        .ks(0.2)
        .n(9.0);
    let m = builder.material(phong);
    let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    for shape in [
        Shape::plane([0.0, -1.0, 0.0], [0.0, 1.0, 0.1]),
        Shape::sphere([-1.0, 0.0, 0.0], 0.5),
        Shape::triangle([[0.0; 3], x, [0.0, 1.0, 0.2]]),
        Shape::quad([x, [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 0.0]]),
        Shape::disc([-2.0, 1.0, 0.0], [0.3, 0.4, 1.0], 0.4),
        Shape::cylinder([0.0, 1.0, -1.0], x, 1.0, 0.2),
        Shape::cone([-2.0, -1.0, 0.0], [0.0, 0.9, 0.0], 0.4),
        Shape::paraboloid([2.0, -1.0, 1.0], [0.0, 0.9, 0.0], 0.4),
        Shape::torus([0.0, -0.7, 2.0], [0.0, 1.0, 0.2], 0.5, 0.2),
        Shape::infinite_cylinder([-3.0, 0.0, -2.0], y, 0.2),
    ] {
        builder.add(shape, m);
    }
    let last = builder.add(Shape::sphere([3.0, 0.0, 0.0], 0.4), m);
    builder.set_shadow(last, false);
    builder.set_velocity(last, [0.0, 0.5, 0.0]);
    let bowl = Shape::intersection([
        Shape::sphere([2.0, 1.0, 2.0], 0.5),
        Shape::plane([2.0, 1.2, 2.0], y),
    ]);
    let hollow = Shape::difference([bowl, Shape::cylinder([2.0, 0.0, 2.0], y, 3.0, 0.2)]);
    builder.add(hollow.clone().part(&[0, 1]), m);
    let red = Phong::default().color([1.0, 0.0, 0.0]).ka(0.3).kd(0.7);
    builder.add(hollow.part(&[2]), red);
    assert_equal(builder, &text, &[]);
}

#[test]
fn light_and_materials_are_those_of_a_text() {
    let text = "\
Camera: {eye: [1, 2, 9], center: [0.2, 0.1, 0], up: [0, 1, 0], viewSize: [24, 18], fov: 35,
  apertureRadius: 0.1}
Environment: {color: [0.2, 0.3, 0.4]}
Lights:
- {type: sun, direction: [1, 2, 3], irradiance: [2, 2, 1]}
- {type: point, position: [0, 3, 2], intensity: [9, 8, 7], range: 20}
- {type: spot, position: [3, 3, 3], direction: [-1, -1, -1], innerAngle: 0.1, outerAngle: 0.5,
   intensity: [30, 30, 30]}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {type: standard, metallic: 0,
   baseColor: [0.8, 0.2, 0.1, 0.5], alpha: blend, roughness: 0.4, clearcoat: 0.5}}
- {type: sphere, position: [2, 0, 0], radius: 0.7, material: {type: standard, metallic: 0,
   transmission: 1, roughness: 0, ior: 1.4, attenuationDistance: 0.5, thickness: 1}}
- {type: triangle, v0: [-3, -1, 0], v1: [3, -1, 0], v2: [0, -1, -5], uv0: [0, 0], uv1: [1, 0],
   uv2: [0.5, 1], material: {texture: UV, ka: 0, kd: 0.8, ks: 0, n: 1}}
";
    let mut builder = SceneBuilder::new(camera().lens(0.1, 1));
    builder.environment(Environment::uniform([0.2, 0.3, 0.4]));
    builder.light(Light::sun([1.0, 2.0, 3.0], [2.0, 2.0, 1.0]));
    builder.light(Light::point([0.0, 3.0, 2.0], [9.0, 8.0, 7.0]).range(20.0));
    builder.light(Light::spot([3.0; 3], [-1.0; 3], [0.1, 0.5], [30.0; 3]));
    let coated = Standard::default()
        .metallic(0.0)
        .base_color([0.8, 0.2, 0.1, 0.5])
        .alpha(Alpha::Blend)
        .roughness(0.4)
        .clearcoat(0.5);
    builder.add(Shape::sphere([0.0; 3], 1.0), coated);
    let glass = Standard::default()
        .metallic(0.0)
        .transmission(1.0)
        .roughness(0.0)
        .ior(1.4)
        .attenuation_distance(0.5)
        .thickness(1.0);
    builder.add(Shape::sphere([2.0, 0.0, 0.0], 0.7), glass);
    let uv = builder.texture(Texture::uv());
    let floor = Shape::triangle([[-3.0, -1.0, 0.0], [3.0, -1.0, 0.0], [0.0, -1.0, -5.0]]);
    let floor = floor.uvs([[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]);
    builder.add(floor, Phong::default().color_map(uv).kd(0.8));
    assert_equal(builder, text, &[]);
}

#[test]
fn meshes_and_textures_are_those_of_files() {
    let text = HEAD.to_owned()
        + "\
Objects:
- {type: sphere, position: [-1, 0, 0], radius: 1, axis: [0, 1, 0], angle: 30,
   material: {texture: tiles.png, ka: 0.2, kd: 0.8, ks: 0, n: 1}}
- {type: mesh, file: ball.obj, position: [1, 0.5, 0], scale: 0.5,
   material: {color: [0.5, 0.6, 0.9], ka: 0.1, kd: 0.8, ks: 0, n: 1}}
";
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let tiles = image::open(scenes.join("tiles.png")).unwrap().to_rgb8();
    let mut builder = lit();
    let texture = Texture::rgb8(tiles.width(), tiles.height(), tiles.into_raw()).as_in_texts();
    let texture = builder.texture(texture);
    let sphere = Shape::sphere([-1.0, 0.0, 0.0], 1.0).pole([0.0, 1.0, 0.0], 30.0);
    builder.add(sphere, Phong::default().color_map(texture).ka(0.2).kd(0.8));
    let read = read(&text, &["tiles.png", "ball.obj"]);
    let blue = Phong::default().color([0.5, 0.6, 0.9]).ka(0.1).kd(0.8);
    let mesh = builder.mesh(obj(&fs::read_to_string(scenes.join("ball.obj")).unwrap()));
    let placed = Transform::new().scale([0.5; 3]).translate([1.0, 0.5, 0.0]);
    builder.add(Shape::instance(mesh, placed), blue);
    let built = builder.build().unwrap();
    assert!(values(&built) == values(&read), "{:?}", read.check());
}

#[test]
fn a_texture_of_phong_shading_is_sampled_as_it_says() {
    let [red, green, blue, grey] = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [128; 3]];
    let pixels = [red, green, blue, grey].concat();
    // The lower left corner of the quad has the texture coordinates (0, 0), and those of glTF count
    // down.
    let corners = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    let picture = |filter: Filter| {
        let camera = Camera::look_at([0.0, 0.0, 9.0], [0.0; 3]);
        let mut builder = SceneBuilder::new(camera.orthographic(2.0).size(2, 2));
        builder.light(Light::plain([0.0, 0.0, 9.0], [1.0; 3], 0.0));
        let texture = builder.texture(Texture::rgb8(2, 2, pixels.clone()).filter(filter));
        let shown = Phong::default().color_map(texture).ka(1.0).kd(0.0);
        builder.add(Shape::quad(corners), shown);
        let scene = builder.build().unwrap();
        let picture = scene.render(&Options::new().format(Format::Exr)).unwrap();
        picture.pixels().to_vec()
    };
    let linear = |pixel: [u8; 3]| pixel.map(|byte| f64::from(byte) / 255.0);
    let expected = [blue, grey, red, green].map(linear);
    let close = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-6);
    let seen = picture(Filter::Nearest);
    assert!(seen.iter().zip(&expected).all(close), "{seen:?}");
    // At the centre of a texel both filters agree.
    assert!(picture(Filter::Linear).iter().zip(&expected).all(close));
}

#[test]
fn patterns_are_those_of_a_text() {
    let text = HEAD.to_owned()
        + "\
Objects:
- {type: plane, position: [0, -1, 0], normal: [0, 1, 0], material: {texture: {pattern: checker,
   mapping: world, scale: 0.7, colors: [[0.9, 0.9, 0.8], [0.3, 0.2, 0.2]]}, ka: 0.2, kd: 0.7,
   ks: 0, n: 1}}
- {type: sphere, position: [-1, 0, 0], radius: 1, material: {texture: {pattern: stripes, scale: 8,
   colors: [[0.7, 0.1, 0.1], [1, 1, 1]]}, ka: 0.2, kd: 0.7, ks: 0, n: 1}}
- {type: sphere, position: [1, 0, 0], radius: 1, material: {texture: {pattern: noise, seed: 5,
   mapping: world, scale: 3, octaves: 2, colors: [[0, 0.1, 0.6], [1, 0.9, 0.7]]}, ka: 0.2, kd: 0.7,
   ks: 0, n: 1}}
- {type: sphere, position: [0, 1, 1], radius: 0.6, material: {texture: {pattern: worley, seed: 3,
   mapping: world, scale: 4, colors: [[0, 0, 0], [0, 1, 0]]}, ka: 0.2, kd: 0.7, ks: 0, n: 1}}
";
    let mut builder = lit();
    let floor = Shape::plane([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]);
    for (shape, texture) in [
        (
            floor,
            Texture::checker([[0.9, 0.9, 0.8], [0.3, 0.2, 0.2]], 0.7).in_world(),
        ),
        (
            Shape::sphere([-1.0, 0.0, 0.0], 1.0),
            Texture::stripes([[0.7, 0.1, 0.1], [1.0; 3]], 8.0),
        ),
        (
            Shape::sphere([1.0, 0.0, 0.0], 1.0),
            Texture::noise([[0.0, 0.1, 0.6], [1.0, 0.9, 0.7]], 3.0, 2, 5).in_world(),
        ),
        (
            Shape::sphere([0.0, 1.0, 1.0], 0.6),
            Texture::worley([[0.0; 3], [0.0, 1.0, 0.0]], 4.0, 3).in_world(),
        ),
    ] {
        let texture = builder.texture(texture);
        builder.add(shape, Phong::default().color_map(texture).ka(0.2).kd(0.7));
    }
    assert_equal(builder, &text, &[]);
}

/// The mesh of an OBJ whose corners have the same index for position and normal.
fn obj(text: &str) -> Mesh {
    let numbers = |line: &str| -> [f64; 3] {
        let numbers: Vec<f64> = line
            .split(' ')
            .skip(1)
            .map(|n| n.parse().unwrap())
            .collect();
        numbers.try_into().unwrap()
    };
    let all = |key: &str| -> Vec<[f64; 3]> {
        let lines = text.lines().filter(|line| line.starts_with(key));
        lines.map(numbers).collect()
    };
    let face = |line: &str| -> [u32; 3] {
        let corner = |corner: &str| corner.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
        let corners: Vec<u32> = line.split(' ').skip(1).map(corner).collect();
        corners.try_into().unwrap()
    };
    let faces: Vec<_> = text
        .lines()
        .filter(|line| line.starts_with("f "))
        .map(face)
        .collect();
    Mesh::new(&all("v "), &faces).normals(&all("vn "))
}

/// Something wrong in code and in a text, and its path.
type Wrong = (fn(&mut SceneBuilder), &'static str, &'static str);

/// The codes and pointers of the errors.
fn errors(found: &[Diagnostic]) -> Vec<(&'static str, Option<&str>)> {
    let errors = found
        .iter()
        .filter(|found| found.severity == Severity::Error);
    errors
        .map(|found| (found.code, found.pointer.as_deref()))
        .collect()
}

fn ball(builder: &mut SceneBuilder, material: impl Into<Material>) {
    add(builder, Shape::sphere([0.0; 3], 1.0), material.into());
}

fn add(builder: &mut SceneBuilder, shape: Shape, material: impl Into<MaterialRef>) {
    builder.add(shape, material);
}

/// Wrong materials of a sphere.
const MATERIALS: &[Wrong] = &[
    (
        |b| ball(b, Phong::default().kt(1.0).ior(-1.0)),
        "{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1, kt: 1, eta: -1}}",
        "objects[0].material.ior",
    ),
    (
        |b| ball(b, Phong::default().kd(-1.0)),
        "{color: [1, 1, 1], ka: 0, kd: -1, ks: 0, n: 1}}",
        "objects[0].material.kd",
    ),
    (
        |b| ball(b, Phong::default().color([1.0, -1.0, 1.0])),
        "{color: [1, -1, 1], ka: 0, kd: 1, ks: 0, n: 1}}",
        "objects[0].material.color",
    ),
    (
        |b| ball(b, Phong::default().glossy_samples(0)),
        "{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1, glossySamples: 0}}",
        "objects[0].material.glossy_samples",
    ),
    (
        |b| ball(b, Standard::default().roughness(1.5)),
        "{type: standard, roughness: 1.5}}",
        "objects[0].material.roughness",
    ),
    (
        |b| ball(b, Standard::default().iridescence_ior(0.5)),
        "{type: standard, iridescenceIor: 0.5}}",
        "objects[0].material.iridescence_ior",
    ),
];

/// Wrong shapes, lights and settings.
const OTHERS: &[Wrong] = &[
    (
        |b| add(b, Shape::sphere([0.0; 3], -2.0), Phong::default()),
        "Objects: [{type: sphere, position: [0, 0, 0], radius: -2, material: *m}]",
        "objects[0].radius",
    ),
    (
        |b| add(b, Shape::disc([0.0; 3], [0.0; 3], 1.0), Phong::default()),
        "Objects: [{type: circle, center: [0, 0, 0], normal: [0, 0, 0], radius: 1, material: *m}]",
        "objects[0].normal",
    ),
    (
        |b| {
            add(
                b,
                Shape::plane([1e99, 0.0, 0.0], [0.0, 1.0, 0.0]),
                Phong::default(),
            )
        },
        "Objects: [{type: plane, position: [1.0e99, 0, 0], normal: [0, 1, 0], material: *m}]",
        "objects[0].center",
    ),
    (
        |b| b.set_light(0, Light::plain([5.0, 6.0, 9.0], [0.9, -0.8, 0.7], 0.0)),
        "Lights: [{position: [5, 6, 9], color: [0.9, -0.8, 0.7]}]",
        "lights[0].color",
    ),
    (
        |b| b.set_light(0, Light::sun([0.0; 3], [1.0; 3])),
        "Lights: [{type: sun, direction: [0, 0, 0], irradiance: 1}]",
        "lights[0]",
    ),
    (
        |b| b.set_light(0, Light::point([0.0; 3], [-1.0; 3])),
        "Lights: [{type: point, position: [0, 0, 0], intensity: [-1, -1, -1]}]",
        "lights[0].intensity",
    ),
    (
        |b| b.environment(Environment::uniform([-1.0, 0.0, 0.0])),
        "Environment: {color: [-1, 0, 0]}",
        "environment.radiance",
    ),
    (
        |b| b.supersampling(0),
        "SuperSamplingFactor: 0",
        "settings.supersampling",
    ),
];

#[test]
fn what_is_wrong_has_the_code_of_a_file_and_a_path() {
    const SPHERE: &str = "- {type: sphere, position: [0, 0, 0], radius: 1, material: ";
    let spheres = MATERIALS
        .iter()
        .map(|(build, text, path)| (*build, format!("{HEAD}Objects:\n{SPHERE}{text}\n"), *path));
    let (camera, lights) = HEAD.split_once("Lights").unwrap();
    let others = OTHERS.iter().map(|(build, text, path)| {
        let head = if text.starts_with("Lights") {
            camera.to_owned()
        } else {
            format!("{camera}Lights{lights}")
        };
        let text = text.replace("*m", "{color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}");
        (*build, format!("{head}{text}\n"), *path)
    });
    for (build, text, path) in spheres.chain(others) {
        let mut builder = lit();
        build(&mut builder);
        let built = builder.build().unwrap_err();
        let read = read(&text, &[]).check();
        assert_eq!(errors(&built), errors(&read), "{text}");
        let error = built.iter().find(|found| found.severity == Severity::Error);
        let error = error.unwrap();
        assert_eq!(error.path.as_deref(), Some(path), "{error}");
        assert!(error.to_string().contains(path), "{error}");
        assert!(
            error.short().starts_with(&format!("{path}: error[")),
            "{}",
            error.short()
        );
    }
}

#[test]
fn a_wrong_camera_has_the_code_of_a_file() {
    let look = || Camera::look_at([0.0, 0.0, 9.0], [0.0; 3]).size(8, 8);
    let head = "eye: [0, 0, 9], center: [0, 0, 0], viewSize: [8, 8]";
    for (camera, text, path) in [
        (
            look().fov(180.0),
            format!("{{{head}, up: [0, 1, 0], fov: 180}}"),
            "camera.fov",
        ),
        (
            look().fov(40.0).up([0.0; 3]),
            format!("{{{head}, up: [0, 0, 0], fov: 40}}"),
            "camera.up",
        ),
        (
            look().fov(40.0).up([0.0, 0.0, 2.0]),
            format!("{{{head}, up: [0, 0, 1], fov: 40}}"),
            "camera.up",
        ),
        (
            Camera::look_at([0.0; 3], [0.0; 3]).size(8, 8),
            "{eye: [0, 0, 0], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8], fov: 45}"
                .to_owned(),
            "camera.center",
        ),
        (
            look().size(0, 8),
            "{eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [0, 8], fov: 45}"
                .to_owned(),
            "camera.size",
        ),
    ] {
        let built = SceneBuilder::new(camera).build().unwrap_err();
        let read = read(&format!("Camera: {text}\n"), &[]).check();
        let code = |found: &[Diagnostic]| errors(found).first().map(|(code, _)| *code);
        // A `fov` in a file that is older than the key is a warning.
        let mut told = read.iter().filter(|found| found.severity != Severity::Note);
        let of_file = code(&read).or_else(|| told.next().map(|found| found.code));
        assert_eq!(code(&built), of_file, "{text}");
        assert_eq!(built[0].path.as_deref(), Some(path), "{text}");
    }
    // Straight down, +y is no upward direction, and none was asked for.
    let down = Camera::look_at([0.0, 9.0, 0.0], [0.0; 3]);
    assert!(SceneBuilder::new(down).build().is_ok());
}

#[test]
fn what_is_not_there_and_what_does_not_fit_is_wrong() {
    let wrong = |change: fn(&mut SceneBuilder)| {
        let mut builder = lit();
        change(&mut builder);
        let found = builder.build().unwrap_err();
        found[0].path.clone().unwrap()
    };
    let texture = |b: &mut SceneBuilder| b.texture(Texture::rgb8(2, 2, [0; 5]));
    assert_eq!(
        wrong(|b| {
            let _ = b.texture(Texture::rgb8(2, 2, [0; 5]));
        }),
        "textures[0]"
    );
    let mut builder = lit();
    let map = TextureMap::from(texture(&mut builder)).set(2);
    builder.add(
        Shape::sphere([0.0; 3], 1.0),
        Standard::default().base_color_map(map),
    );
    let found = builder.build().unwrap_err();
    let paths: Vec<_> = found
        .iter()
        .filter_map(|found| found.path.as_deref())
        .collect();
    assert!(
        paths.contains(&"objects[0].material.base_color_map"),
        "{found:?}"
    );
    let mesh = |b: &mut SceneBuilder| {
        let mesh = b.mesh(Mesh::new(&[[0.0_f32; 3]; 3], &[[0, 1, 7]]));
        b.add(Shape::instance(mesh, Transform::new()), Phong::default());
    };
    assert_eq!(wrong(mesh), "meshes[0]");
    assert_eq!(
        wrong(|b| {
            let _ = b.add(Shape::sphere([0.0; 3], 1.0), rtc::MaterialId(7));
        }),
        "objects[0].material"
    );
    let flat = Shape::triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let mut builder = lit();
    let ball = Shape::sphere([0.0; 3], 1.0);
    builder.add(Shape::union([ball, flat]), Phong::default());
    let found = builder.build().unwrap_err();
    assert_eq!(
        (found[0].code, found[0].path.as_deref()),
        ("VA110", Some("objects[0]"))
    );
    assert_eq!(wrong(|b| b.set("toon", "7")), "settings.toon");
    assert_eq!(wrong(|b| b.set("tune", "7")), "settings.tune");
}

#[test]
fn an_edit_keeps_a_scene_valid_or_as_it_was() {
    let text = HEAD.to_owned()
        + "Objects:\n- {type: sphere, position: [0, 0, 0], radius: 1, material: \
         {color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}\n";
    let mut scene = read(&text, &[]);
    let before = scene.clone();
    let ball = scene.tree().unwrap().objects().next().unwrap().id();
    let found = scene.edit(|builder| builder.set_shape(ball, Shape::sphere([0.0; 3], -1.0)));
    let found = found.unwrap_err();
    assert_eq!(
        errors(&found),
        [("VA002", Some("/surfaces/0/shape/sphere/radius"))]
    );
    assert_eq!(found[0].path.as_deref(), Some("objects[0].radius"));
    assert_eq!(found[0].primary, None, "the text does not say so");
    assert!(values(&scene) == values(&before) && scene.check() == before.check());
    // What is changed is that of a text that says so.
    scene
        .edit(|builder| {
            builder.set_shape(ball, Shape::sphere([0.5, 0.0, 0.0], 0.7));
            builder.set_camera(builder.camera().size(30, 20));
            builder.add(
                Shape::sphere([-1.0, 0.0, 0.0], 0.3),
                Phong::default().ka(0.3),
            );
        })
        .unwrap();
    let text = text
        .replace("[24, 18]", "[30, 20]")
        .replace("[0, 0, 0], radius: 1", "[0.5, 0, 0], radius: 0.7")
        + "- {type: sphere, position: [-1, 0, 0], radius: 0.3, material: {color: [1, 1, 1], \
           ka: 0.3, kd: 1, ks: 0, n: 1}}\n";
    let picture = |scene: &Scene| scene.render(&Options::new()).unwrap().rgba8();
    assert!(picture(&scene) == picture(&read(&text, &[])));
    assert!(values(&before).len() == 24 * 18, "the copy is as it was");
    let tree = scene.tree().unwrap();
    assert_eq!(tree.objects().len(), 2);
    assert_eq!(
        tree.light_location(0).unwrap().line,
        Some(3),
        "lights keep their places"
    );
    // A scene that has errors keeps them.
    let mut broken = read("Camera: 3\n", &[]);
    assert!(broken.edit(|builder| builder.shadows(true)).is_err());
}

#[test]
fn objects_are_named_found_shared_and_removed() {
    let mut builder = lit();
    let red = builder.material(Phong::default().color([1.0, 0.0, 0.0]));
    let first = builder.add(Shape::sphere([0.0; 3], 1.0), red);
    let second = builder.add(Shape::sphere([2.0, 0.0, 0.0], 0.5), red);
    builder.name(second, "moon");
    let third = builder.add(Shape::plane([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]), red);
    assert_eq!(builder.find("moon"), Some(second));
    let mut scene = builder.build().unwrap();
    scene
        .edit(|builder| {
            builder.set_material(third, Phong::default());
            builder
                .material_mut(red)
                .unwrap()
                .set_color([0.0, 1.0, 0.0]);
            builder.remove(first);
        })
        .unwrap();
    let tree = scene.tree().unwrap();
    let moon = tree.find("moon").unwrap();
    assert_eq!(
        tree.objects()
            .map(|object| object.name())
            .collect::<Vec<_>>(),
        ["moon", ""]
    );
    assert_eq!(moon.id().0, 0);
    assert_eq!(tree.bounds(), Some([[1.5, -0.5, -0.5], [2.5, 0.5, 0.5]]));
    assert!(matches!(
        &tree.materials()[moon.material().0 as usize],
        Material::Phong(phong) if phong.color == [0.0, 1.0, 0.0]
    ));
    let plane = tree.objects().nth(1).unwrap();
    assert_eq!((plane.shape().kind(), plane.bounds()), ("plane", None));
    assert_ne!(plane.material(), moon.material());
    // Alone with its material it keeps the index.
    let material = plane.material();
    scene
        .edit(|builder| builder.set_material(rtc::ObjectId(1), Phong::default().kd(0.5)))
        .unwrap();
    let tree = scene.tree().unwrap();
    assert_eq!(tree.objects().nth(1).unwrap().material(), material);
}

#[test]
fn an_edited_asset_is_seen_by_its_new_camera() {
    let asset = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/render/asset/binary.glb");
    let mut scene = Scene::open(asset).unwrap();
    let options = Options::new().size(12, 12).samples(1);
    let framed = scene.render(&options).unwrap();
    let [low, high] = scene.tree().unwrap().bounds().unwrap();
    let center: [f64; 3] = std::array::from_fn(|axis| (low[axis] + high[axis]) / 2.0);
    let eye = [
        center[0],
        center[1],
        high[2] + 50.0 * (high[2] - low[2]).max(1.0),
    ];
    scene
        .edit(|builder| builder.set_camera(Camera::look_at(eye, center).size(12, 12)))
        .unwrap();
    let far = scene.render(&options).unwrap();
    assert!(far.statistics().hits < framed.statistics().hits);
}

#[test]
fn clones_render_at_once_and_alike() {
    fn shared<T: Clone + Send + Sync>() {}
    shared::<Scene>();
    shared::<SceneBuilder>();
    let scene = build::scene().unwrap();
    let options = Options::new().size(24, 16).threads(1);
    let bytes = std::thread::scope(|scope| {
        let renders: Vec<_> = (0..4)
            .map(|_| {
                let scene = scene.clone();
                let options = &options;
                scope.spawn(move || scene.render(options).unwrap().encode().unwrap())
            })
            .collect();
        let renders = renders.into_iter().map(|render| render.join().unwrap());
        renders.collect::<Vec<_>>()
    });
    let alone = scene.render(&options).unwrap().encode().unwrap();
    assert!(bytes.iter().all(|bytes| *bytes == alone));
}
