//! `rtc diff` from outside.

use super::*;

/// Two pictures of the ball: as the scene says, and without supersampling; of a kind.
fn pictures(kind: &str, more: &[&str]) -> TempDir {
    let folder = folder();
    for (name, samples) in [("two", "2"), ("one", "1")] {
        let picture = format!("{name}.{kind}");
        let args = [
            "render",
            "ball.json",
            "-q",
            "--supersampling",
            samples,
            "-o",
            &picture,
        ];
        let output = rtc(&folder, &[&args, more].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    folder
}

fn diff(folder: &TempDir, args: &[&str]) -> (i32, String, String) {
    let output = rtc(folder, &[&["diff"], args].concat());
    let reported = String::from_utf8(output.stdout.clone()).unwrap();
    (code(&output), reported, stderr(&output))
}

#[test]
fn the_same_picture_has_no_difference() {
    for (kind, more) in [("png", &[][..]), ("png", &["--bits", "16"]), ("exr", &[])] {
        let folder = pictures(kind, more);
        let name = format!("two.{kind}");
        let (code, reported, _) = diff(&folder, &[&name, &name, "--gate", "rmse<=0"]);
        assert_eq!(
            (code, reported),
            (0, format!("{name} and {name}: 40×30, no difference\n"))
        );
    }
}

#[test]
fn edges_without_supersampling_are_off() {
    for (kind, more) in [("png", &[][..]), ("png", &["--bits", "16"]), ("exr", &[])] {
        let folder = pictures(kind, more);
        let names = [format!("one.{kind}"), format!("two.{kind}")];
        let args = [names[0].as_str(), &names[1], "--json", "-o", "map.png"];
        let (code, reported, _) = diff(&folder, &args);
        assert_eq!(code, 0);
        let report: serde_json::Value = serde_json::from_str(&reported).unwrap();
        assert_eq!(report["size"], serde_json::json!([40, 30]));
        let found = |name: &str| report["difference"][name].as_f64().unwrap();
        assert!(found("rmse") > 1.0 && found("rmse") < found("max") && found("max") > 10.0);
        assert!(
            found("share") > 0.01 && found("share") < 0.3,
            "only edges: {reported}"
        );
        assert!(found("flip") > 0.0 && found("relMse") > 0.0);
        let map = image::open(folder.path().join("map.png"))
            .unwrap()
            .to_rgb8();
        let lit = map.pixels().filter(|pixel| pixel.0[0] > 15).count();
        assert!(
            map.dimensions() == (40, 30) && lit > 10 && lit < 400,
            "{lit}"
        );
        let [column, row] = [0, 1].map(|k| report["difference"]["maxAt"][k].as_u64().unwrap());
        assert!(column < 40 && row < 30);
    }
}

#[test]
fn sixteen_bits_are_not_rounded_to_eight() {
    let folder = pictures("png", &["--bits", "16"]);
    let path = folder.path().join("two.png");
    let mut picture = image::open(&path).unwrap().to_rgb16();
    picture.get_pixel_mut(3, 4).0[1] ^= 1;
    picture.save(folder.path().join("bit.png")).unwrap();
    let (_, reported, _) = diff(&folder, &["bit.png", "two.png"]);
    assert!(
        reported.contains("max     0.00 grey levels, first in column 3, row 4"),
        "{reported}"
    );
}

#[test]
fn a_gate_that_is_not_met_ends_with_1() {
    let folder = pictures("png", &[]);
    let gate = |gate| diff(&folder, &["one.png", "two.png", "-q", "--gate", gate]);
    assert_eq!(
        gate("rmse<=100, share<=90%"),
        (0, String::new(), String::new())
    );
    let (code, reported, said) = gate("rmse<=0.5,flip<=1");
    assert_eq!((code, reported.as_str(), said.lines().count()), (1, "", 1));
    assert!(said.starts_with("gate failed: rmse is ") && said.ends_with("limit 0.5\n"));
    let (code, _, said) = gate("speed<=1");
    assert!(
        code == 2 && said.contains("measures are rmse, max, relmse, flip, share"),
        "{said}"
    );
}

#[test]
fn what_can_not_be_compared_is_told_and_no_map_appears() {
    let folder = pictures("png", &[]);
    let small = [
        "render",
        "ball.json",
        "-q",
        "--size",
        "20x15",
        "-o",
        "small.png",
    ];
    assert_eq!(code(&rtc(&folder, &small)), 0);
    assert_eq!(
        code(&rtc(
            &folder,
            &["render", "ball.json", "-q", "-o", "light.exr"]
        )),
        0
    );
    let whole = fs::read(folder.path().join("two.png")).unwrap();
    fs::write(folder.path().join("cut.png"), &whole[..whole.len() / 2]).unwrap();
    fs::copy(
        folder.path().join("ball.json"),
        folder.path().join("ball.png"),
    )
    .unwrap();
    for (other, words) in [
        (
            "small.png",
            "`two.png` has 40 × 30 pixels, `small.png` 20 × 15",
        ),
        (
            "light.exr",
            "`light.exr` holds values of light, and `two.png` those of a display",
        ),
        ("cut.png", "`cut.png` is damaged"),
        (
            "ball.json",
            "`two.png` is a picture, and `ball.json` a scene",
        ),
        ("ball.png", "`ball.png` is not a picture"),
        ("none.png", "`none.png`"),
    ] {
        let (code, reported, said) = diff(&folder, &["two.png", other, "-o", "map.png"]);
        assert!(
            code == 2 && reported.is_empty() && said.contains(words),
            "{other}: {said}"
        );
        assert!(!folder.path().join("map.png").exists());
    }
    let (code, _, said) = diff(&folder, &["one.png", "two.png", "-o", "two.png"]);
    assert!(
        code == 2 && said.contains("it is an input of this run"),
        "{said}"
    );
}

#[test]
fn scenes_are_compared_by_their_values_and_by_one_camera() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let old = fs::read_to_string(path("ball.json")).unwrap();
    let mut scene: serde_json::Value = serde_json::from_str(&old).unwrap();
    scene["materials"][0]["phong"]["kd"] = serde_json::json!(0.015_625);
    fs::write(path("new.json"), scene.to_string()).unwrap();
    let args = [
        "new.json",
        "ball.json",
        "--json",
        "--html",
        "page.html",
        "-o",
        "map.png",
    ];
    let (code, reported, _) = diff(&folder, &args);
    assert_eq!(code, 0, "{reported}");
    let report: serde_json::Value = serde_json::from_str(&reported).unwrap();
    let changes = report["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 1, "{reported}");
    assert!(changes[0]["path"].as_str().unwrap().ends_with("phong.kd"));
    assert_eq!(changes[0]["new"], serde_json::json!(0.015_625));
    assert!(report["difference"]["rmse"].as_f64().unwrap() > 0.0);
    let page = fs::read_to_string(path("page.html")).unwrap();
    assert!(page.contains("phong.kd") && page.contains("type=\"range\""));
    assert_eq!(page.matches("data:image/png").count(), 3);
    assert!(path("map.png").exists());

    // One camera: a scene that differs in its camera alone has the same picture.
    scene = serde_json::from_str(&old).unwrap();
    scene["camera"]["eye"] = serde_json::json!([5, 0, 50]);
    fs::write(path("moved.json"), scene.to_string()).unwrap();
    let (code, reported, _) = diff(&folder, &["moved.json", "ball.json", "--gate", "max<=0"]);
    assert_eq!(code, 0, "{reported}");
    assert!(reported.contains("camera.eye: "), "{reported}");

    assert_eq!(diff(&folder, &["new.json", "map.png"]).0, 2);
    assert_eq!(
        diff(&folder, &["new.json", "ball.json", "-o", "ball.json"]).0,
        2
    );
    assert_eq!(fs::read_to_string(path("ball.json")).unwrap(), old);
}

/// A PNG of a bit a pixel, all of them alike.
fn flat(width: u32, height: u32, level: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let mut writer = encoder.write_header().unwrap();
    let rows = vec![level; (width.div_ceil(8) * height) as usize];
    writer.write_image_data(&rows).unwrap();
    drop(writer);
    bytes
}

/// What decoding takes is charged before, and files that are the same are not decoded.
#[test]
fn small_files_of_many_pixels_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, level) in [("black.png", 0), ("white.png", 0xff)] {
        fs::write(folder.path().join(name), flat(16_000, 16_000, level)).unwrap();
    }
    let (code, _, said) = diff(
        &folder,
        &["black.png", "white.png", "--limit", "memory=100MiB"],
    );
    assert!(
        code == 2 && said.contains("of memory, and the limit is"),
        "{said}"
    );
    let (code, reported, _) = diff(&folder, &["black.png", "black.png"]);
    assert_eq!(
        (code, reported.as_str()),
        (0, "black.png and black.png: 16000×16000, no difference\n")
    );
    let (code, _, said) = diff(&folder, &["black.png", "black.png", "--limit", "pixels=9"]);
    assert!(code == 2 && said.contains("pixels"), "{said}");
}

