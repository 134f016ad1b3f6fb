//! Keys that other programs of the course read as something else, or that only rtc has: what they
//! mean in an older file, and that it stays readable.

use super::scene;
use crate::small::{WHOLE, film};
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::front::{FrontOptions, course};
use rtc::internals::ir::{Light, Mode, Scene, Shape};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Limits, Resource, SourceMap};

/// The scene of a text, and its findings: code, severity and message.
fn loaded(text: &str, strict: bool) -> (Option<Scene>, Vec<(&'static str, Severity, String)>) {
    let mut map = SourceMap::default();
    let file = map.add("scene", text.as_bytes().to_vec());
    let mut sink = DiagnosticSink::default();
    let mut options = Options::default();
    options.front.strict = strict;
    let lowered = pipeline::load(file, &mut map, &options, &mut sink);
    let valid = lowered
        .as_ref()
        .and_then(|lowered| pipeline::validate(lowered, &options, &mut sink));
    let found = sink.kept().iter();
    let found = found.map(|found| (found.code.id, found.severity, found.message.clone()));
    let found = found.collect();
    let is_valid = valid.is_some();
    (
        lowered.filter(|_| is_valid).map(|lowered| lowered.scene),
        found,
    )
}

/// The scene of a text that is accepted, and the codes of its warnings.
fn accepted(text: &str) -> (Scene, Vec<&'static str>) {
    let (scene, found) = loaded(text, false);
    let scene = scene.unwrap_or_else(|| panic!("{text}\n{found:?}"));
    let warnings = found
        .iter()
        .filter(|(_, severity, _)| *severity == Severity::Warning);
    (scene, warnings.map(|(code, ..)| *code).collect())
}

const BALL: &str = "{type: sphere, position: [0, 0, 0], radius: 90, material: \
    {color: [0.3, 0.6, 0.9], ka: 0.2, kd: 0.7, ks: 0.3, n: 20}}";

/// A scene of a ball before this camera.
fn seen_by(camera: &str) -> String {
    format!(
        "Camera: {camera}\nLights: [{{position: [-400, 600, 1500], color: [1, 1, 1]}}]\n\
         Objects: [{BALL}]\n"
    )
}

#[test]
fn a_long_up_of_position_lookat_and_resolution_is_an_angle_across() {
    let text = |keys: [&str; 3], up: &str, [width, height]: [u32; 2]| {
        let [eye, center, size] = keys;
        seen_by(&format!(
            "{{{eye}: [0, 0, 1000], {center}: [0, 0, 0], up: {up}, {size}: [{width}, {height}]}}"
        ))
    };
    let other = ["position", "lookat", "resolution"];
    for degrees in [22.6_f64, 60.0, 120.0] {
        for size in [[400, 400], [400, 100], [90, 300]] {
            let up = format!("[0, {degrees}, 0]");
            let (scene, warnings) = accepted(&text(other, &up, size));
            let focal = f64::from(size[0]) / 2.0 / (degrees.to_radians() / 2.0).tan();
            let expected = 1000.0 / focal;
            let [right, up] = [scene.camera.right[0], scene.camera.up[1]];
            assert!((right / expected - 1.0).abs() < 1e-12, "{right} {expected}");
            assert!((up / expected - 1.0).abs() < 1e-12, "{up} {expected}");
            assert_eq!(warnings.first(), Some(&"SC013"));
        }
    }
    // A pixel of 1 is one, and so is any length of the keys of the course.
    let (scene, warnings) = accepted(&text(other, "[0, 1, 0]", [400, 400]));
    assert_eq!((scene.camera.up, warnings), ([0.0, 1.0, 0.0], vec![]));
    let own = ["eye", "center", "viewSize"];
    let (scene, warnings) = accepted(&text(own, "[0, 22.6, 0]", [400, 400]));
    assert_eq!(scene.camera.up, [0.0, 22.6, 0.0]);
    assert_eq!(warnings, ["VA032"], "the ball covers 0.04 % of the picture");
}

#[test]
fn what_covers_less_than_a_hundredth_is_told() {
    for (up, is_told) in [(2.0, false), (3.9, false), (4.1, true), (40.0, true)] {
        let camera = format!(
            "{{eye: [0, 0, 1000], center: [0, 0, 0], up: [0, {up}, 0], viewSize: [400, 400]}}"
        );
        let (_, warnings) = accepted(&seen_by(&camera));
        // A circle of 180 / up pixels against 160 000.
        assert_eq!(warnings == ["VA032"], is_told, "{up}: {warnings:?}");
    }
}

#[test]
fn a_resolution_beside_an_eye_keeps_the_window() {
    let text = |size: &str| {
        format!(
            "Eye: [200, 200, 1000]\n{size}\nLights: [{{position: [0, 0, 900], color: [1, 1, 1]}}]\n\
             Objects: [{}]\n",
            BALL.replace("[0, 0, 0]", "[200, 200, 0]")
        )
    };
    let camera = |size: &str| accepted(&text(size)).0.camera;
    let coarse = camera("Resolution: 250");
    assert_eq!(
        (coarse.size, coarse.center),
        ([250, 250], [200.0, 200.0, 0.0])
    );
    assert_eq!(
        (coarse.right, coarse.up),
        ([1.6, 0.0, 0.0], [0.0, 1.6, 0.0])
    );
    assert_eq!(camera("Resolution: [800, 400]").center, [200.0, 100.0, 0.0]);
    assert_eq!(camera("ImageSize: 250").center, [125.0, 125.0, 0.0]);
    assert_eq!(camera("Resolution: 400"), camera(""));
}

/// A scene with this light.
fn lit_by(light: &str) -> String {
    format!("Eye: [0, 0, 1000]\nLights: [{light}]\nObjects: [{BALL}]\n")
}

#[test]
fn an_intensity_says_that_it_makes_paths_and_beside_a_color_is_a_factor() {
    let alone = lit_by("{position: [5, 9, 800], intensity: 5}");
    let (scene, warnings) = accepted(&alone);
    assert!(matches!(scene.settings.mode, Mode::Path(_)));
    assert_eq!(warnings, ["SC013"]);
    for asked in ["RenderMode: path\n", "PathParameters: {samples: 2}\n"] {
        assert_eq!(accepted(&format!("{asked}{alone}")).1, [""; 0]);
    }
    let (_, warnings) = accepted(&format!("RenderMode: phong\n{alone}"));
    assert_eq!(warnings, ["SC013"], "it fades");
    let spot = "{position: [5, 9, 800], direction: [0, 0, -1], outerAngle: 0.5, intensity: 5}";
    assert_eq!(
        accepted(&lit_by(spot)).1,
        [""; 0],
        "no light of Phong shading is so written"
    );
    let both = lit_by("{position: [5, 9, 800], color: [1, 0.5, 0.25], intensity: 0.5}");
    let (scene, warnings) = accepted(&both);
    assert_eq!(scene.settings.mode, Mode::Phong);
    let Light::Point(light) = &scene.lights[0] else {
        panic!()
    };
    assert_eq!((light.color, warnings), ([0.5, 0.25, 0.125], vec!["SC013"]));
}

/// The keys that no sheet of the course has, each with values that are none of rtc's.
const OTHER_VALUES: &[(&str, &[&str])] = &[
    (
        "Ambient",
        &["{factor: 5, random: 0.08}", "0.2", "[0.1, 0.1, 0.1]", "on"],
    ),
    ("AmbientLight", &["bright", "0.2", "{r: 1}"]),
    ("Background", &["sky.png", "[1, 1]", "blue"]),
    ("Exposure", &["high", "[1, 2]", "100"]),
    ("Reflections", &["2", "many"]),
    ("ToneMap", &["filmic", "{gamma: 2.2}"]),
    ("Environment", &["sky.hdr", "[0, 0, 1]"]),
    ("Medium", &["water", "1.3"]),
    ("SoftShadows", &["{samples: 3}", "9"]),
    ("LightSamples", &["many"]),
    ("PathParameters", &["64", "{samples: many}"]),
    ("AspectRatio", &["wide"]),
];

#[test]
fn keys_of_rtc_alone_do_not_make_an_older_file_unreadable() {
    let plain = lit_by("{position: [5, 9, 800], color: [1, 1, 1]}");
    let meant = scene(&plain).unwrap();
    let ignored = |text: &str| {
        let (scene, found) = loaded(text, false);
        let mut scene = scene.unwrap_or_else(|| panic!("{text}\n{found:?}"));
        scene.images.clear();
        assert_eq!(scene, meant, "{text}");
        let mut warnings = found
            .iter()
            .filter(|(_, severity, _)| *severity == Severity::Warning);
        assert!(warnings.next().is_some(), "{text}");
        assert!(
            loaded(text, true).0.is_none(),
            "an error with --strict: {text}"
        );
    };
    for (key, values) in OTHER_VALUES {
        for value in *values {
            ignored(&format!("{key}: {value}\n{plain}"));
        }
    }
    for key in [
        "type: glass",
        "bump: 0.5",
        "fresnel: 3",
        "reflect: yes please",
    ] {
        ignored(&plain.replace("ka: 0.2", &format!("ka: 0.2, {key}")));
    }
    for key in [
        "type: directional",
        "radius: big",
        "file: 3",
        "width: wide",
        "intensity: high",
    ] {
        ignored(&plain.replace("color: [1, 1, 1]", &format!("color: [1, 1, 1], {key}")));
    }
    for key in [
        "direction: [0, -1, 0]",
        "irradiance: 3",
        "file: lamp.ies",
        "outerAngle: 0.5",
    ] {
        let text = plain.replace("color: [1, 1, 1]", &format!("color: [1, 1, 1], {key}"));
        let (scene, found) = loaded(&text, false);
        assert_eq!(scene.as_ref(), Some(&meant), "{text} {found:?}");
        assert!(loaded(&text, true).0.is_none(), "{text}");
    }
    ignored(&plain.replace("radius: 90", "radius: 90, velocity: fast"));
}

#[test]
fn keys_of_the_sheets_stay_errors() {
    let plain = lit_by("{position: [5, 9, 800], color: [1, 1, 1]}");
    for (from, to) in [
        ("radius: 90", "radius: big"),
        ("ka: 0.2", "ka: much"),
        ("color: [1, 1, 1]", "color: 1"),
        ("Eye: [0, 0, 1000]", "Eye: [0, 0]"),
    ] {
        let (scene, found) = loaded(&plain.replacen(from, to, 1), false);
        assert!(scene.is_none(), "{to}: {found:?}");
    }
}

#[test]
fn a_csg_takes_its_operation_from_a_key() {
    let text = |kind: &str, keys: [&str; 2], more: &str| {
        let operand = |x: i32| format!("{{type: sphere, position: [{x}, 0, 0], radius: 60}}");
        format!(
            "Eye: [0, 0, 1000]\nLights: [{{position: [5, 9, 800], color: [1, 1, 1]}}]\nObjects:\n\
             - {{type: {kind}, {}: {}, {}: {}, {more} material: {{color: [1, 0, 0], ka: 1, kd: 0, \
             ks: 0, n: 1}}}}\n",
            keys[0],
            operand(0),
            keys[1],
            operand(50)
        )
    };
    for operation in ["union", "intersection", "difference"] {
        let own = scene(&text(operation, ["a", "b"], "")).unwrap();
        assert!(matches!(own.surfaces[0].shape, Shape::Csg(_)));
        for keys in [["first", "second"], ["left", "right"], ["A", "B"]] {
            for key in ["operation", "operator", "op"] {
                let more = format!("{key}: {operation},");
                let (read, warnings) = accepted(&text("csg", keys, &more));
                assert_eq!((read, warnings), (own.clone(), vec![]));
            }
        }
    }
    let (union, warnings) = accepted(&text("csg", ["first", "second"], ""));
    assert_eq!(union, scene(&text("union", ["a", "b"], "")).unwrap());
    assert_eq!(warnings, ["SC012"]);
    let more = "operation: difference,";
    let (union, warnings) = accepted(&text("union", ["a", "b"], more));
    assert_eq!(union, scene(&text("union", ["a", "b"], "")).unwrap());
    assert_eq!(warnings, ["SC011"]);
}

#[test]
fn supersampling_without_a_factor_is_one_ray() {
    let plain = lit_by("{position: [5, 9, 800], color: [1, 1, 1]}");
    let (read, warnings) = accepted(&format!("SuperSampling: {{jitter: true}}\n{plain}"));
    assert_eq!(read, scene(&plain).unwrap());
    assert!(warnings.contains(&"SC012"), "{warnings:?}");
    let (read, _) = accepted(&format!("SuperSampling: {{factor: 3}}\n{plain}"));
    assert_eq!(read.settings.supersampling, 3);
}

/// The pixel of an image of 400 × 400 in this column and row, in bytes.
fn pixel(scene: &Scene, [x, y]: [usize; 2]) -> [f64; 3] {
    let film = film(scene, &WHOLE, 1);
    film.image.pixels[400 * y + x].map(|value| (value.min(1.0) * 255.0).floor())
}

#[test]
fn texture_coordinates_are_shown_as_each_program_does() {
    let text = |mode: &str| {
        format!(
            "RenderMode: {mode}\nEye: [200, 200, 1000]\nObjects:\n- {{type: quad, \
             v0: [0, 0, 0], v1: [400, 0, 0], v2: [400, 400, 0], v3: [0, 400, 0], material: \
             {{color: [1, 1, 1], ka: 0.2, kd: 0.7, ks: 0, n: 1}}}}\n"
        )
    };
    // The centre of the pixel is u = 300.5 / 400 and v = 1 − 100.5 / 400.
    let shown = |mode: &str| pixel(&accepted(&text(mode)).0, [300, 100]);
    assert_eq!(shown("texture"), [191.0, 0.0, 190.0]);
    assert_eq!(shown("texCoords"), shown("texture"));
    assert_eq!(shown("texcoords"), [191.0, 64.0, 0.0]);
}

#[test]
fn a_texture_beside_the_material_is_that_of_the_material() {
    let text = |objects: &str| {
        format!(
            "Eye: [200, 200, 1000]\nLights: [{{position: [5, 9, 800], color: [1, 1, 1]}}]\n\
             Objects:\n{objects}"
        )
    };
    let ball =
        |keys: &str| format!("- {{type: sphere, position: [0, 0, 0], radius: 90, {keys}}}\n");
    let within = text(&ball(
        "material: {texture: checker, ka: 0.2, kd: 0.7, ks: 0.3, n: 20}",
    ));
    let beside = text(&ball(
        "texture: checker, material: {ka: 0.2, kd: 0.7, ks: 0.3, n: 20}",
    ));
    assert_eq!(accepted(&beside), (scene(&within).unwrap(), vec![]));
    // Objects that share a material keep their own textures.
    let shared = "{ka: 0.2, kd: 0.7, ks: 0.3, n: 20, color: [1, 0, 0]}";
    let (read, warnings) = accepted(&text(&format!(
        "{}{}{}",
        ball(&format!("texture: checker, material: &m {shared}")),
        ball("texture: stripes, material: *m"),
        ball("material: *m"),
    )));
    assert_eq!(warnings, [""; 0]);
    let maps = read.surfaces.iter().map(|surface| {
        let material = &read.materials[surface.material.0 as usize];
        material.phong().unwrap().color_map
    });
    let maps: Vec<_> = maps.collect();
    assert!(
        maps[0].is_some() && maps[1].is_some() && maps[0] != maps[1],
        "{maps:?}"
    );
    assert_eq!(maps[2], None);
    // Of a material with a texture of its own, the one beside it is ignored, and that is told.
    let two = text(&ball(
        "texture: stripes, material: {texture: checker, ka: 0.2, kd: 0.7, ks: 0.3, n: 20}",
    ));
    assert_eq!(accepted(&two), (scene(&within).unwrap(), vec!["SC001"]));
    // Of merged keys, too, each material has its own colour.
    let (read, warnings) = accepted(&text(&format!(
        "{}- {{<<: *b, material: {{color: [0, 1, 0], ka: 0.2, kd: 0.7, ks: 0.3, n: 20}}}}\n",
        ball(&format!("texture: checker, material: {shared}")).replace("- {", "- &b {"),
    )));
    let colors = read.materials.iter().map(|own| own.phong().unwrap().color);
    let colors: Vec<_> = colors.collect();
    assert_eq!(
        (&colors[..], warnings),
        (&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][..], vec![])
    );
}

