//! `rtc compile --emit mitsuba`, `--emit pbrt` and `--emit pov`: what is written, and that all else is told.

use super::*;

/// A scene as a file of another renderer, and what was said of it.
fn written(scene: &str, target: &str) -> (TempDir, String, String) {
    let folder = folder();
    fs::write(folder.path().join("scene.yaml"), scene).unwrap();
    let done = rtc(&folder, &["compile", "scene.yaml", "-o", target]);
    let reported = stderr(&done);
    assert_eq!(code(&done), 0, "{reported}");
    let text = fs::read_to_string(folder.path().join(target)).unwrap();
    (folder, text, reported)
}

#[test]
fn a_scene_of_the_course_becomes_one_of_pov_ray() {
    let folder = folder();
    let done = rtc(&folder, &["compile", "ball.json", "--emit", "pov"]);
    assert_eq!((code(&done), stderr(&done)), (0, String::new()));
    let expected = "\
// povray +W40 +H30 +FN File_Gamma=1.0 +A0.0 +AM1 +R2 -J
#version 3.7;
global_settings { assumed_gamma 1 ambient_light rgb 1 max_trace_level 2 adc_bailout 0 }
camera { perspective location <0, 0, 50> direction <0, 0, -50> right <40, 0, 0> up <0, 30, 0> }
light_source { <30, 40, 60>, rgb <1, 1, 1> }
#declare M0 = texture { pigment { rgb <1, 0, 0> } finish { ambient rgb <0.2, 0.2, 0.2> diffuse 0.7 phong 0.5 phong_size 16 reflection 0.5 } }
#declare M1 = texture { pigment { rgb <0.5, 0.5, 0.5> } finish { ambient rgb <0.2, 0.2, 0.2> diffuse 0.7 phong 0 phong_size 1 reflection 0 } }
sphere { <0, 0, 0>, 10 texture { M0 } }
plane { <0, 0, 1>, -20 texture { M1 } }
";
    assert_eq!(String::from_utf8(done.stdout).unwrap(), expected);
}

#[test]
fn refraction_soft_lights_and_textures_reach_pov_ray() {
    let scene = "\
Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 0.1, 0], right: [0.1, 0, 0], viewSize: [40, 30]}
LightSamples: 16
Lights:
- {position: [0, 9, 0], color: [1, 1, 1], radius: 0.5}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1,
   material: {color: [1, 1, 1], ka: 0.1, kd: 0.2, ks: 0.3, n: 9, kt: 0.5, eta: 1.5}}
- {type: quad, v0: [-2, -2, -2], v1: [2, -2, -2], v2: [2, 2, -2], v3: [-2, 2, -2],
   material: {ka: 0, kd: 1, ks: 0, n: 1, texture: UV}}
";
    let (folder, text, _) = written(scene, "scene.pov");
    for part in [
        "area_light <1, 0, 0>, <0, 1, 0>, 4, 4 circular orient",
        "pigment { rgb <1, 1, 1> transmit 0.5 }",
        "diffuse 0.4 phong 0.3",
        "interior { ior 1.5 }",
        "uv_mapping image_map { png \"scene.files/",
        "uv_vectors",
    ] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
    assert_eq!(beside(&folder, ".png").len(), 1);
}

/// Traced paths between shapes that Mitsuba has.
const PATHS: &str = "\
Camera: {eye: [0, 1, 5], center: [0.5, 1, 0], up: [0, 0.1, 0], right: [0.1, 0, 0], viewSize: [40, 30]}
RenderMode: path
MaxRecursionDepth: 3
PathParameters: {samples: 16}
Environment: {color: [0.5, 0.6, 0.7]}
Lights:
- {type: sun, direction: [0, 2, 0], irradiance: [3, 2, 1]}
- {type: point, position: [1, 2, 3], intensity: [4, 5, 6]}
Objects:
- {type: sphere, position: [0, 1, 0], radius: 1, material: &a {color: [0.5, 0.6, 0.8], ka: 0, kd: 0.5, ks: 0, n: 1}}
- {type: sphere, position: [2, 1, 0], radius: 1, material: {color: [1, 1, 1], ka: 0, kd: 0, ks: 1, n: 1}}
- {type: triangle, v0: [0, 0, 0], v1: [1, 0, 0], v2: [0, 0, 1], material: *a}
- {type: quad, v0: [0, 0, 0], v1: [0, 0, 1], v2: [0, 1, 1], v3: [0, 1, 0], material: *a}
";

