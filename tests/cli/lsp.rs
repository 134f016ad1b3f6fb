//! `rtc lsp`, by messages as they stand on the wire: what an editor is told, and what it can't break.

mod editor;
mod every_key;
mod structure;

use super::*;
use editor::Editor;
use serde_json::{Value, json};

/// A scene with a key that has a slip, an alias, a file that is not there and a colour.
const SCENE: &str = "# 😀\nCamera: {eye: [0, 0, 50], center: [0, 0, 0], up: [0, 1, 0], viewSize: [12, 8]}\n\
Shadws: true\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjects:\n\
- &a {type: sphere, position: [0, 0, 0], radius: 3, material: {color: [1, 0.5, 0], ka: 1}}\n\
- type: mesh\n  file: bal.obj\n- *a\n";

fn codes(findings: &[Value]) -> Vec<&str> {
    findings
        .iter()
        .map(|own| own["code"].as_str().unwrap())
        .collect()
}

fn labels(items: &Value) -> Vec<&str> {
    let items = items.as_array().unwrap().iter();
    items.map(|own| own["label"].as_str().unwrap()).collect()
}

#[test]
fn findings_come_while_one_types_and_go_with_their_fix() {
    let mut editor = Editor::with(SCENE);
    let found = editor.findings("a.yaml");
    assert!(codes(&found).contains(&"SC001"), "{found:?}");
    let slip = found.iter().find(|own| own["code"] == "SC001").unwrap();
    assert_eq!(slip["range"]["start"], json!({"line": 2, "character": 0}));
    assert_eq!(slip["range"]["end"], json!({"line": 2, "character": 6}));
    let place = json!({"line": 2, "character": 3});
    let params = json!({"textDocument": {"uri": editor.uri("a.yaml")},
        "range": {"start": place, "end": place}, "context": {"diagnostics": []}});
    let actions = editor.ask("textDocument/codeAction", params);
    let [action] = actions.as_array().unwrap().as_slice() else {
        panic!("{actions}");
    };
    assert_eq!(action["kind"], "quickfix");
    assert_eq!(action["title"], "replace `Shadws` by `Shadows`");
    assert_eq!(action["isPreferred"], false, "it is a guess");
    let edits = action["edit"]["changes"][editor.uri("a.yaml")].clone();
    assert_eq!(edits[0]["newText"], "Shadows");
    let change = json!([{"range": edits[0]["range"], "text": edits[0]["newText"]}]);
    editor.change(2, change);
    let found = editor.findings("a.yaml");
    assert!(!codes(&found).contains(&"SC001"), "{found:?}");
    assert_eq!(editor.reported.last().unwrap()["version"], 2);
    let own = json!({"uri": editor.uri("a.yaml")});
    editor.note("textDocument/didClose", json!({"textDocument": own}));
    assert_eq!(editor.findings("a.yaml"), Vec::<Value>::new());
    assert_eq!(editor.ask("shutdown", Value::Null), Value::Null);
    assert_eq!(editor.leave(), 0);
}

#[test]
fn all_that_is_sure_is_mended_at_once_as_check_fix_does() {
    let mut editor = Editor::with(SCENE);
    let params = json!({"textDocument": {"uri": editor.uri("a.yaml")},
        "range": {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}},
        "context": {"diagnostics": [], "only": ["source.fixAll"]}});
    let actions = editor.ask("textDocument/codeAction", params);
    fs::write(editor.folder.path().join("b.yaml"), SCENE).unwrap();
    rtc(&editor.folder, &["check", "--fix", "-q", "b.yaml"]);
    let fixed = fs::read_to_string(editor.folder.path().join("b.yaml")).unwrap();
    match actions[0]["edit"]["changes"][editor.uri("a.yaml")][0]["newText"].as_str() {
        Some(text) => assert_eq!(text, fixed),
        None => assert_eq!(fixed, SCENE),
    }
}

#[test]
fn keys_words_names_and_files_are_completed() {
    let mut editor = Editor::with(SCENE);
    fs::write(editor.folder.path().join("ball.obj"), "v 0 0 0\n").unwrap();
    fs::write(editor.folder.path().join("notes.txt"), "").unwrap();
    let keys = editor.ask_at("textDocument/completion", 2, 3);
    let keys = labels(&keys);
    assert!(
        keys.contains(&"Shadows") && keys.contains(&"ImageSize"),
        "{keys:?}"
    );
    assert!(
        !keys.contains(&"Camera"),
        "what is there is not proposed: {keys:?}"
    );
    let files = editor.ask_at("textDocument/completion", 7, 12);
    let files = labels(&files);
    assert!(
        files.contains(&"ball.obj") && !files.contains(&"notes.txt"),
        "{files:?}"
    );
    let words = editor.ask_at("textDocument/completion", 6, 10);
    assert!(labels(&words).contains(&"torus"), "{words}");
    assert!(!labels(&words).contains(&"OBJModel"), "{words}");
    let names = editor.ask_at("textDocument/completion", 8, 3);
    assert!(labels(&names).contains(&"*a"), "{names}");
}

