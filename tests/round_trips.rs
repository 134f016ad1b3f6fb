//! What is written for Mitsuba and pbrt, as glTF and as a text is read back to the same picture:
//! within a thousandth of its mean where the writer told nothing, within a twentieth otherwise.

use rtc::internals::image::{FileFormat, Image, Picture};
use rtc::{Options, Scene};

/// What all scenes have in common.
const HEAD: &str = "\
RenderMode: path
MaxRecursionDepth: 3
PathParameters: {samples: 64}
";
const CAMERA: &str = "\
Camera: {eye: [1, 2, 9], center: [0, 1, 0], up: [0, 1, 0], viewSize: [16, 12], fov: 30}
";
const LIGHT: &str = "\
Environment: {color: [0.3, 0.4, 0.5]}
Lights: [{type: sun, direction: [1, 2, 1], irradiance: [3, 2, 2]}]
";
const FLOOR: &str = "\
- {type: quad, v0: [-5, 0, -5], v1: [-5, 0, 5], v2: [5, 0, 5], v3: [5, 0, -5], material: &matte \
{type: standard, baseColor: [0.8, 0.4, 0.3, 1], metallic: 0, roughness: 1, specular: 0, \
doubleSided: true}}
";
/// A pyramid with texture coordinates.
const MESH: &str = "\
v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n\
f 1/1 2/2 5/3\nf 2/1 3/2 5/3\nf 3/1 4/2 5/3\nf 4/1 1/2 5/3\n";

/// A scene: camera, light and objects.
struct Case {
    name: &'static str,
    camera: &'static str,
    light: &'static str,
    objects: &'static str,
    targets: &'static [&'static str],
}

const MITSUBA: &str = "scene.xml";
const PBRT: &str = "scene.pbrt";
const ALL: &[&str] = &[MITSUBA, PBRT, "scene.glb", "scene.gltf", "scene.yaml"];

const fn objects(name: &'static str, objects: &'static str) -> Case {
    Case {
        name,
        camera: CAMERA,
        light: LIGHT,
        objects,
        targets: ALL,
    }
}

const fn light(name: &'static str, light: &'static str) -> Case {
    Case {
        light,
        ..objects(name, BALL)
    }
}

const fn camera(name: &'static str, camera: &'static str) -> Case {
    Case {
        camera,
        ..objects(name, BALL)
    }
}

const BALL: &str = "- {type: sphere, position: [0, 1, 0], radius: 1, material: *matte}\n";

/// The material of a ball.
macro_rules! ball {
    ($material:literal) => {
        concat!(
            "- {type: sphere, position: [0, 1, 0], radius: 1, material: {type: standard, ",
            $material,
            "}}\n"
        )
    };
}

/// The colour of a pyramid with texture coordinates.
macro_rules! pyramid {
    ($map:literal) => {
        concat!(
            "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
             doubleSided: true, baseColor: [1, 0.5, 1, 1], baseColorMap: ",
            $map,
            "}}\n"
        )
    };
}

