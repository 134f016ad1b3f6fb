//! The page of each code has an example that raises it, and the same example without the mistake.
//!
//! A block of a page is a file (`yaml`, `gltf`, `obj`, `mtl`, `ies`, `xml`, `toml`) or a command
//! (`console`; without one, the scene is checked). A scene leaves out what does not matter: it gets
//! a camera, a light and a ball, a glTF asset a triangle. `whole` after the language leaves it alone.

use rtc::internals::diag::codes::{self, Code};
use serde_json::{Map, Value};
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Codes whose page shows no example: files of bytes or of a size that no page can show, files of
/// pictures, and a hand-made IR.
const WITHOUT: &[&str] = &[
    "IO002", "SY001", "SY004", "SY010", "SY011", "RE003", "RE005", "RE008", "VA014", "VA017",
    "VA018", "IR004", "IR005", "IR006", "IR007", "GL001", "GL002", "GL003", "GL042", "GL043",
    "GL044", "GL047", "GL052", "RD004", "RD005", "RD007", "RD009", "RD015",
];

/// Codes for which the page shows no way to be rid of them: a newer file, a damaged file, what every
/// export reports, and a machine that is too slow.
const WITHOUT_FIX: &[&str] = &["IR001", "IR002", "IR003", "GL050", "GL051", "RD011"];

const CAMERA: &str =
    "Camera: {eye: [0, 0, 10], center: [0, 0, 0], up: [0, 0.2, 0], viewSize: [40, 40]}\n";
const LIGHTS: &str = "Lights: [{position: [0, 5, 9], color: [1, 1, 1]}]\n";
const OBJECTS: &str = "Objects: [{type: sphere, position: [0, 0, 0], radius: 2, material: \
                       {color: [1, 0, 0], ka: 0.2, kd: 0.8, ks: 0, n: 1}}]\n";
const ASSET: &str = r#"{
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
}"#;

/// A fenced block: its language and its text.
type Block<'a> = (&'a str, &'a str);

fn blocks(part: &str) -> Vec<Block<'_>> {
    let fences = part.split("```").skip(1).step_by(2);
    fences.filter_map(|fence| fence.split_once('\n')).collect()
}

/// A scene with what its example leaves out.
fn whole_scene(text: &str) -> String {
    let has = |key: &str| text.lines().any(|line| line.starts_with(key));
    let missing = [
        ("Camera", CAMERA, has("Eye:")),
        ("Lights", LIGHTS, false),
        ("Objects", OBJECTS, false),
    ];
    let is_scene = text.lines().any(|line| line.contains(": ")) && !text.starts_with("- ");
    let added = missing
        .iter()
        .filter(|(key, _, other)| is_scene && !has(key) && !other);
    added.fold(text.to_owned(), |scene, (_, lines, _)| scene + lines)
}

/// An asset with what its example leaves out. Text that is no JSON object stays.
fn whole_asset(text: &str) -> String {
    let Ok(Value::Object(given)) = serde_json::from_str::<Value>(text) else {
        return text.to_owned();
    };
    let mut asset: Map<String, Value> = serde_json::from_str(ASSET).unwrap();
    asset.extend(given);
    serde_json::to_string_pretty(&asset).unwrap()
}

/// Writes the files of an example and returns the commands that it runs.
fn lay_out(folder: &Path, blocks: &[Block]) -> Vec<String> {
    let mut commands = Vec::new();
    for (language, text) in blocks {
        let (name, text) = match *language {
            "console" => {
                commands.extend(text.lines().filter_map(|line| line.strip_prefix("$ ")));
                continue;
            }
            "yaml" => ("scene.yaml", whole_scene(text)),
            "yaml whole" => ("scene.yaml", (*text).to_owned()),
            "gltf" => ("scene.gltf", whole_asset(text)),
            "xml" => ("scene.xml", (*text).to_owned()),
            "pbrt" => ("scene.pbrt", (*text).to_owned()),
            "usda" => ("scene.usda", (*text).to_owned()),
            "gltf whole" => ("scene.gltf", (*text).to_owned()),
            "json" => ("scene.json", (*text).to_owned()),
            "toml" => ("rtc.toml", (*text).to_owned()),
            "obj" => ("part.obj", (*text).to_owned()),
            "mtl" => ("part.mtl", (*text).to_owned()),
            "ies" => ("lamp.ies", (*text).to_owned()),
            other => panic!("there is no file for a block of `{other}`"),
        };
        fs::write(folder.join(name), text).unwrap();
    }
    commands.into_iter().map(str::to_owned).collect()
}

/// What the commands print on standard error.
fn run(folder: &Path, commands: &[String]) -> String {
    let mut printed = String::new();
    for command in commands {
        let mut words = command.split(' ');
        if command == "rm rtc.toml" {
            fs::remove_file(folder.join("rtc.toml")).unwrap();
            continue;
        }
        assert_eq!(words.next(), Some("rtc"), "{command}");
        let output = Command::new(env!("CARGO_BIN_EXE_rtc"))
            .args(words)
            .args(["--message-format", "short"])
            .current_dir(folder)
            .output()
            .unwrap();
        printed += &String::from_utf8_lossy(&output.stderr);
        printed += &String::from_utf8_lossy(&output.stdout);
    }
    printed
}

/// What is wrong with the examples of a page.
fn faults(code: &Code) -> Vec<String> {
    let (example, fixed) = code
        .page()
        .split_once("\nFixed:")
        .unwrap_or((code.page(), ""));
    let (example, fixed) = (blocks(example), blocks(fixed));
    let id = code.id;
    let mut faults = Vec::new();
    if example.is_empty() != WITHOUT.contains(&id) {
        faults.push(format!(
            "{id}: an example is missing, or is not needed any more"
        ));
    }
    if fixed.is_empty() != (example.is_empty() || WITHOUT_FIX.contains(&id)) {
        faults.push(format!(
            "{id}: what is fixed is missing, or is not needed any more"
        ));
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(
        folder.join("scene.yaml"),
        [CAMERA, LIGHTS, OBJECTS].concat(),
    )
    .unwrap();
    // The search for a project file ends here.
    fs::create_dir(folder.join(".git")).unwrap();
    let scene = match example.iter().find(|(language, _)| *language != "console") {
        Some((language, _)) if language.starts_with("gltf") => "scene.gltf",
        Some(("json", _)) => "scene.json",
        Some(("xml", _)) => "scene.xml",
        Some(("pbrt", _)) => "scene.pbrt",
        Some(("usda", _)) => "scene.usda",
        _ => "scene.yaml",
    };
    let check = vec![format!("rtc check {scene} -v")];
    let given = lay_out(folder, &example);
    let commands = if given.is_empty() { check } else { given };
    let printed = run(folder, &commands);
    let raised = format!("[{id}]");
    if !example.is_empty() && !printed.contains(&raised) {
        faults.push(format!("{id} is not raised by its example:\n{printed}"));
    }
    if !fixed.is_empty() {
        let given = lay_out(folder, &fixed);
        let printed = run(folder, if given.is_empty() { &commands } else { &given });
        let is_bad = printed.contains("error[") || printed.contains("warning[");
        if printed.contains(&raised) || is_bad {
            faults.push(format!(
                "{id}: not all is well when it is fixed:\n{printed}"
            ));
        }
    }
    faults
}

#[test]
fn examples_raise_their_codes_and_fixed_ones_pass() {
    let faults: Vec<String> = codes::all().flat_map(faults).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