#[test]
fn words_come_before_numbers_and_are_explained() {
    let mut editor = Editor::with("RenderMode: path\nEnvironment: {color: 1}\nShadows: true\n");
    let words = editor.ask_at("textDocument/completion", 0, 12);
    assert_eq!(
        labels(&words),
        ["phong", "zbuffer", "normal", "gooch", "path", "texture"]
    );
    assert!(
        words[4]["documentation"]
            .as_str()
            .unwrap()
            .starts_with("Path tracing")
    );
    assert!(words[0]["sortText"].as_str() < words[1]["sortText"].as_str());
    let hover = editor.ask_at("textDocument/hover", 0, 13);
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.contains("`path`: Path tracing"), "{text}");
    assert!(!text.contains("`4`"), "{text}");
    let keys = editor.ask_at("textDocument/completion", 2, 0);
    let names = labels(&keys);
    assert!(
        !names.contains(&"rendermode") && !names.contains(&"AA"),
        "{names:?}"
    );
}

/// The scene around an object, which stands at the mark.
const AROUND: &str = "Camera: {eye: [9, 7, 20], center: [0, 0, 0], up: [0, 0.1, 0], viewSize: [9, 9]}\n\
Lights: [{position: [0, 90, 90], color: [1, 1, 1]}]\nObjects:\n- @\n";

#[test]
fn objects_are_proposed_whole_and_read_without_findings() {
    let mut editor = Editor::with(&AROUND.replace('@', ""));
    let items = editor.ask_at("textDocument/completion", 3, 2);
    let objects: Vec<Value> = items.as_array().unwrap().clone();
    let is_object = |own: &&Value| own["kind"] == 15;
    let objects: Vec<&Value> = objects.iter().filter(is_object).collect();
    assert!(objects.len() > 15, "{}", objects.len());
    for (at, object) in objects.iter().enumerate() {
        let name = object["label"].as_str().unwrap();
        let text = object["insertText"].as_str().unwrap();
        assert!(text.starts_with(&format!("{{type: {name}")), "{text}");
        let file = format!("{at}.yaml");
        editor.open(&file, &AROUND.replace('@', text));
        let found = editor.findings(&file);
        // Files are what one has.
        let is_told = |own: &&Value| own["code"] != "RE001";
        let found: Vec<_> = found.iter().filter(is_told).collect();
        assert!(found.is_empty(), "{text}: {found:?}");
    }
    let text = "Camera: \nLights:\n- \n";
    editor.open("a.yaml", text);
    for (line, column, name) in [(0, 8, "camera"), (2, 2, "light")] {
        let items = editor.ask_at("textDocument/completion", line, column);
        assert!(labels(&items).contains(&name), "{items}");
    }
}

#[test]
fn a_key_is_explained_with_its_finding() {
    let mut editor = Editor::with(SCENE);
    editor.findings("a.yaml");
    let reported = editor.ask_at("textDocument/hover", 1, 45);
    let text = reported["contents"]["value"].as_str().unwrap();
    assert!(text.starts_with("**`up`**"), "{text}");
    let reported = editor.ask_at("textDocument/hover", 2, 2);
    let text = reported["contents"]["value"].as_str().unwrap();
    assert!(text.contains("SC001"), "{text}");
}