const CASES: &[Case] = &[
    objects("a matt ball", BALL),
    objects(
        "a disc, a triangle and an ellipsoid",
        "- {type: circle, center: [1.5, 1, 0], normal: [0, 1, 2], radius: 1, material: *matte}
- {type: triangle, v0: [-2, 0, 0], v1: [-1, 0, 0], v2: [-1, 2, 0], material: *matte}
- {type: ellipsoid, position: [0, 1, 0], radius: [0.5, 1, 0.3], material: *matte}
",
    ),
    objects(
        "a bilinear patch",
        "- {type: quad, curved: true, v0: [-1, 0, 1], v1: [1, 1, 1], v2: [1, 0, -1], v3: [-1, 2, -1], material: *matte}\n",
    ),
    objects(
        "a cylinder, a torus and a plane",
        "- {type: cylinder, p1: [-1, 0, 0], p2: [-1, 1, 0], radius: 0.6, material: *matte}
- {type: torus, position: [1, 1, 0], radius: 0.6, alpha: 0.2, material: *matte}
- {type: plane, position: [0, -1, 0], normal: [0, 1, 0], material: *matte}
",
    ),
    objects(
        "a mesh shown twice",
        "- {type: mesh, file: m.obj, position: [-1, 0, 0], material: *matte}
- {type: mesh, file: m.obj, position: [1, 0, 0], material: *matte}
",
    ),
    objects(
        "a textured mesh",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
doubleSided: true, baseColor: [1, 0.5, 1, 1], baseColorMap: p.png}}\n",
    ),
    objects("checks of any size", pyramid!("{pattern: checker, scale: 3, colors: [[1, 0, 0], [0, 0, 1]]}")),
    objects("checks that are cells", pyramid!("{pattern: checker, scale: 1, colors: [[1, 0, 0], [0, 0, 1]]}")),
    objects("stripes", pyramid!("{pattern: stripes, scale: 2.5, colors: [[0.1, 0.2, 0.3], [0.9, 0.8, 0.1]]}")),
    objects("noise", pyramid!("{pattern: noise, scale: 5, octaves: 2, seed: 3}")),
    objects("distances", pyramid!("{pattern: worley, scale: 4}")),
    objects(
        "noise in space",
        pyramid!("{pattern: noise, mapping: world, scale: 2, octaves: 2}"),
    ),
    objects(
        "checks with a placement",
        pyramid!(
            "{pattern: checker, scale: 3, transform: [0.8, 0.3, 0.1, -0.4, 1.5, 0.2]}"
        ),
    ),
    objects("a texture of floats", pyramid!("e.exr")),
    objects(
        "checks for a roughness",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, \
doubleSided: true, baseColor: [0.9, 0.7, 0.4, 1], metallicRoughnessMap: {pattern: checker, scale: 3, \
colors: [[1, 0.2, 1], [1, 0.6, 1]]}}}\n",
    ),
    objects(
        "a mesh that checks cut out",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
doubleSided: true, baseColor: [0.5, 0.2, 0.5, 1], alpha: mask, opacityMap: {pattern: checker, scale: 3}}}\n",
    ),
    objects(
        "a ball of which a box is left",
        "- {type: intersection, a: {type: sphere, position: [0, 1, 0], radius: 1}, \
b: {type: box, min: [-0.7, 0.3, -0.7], max: [0.7, 1.7, 0.7]}, material: *matte}\n",
    ),
    objects(
        "a mesh that a texture covers",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
doubleSided: true, baseColor: [0.5, 0.2, 0.5, 0.9], alpha: blend, opacityMap: p.png}}\n",
    ),
    objects(
        "a blend of copper and a leaf, by a texture",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
doubleSided: true, baseColor: [0.5, 0.2, 0.5, 1], blendWeight: 0.8, blendMap: p.png, \
blendWith: {type: standard, doubleSided: true, conductor: copper, roughness: 0.4, microfacets: separable-ggx}}}\n",
    ),
    objects(
        "a mesh with heights by a texture",
        "- {type: mesh, file: m.obj, position: [0, 0, 0], material: {type: standard, metallic: 0, specular: 0, \
doubleSided: true, baseColor: [0.5, 0.2, 0.5, 1], bumpMap: p.png, bumpScale: 0.2}}\n",
    ),
    objects("a white mirror", ball!("doubleSided: true, roughness: 0")),
    objects(
        "a rough metal",
        ball!("doubleSided: true, baseColor: [0.9, 0.7, 0.4, 1], roughness: 0.5"),
    ),
    objects(
        "gold by its index",
        ball!(
            "doubleSided: true, roughness: 0.4, conductor: {eta: [0.14, 0.37, 1.44], k: [3.98, 2.39, 1.6]}"
        ),
    ),
    objects(
        "brushed gold of Beckmann's facets",
        ball!(
            "doubleSided: true, roughness: 0.4, microfacets: beckmann, anisotropy: 0.5, \
             conductor: {eta: [0.14, 0.37, 1.44], k: [3.98, 2.39, 1.6]}"
        ),
    ),
    objects(
        "a smooth plastic",
        ball!(
            "doubleSided: true, metallic: 0, roughness: 0, plastic: nonlinear, ior: 1.49, \
             baseColor: [0.8, 0.5, 0.1, 1]"
        ),
    ),
    objects(
        "a rough plastic with a black back",
        ball!(
            "doubleSided: true, blackBack: true, metallic: 0, roughness: 0.5, plastic: linear, \
             microfacets: separable-ggx, ior: 1.49, specular: 0.8, baseColor: [0.8, 0.5, 0.1, 1]"
        ),
    ),
    objects(
        "a plastic without reflections inside",
        ball!(
            "doubleSided: true, metallic: 0, roughness: 0.3, plastic: single, \
             microfacets: beckmann, ior: 1.49, baseColor: [0.8, 0.5, 0.1, 1]"
        ),
    ),
    objects(
        "a coated surface",
        ball!("doubleSided: true, metallic: 0, roughness: 0.3, baseColor: [0.2, 0.5, 0.3, 1]"),
    ),
    objects(
        "a half metallic surface",
        ball!("doubleSided: true, metallic: 0.5, roughness: 0.6"),
    ),
    objects(
        "glass",
        ball!("metallic: 0, roughness: 0, transmission: 1, thickness: 1, ior: 1.5"),
    ),
    objects(
        "a thin pane",
        ball!("metallic: 0, roughness: 0, transmission: 1"),
    ),
    objects(
        "a thin pane of two faces",
        ball!("metallic: 0, roughness: 0, transmission: 1, thinDielectric: true"),
    ),
    objects(
        "a body that lets half of the light through",
        ball!("doubleSided: true, metallic: 0, roughness: 0.4, transmission: 0.5, thickness: 1"),
    ),
    objects(
        "a half covering surface",
        ball!(
            "doubleSided: true, metallic: 0, specular: 0, alpha: blend, baseColor: [0.8, 0.8, 0.2, 0.5]"
        ),
    ),
    objects(
        "a leaf",
        ball!(
            "doubleSided: true, metallic: 0, specular: 0, baseColor: [0.4, 0.5, 0.2, 1], diffuseTransmission: 0.4"
        ),
    ),
    objects(
        "what shows its colour",
        ball!("doubleSided: true, unlit: true, baseColor: [0.2, 0.5, 0.9, 1]"),
    ),
    Case {
        light: "",
        ..objects(
            "a lamp",
            "- {type: circle, center: [0, 4, 0], normal: [0, -1, 0], radius: 1.5, material: {type: standard, \
metallic: 0, specular: 0, baseColor: [0, 0, 0, 1], doubleSided: true, emissive: [4, 3, 2]}}\n",
        )
    },
    light(
        "a point",
        "Lights: [{type: point, position: [1, 4, 3], intensity: [20, 30, 25]}]\n",
    ),
    light(
        "a spot",
        "Lights: [{type: spot, position: [0, 6, 2], direction: [0, -3, -1], innerAngle: 0.2, outerAngle: 0.5, intensity: [40, 40, 30]}]\n",
    ),
    light(
        "a light without falloff",
        "Lights: [{position: [3, 8, 6], color: [1, 1, 1]}]\n",
    ),
    light("an environment map", "Environment: {file: e.exr}\n"),
    camera(
        "an orthographic camera",
        "Camera: {eye: [1, 2, 9], center: [0, 1, 0], up: [0, 0.3, 0], viewSize: [16, 12], projection: orthographic}\n",
    ),
    objects(
        "smoke around a ball",
        "- {type: sphere, position: [0, 1, 0], radius: 0.5, material: *matte}
- {type: sphere, position: [0, 1, 0], radius: 1, material: {type: standard, alpha: blend, baseColor: [1, 1, 1, 0], \
interior: {sigmaA: [0.1, 0.2, 0.5], sigmaS: [0.5, 1, 0.4], g: 0.3}}}
- {type: sphere, position: [0, 1, 0], radius: 0.8, material: {type: standard, alpha: blend, baseColor: [1, 1, 1, 0], \
exterior: {sigmaA: [0.1, 0.2, 0.5], sigmaS: [0.5, 1, 0.4], g: 0.3}}}
",
    ),
    objects(
        "milk in glass",
        ball!("metallic: 0, roughness: 0, transmission: 1, thickness: 1, interior: {sigmaS: 3, sigmaA: 0.1}"),
    ),
    light(
        "fog around the camera",
        "Environment: {color: [0.3, 0.4, 0.5]}
Lights: [{position: [0, 4, 2], intensity: 20}]
Medium: {sigmaA: 0.01, sigmaS: [0.05, 0.03, 0.02], g: -0.4}
",
    ),
    camera(
        "a lens",
        "Camera: {eye: [1, 2, 9], center: [0, 1, 0], up: [0, 1, 0], viewSize: [16, 12], fov: 30, apertureRadius: 0.3, apertureSamples: 2}\n",
    ),
    camera(
        "a shifted view",
        "Camera: {eye: [0, 1, 5], center: [0.5, 1.2, 0], up: [0, 0.25, 0], right: [0.25, 0, 0], viewSize: [16, 12]}\n",
    ),
];