#[test]
fn a_texture_beside_the_material_of_a_solid_is_that_of_its_operands() {
    let text = |a: &str, own: &str| {
        format!(
            "Eye: [200, 200, 1000]\nLights: [{{position: [5, 9, 800], color: [1, 1, 1]}}]\n\
             Objects:\n- {{type: csg, operation: difference, \
             a: {{type: sphere, position: [0, 0, 0], radius: 90{a}}}, \
             b: {{type: sphere, position: [0, 0, 90], radius: 50}}, {own}}}\n"
        )
    };
    let coefficients = "ka: 0.2, kd: 0.7, ks: 0.3, n: 20";
    let within = text(
        "",
        &format!("material: {{texture: checker, {coefficients}}}"),
    );
    let beside = text(
        "",
        &format!("texture: checker, material: {{{coefficients}}}"),
    );
    assert_eq!(accepted(&beside), (scene(&within).unwrap(), vec![]));
    // An operand's own texture or material is its own.
    let maps = |a: &str| {
        let (read, warnings) = accepted(&text(
            a,
            &format!("texture: checker, material: {{color: [1, 0, 0], {coefficients}}}"),
        ));
        assert_eq!(warnings, [""; 0], "{a}");
        let map = |surface: &rtc::internals::ir::Surface| {
            let material = &read.materials[surface.material.0 as usize];
            let map = material.phong().unwrap().color_map;
            map.map(|map| read.textures[map.0 as usize].clone())
        };
        read.surfaces.iter().map(map).collect::<Vec<_>>()
    };
    let [Some(stripes), Some(checker)] = &maps(", texture: stripes")[..] else {
        panic!("each operand has a texture");
    };
    assert_ne!(stripes, checker);
    let plain = format!(", material: {{color: [0, 1, 0], {coefficients}}}");
    assert_eq!(maps(&plain), [None, Some(checker.clone())]);
    // Of a material with a texture of its own, the one beside it is ignored, and that is told.
    let two = format!("texture: stripes, material: {{texture: checker, {coefficients}}}");
    assert_eq!(
        accepted(&text("", &two)),
        (scene(&within).unwrap(), vec!["SC001"])
    );
}

