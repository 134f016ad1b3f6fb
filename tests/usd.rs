//! Stages of USD: what they compose to, and what they look like where that is known.

use crate::assets::png;
use crate::small::{WHOLE, film};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Alpha, Material, Scene, Shape, Standard};
use rtc::internals::pipeline::{Options, load};
use rtc::internals::source::{Loader, Resource, SourceMap};
use std::fs;
use std::path::Path;

/// The scene of a file, which has no error, and the codes of its diagnostics.
fn read_with(path: &Path, options: &Options) -> (Scene, Vec<&'static str>) {
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader.file(path, &mut map).unwrap();
    let lowered = load(file, &mut map, options, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.kept());
    let codes = sink.kept().iter().map(|diagnostic| diagnostic.code.id);
    (lowered.unwrap().scene, codes.collect())
}

/// Reads layers of a folder, in metres; the first one is the stage.
fn read_layers(layers: &[(&str, &str)], options: &Options) -> (Scene, Vec<&'static str>) {
    let folder = tempfile::tempdir().unwrap();
    for (name, body) in layers {
        fs::write(folder.path().join(name), format!("#usda 1.0\n{body}")).unwrap();
    }
    read_with(&folder.path().join(layers[0].0), options)
}

const METRES: &str = "(\n metersPerUnit = 1\n)\n";