#[test]
fn traced_paths_become_a_scene_of_mitsuba() {
    let (folder, text, reported) = written(PATHS, "scene.xml");
    assert_eq!(reported, "");
    let squeezed = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        r#"<default name="spp" value="16"/>"#,
        // Three bounces are four edges after the first.
        r#"<integer name="max_depth" value="4"/>"#,
        // The middle of the picture is half a unit to the right, and half the picture is 2 units.
        r#"<float name="principal_point_offset_x" value="0.125"/>"#,
        r#"<matrix value="-1 0 0 0 "#,
        r#"<emitter type="constant"> <rgb name="radiance" value="0.5 0.6 0.7"/>"#,
        r#"<rgb name="irradiance" value="3 2 1"/>"#,
        r#"<emitter type="point"> <point name="position" value="1, 2, 3"/> <rgb name="intensity" value="4 5 6"/>"#,
        r#"<bsdf type="diffuse"> <rgb name="reflectance" value="0.25 0.3 0.4"/> </bsdf>"#,
        r#"<bsdf type="conductor"> <string name="material" value="none"/>"#,
        // Mitsuba refuses a radius of its box, which is always half a pixel.
        r#"<rfilter type="box"> </rfilter>"#,
    ] {
        assert!(squeezed.contains(part), "{part} is missing: {text}");
    }
    // What has corners is one mesh for each material.
    let files: Vec<_> = fs::read_dir(folder.path().join("scene.files"))
        .unwrap()
        .collect();
    let [Ok(file)] = &files[..] else {
        panic!("{files:?}");
    };
    let name = file.file_name().into_string().unwrap();
    assert!(text.contains(&format!("scene.files/{name}")), "{text}");
    let mesh = rtc(&folder, &["info", &format!("scene.files/{name}"), "--json"]);
    let reported = String::from_utf8(mesh.stdout).unwrap();
    assert!(
        reported.contains(r#""triangles": 3"#) || reported.contains(r#""triangles":3"#),
        "{reported}"
    );
}

#[test]
fn traced_paths_become_a_scene_of_pbrt() {
    let (_, text, reported) = written(PATHS, "scene.pbrt");
    assert_eq!(reported, "");
    for part in [
        r#"Integrator "path" "integer maxdepth" [ 3 ]"#,
        r#"Sampler "independent" "integer pixelsamples" [ 16 ]"#,
        r#"Film "rgb" "integer xresolution" [ 40 ] "integer yresolution" [ 30 ]"#,
        // Half of the height is 1.5 units, and the middle is half a unit to the right.
        r#""float screenwindow" [ -1 1.66666666666666"#,
        r#"LightSource "infinite" "rgb L" [ 0.5 0.6 0.7 ]"#,
        r#"LightSource "distant" "point3 from" [ 0 1 0 ] "point3 to" [ 0 0 0 ] "rgb L" [ 3 2 1 ]"#,
        r#"LightSource "point" "point3 from" [ 1 2 3 ] "rgb I" [ 4 5 6 ]"#,
        r#""string type" "diffuse" "rgb reflectance" [ 0.25 0.3 0.4 ]"#,
        r#""string type" "conductor" "rgb reflectance" [ 1 1 1 ]"#,
        r#"Shape "bilinearmesh" "point3 P" [ 0 0 0 0 0 1 0 1 0 0 1 1 ]"#,
        r#"Shape "plymesh" "string filename" "scene.files/"#,
    ] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
}