/// The files that scenes name.
fn files() -> Vec<(String, Vec<u8>)> {
    let picture = |width, height, color: &dyn Fn(u32, u32) -> [f64; 3]| {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Picture::opaque(Image {
            width,
            height,
            pixels: places.map(|(x, y)| color(x, y)).collect(),
        })
    };
    let checks = picture(4, 4, &|x, y| match (x + y) % 2 {
        0 => [0.9, 0.1, 0.3],
        _ => [0.2, 0.8, 0.4],
    });
    let sky = picture(32, 16, &|x, y| {
        let [x, y] = [x, y].map(f64::from);
        [0.2 + x / 32.0, 0.5, 0.2 + y / 16.0]
    });
    vec![
        ("m.obj".to_owned(), MESH.as_bytes().to_vec()),
        ("p.png".to_owned(), checks.encode(FileFormat::Png8).unwrap()),
        ("e.exr".to_owned(), sky.encode(FileFormat::Exr).unwrap()),
    ]
}

/// The mean of all values of the picture of a scene.
fn mean(scene: &Scene) -> f64 {
    let picture = scene
        .render(&Options::new().exposure(0.0).threads(1))
        .unwrap();
    let values = picture.pixels().as_flattened();
    values.iter().sum::<f64>() / values.len() as f64
}