/// Two folders with pictures of the same names, one of them below a folder, and one alone.
fn classes() -> TempDir {
    let folder = pictures("png", &[]);
    for (class, names) in [
        ("handed-in", ["two.png", "one.png", "two.png"]),
        ("solutions", ["two.png", "two.png", "one.png"]),
    ] {
        fs::create_dir_all(folder.path().join(class).join("a")).unwrap();
        let places = ["same.png", "a/other.png", &format!("{class}.png")];
        for (name, place) in names.iter().zip(places) {
            let to = folder.path().join(class).join(place);
            fs::copy(folder.path().join(name), to).unwrap();
        }
    }
    folder
}

#[test]
fn the_pictures_of_two_folders_are_compared_in_one_table() {
    let folder = classes();
    let (exit, reported, _) = diff(&folder, &["handed-in", "solutions"]);
    assert_eq!(exit, 2, "some have no counterpart");
    let lines: Vec<_> = reported.lines().collect();
    assert!(
        lines[0].starts_with("file") && lines[0].ends_with("share"),
        "{reported}"
    );
    assert!(
        lines[1].starts_with("a/other.png") && lines[1].contains("differs"),
        "{reported}"
    );
    assert!(lines[2].starts_with("handed-in.png") && lines[2].ends_with("only in handed-in"));
    assert!(
        lines[3].starts_with("same.png") && lines[3].contains("same "),
        "{reported}"
    );
    assert!(lines[4].ends_with("only in solutions"), "{reported}");
    assert!(
        lines[5].starts_with("4 pictures") && lines.len() == 6,
        "{reported}"
    );
    assert!(
        lines[5].contains("1 same, 1 differ, 2 not compared"),
        "{reported}"
    );

    let (_, csv, _) = diff(&folder, &["handed-in", "solutions", "--table", "csv"]);
    assert!(
        csv.starts_with("file,result,rmse,max,flip,share\na/other.png,differs,"),
        "{csv}"
    );
    assert!(csv.contains("\nsame.png,same,0,0,0,0\n"), "{csv}");
    for format in [["--table", "json"], ["--format", "json"]] {
        let (_, json, _) = diff(
            &folder,
            &[&["handed-in", "solutions"], &format[..]].concat(),
        );
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(value["schema"], "rtc-diff-table/1");
        assert_eq!(value["files"][1]["rmse"], serde_json::Value::Null);
        let single = diff(&folder, &["one.png", "two.png", "--format", "json"]).1;
        let single: serde_json::Value = serde_json::from_str(&single).unwrap();
        assert_eq!(value["files"][0]["rmse"], single["difference"]["rmse"]);
        assert_eq!(value["total"]["rmse"], single["difference"]["rmse"]);
        assert_eq!(value["total"]["files"], 4);
    }
}