#[test]
fn what_has_no_twin_is_told_part_by_part() {
    let more = "\
- {type: torus, position: [0, 3, 0], radius: 1, alpha: 0.2, material: &b {color: [1, 1, 1], ka: 0, kd: 1, ks: 0, n: 1}}
- {type: quad, curved: true, v0: [0, 0, 0], v1: [1, 0, 0], v2: [1, 1, 1], v3: [0, 1, 0], material: *b}
- {type: plane, position: [0, 0, 0], normal: [0, 1, 0], material: *b}
- {type: sphere, position: [0, 5, 0], radius: 1, material: {type: standard, metallic: 0.5, clearcoat: 1}}
- {type: triangle, v0: [0, 7, 0], v1: [1, 7, 0], v2: [0, 7, 1], material: {type: standard, emissive: [1, 1, 1], specular: 0, metallic: 0, doubleSided: true}}
";
    let spot = "Objects:";
    let lit = "- {type: spot, position: [0, 9, 0], direction: [0, -1, 0], innerAngle: 0.2, outerAngle: 0.4, intensity: [1, 1, 1]}\nObjects:";
    let scene = format!("{}{more}", PATHS.replace(spot, lit));
    let (_, text, reported) = written(&scene, "scene.xml");
    let words = [
        "Mitsuba has no torus: a mesh",
        "Mitsuba has no bilinear patch: a mesh",
        "Mitsuba has no plane: a square",
        "a material is written without one-sidedness for the camera",
        "`principled` approximates the metallic-roughness material",
        "a material shines both ways",
    ];
    for words in words {
        assert!(reported.contains(words), "{words} is missing: {reported}");
    }
    assert_eq!(
        reported.matches("warning[EX001]").count(),
        words.len(),
        "{reported}"
    );
    assert!(
        !text.contains("torus") && text.contains("principled") && text.contains("clearcoat"),
        "{text}"
    );
    // A spot is exact: full up to its rim, under a picture of its profile.
    assert!(text.contains(r#"<emitter type="spot">"#), "{text}");

    // POV-Ray has the torus and the plane, but no traced paths.
    let (_, text, reported) = written(&scene, "scene.pov");
    for words in [
        "paths are not traced",
        "POV-Ray's spots fade in another way at their rim",
        "POV-Ray has no bilinear patch: it is left out",
        "a material is written with a matt colour and sharp mirror images",
    ] {
        assert!(reported.contains(words), "{words} is missing: {reported}");
    }
    for part in [
        "torus { 1, 0.2 matrix <",
        "plane { <0, 1, 0>, 0",
        "sky_sphere { pigment { rgb <0.5, 0.6, 0.7> } }",
        "spotlight",
        "parallel",
        "radiosity",
    ] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
}

/// The files beside `scene.xml`, by extension.
fn beside(folder: &TempDir, extension: &str) -> Vec<String> {
    let files = fs::read_dir(folder.path().join("scene.files")).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(extension)).collect()
}

#[test]
fn motion_and_two_eyes_are_told_where_they_are_left_out() {
    let scene = "\
Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [40, 30], shutter: [0, 0.5],
  stereo: 0.3, stereoView: anaglyph}
PathParameters: {samples: 16}
Environment: {color: 1}
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, velocity: [1, 0, 0], material: {type: standard}}
";
    for target in ["scene.xml", "scene.pbrt", "scene.pov"] {
        let (_, _, reported) = written(scene, target);
        for words in ["written with one eye", "motion is left out"] {
            assert!(reported.contains(words), "{target}: {reported}");
        }
        assert!(reported.contains("warning[EX001]"), "{target}: {reported}");
    }
    // A text and a glTF hold both; of the latter no other program reads them.
    let (_, text, reported) = written(scene, "copy.yaml");
    assert_eq!(reported, "");
    for words in [
        "stereoView: anaglyph",
        "velocity: [1, 0, 0]",
        "shutter: [0, 0.5]",
    ] {
        assert!(text.contains(words), "{words} is missing: {text}");
    }
    let folder = folder();
    fs::write(folder.path().join("scene.yaml"), scene).unwrap();
    let done = rtc(
        &folder,
        &["compile", "scene.yaml", "-v", "-o", "scene.gltf"],
    );
    let reported = stderr(&done);
    for words in [
        "the velocity of a surface is written to",
        "how the picture is made is written to",
    ] {
        assert!(reported.contains(words), "{words} is missing: {reported}");
    }
}

#[test]
fn the_light_of_the_studio_and_textures_go_beside_the_scene_of_mitsuba() {
    let scene = "\
Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 0.1, 0], right: [0.1, 0, 0], viewSize: [40, 30]}
RenderMode: path
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1,
   material: {type: standard, name: Globe, metallic: 0, specular: 0, baseColor: [0.5, 1, 1, 1],
   baseColorMap: {pattern: noise, scale: 6, colors: [[0.1, 0.1, 0.1], [1, 1, 1]]}, alpha: mask}}
";
    let folder = folder();
    fs::write(folder.path().join("scene.yaml"), scene).unwrap();
    let compile = ["compile", "scene.yaml", "-o", "scene.xml", "--studio", "on"];
    let done = rtc(&folder, &compile);
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    let text = fs::read_to_string(folder.path().join("scene.xml")).unwrap();
    for part in [
        r#"<emitter type="envmap">"#,
        r#"<texture type="bitmap" name="reflectance">"#,
        r#"<bsdf type="mask""#,
    ] {
        assert!(text.contains(part), "{part} is missing: {text}");
    }
    assert_eq!(beside(&folder, ".exr").len(), 1);
    assert!(
        stderr(&done).contains("the material `Globe`"),
        "{}",
        stderr(&done)
    );
}

#[test]
fn the_direct_light_of_phong_s_model_reaches_mitsuba() {
    let folder = folder();
    let done = rtc(&folder, &["compile", "ball.json", "-o", "ball.xml"]);
    assert_eq!(code(&done), 0, "{}", stderr(&done));
    let text = fs::read_to_string(folder.path().join("ball.xml")).unwrap();
    // One reflection, and the light at its hit.
    let depth = r#"<integer name="max_depth" value="3"/>"#;
    assert!(text.contains(depth), "{text}");
}