#[test]
fn the_text_is_outlined_laid_out_coloured_and_followed() {
    let mut editor = Editor::with(SCENE);
    let whole = json!({"textDocument": {"uri": editor.uri("a.yaml")}, "options": {"tabSize": 2, "insertSpaces": true},
        "range": {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}});
    let symbols = editor.ask("textDocument/documentSymbol", whole.clone());
    let objects = symbols
        .as_array()
        .unwrap()
        .iter()
        .find(|own| own["name"] == "Objects");
    let objects = objects.unwrap()["children"].as_array().unwrap();
    assert_eq!(objects[1]["name"], "mesh");
    let colors = editor.ask("textDocument/documentColor", whole.clone());
    let found: Vec<_> = colors
        .as_array()
        .unwrap()
        .iter()
        .map(|own| &own["color"]["green"])
        .collect();
    assert_eq!(found, [1.0, 0.5]);
    let shown = json!({"textDocument": {"uri": editor.uri("a.yaml")}, "range": colors[1]["range"],
        "color": {"red": 0.25, "green": 0.0, "blue": 1.0, "alpha": 1.0}});
    let shown = editor.ask("textDocument/colorPresentation", shown);
    assert_eq!(shown[0]["label"], "[0.25, 0, 1]");
    let anchor = editor.ask_at("textDocument/definition", 8, 3);
    assert_eq!(anchor["range"]["start"]["line"], 5);
    assert!(editor.ask_at("textDocument/definition", 7, 10).is_null());
    fs::write(editor.folder.path().join("bal.obj"), "").unwrap();
    let file = editor.ask_at("textDocument/definition", 7, 10);
    assert!(
        file["uri"].as_str().unwrap().ends_with("/bal.obj"),
        "{file}"
    );
    let hints = editor.ask("textDocument/inlayHint", whole.clone());
    let hints = hints.as_array().unwrap();
    let camera = hints
        .iter()
        .find(|own| own["position"]["line"] == 1)
        .unwrap();
    assert!(camera["label"].as_str().unwrap().contains(": "), "{camera}");
    let alias = hints.iter().find(|own| own["position"]["line"] == 8);
    let alias = alias.unwrap()["label"].as_str().unwrap();
    assert!(alias.starts_with("= {type: sphere"), "{alias}");
    let of_object = |own: &&Value| own["position"]["line"] == 5;
    assert_eq!(hints.iter().find(of_object), None, "it tells nothing");
    let sound = SCENE
        .replace("Shadws: ", "Shadows:   ")
        .replace("- type: mesh\n  file: bal.obj\n", "");
    editor.change(2, json!([{"text": sound}]));
    let edits = editor.ask("textDocument/formatting", whole);
    fs::write(editor.folder.path().join("b.yaml"), &sound).unwrap();
    assert_eq!(code(&rtc(&editor.folder, &["fmt", "-q", "b.yaml"])), 0);
    assert_ne!(edits, json!([]));
    let laid_out = fs::read_to_string(editor.folder.path().join("b.yaml")).unwrap();
    assert_eq!(edits[0]["newText"], laid_out);
}

#[test]
fn what_is_found_in_a_file_of_the_scene_is_told_there() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("bal.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
    )
    .unwrap();
    let mut editor = Editor::new(folder);
    let text = SCENE.replace("Shadws", "Shadows");
    editor.open("a.yaml", &text);
    let found = editor.findings("bal.obj");
    assert_eq!(found[0]["range"]["start"]["line"], 3, "{found:?}");
    fs::write(
        editor.folder.path().join("bal.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    let own = json!({"uri": editor.uri("bal.obj")});
    editor.note("textDocument/didSave", json!({"textDocument": own}));
    assert_eq!(editor.findings("bal.obj"), Vec::<Value>::new());
}

#[test]
fn what_is_open_is_read_in_place_of_its_file() {
    let mesh = |last: u8| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {last}\n");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bal.obj"), mesh(9)).unwrap();
    let mut editor = Editor::new(folder);
    editor.open("a.yaml", &SCENE.replace("Shadws", "Shadows"));
    assert_eq!(editor.findings("bal.obj").len(), 1);
    // The scene is checked first, then the mesh by itself.
    let reported = |editor: &mut Editor| [editor.findings("bal.obj"), editor.findings("bal.obj")];
    editor.open("bal.obj", &mesh(3));
    let [_, last] = reported(&mut editor);
    assert_eq!(last, Vec::<Value>::new());
    let own = json!({"uri": editor.uri("bal.obj"), "version": 2});
    let params = json!({"textDocument": own, "contentChanges": [{"text": mesh(8)}]});
    editor.note("textDocument/didChange", params);
    let [first, last] = reported(&mut editor);
    assert_eq!(first, last, "what both find is told once");
    assert_eq!(last[0]["range"]["start"]["line"], 3, "{last:?}");
    let own = json!({"uri": editor.uri("bal.obj")});
    fs::write(editor.folder.path().join("bal.obj"), mesh(3)).unwrap();
    editor.note("textDocument/didClose", json!({"textDocument": own}));
    let [_, last] = reported(&mut editor);
    assert_eq!(last, Vec::<Value>::new(), "the file counts again");
}