/// A scene as it is read back from a file of another renderer, and the warnings of the writer.
fn read_back(scene: &Scene, target: &str) -> (Scene, Vec<String>) {
    let export = scene.export(target).unwrap();
    let findings = export.diagnostics().iter();
    let warnings = findings.map(|finding| finding.message.clone()).collect();
    let files = export.files().chain([(target, export.bytes())]);
    let files = files.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
    let again = Scene::from_files(target, files);
    (again.unwrap_or_else(|error| panic!("{error}")), warnings)
}

/// The differences between the pictures of a case that its writers do not explain.
fn differences(case: &Case) -> Vec<String> {
    let Case {
        name,
        camera,
        light,
        objects,
        targets,
    } = case;
    let text = format!("{camera}{HEAD}{light}Objects:\n{FLOOR}{objects}");
    let files = files().into_iter();
    let files = files.chain([("scene.yaml".to_owned(), text.into_bytes())]);
    let scene = Scene::from_files("scene.yaml", files);
    let scene = scene.unwrap_or_else(|error| panic!("{name}: {error}"));
    let known = mean(&scene);
    assert!(known > 0.01, "{name}: nothing is seen");
    let difference = |target: &&str| {
        let (again, warnings) = read_back(&scene, target);
        let found = mean(&again);
        let tolerance = if warnings.is_empty() { 1e-3 } else { 5e-2 };
        let is_near = (found / known - 1.0).abs() <= tolerance;
        (!is_near).then(|| format!("{name}, {target}: {found}, not {known}; {warnings:?}"))
    };
    targets.iter().filter_map(difference).collect()
}