#[test]
fn a_file_in_which_nothing_shines_is_an_error() {
    let scene = "\
Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 0.1, 0], right: [0.1, 0, 0], viewSize: [40, 30]}
RenderMode: path
Objects:
- {type: sphere, position: [0, 0, 0], radius: 1, material: {type: standard, metallic: 0}}
";
    let folder = folder();
    fs::write(folder.path().join("scene.yaml"), scene).unwrap();
    for target in ["scene.xml", "scene.pbrt", "scene.pov"] {
        let done = rtc(
            &folder,
            &[
                "compile",
                "scene.yaml",
                "--env-color",
                "0,0,0",
                "-o",
                target,
            ],
        );
        assert_eq!(code(&done), 1, "{target}: {}", stderr(&done));
        assert!(stderr(&done).contains("error[EX001]"), "{}", stderr(&done));
        assert!(!folder.path().join(target).exists());
    }
}

#[test]
fn meshes_of_mitsuba_are_files_so_it_needs_a_place() {
    let folder = folder();
    for format in ["mitsuba", "pbrt"] {
        let nowhere = rtc(&folder, &["compile", "ball.json", "--emit", format]);
        assert_eq!((code(&nowhere), nowhere.stdout.len()), (1, 0));
        assert!(stderr(&nowhere).contains("give `-o FILE`"));
    }
    let refused = rtc(
        &folder,
        &["compile", "ball.json", "-o", "x.pov", "--tolerance", "1"],
    );
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
}

#[test]
fn a_scene_of_another_renderer_becomes_a_text_of_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    for source in ["render/pbrt/room.pbrt", "mitsuba/room.xml"] {
        let source = cases.join(source).display().to_string();
        let compiled = rtc(&folder, &["compile", &source, "-o", "room.yaml"]);
        assert_eq!(code(&compiled), 0, "{}", stderr(&compiled));
        let few = ["--size", "16", "--spp", "4", "--no-metadata", "-q", "-o"];
        let picture = |scene: &str| {
            let rendered = rtc(
                &folder,
                &[&["render", scene], &few[..], &["x.png"]].concat(),
            );
            assert_eq!(code(&rendered), 0, "{}", stderr(&rendered));
            fs::read(folder.path().join("x.png")).unwrap()
        };
        assert!(picture(&source) == picture("room.yaml"), "{source}");
    }
}

#[test]
fn a_model_that_glows_is_written_in_the_light_of_the_studio() {
    let folder = folder();
    let asset = include_bytes!("models/emissive-switches-studio-off.glb");
    fs::write(folder.path().join("x.glb"), asset).unwrap();
    for (target, map) in [
        ("x.xml", r#"<emitter type="envmap">"#),
        ("x.pbrt", r#"LightSource "infinite" "string filename""#),
        ("x.pov", "sky_sphere"),
    ] {
        let done = rtc(&folder, &["compile", "x.glb", "-o", target]);
        assert_eq!(code(&done), 0, "{}", stderr(&done));
        let text = fs::read_to_string(folder.path().join(target)).unwrap();
        assert!(text.contains(map), "{target}: {text}");
        let alone = ["compile", "x.glb", "--studio", "off", "-o", target];
        assert_eq!(code(&rtc(&folder, &alone)), 0);
        let text = fs::read_to_string(folder.path().join(target)).unwrap();
        assert!(!text.contains(map), "{target}: {text}");
    }
}

#[test]
fn an_image_of_the_course_that_moves_by_half_a_texel_is_told() {
    let scene = "\
Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 0.1, 0], right: [0.1, 0, 0], viewSize: [8, 8]}
Lights: [{position: [0, 9, 9], color: [1, 1, 1]}]
Objects:
- {type: quad, v0: [-2, -2, 0], v1: [2, -2, 0], v2: [2, 2, 0], v3: [-2, 2, 0],
   material: {ka: 0, kd: 1, ks: 0, n: 1, texture: p.png}}
";
    let folder = folder();
    fs::write(
        folder.path().join("p.png"),
        crate::assets::png([200, 100, 50]),
    )
    .unwrap();
    for (mode, is_told) in [("phong", true), ("path", false)] {
        fs::write(
            folder.path().join("scene.yaml"),
            format!("RenderMode: {mode}\n{scene}"),
        )
        .unwrap();
        for target in ["scene.xml", "scene.pbrt"] {
            let done = rtc(&folder, &["compile", "scene.yaml", "-o", target]);
            let reported = stderr(&done);
            assert_eq!(
                reported.contains("half texel"),
                is_told,
                "{target}: {reported}"
            );
        }
    }
}