#[test]
fn gltf_has_its_findings_and_its_own_keys() {
    let mut editor = Editor::new(tempfile::tempdir().unwrap());
    let text = r#"{"asset": {"version": "2.0"}, "scene": 3, "nodes": [{"mesh": 0}],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": 0.5}}]}},
"materials": [{"extensions": {"KHR_materials_volume": {"thicknessFactor": 2}}}], "cameras": [{"type": "p"}]}"#;
    editor.open("a.yaml", text);
    let found = editor.findings("a.yaml");
    assert!(found.iter().any(|own| own["severity"] == 1), "{found:?}");
    let keys = editor.ask_at("textDocument/completion", 0, 32);
    let names = labels(&keys);
    assert!(
        names.contains(&"bufferViews") && !names.contains(&"Lights") && !names.contains(&"nodes"),
        "{names:?}"
    );
    let (line, at) = (
        2,
        text.lines().nth(2).unwrap().rfind("\"p\"").unwrap() as u32 + 2,
    );
    let words = editor.ask_at("textDocument/completion", line, at);
    assert_eq!(labels(&words), ["perspective", "orthographic"]);
    assert_eq!(
        words[0]["insertText"], "perspective",
        "the quotes are there"
    );
    let mut reported = |line: u32, key: &str| {
        let at = text.lines().nth(line as usize).unwrap().find(key).unwrap();
        let reported = editor.ask_at("textDocument/hover", line, at as u32 + 2);
        reported["contents"]["value"].as_str().unwrap().to_owned()
    };
    let spot = reported(1, "outerConeAngle");
    for words in [
        "where the light ends",
        "in radians",
        "default `0.785",
        "at most 1.57",
    ] {
        assert!(spot.contains(words), "{words}: {spot}");
    }
    let volume = reported(2, "thicknessFactor");
    assert!(
        volume.contains("in metres") && volume.contains("volume"),
        "{volume}"
    );
    let scene = reported(0, ": 3");
    let mut all = codes(&found).into_iter();
    assert!(
        scene.contains("**`scene`**") && all.any(|code| scene.contains(code)),
        "{scene}"
    );
}

#[test]
fn a_value_is_told_with_its_unit_and_as_it_is_in_effect() {
    let sound = SCENE
        .replace("Shadws", "Shadows")
        .replace("ka: 1", "ka: 1, kd: 0, ks: 0, n: 1")
        .replace("- type: mesh\n  file: bal.obj\n", "");
    let mut editor = Editor::with(&sound);
    editor.findings("a.yaml");
    let mut reported = |line: u32, key: &str| {
        let at = sound.lines().nth(line as usize).unwrap().find(key).unwrap();
        let reported = editor.ask_at("textDocument/hover", line, at as u32 + 1);
        reported["contents"]["value"].as_str().unwrap().to_owned()
    };
    let eye = reported(1, "eye");
    assert!(
        eye.contains("in scene units") && !eye.contains("in effect"),
        "{eye}"
    );
    // A map as a whole, with what it does not say.
    let material = reported(5, "material");
    let (_, effect) = material.split_once("in effect\n```json\n").unwrap();
    let effect: Value = serde_json::from_str(effect.split_once("```").unwrap().0).unwrap();
    assert_eq!(effect["phong"]["color"], json!([1, 0.5, 0]), "{material}");
    assert_eq!(effect["phong"]["kt"], 0, "{material}");
}

/// A material that is an alias is one of a list: its index says nothing.
#[test]
fn an_alias_of_a_map_is_in_effect_no_number() {
    let text = "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8]}\n\
        Objects:\n- type: sphere\n  position: [0, 0, 0]\n  radius: 1\n  material: &red \
        {color: [1, 0, 0], ka: 0.2, kd: 0.8, ks: 0, n: 1}\n- type: sphere\n  \
        position: [2, 0, 0]\n  radius: 1\n  material: *red\n";
    let mut editor = Editor::with(text);
    editor.findings("a.yaml");
    let reported = editor.ask_at("textDocument/hover", 9, 13);
    let reported = reported["contents"]["value"].as_str().unwrap();
    assert!(!reported.contains("in effect `"), "{reported}");
}