#[test]
fn what_is_written_for_path_tracers_is_read_back_to_the_same_picture() {
    let differences: Vec<_> = CASES.iter().flat_map(differences).collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

#[test]
fn what_is_written_for_pbrt_again_has_the_spot_of_pbrt() {
    let text = format!(
        "{CAMERA}{HEAD}Lights: [{{type: spot, position: [0, 6, 2], \
        direction: [0, -3, -1], innerAngle: 0.2, outerAngle: 0.5, intensity: [40, 40, 30]}}]\n\
        Objects:\n{FLOOR}"
    );
    let files = [("scene.yaml".to_owned(), text.into_bytes())];
    let scene = Scene::from_files("scene.yaml", files).unwrap();
    let (first, warnings) = read_back(&scene, PBRT);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let (second, warnings) = read_back(&first, PBRT);
    assert_eq!(warnings, [""; 0]);
    let [a, b] = [&first, &second].map(mean);
    assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
}

/// A scene of this light and this material of a ball.
fn ball(light: &str, material: &str) -> Scene {
    let text = format!(
        "{CAMERA}{HEAD}{light}Objects:\n\
        - {{type: sphere, position: [0, 1, 0], radius: 1, material: {{type: standard, {material}}}}}\n"
    );
    let files = [("scene.yaml".to_owned(), text.into_bytes())];
    Scene::from_files("scene.yaml", files).unwrap()
}

fn text_of(scene: &Scene, target: &str) -> String {
    let export = scene.export(target).unwrap();
    String::from_utf8(export.bytes().to_vec()).unwrap()
}

#[test]
fn widths_of_facets_are_written_as_they_were_read() {
    for width in ["0.1", "0.3", "0.7"] {
        let pbrt = format!(
            "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
            WorldBegin\nLightSource \"infinite\"\nMaterial \"conductor\" \"float roughness\" {width} \
            \"bool remaproughness\" false\nTranslate 0 0 5\nShape \"sphere\"\n"
        );
        let files = [(PBRT.to_owned(), pbrt.into_bytes())];
        let scene = Scene::from_files(PBRT, files).unwrap();
        let again = text_of(&scene, PBRT);
        assert!(
            again.contains(&format!("roughness\" [ {width} ]")),
            "{again}"
        );
        let again = text_of(&scene, MITSUBA);
        let expected = format!(r#"name="alpha" value="{width}""#);
        assert!(again.contains(&expected), "{again}");
    }
}

#[test]
fn an_emitter_of_pov_ray_reflects_its_own_colour() {
    for color in ["[0, 0, 0, 1]", "[0.5, 0, 0, 1]"] {
        let material = format!(
            "metallic: 0, specular: 0, baseColor: {color}, emissive: [4, 3, 2], doubleSided: true"
        );
        let text = text_of(&ball("", &material), "scene.pov");
        let pigment = text.split("pigment { rgb <").nth(1).unwrap();
        let pigment = pigment.split('>').next().unwrap();
        let reflected: Vec<f64> = pigment
            .split(", ")
            .map(|channel| channel.parse().unwrap())
            .collect();
        assert!(
            reflected[1..].iter().all(|channel| *channel < 1e-3),
            "{text}"
        );
    }
}

#[test]
fn a_cut_out_of_pov_ray_has_the_opacity_of_its_texture() {
    let text = format!(
        "{CAMERA}{HEAD}{LIGHT}Objects:\n- {{type: mesh, file: m.obj, position: [0, 0, 0], material: \
        {{type: standard, metallic: 0, specular: 0, doubleSided: true, alpha: mask, opacityMap: p.png}}}}\n"
    );
    let files = files().into_iter();
    let files = files.chain([("scene.yaml".to_owned(), text.into_bytes())]);
    let export = Scene::from_files("scene.yaml", files).unwrap();
    let export = export.export("scene.pov").unwrap();
    let text = String::from_utf8(export.bytes().to_vec()).unwrap();
    assert!(text.contains("image_map { png"), "{text}");
    let (_, png) = export.files().next().unwrap();
    // Colour type 6 of a PNG has an opacity.
    assert_eq!(png[25], 6);
}