#[test]
fn json_names_a_pattern_in_quotes() {
    let yaml = "Eye: [200, 200, 1000]\nObjects: [{type: sphere, position: [0, 0, 0], radius: 90, \
        material: {texture: checker, ka: 0.2, kd: 0.7, ks: 0.3, n: 20}}]\n";
    let value: serde_json::Value = serde_yaml::from_str(yaml).unwrap();
    let materials = |text: &str| {
        let scene = scene(text).unwrap();
        (scene.materials, scene.textures)
    };
    assert_eq!(materials(&value.to_string()), materials(yaml));
}

/// The steps of merging are counted by the limit of nodes.
#[test]
fn maps_that_merge_one_list_count_each_of_its_items() {
    let codes = |count: usize, limit: u64| {
        let list = vec!["*a"; count].join(", ");
        let objects = "- <<: *l\n".repeat(count);
        let text = format!("a: &a {{x: 1}}\nl: &l [{list}]\nEye: [0, 0, 9]\nObjects:\n{objects}");
        let mut limits = Limits::default();
        limits.set(Resource::Nodes, limit);
        let mut map = SourceMap::with_limits(limits);
        let file = map.add("scene", text.into_bytes());
        let mut sink = DiagnosticSink::default();
        course::lower(file, &map, &FrontOptions::default(), &mut sink);
        let codes = sink.kept().iter().map(|found| found.code.id);
        codes.collect::<Vec<_>>()
    };
    for count in [100, 200, 400] {
        let square = u64::try_from(count * count).unwrap();
        assert!(codes(count, square / 2).contains(&"SY011"), "{count}");
        assert!(!codes(count, 4 * square).contains(&"SY011"), "{count}");
    }
}