#[test]
fn a_gate_holds_for_each_picture_of_a_folder() {
    let folder = classes();
    for class in ["handed-in", "solutions"] {
        fs::remove_file(folder.path().join(class).join(format!("{class}.png"))).unwrap();
    }
    let folders = ["handed-in", "solutions", "--gate"];
    let (exit, _, _) = diff(&folder, &[&folders[..], &["max<=255"]].concat());
    assert_eq!(exit, 0);
    let (exit, reported, said) = diff(&folder, &[&folders[..], &["max<=0"]].concat());
    assert!(exit == 1 && said.contains("gate failed"), "{said}");
    assert!(reported.contains("gate failed"), "{reported}");
    fs::write(folder.path().join("solutions/same.png"), "no picture").unwrap();
    let (exit, reported, _) = diff(&folder, &[&folders[..], &["max<=255"]].concat());
    assert_eq!(exit, 1, "what can't be read passes no gate: {reported}");
    let (exit, _, said) = diff(&folder, &["handed-in", "."]);
    assert_eq!(exit, 2, "{said}");
    let (exit, _, said) = diff(&folder, &["one.png", "two.png", "--table", "csv"]);
    assert!(exit == 2 && said.contains("of two folders"), "{said}");
}

/// Two scenes without light of their own, which differ in one colour, of each front end: the name,
/// and the text where `COLOR` stands for red, green and blue.
const UNLIT: [(&str, &str, [&str; 2]); 4] = [
    ("ball.yaml", UNLIT_YAML, ["1, 1, 1", "1, 0, 0"]),
    ("square.usda", UNLIT_USD, ["1, 1, 1", "1, 0, 0"]),
    ("square.obj", UNLIT_OBJ, ["1 1 1", "1 0 0"]),
    ("triangle.gltf", UNLIT_GLTF, ["1, 1, 1", "1, 0, 0"]),
];
const UNLIT_YAML: &str = "Camera: {eye: [0, 0, 5], center: [0, 0, 0], up: [0, 1, 0], fov: 40, \
    viewSize: [32, 32]}\nObjects:\n- {type: sphere, position: [0, 0, 0], radius: 1, material: \
    {type: standard, baseColor: [COLOR, 1], metallic: 0}}\n";