/// Editors send all YAML and JSON that is open.
#[test]
fn texts_of_other_programs_are_left_alone() {
    for text in [
        "apiVersion: v1\nkind: Service\nmetadata:\n  name: a\n",
        "name: ci\non: push\njobs:\n  test:\n    runs-on: ubuntu-latest\n",
        "services:\n  web:\n    image: a\nenvironment:\n  A: b\n",
        "replicaCount: 1\nimage: {{ .Values.image }}\n",
        "{\"name\": \"x\", \"version\": \"1.0.0\"}",
        "light:\n  - platform: mqtt\ncamera:\n  - platform: generic\n",
        "{\"camera\":{\"fov\":3},\"objects\":[]}",
    ] {
        let mut editor = Editor::with(text);
        assert_eq!(editor.findings("a.yaml"), Vec::<Value>::new(), "{text}");
        for method in ["hover", "completion", "definition"] {
            let answer = editor.ask_at(&format!("textDocument/{method}"), 0, 2);
            assert_eq!(answer, Value::Null, "{method}: {text}");
        }
    }
    // A new text may become a scene, and one that is a scene has findings.
    let mut editor = Editor::with("# Mine.\n\n");
    assert_eq!(editor.findings("a.yaml"), Vec::<Value>::new());
    for (version, text) in [(2, "# Mine.\n\n"), (3, "# Mine.\nCam")] {
        editor.change(version, json!([{"text": text}]));
        assert_eq!(editor.findings("a.yaml"), Vec::<Value>::new());
        let keys = editor.ask_at("textDocument/completion", 1, text.len() as u32 - 8);
        assert!(labels(&keys).contains(&"Camera"), "{keys}");
    }
    editor.change(4, json!([{"text": "Objcts: [{type: sphere}]\n"}]));
    assert!(codes(&editor.findings("a.yaml")).contains(&"SC001"));
}

#[test]
fn texts_follow_changes_in_columns_of_utf_16() {
    let mut editor = Editor::with("Lights: [] # 😀😀 x\n");
    editor.findings("a.yaml");
    let at = |start: u32, end: u32, text: &str| json!({"range": {"start": {"line": 0, "character": start}, "end": {"line": 0, "character": end}}, "text": text});
    // Behind two smileys of two units each; then in the text that this leaves.
    editor.change(
        2,
        json!([at(18, 19, "y"), at(0, 6, "Shadws"), at(8, 10, "true")]),
    );
    let found = editor.findings("a.yaml");
    let slip = found.iter().find(|own| own["code"] == "SC001").unwrap();
    assert_eq!(slip["range"]["end"]["character"], 6);
    let params = json!({"textDocument": {"uri": editor.uri("a.yaml")}, "options": {"tabSize": 2, "insertSpaces": true}});
    let edits = editor.ask("textDocument/formatting", params);
    assert!(
        edits.is_null() || edits.as_array().is_some_and(Vec::is_empty),
        "{edits}"
    );
}

#[test]
fn nothing_that_an_editor_says_ends_it() {
    let mut editor = Editor::silent(tempfile::tempdir().unwrap());
    let early = editor.response("textDocument/hover", json!({}));
    assert_eq!(early["error"]["code"], -32002);
    editor.raw("{no JSON");
    assert_eq!(
        editor.until(|own| own["id"].is_null())["error"]["code"],
        -32700
    );
    editor.ask("initialize", json!({"capabilities": {}}));
    let again = editor.response("initialize", json!({"capabilities": {}}));
    assert_eq!(again["error"]["code"], -32600);
    for (method, params, code) in [
        ("textDocument/hover", json!({"textDocument": 3}), -32602),
        ("textDocument/rename", json!({}), -32602),
        ("textDocument/moniker", json!({}), -32601),
    ] {
        let response = editor.response(method, params);
        assert_eq!(response["error"]["code"], code, "{method}");
    }
    editor.note("textDocument/didOpen", json!([1]));
    editor.change(9, json!([{"text": "not open"}]));
    assert!(editor.ask_at("textDocument/hover", 7, 7).is_null());
    editor.open("a.yaml", "Eye: [\n");
    let beyond = json!([{"range": {"start": {"line": 9, "character": 9}, "end": {"line": 0, "character": 0}}, "text": "]"}]);
    editor.change(2, beyond);
    assert!(!editor.findings("a.yaml").is_empty());
    assert_eq!(editor.ask("shutdown", Value::Null), Value::Null);
    let late = editor.response("textDocument/hover", json!({}));
    assert_eq!(late["error"]["code"], -32600);
    assert_eq!(editor.leave(), 0);
    let unfinished = Editor::new(tempfile::tempdir().unwrap());
    assert_eq!(unfinished.leave(), 1);
}

#[test]
fn a_project_that_can_not_be_read_is_told_in_the_text() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("rtc.toml"), "#".repeat(100_000)).unwrap();
    let mut editor = Editor::new(folder);
    editor.open("a.yaml", SCENE);
    let found = editor.findings("a.yaml");
    let is_told = |found: &Value| found["message"].as_str().unwrap().contains("rtc.toml");
    assert!(found.iter().any(is_told), "{found:?}");
    fs::write(editor.folder.path().join("rtc.toml"), "").unwrap();
    editor.note("workspace/didChangeWatchedFiles", json!({"changes": []}));
    assert!(codes(&editor.findings("a.yaml")).contains(&"SC001"));
}