fn stage(body: &str) -> Scene {
    let text = format!("{METRES}{body}");
    let (scene, codes) = read_layers(&[("a.usda", &text)], &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    scene
}

fn spheres(scene: &Scene) -> Vec<([f64; 3], f64)> {
    let spheres = scene.surfaces.iter().map(|surface| match &surface.shape {
        Shape::Sphere(sphere) => (sphere.center, sphere.radius),
        other => panic!("{other:?}"),
    });
    spheres.collect()
}

fn standard(scene: &Scene, surface: usize) -> &Standard {
    let material = scene.surfaces[surface].material.0 as usize;
    match &scene.materials[material] {
        Material::Standard(standard) => standard,
        Material::Phong(other) => panic!("{other:?}"),
    }
}

fn assert_near(a: [f64; 3], b: [f64; 3]) {
    let is_near = a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(is_near, "{a:?}, not {b:?}");
}

/// A camera of a few pixels that looks along −z from (0, 0, 10).
const CAMERA: &str = "def Camera \"eye\" {\nfloat focalLength = 200\n\
    float horizontalAperture = 20\n\
    float verticalAperture = 20\ndouble3 xformOp:translate = (0, 0, 10)\n\
    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\n";

/// The mean of the middle of a picture before that camera.
fn middle(body: &str) -> [f64; 3] {
    let mut scene = stage(&format!("{CAMERA}{body}"));
    scene.camera.fit([8, 8]);
    let pixels = film(&scene, &WHOLE, 1).image.pixels;
    let around = [pixels[27], pixels[28], pixels[35], pixels[36]];
    std::array::from_fn(|channel| around.iter().map(|pixel| pixel[channel]).sum::<f64>() / 4.0)
}

#[test]
fn transforms_apply_from_the_last_to_the_first() {
    let operations = "double3 xformOp:translate = (1, 0, 0)\n\
        float3 xformOp:rotateXYZ = (90, 90, 0)\n\
        double3 xformOp:translate:in = (0, 0, 2)\nfloat3 xformOp:scale = (2, 2, 2)\n";
    let order = |names: &str| {
        let body = format!(
            "def Xform \"a\" {{\ndouble3 xformOp:translate = (0, 5, 0)\n\
             uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\
             def Sphere \"s\" {{\n{operations}uniform token[] xformOpOrder = [{names}]\n}}\n}}"
        );
        spheres(&stage(&body))[0]
    };
    // (0, 0, 2) about x by 90° is (0, −2, 0), which y leaves.
    let all = order("\"xformOp:translate\", \"xformOp:rotateXYZ\", \"xformOp:translate:in\"");
    assert_near(all.0, [1.0, 3.0, 0.0]);
    let undone = order("\"xformOp:translate\", \"!invert!xformOp:translate\", \"xformOp:scale\"");
    assert_near(undone.0, [0.0, 5.0, 0.0]);
    assert!((undone.1 - 2.0).abs() < 1e-12);
    let reset = order("\"xformOp:translate\", \"!resetXformStack!\", \"xformOp:translate:in\"");
    assert_near(reset.0, [0.0, 0.0, 2.0]);
}

#[test]
fn stages_are_in_metres_with_y_up() {
    let text = "(\n upAxis = \"Z\"\n metersPerUnit = 0.01\n)\ndef Sphere \"s\" {\n\
        double3 xformOp:translate = (100, 200, 300)\n\
        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}";
    let (scene, _) = read_layers(&[("a.usda", text)], &Options::default());
    let (center, radius) = spheres(&scene)[0];
    assert_near(center, [1.0, 3.0, -2.0]);
    assert!((radius - 0.01).abs() < 1e-12);
}

#[test]
fn stronger_opinions_win() {
    // Local, then inherited, of a variant, referenced, of a payload, specialized.
    let radius = |stronger: &[&str]| {
        let has = |name: &str| stronger.contains(&name);
        let own = |name: &str, value: u32| match has(name) {
            true => format!("double radius = {value}\n"),
            false => String::new(),
        };
        let root = format!(
            "{METRES}class \"c\" {{ {} }}\nclass \"z\" {{ {} }}\n\
             def Sphere \"s\" (\n inherits = </c>\n\
             specializes = </z>\n references = @r.usda@</r>\n payload = @r.usda@</p>\n\
             variants = {{ string v = \"x\" }}\n variantSets = \"v\"\n)\n{{\n{}\
             variantSet \"v\" = {{\n\"x\" {{ {} }}\n\"y\" {{ double radius = 9 }}\n}}\n}}",
            own("inherit", 2),
            own("specialize", 6),
            own("local", 1),
            own("variant", 3)
        );
        let other = format!(
            "def \"r\" {{ {} }}\ndef \"p\" {{ {} }}",
            own("reference", 4),
            own("payload", 5)
        );
        let layers = [("a.usda", root.as_str()), ("r.usda", other.as_str())];
        spheres(&read_layers(&layers, &Options::default()).0)[0].1
    };
    let order = [
        "local",
        "inherit",
        "variant",
        "reference",
        "payload",
        "specialize",
    ];
    for first in 0..order.len() {
        let expected = f64::from(u32::try_from(first).unwrap() + 1);
        assert_eq!(
            radius(&order[first..]).to_bits(),
            expected.to_bits(),
            "{}",
            order[first]
        );
    }
}

#[test]
fn a_variant_of_an_asset_is_stronger_than_what_its_children_refer_to() {
    let text = format!(
        "{METRES}class Sphere \"ball\" {{ double radius = 2 }}\n\
         def \"a\" (\n variants = {{ string v = \"x\" }}\n)\n{{\n\
         variantSet \"v\" = {{ \"x\" {{ over \"b\" {{ double radius = 3 }} }} }}\n\
         def \"b\" ( references = </ball> ) {{}}\n}}"
    );
    let (scene, _) = read_layers(&[("a.usda", &text)], &Options::default());
    assert_eq!(spheres(&scene)[0].1.to_bits(), 3.0_f64.to_bits());
}

#[test]
fn a_variant_is_chosen_from_outside_and_by_the_user() {
    let asset = "(\n defaultPrim = \"a\"\n)\n\
        def \"a\" (\n variants = { string size = \"small\" }\n)\n{\n\
        variantSet \"size\" = {\n\"small\" { def Sphere \"s\" { double radius = 1 } }\n\
        \"large\" { def Sphere \"s\" { double radius = 2 } }\n\
        \"huge\" { def Sphere \"s\" { double radius = 3 } }\n}\n}";
    let stage =
        |choice: &str| format!("{METRES}def \"b\" (\n references = @asset.usda@\n{choice})\n{{}}");
    let radius = |choice: &str, wanted: Option<&str>| {
        let mut options = Options::default();
        options.front.variant = wanted.map(str::to_owned);
        let layers = [("a.usda", stage(choice)), ("asset.usda", asset.to_owned())];
        let layers = layers.each_ref().map(|(name, text)| (*name, text.as_str()));
        spheres(&read_layers(&layers, &options).0)[0].1.to_bits()
    };
    let chosen = " variants = { string size = \"large\" }\n";
    assert_eq!(radius("", None), 1.0_f64.to_bits());
    assert_eq!(radius(chosen, None), 2.0_f64.to_bits());
    assert_eq!(radius(chosen, Some("size=huge")), 3.0_f64.to_bits());
}

#[test]
fn samples_are_read_at_the_time_and_layers_have_their_own() {
    let moved = "def Sphere \"s\" {\n\
        double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 10: (10, 0, 0) }\n\
        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}";
    let stage = "(\n metersPerUnit = 1\n timeCodesPerSecond = 10\n)\n\
        def \"a\" ( references = @m.usda@</s> ) {}\n\
        def \"b\" ( references = @m.usda@</s> (offset = 5; scale = 2) ) {}";
    let at = |time: Option<f64>| {
        let mut options = Options::default();
        options.front.time = time;
        let layers = [("a.usda", stage), ("m.usda", moved)];
        let scene = read_layers(&layers, &options).0;
        spheres(&scene)
            .into_iter()
            .map(|(center, _)| center[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(at(None), [0.0, 0.0]);
    assert_eq!(at(Some(0.7)), [7.0, 1.0]);
    assert_eq!(at(Some(9.0)), [10.0, 10.0]);
}

#[test]
fn texture_coordinates_run_up_and_are_turned_and_moved() {
    let body = "def Mesh \"m\" {\nuniform token subdivisionScheme = \"none\"\n\
        int[] faceVertexCounts = [4]\n\
        int[] faceVertexIndices = [0, 1, 2, 3]\n\
        point3f[] points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]\n\
        texCoord2f[] primvars:uv = [(0, 0), (1, 0), (1, 1), (0, 1)] \
         ( interpolation = \"vertex\" )\n\
        rel material:binding = </m/l>\ndef Material \"l\" {\n\
        token outputs:surface.connect = </m/l/s.outputs:surface>\n\
        def Shader \"s\" {\nuniform token info:id = \"UsdPreviewSurface\"\n\
        color3f inputs:diffuseColor.connect = </m/l/t.outputs:rgb>\n}\n\
        def Shader \"t\" {\nuniform token info:id = \"UsdUVTexture\"\nasset inputs:file = @t.png@\n\
        float2 inputs:st.connect = </m/l/x.outputs:result>\nfloat4 inputs:scale = (0.5, 1, 1, 1)\n\
        }\n\
        def Shader \"x\" {\nuniform token info:id = \"UsdTransform2d\"\n\
        float2 inputs:translation = (0, 0.25)\n\
        float2 inputs:in.connect = </m/l/r.outputs:result>\n}\n\
        def Shader \"r\" {\nuniform token info:id = \"UsdPrimvarReader_float2\"\n\
        string inputs:varname = \"uv\"\n}\n}\n}";
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.usda"),
        format!("#usda 1.0\n{METRES}{body}"),
    )
    .unwrap();
    // A white texel, without compression.
    let texture = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/render/usd/files/white.png");
    fs::copy(texture, folder.path().join("t.png")).unwrap();
    let (scene, codes) = read_with(&folder.path().join("a.usda"), &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    let map = standard(&scene, 0).base_color_map.as_ref().unwrap();
    // v runs down: what moves up by a quarter moves the row up.
    assert_eq!(
        map.texture_from_surface,
        Some([[1.0, 0.0, 0.0], [0.0, 1.0, -0.25]])
    );
    assert_eq!(scene.meshes[0].uvs.at(0), [0.0, 1.0]);
    // Half of white, coded as sRGB.
    assert_eq!(scene.images[0].pixels[..3], [188, 255, 255]);
}

#[test]
fn layers_in_two_folders_may_give_two_pictures_one_name() {
    let texture = |shader: &str| {
        format!(
            "def Shader \"{shader}\" {{ uniform token info:id = \"UsdUVTexture\"\n\
             asset inputs:file = @t.png@ }}\n"
        )
    };
    let root = format!(
        "#usda 1.0\n(\n metersPerUnit = 1\n subLayers = [@sub/b.usda@]\n)\n\
         def Sphere \"s\" {{ rel material:binding = </l> }}\ndef Material \"l\" {{\n\
         token outputs:surface.connect = </l/s.outputs:surface>\ndef Shader \"s\" {{\n\
         uniform token info:id = \"UsdPreviewSurface\"\n\
         float inputs:roughness.connect = </l/rough.outputs:r>\n\
         float inputs:metallic.connect = </l/metal.outputs:r>\n}}\n{}}}",
        texture("rough")
    );
    let below = format!("#usda 1.0\nover \"l\" {{\n{}}}", texture("metal"));
    let folder = tempfile::tempdir().unwrap();
    let sub = folder.path().join("sub");
    fs::create_dir(&sub).unwrap();
    fs::write(folder.path().join("a.usda"), root).unwrap();
    fs::write(sub.join("b.usda"), below).unwrap();
    fs::write(folder.path().join("t.png"), png([10; 3])).unwrap();
    fs::write(sub.join("t.png"), png([20; 3])).unwrap();
    let (scene, codes) = read_with(&folder.path().join("a.usda"), &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    // Roughness is green, metal blue.
    assert_eq!(scene.images[0].pixels[..3], [255, 10, 20]);
}

#[test]
fn a_preview_surface_is_the_standard_material() {
    let material = |inputs: &str| {
        let body = format!(
            "def Sphere \"s\" {{ rel material:binding = </l> }}\ndef Material \"l\" {{\n\
             token outputs:surface.connect = </l/s.outputs:surface>\ndef Shader \"s\" {{\n\
             uniform token info:id = \"UsdPreviewSurface\"\n{inputs}\n}}\n}}"
        );
        let scene = stage(&body);
        standard(&scene, 0).clone()
    };
    let plain = material("");
    assert_eq!(
        (plain.base_color, plain.roughness),
        ([0.18, 0.18, 0.18, 1.0], 0.5)
    );
    let glass = material(
        "float inputs:opacity = 0.25\nfloat inputs:ior = 1.3\nfloat inputs:clearcoat = 0.5",
    );
    assert_eq!((glass.alpha, glass.base_color[3]), (Alpha::Blend, 0.25));
    assert_eq!((glass.ior, glass.clearcoat), (1.3, 0.5));
    let cut = material("float inputs:opacity = 0.25\nfloat inputs:opacityThreshold = 0.5");
    assert_eq!(cut.alpha, Alpha::Mask(0.5));
    let specular = material(
        "int inputs:useSpecularWorkflow = 1\ncolor3f inputs:specularColor = (0.1, 0.2, 0.3)\n\
         float inputs:metallic = 1",
    );
    assert_eq!(
        (specular.metallic, specular.specular_color),
        (0.0, [0.1, 0.2, 0.3])
    );
}

#[test]
fn lights_have_the_radiance_that_they_say() {
    let seen = |light: &str, inputs: &str| middle(&format!("def {light} \"l\" {{\n{inputs}\n}}"));
    // A light is seen by its radiance: its intensity, times 2 to the exposure.
    assert_near(
        seen(
            "SphereLight",
            "float inputs:intensity = 3\nfloat inputs:exposure = 2",
        ),
        [12.0; 3],
    );
    // Over its area, if it is normalized.
    let area = 4.0 * std::f64::consts::PI * 0.25;
    let inputs =
        "bool inputs:normalize = 1\nfloat inputs:intensity = 3\ncolor3f inputs:color = (1, 0.5, 0)";
    assert_near(seen("SphereLight", inputs), [3.0 / area, 1.5 / area, 0.0]);
    // Flat lights face −z, away from the camera.
    let turned = "float inputs:intensity = 2\ndouble xformOp:rotateY = 180\n\
        uniform token[] xformOpOrder = [\"xformOp:rotateY\"]";
    for light in ["RectLight", "DiskLight"] {
        assert_near(seen(light, "float inputs:intensity = 2"), [0.0; 3]);
        assert_near(seen(light, turned), [2.0; 3]);
    }
    assert_near(
        seen("CylinderLight", "float inputs:intensity = 2"),
        [2.0; 3],
    );
}

#[test]
fn a_wall_is_lit_by_the_irradiance_of_a_distant_light() {
    let wall = "def Plane \"w\" {\ndouble width = 50\ndouble length = 50\n\
        color3f[] primvars:displayColor = [(0.5, 0.5, 0.5)]\n}\n";
    let reflected = 0.5 / std::f64::consts::PI;
    let sun = |inputs: &str| middle(&format!("{wall}def DistantLight \"l\" {{\n{inputs}\n}}"));
    assert_near(
        sun("float inputs:angle = 0\nfloat inputs:intensity = 2"),
        [2.0 * reflected; 3],
    );
    let sine = (0.25_f64.to_radians()).sin();
    let irradiance = 50_000.0 * std::f64::consts::PI * sine * sine;
    assert_near(sun("float inputs:angle = 0.5"), [irradiance * reflected; 3]);
}

#[test]
fn a_binary_package_has_the_scene_of_its_text() {
    // The layer was written by OpenUSD, as text, too.
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/render/usd");
    let (packed, codes) = read_with(&folder.join("package.usdz"), &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    let (text, _) = read_with(&folder.join("files/package.usda"), &Options::default());
    assert_eq!(packed.meshes, text.meshes);
    assert_eq!(packed.surfaces.len(), text.surfaces.len());
    assert_eq!(packed.camera.size, text.camera.size);
    assert_near(packed.camera.eye, text.camera.eye);
    for surface in 0..packed.surfaces.len() {
        let shapes = [&packed, &text].map(|scene| scene.surfaces[surface].shape.kind());
        assert_eq!(shapes[0], shapes[1]);
        let [a, b] = [&packed, &text].map(|scene| standard(scene, surface));
        assert_eq!((a.alpha, a.base_color), (b.alpha, b.base_color));
    }
    // Texts are read with more digits than floats have.
    let look = |scene: &Scene| {
        let map = standard(scene, 0).base_color_map.as_ref();
        map.and_then(|map| map.texture_from_surface).unwrap()
    };
    let rows = look(&packed)
        .into_iter()
        .flatten()
        .zip(look(&text).into_iter().flatten());
    assert!(rows.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
    assert_eq!(packed.images.len(), 3);
}

/// A material `m` of one colour, and one more.
const MATERIALS: &str = "def Material \"m\" { token outputs:surface.connect = </m/s.outputs:surface>\n\
    def Shader \"s\" { uniform token info:id = \"UsdPreviewSurface\"\n\
    color3f inputs:diffuseColor = (1, 0, 0) } }\n\
    def Material \"k\" { token outputs:surface.connect = </k/s.outputs:surface>\n\
    def Shader \"s\" { uniform token info:id = \"UsdPreviewSurface\"\n\
    color3f inputs:diffuseColor = (0, 0, 1) } }\n";

fn color(scene: &Scene, surface: usize) -> [f64; 3] {
    let [r, g, b, _] = standard(scene, surface).base_color;
    [r, g, b]
}

#[test]
fn a_binding_may_be_stronger_than_those_of_the_prims_and_faces_below() {
    let bound = |strength: &str| {
        let body = format!(
            "{MATERIALS}def Xform \"x\" {{ rel material:binding = </m> {strength}\n\
             def Sphere \"s\" {{ rel material:binding = </k> }}\n\
             def Mesh \"f\" {{ int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n\
             uniform token subdivisionScheme = \"none\"\n\
             point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
             def GeomSubset \"g\" {{ int[] indices = [0]\nrel material:binding = </k> }} }} }}"
        );
        let scene = stage(&body);
        [color(&scene, 0), color(&scene, 1)]
    };
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let strong = "( bindMaterialAs = \"strongerThanDescendants\" )";
    let weak = "( bindMaterialAs = \"weakerThanDescendants\" )";
    assert_eq!(
        [bound(strong), bound(weak), bound("")],
        [[red; 2], [blue; 2], [blue; 2]]
    );
}

#[test]
fn a_shader_reads_the_constant_primvar_of_the_nearest_prim() {
    let body = "def Material \"m\" { token outputs:surface.connect = </m/s.outputs:surface>\n\
        def Shader \"s\" { uniform token info:id = \"UsdPreviewSurface\"\n\
        color3f inputs:diffuseColor.connect = </m/r.outputs:result> }\n\
        def Shader \"r\" { uniform token info:id = \"UsdPrimvarReader_float3\"\n\
        string inputs:varname = \"tint\"\nfloat3 inputs:fallback = (0, 1, 0) } }\n\
        def \"a\" { color3f primvars:tint = (1, 0, 0)\nrel material:binding = </m>\n\
        def Sphere \"above\" {}\n\
        def Sphere \"own\" { color3f primvars:tint = (0, 0, 1) }\n\
        def \"b\" { color3f[] primvars:tint = [(1, 1, 1)] ( interpolation = \"vertex\" )\n\
        def Sphere \"hidden\" {} }\n\
        def Mesh \"mesh\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n\
        uniform token subdivisionScheme = \"none\"\n\
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
        color3f[] primvars:tint = [(1, 0, 0), (0, 1, 0), (0, 0, 1)] ( interpolation = \"vertex\" )\n\
        } }\ndef Sphere \"none\" { rel material:binding = </m> }";
    let scene = stage(body);
    let colors: Vec<_> = (0..5).map(|surface| color(&scene, surface)).collect();
    let (red, green, blue) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    // The colours of the mesh are those of its vertices.
    assert_eq!(colors, [red, blue, green, [1.0; 3], green]);
    assert_eq!(scene.meshes[0].colors.at(1), [0.0, 1.0, 0.0, 1.0]);
}

/// A square of 2 × 2 units of texture coordinates with a texture.
fn textured(file: &str) -> String {
    format!(
        "def Mesh \"m\" {{\nuniform token subdivisionScheme = \"none\"\n\
         int[] faceVertexCounts = [4]\nint[] faceVertexIndices = [0, 1, 2, 3]\n\
         point3f[] points = [(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]\n\
         texCoord2f[] primvars:st = [(0, 0), (2, 0), (2, 2), (0, 2)] ( interpolation = \"vertex\" )\n\
         rel material:binding = </l> }}\n\
         def Material \"l\" {{ token outputs:surface.connect = </l/s.outputs:surface>\n\
         def Shader \"s\" {{ uniform token info:id = \"UsdPreviewSurface\"\n\
         color3f inputs:diffuseColor.connect = </l/t.outputs:rgb> }}\n\
         def Shader \"t\" {{ uniform token info:id = \"UsdUVTexture\"\nasset inputs:file = @{file}@\n\
         float2 inputs:st.connect = </l/r.outputs:result> }}\n\
         def Shader \"r\" {{ uniform token info:id = \"UsdPrimvarReader_float2\"\n\
         string inputs:varname = \"st\" }} }}\n"
    )
}

#[test]
fn tiles_become_one_picture_from_the_lowest_row() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let body = textured("t.<UDIM>.png");
    fs::write(at("a.usda"), format!("#usda 1.0\n{METRES}{body}")).unwrap();
    for (number, byte) in [(1001, 10), (1002, 20), (1011, 30)] {
        fs::write(at(&format!("t.{number}.png")), png([byte; 3])).unwrap();
    }
    let (scene, codes) = read_with(&at("a.usda"), &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    let image = &scene.images[0];
    let tile = [image.width as usize / 2, image.height as usize / 2];
    let shown = |column: usize, row: usize| {
        let [x, y] = [column * tile[0], row * tile[1]];
        image.pixels[3 * (y * image.width as usize + x)]
    };
    // The second row of tiles is above the first one; one tile is not there.
    assert_eq!(
        [shown(0, 0), shown(1, 0), shown(0, 1), shown(1, 1)],
        [30, 0, 10, 20]
    );
    let map = standard(&scene, 0).base_color_map.as_ref().unwrap();
    assert_eq!(
        map.texture_from_surface,
        Some([[0.5, 0.0, 0.0], [0.0, 0.5, 0.5]])
    );
    // Without any tile the file is missed as others are.
    let missed = textured("u.<UDIM>.png");
    fs::write(at("b.usda"), format!("#usda 1.0\n{METRES}{missed}")).unwrap();
    assert_eq!(read_with(&at("b.usda"), &Options::default()).1, ["RE001"]);
}

#[test]
fn a_dome_takes_a_picture_of_a_display() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "#usda 1.0\n{METRES}def DomeLight \"d\" {{ asset inputs:texture:file = @sky.png@ }}"
    );
    fs::write(folder.path().join("a.usda"), text).unwrap();
    fs::write(folder.path().join("sky.png"), png([188, 255, 0])).unwrap();
    let (scene, codes) = read_with(&folder.path().join("a.usda"), &Options::default());
    assert_eq!(codes, Vec::<&str>::new());
    let image = scene.environment.unwrap().image.unwrap();
    let floats = scene.images[image.0 as usize].pixels.as_chunks::<4>().0;
    let [r, g, b] = [0, 1, 2].map(|at| f32::from_le_bytes(floats[at]));
    assert!(
        (r - 0.5).abs() < 0.01 && (g, b) == (1.0, 0.0),
        "{r} {g} {b}"
    );
}

/// A package: an archive of files as they are.
fn package(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let header = |signature: &[u8], name: &str, size: usize| {
        let size = u32::try_from(size).unwrap().to_le_bytes();
        let length = u16::try_from(name.len()).unwrap().to_le_bytes();
        [signature, &[0; 14], &size, &size, &length, &[0; 2]].concat()
    };
    let (mut archive, mut list) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let start = u32::try_from(archive.len()).unwrap().to_le_bytes();
        archive.extend(header(b"PK\x03\x04", name, bytes.len()));
        archive.extend([name.as_bytes(), bytes].concat());
        list.extend(header(b"PK\x01\x02\x00\x00", name, bytes.len()));
        list.extend([[0; 10].as_slice(), &start, name.as_bytes()].concat());
    }
    let start = u32::try_from(archive.len()).unwrap().to_le_bytes();
    [
        archive,
        list,
        b"PK\x05\x06".to_vec(),
        vec![0; 12],
        start.to_vec(),
        vec![0; 2],
    ]
    .concat()
}

#[test]
fn packages_hold_packages_and_files_are_named_through_both() {
    let layer = |body: &str| format!("#usda 1.0\n{METRES}{body}").into_bytes();
    let inner = package(&[
        ("ball.usda", layer("def Sphere \"s\" {}")),
        (
            "other.usda",
            layer("def Sphere \"o\" { double radius = 3 }"),
        ),
        ("t.png", png([7; 3])),
    ]);
    let stage = format!(
        "def \"a\" ( references = @in.usdz@</s> ) {{}}\n\
         def \"b\" ( references = @in.usdz[other.usda]@</o> ) {{}}\n{}",
        textured("in.usdz[t.png]")
    );
    let outer = package(&[("a.usda", layer(&stage)), ("in.usdz", inner.clone())]);
    let first = package(&[("in.usdz", inner)]);
    let folder = tempfile::tempdir().unwrap();
    let read = |bytes: &[u8]| {
        fs::write(folder.path().join("a.usdz"), bytes).unwrap();
        let (scene, codes) = read_with(&folder.path().join("a.usdz"), &Options::default());
        assert_eq!(codes, Vec::<&str>::new());
        scene
    };
    let scene = read(&outer);
    let radii = scene
        .surfaces
        .iter()
        .filter_map(|surface| match &surface.shape {
            Shape::Sphere(sphere) => Some(sphere.radius),
            _ => None,
        });
    assert_eq!(radii.collect::<Vec<_>>(), [1.0, 3.0]);
    assert_eq!(scene.images[0].pixels[..3], [7; 3]);
    // The stage of a package may be that of one in it; and from outside each file has a name.
    assert_eq!(spheres(&read(&first)).len(), 1);
    let through = b"#usda 1.0\ndef \"c\" ( references = @a.usdz[in.usdz[other.usda]]@</o> ) {}";
    fs::write(folder.path().join("c.usda"), through).unwrap();
    let (scene, codes) = read_with(&folder.path().join("c.usda"), &Options::default());
    assert_eq!((scene.surfaces.len(), codes), (1, Vec::new()));
}

#[test]
fn a_file_outside_of_the_folder_is_told_apart_from_one_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b/c");
    fs::create_dir_all(&deep).unwrap();
    fs::write(
        folder.path().join("ball.usda"),
        "#usda 1.0\ndef Sphere \"s\" {}",
    )
    .unwrap();
    let text = "#usda 1.0\ndef \"x\" ( references = @../../../ball.usda@</s> ) {}";
    fs::write(deep.join("a.usda"), text).unwrap();
    assert_eq!(
        read_with(&deep.join("a.usda"), &Options::default()).1,
        ["RE002"]
    );
}

/// What a stage takes of the nodes and the memory of a budget, and whether it is read.
fn work(layers: &[(&str, String)]) -> ([u64; 2], bool) {
    let folder = tempfile::tempdir().unwrap();
    for (name, body) in layers {
        fs::write(folder.path().join(name), format!("#usda 1.0\n{body}")).unwrap();
    }
    let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
    let file = Loader
        .file(&folder.path().join(layers[0].0), &mut map)
        .unwrap();
    let is_read = load(file, &mut map, &Options::default(), &mut sink).is_some();
    let taken = [Resource::Nodes, Resource::Memory]
        .map(|resource| map.budget().limit(resource) - map.budget().remaining(resource));
    (taken, is_read)
}

fn numbered(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}

/// What many prims inherit is read for each of them: it takes as much of the budget as it takes
/// work, so that a small file ends at a limit.
#[test]
fn what_many_prims_inherit_is_charged_for_each() {
    let heirs = |count| {
        numbered(count, |n| {
            format!("def Sphere \"s{n}\" ( inherits = </C> ) {{}}\n")
        })
    };
    let families: [(&str, usize, fn(usize) -> String); 3] = [
        ("variants", 0, |count| {
            let chosen = numbered(count, |n| format!("string v{n} = \"a\"\n"));
            let sets = numbered(count, |n| {
                format!("variantSet \"v{n}\" = {{ \"a\" {{}} }}\n")
            });
            format!("class \"C\" ( variants = {{ {chosen} }} ) {{ {sets} }}\n")
        }),
        ("operations", 0, |count| {
            let order = "\"xformOp:translate\", ".repeat(count);
            format!(
                "class \"C\" {{ double3 xformOp:translate = (1, 1, 1)\n\
                 uniform token[] xformOpOrder = [{order}] }}\n"
            )
        }),
        ("bindings", 1, |count| {
            let targets = numbered(count, |n| format!("</M{n}>, "));
            format!("class \"C\" {{ rel material:binding = [{targets}] }}\n")
        }),
    ];
    for (name, resource, class) in families {
        let taken = [50, 100, 200].map(|count| {
            let layers = [("a.usda", class(count) + &heirs(count))];
            let (taken, is_read) = work(&layers);
            assert!(is_read, "{name}");
            taken[resource]
        });
        assert!(
            taken[2] - taken[1] > 3 * (taken[1] - taken[0]),
            "{name}: {taken:?}"
        );
        let (_, is_read) = work(&[("a.usda", class(3000) + &heirs(3000))]);
        assert!(!is_read, "{name}");
    }
}

#[test]
fn a_sublayer_that_is_named_again_takes_no_more() {
    let taken = |count: usize, names: usize| {
        let named = "@b.usda@, ".repeat(names);
        let root = format!("(\n subLayers = [{named}]\n)\n");
        let below = numbered(count, |n| format!("def Sphere \"s{n}\" {{}}\n"));
        work(&[("a.usda", root), ("b.usda", below)]).0[0]
    };
    let all = [250, 500, 1000].map(|count| taken(count, count / 2));
    assert!(all[2] - all[1] < 3 * (all[1] - all[0]), "{all:?}");
}

#[test]
fn what_a_package_holds_raises_no_limit_and_its_files_do_not_overlap() {
    let layer = [b"#usda 1.0\n".to_vec(), vec![b'#'; 1 << 20]].concat();
    let references =
        "def \"b\" ( references = @b.usda@ ) {}\ndef \"c\" ( references = @c.usda@ ) {}";
    let stage = format!("#usda 1.0\n(\n defaultPrim = \"b\"\n)\n{references}");
    let whole = package(&[
        ("a.usda", stage.into_bytes()),
        ("b.usda", layer.clone()),
        ("c.usda", layer),
    ]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.usdz");
    let read = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let (mut map, mut sink) = (SourceMap::default(), DiagnosticSink::default());
        let file = Loader.file(&path, &mut map).unwrap();
        let before = map.budget().limit(Resource::Memory);
        let lowered = load(file, &mut map, &Options::default(), &mut sink);
        assert_eq!(map.budget().limit(Resource::Memory), before);
        let codes: Vec<_> = sink.kept().iter().map(|found| found.code.id).collect();
        (lowered.is_some(), codes.contains(&"US002"))
    };
    assert_eq!(read(&whole), (true, false));
    // A file of the list that is also another one.
    let mut twice = whole;
    let end = twice.len() - 6;
    let list = u32::from_le_bytes(twice[end..end + 4].try_into().unwrap()) as usize;
    let second = list + 46 + "a.usda".len();
    twice[second + 42..second + 46].copy_from_slice(&[0; 4]);
    assert_eq!(read(&twice), (false, true));
}