const UNLIT_USD: &str = "#usda 1.0\n(upAxis = \"Y\")\ndef Mesh \"m\" {\n\
    int[] faceVertexCounts = [4]\n    int[] faceVertexIndices = [0, 1, 2, 3]\n\
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\n\
    color3f[] primvars:displayColor = [(COLOR)]\n}\n";
/// Colours of vertices.
const UNLIT_OBJ: &str = "v 0 0 0 COLOR\nv 1 0 0 COLOR\nv 1 1 0 COLOR\nf 1 2 3\n";
const UNLIT_GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [COLOR, 1], "metallicFactor": 0}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// Scenes that `render` places in the studio are compared there: a white one and a red one.
#[test]
fn scenes_without_lights_are_lit_and_framed_as_rendered() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text, colors) in UNLIT {
        let [old, new] = ["old-", "new-"].map(|prefix| format!("{prefix}{name}"));
        for (file, color) in [(&old, colors[0]), (&new, colors[1])] {
            fs::write(folder.path().join(file), text.replace("COLOR", color)).unwrap();
        }
        let small = ["--size", "32x32", "--spp", "16", "--json"];
        let gate = ["--gate", "rmse<=2"];
        let args = [&[new.as_str(), &old][..], &small, &gate].concat();
        let (code, reported, said) = diff(&folder, &args);
        assert_eq!(code, 1, "{name}: {reported}{said}");
        let report: serde_json::Value = serde_json::from_str(&reported).unwrap();
        // Green and blue are gone where the subject is.
        assert!(
            report["difference"]["max"].as_f64().unwrap() > 50.0,
            "{reported}"
        );
        assert!(!said.contains("RD016"), "{name}: {said}");
        // What is told is what the files say, not the studio.
        let changes = report["changes"].as_array().unwrap();
        let is_of_view = |change: &serde_json::Value| {
            let path = change["path"].as_str().unwrap();
            ["camera", "environment", "images", "surfaces"]
                .iter()
                .any(|own| path.starts_with(own))
        };
        assert!(
            !changes.is_empty() && !changes.iter().any(is_of_view),
            "{name}: {reported}"
        );
        // The pictures are those of `rtc render`.
        for file in [&old, &new] {
            let picture = format!("{file}.png");
            let shown = [&["render", file, "-q", "-o", &picture][..], &small[..4]].concat();
            assert_eq!(code_of(&folder, &shown), 0);
        }
        let pictures = [format!("{new}.png"), format!("{old}.png")];
        let (_, rendered, _) = diff(&folder, &[&pictures[0], &pictures[1], "--json"]);
        let rendered: serde_json::Value = serde_json::from_str(&rendered).unwrap();
        let rmse = |report: &serde_json::Value| report["difference"]["rmse"].as_f64().unwrap();
        assert!(
            (rmse(&rendered) - rmse(&report)).abs() < 0.5,
            "{name}: {rendered} {report}"
        );
    }
}

fn code_of(folder: &TempDir, args: &[&str]) -> i32 {
    code(&rtc(folder, args))
}

/// The view holds both subjects, whichever scene is the new one.
#[test]
fn the_view_of_two_assets_holds_both() {
    let folder = tempfile::tempdir().unwrap();
    let near = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(folder.path().join("near.obj"), near).unwrap();
    fs::write(folder.path().join("far.obj"), near.replace("v ", "v 1")).unwrap();
    let compare = |files: [&str; 2]| {
        let map = format!("{}.png", files[0]);
        let args = [
            &files[..],
            &["--size", "32x32", "--spp", "16", "-o", &map, "--json"],
        ]
        .concat();
        let (code, reported, said) = diff(&folder, &args);
        assert_eq!(code, 0, "{said}");
        let report: serde_json::Value = serde_json::from_str(&reported).unwrap();
        report["difference"]["rmse"].as_f64().unwrap()
    };
    let there = compare(["near.obj", "far.obj"]);
    let back = compare(["far.obj", "near.obj"]);
    assert!(
        there > 2.0 && (there - back).abs() < 0.02 * there,
        "{there} {back}"
    );
}

#[test]
fn two_pictures_of_one_value_each_are_a_warning() {
    let folder = folder();
    for (name, level) in [("black.png", 0), ("white.png", 0xff)] {
        fs::write(folder.path().join(name), flat(8, 8, level)).unwrap();
    }
    let (code, _, said) = diff(&folder, &["white.png", "black.png"]);
    assert!(code == 0 && said.contains("warning[RD016]"), "{said}");
    assert_eq!(
        diff(&folder, &["white.png", "black.png", "--deny", "RD016"]).0,
        1
    );
    assert_eq!(diff(&folder, &["white.png", "black.png", "-q"]).2, "");
    let args = ["away.json", "away.json"];
    assert!(diff(&folder, &args).2.contains("warning[RD016]"));
    let args = ["ball.json", "away.json"];
    assert!(!diff(&folder, &args).2.contains("RD016"));
}

#[test]
fn the_scenes_of_folders_without_pictures_are_compared() {
    let folder = folder();
    for (class, scene) in [
        (
            "handed-in",
            scene_with("\"color\": [1, 0, 0]", "\"color\": [0, 1, 0]"),
        ),
        ("solutions", SCENE.to_owned()),
    ] {
        fs::create_dir(folder.path().join(class)).unwrap();
        fs::write(folder.path().join(class).join("ball.json"), scene).unwrap();
        fs::write(folder.path().join(class).join("same.json"), SCENE).unwrap();
        fs::copy(
            folder.path().join("bad.json"),
            folder.path().join(class).join("wrong.json"),
        )
        .unwrap();
    }
    let (exit, csv, said) = diff(&folder, &["handed-in", "solutions", "--table", "csv"]);
    let lines: Vec<_> = csv.lines().collect();
    assert_eq!(exit, 2, "one has errors: {said}");
    assert!(lines[1].starts_with("ball.json,differs,"), "{csv}");
    assert_eq!(lines[2], "same.json,same,0,0,0,0");
    assert_eq!(lines[3], "wrong.json,one has errors,,,,");
    assert!(lines[4].starts_with("3 scenes,"), "{csv}");
}
