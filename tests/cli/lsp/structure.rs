//! What an editor shows and does beside findings: tokens, folding, selections, links, names, lenses,
//! diagnostics that it asks for, and the formats of other renderers.

use super::*;

const NAMED: &str = "# One.\n# Two.\nLights: []\nObjects:\n- &ball\n  type: sphere\n  \
position: [0, 0, 0]\n  radius: 1\n  material: &red {colour: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}\n\
- {type: cube, position: [0, 0, 0], length: 1, material: *red}\n- *ball\n\
- {type: mesh, file: a.obj, material: *red} # &no\n";

/// The editor with the text of names, and parameters about it.
fn named() -> (Editor, Value) {
    let editor = Editor::with(NAMED);
    let params = json!({"textDocument": {"uri": editor.uri("a.yaml")}});
    (editor, params)
}

/// The parameters of a request about a place.
fn placed(params: &Value, line: u32, character: u32) -> Value {
    let mut params = params.clone();
    params["position"] = json!({"line": line, "character": character});
    params
}

/// The lines and columns where ranges start.
fn starts<'v>(ranges: impl Iterator<Item = &'v Value>) -> Vec<(u64, u64)> {
    let number = |value: &Value| value.as_u64().unwrap();
    let start = |range: &Value| {
        let start = &range["start"];
        (number(&start["line"]), number(&start["character"]))
    };
    ranges.map(start).collect()
}

#[test]
fn names_are_found_and_renamed_with_their_aliases() {
    let (mut editor, params) = named();
    let mut asked = placed(&params, 9, 58);
    asked["context"] = json!({"includeDeclaration": true});
    let found = editor.ask("textDocument/references", asked.clone());
    let found = found.as_array().unwrap().iter().map(|own| &own["range"]);
    assert_eq!(starts(found), [(8, 12), (9, 57), (11, 38)]);
    asked["context"] = json!({"includeDeclaration": false});
    let found = editor.ask("textDocument/references", asked);
    assert_eq!(found.as_array().unwrap().len(), 2);
    // From the anchor, whose sign is not a part of the name.
    let range = editor.ask("textDocument/prepareRename", placed(&params, 4, 4));
    assert_eq!(starts(std::iter::once(&range)), [(4, 3)]);
    let mut asked = placed(&params, 4, 4);
    asked["newName"] = json!("globe");
    let edits = editor.ask("textDocument/rename", asked.clone());
    let edits = edits["changes"][editor.uri("a.yaml")].as_array().unwrap();
    assert_eq!(edits.len(), 2);
    assert!(edits.iter().all(|own| own["newText"] == "globe"));
    for name in ["red", "a b", "a,b", ""] {
        asked["newName"] = json!(name);
        let answer = editor.response("textDocument/rename", asked.clone());
        assert_eq!(answer["error"]["code"], -32602, "{name}: {answer}");
    }
    // A comment gives no name.
    let range = editor.ask("textDocument/prepareRename", placed(&params, 11, 46));
    assert!(range.is_null(), "{range}");
}

#[test]
fn tokens_tell_keys_words_files_and_names() {
    let (mut editor, mut params) = named();
    let tokens = editor.ask("textDocument/semanticTokens/full", params.clone());
    let lines: Vec<&str> = NAMED.lines().collect();
    let (mut line, mut column, mut read) = (0, 0, Vec::new());
    let data: Vec<usize> = serde_json::from_value(tokens["data"].clone()).unwrap();
    for token in data.chunks(5) {
        column = if token[0] == 0 {
            column + token[1]
        } else {
            token[1]
        };
        line += token[0];
        let text = lines[line].get(column..column + token[2]).unwrap();
        read.push((text, token[3], token[4]));
    }
    for expected in [
        ("Objects", 0, 0),
        ("&ball", 3, 2),
        ("sphere", 1, 0),
        ("colour", 0, 1),
        ("*red", 3, 0),
        ("a.obj", 2, 0),
    ] {
        assert!(read.contains(&expected), "{expected:?} in {read:?}");
    }
    params["range"] =
        json!({"start": {"line": 9, "character": 0}, "end": {"line": 9, "character": 5}});
    let some = editor.ask("textDocument/semanticTokens/range", params);
    let some = some["data"].as_array().unwrap().len();
    assert!(0 < some && some < data.len(), "{some}");
}

#[test]
fn values_of_several_lines_fold_and_selections_grow() {
    let (mut editor, mut params) = named();
    let folds = editor.ask("textDocument/foldingRange", params.clone());
    let folds: Vec<_> = folds.as_array().unwrap().iter().collect();
    let lines = |own: &Value| [own["startLine"].as_u64(), own["endLine"].as_u64()];
    let found: Vec<_> = folds.iter().map(|own| lines(own)).collect();
    assert!(found.contains(&[Some(0), Some(1)]), "{folds:?}");
    assert_eq!(folds[0]["kind"], "comment");
    assert!(found.contains(&[Some(3), Some(11)]), "{folds:?}");
    params["positions"] = json!([{"line": 7, "character": 11}]);
    let grown = editor.ask("textDocument/selectionRange", params);
    let (mut ranges, mut here) = (Vec::new(), &grown[0]);
    while here.is_object() {
        ranges.push(&here["range"]);
        here = &here["parent"];
    }
    // The number, the pair, the map, the list, the pair `Objects`, the text.
    let begins = starts(ranges.into_iter());
    assert_eq!(begins.first(), Some(&(7, 10)));
    assert!(
        begins.contains(&(7, 2)) && begins.contains(&(5, 2)),
        "{begins:?}"
    );
    assert!(
        begins.contains(&(3, 0)) && begins.last() == Some(&(0, 0)),
        "{begins:?}"
    );
}

#[test]
fn files_are_links_and_lenses_have_commands() {
    let (mut editor, params) = named();
    let links = editor.ask("textDocument/documentLink", params.clone());
    assert_eq!(links, json!([]), "the file is not there");
    fs::write(editor.folder.path().join("a.obj"), "v 0 0 0\n").unwrap();
    let links = editor.ask("textDocument/documentLink", params.clone());
    assert!(links[0]["target"].as_str().unwrap().ends_with("/a.obj"));
    let lenses = editor.ask("textDocument/codeLens", params);
    let titles: Vec<_> = lenses.as_array().unwrap().iter().collect();
    let title = |own: &&Value| own["command"]["title"].as_str().unwrap().to_owned();
    let titles: Vec<_> = titles.iter().map(title).collect();
    assert_eq!(titles, ["render", "what this costs"]);
    let scene = NAMED.replace("- {type: mesh, file: a.obj, material: *red} # &no\n", "");
    let camera = "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [4, 4]}\n";
    let path = editor.folder.path().join("a.yaml");
    fs::write(&path, format!("{camera}{scene}")).unwrap();
    let command = lenses[0]["command"].clone();
    assert!(editor.ask("workspace/executeCommand", command).is_null());
    let told = editor.until(|own| own["method"] == "window/showMessage");
    assert_eq!(told["params"]["type"], 3, "{told}");
    let shown = editor.until(|own| own["method"] == "window/showDocument");
    assert!(shown["params"]["uri"].as_str().unwrap().ends_with("a.png"));
    assert!(path.with_extension("png").exists());
    let other = json!({"command": "rm", "arguments": [editor.uri("a.yaml")]});
    let answer = editor.response("workspace/executeCommand", other);
    assert_eq!(answer["error"]["code"], -32602);
}

#[test]
fn an_editor_that_asks_for_findings_is_sent_none() {
    let mut editor = Editor::silent(tempfile::tempdir().unwrap());
    let can = json!({"textDocument": {"diagnostic": {}},
        "workspace": {"diagnostics": {"refreshSupport": true}}});
    editor.ask("initialize", json!({"capabilities": can}));
    editor.open("a.yaml", SCENE);
    let mut params = json!({"textDocument": {"uri": editor.uri("a.yaml")}});
    let report = editor.ask("textDocument/diagnostic", params.clone());
    assert_eq!(report["kind"], "full");
    let items = report["items"].as_array().unwrap();
    assert!(codes(items).contains(&"SC001"), "{items:?}");
    params["previousResultId"] = report["resultId"].clone();
    let again = editor.ask("textDocument/diagnostic", params.clone());
    assert_eq!(again["kind"], "unchanged");
    editor.change(2, json!([{"text": SCENE.replace("Shadws", "Shadows")}]));
    let changed = editor.ask("textDocument/diagnostic", params);
    let items = changed["items"].as_array().unwrap();
    assert!(!codes(items).contains(&"SC001"), "{items:?}");
    // Where a file changes by other hands, the editor is told to ask again.
    editor.note("workspace/didChangeWatchedFiles", json!({"changes": []}));
    editor.until(|own| own["method"] == "workspace/diagnostic/refresh");
    let uri = editor.uri("a.yaml");
    assert!(editor.reported.iter().all(|own| own["uri"] != uri));
}

#[test]
fn scenes_of_other_renderers_have_findings_and_links() {
    let mut editor = Editor::new(tempfile::tempdir().unwrap());
    let mesh = "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
    fs::write(editor.folder.path().join("a.ply"), mesh).unwrap();
    let xml = "<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n    \
<float name=\"radius\" value=\"x\"/>\n  </shape>\n  <shape type=\"ply\">\n    \
<string name=\"filename\" value=\"a.ply\"/>\n  </shape>\n</scene>\n";
    let pbrt = "Camera \"perspective\" \"float fov\" [ \"x\" ]\nWorldBegin\n\
Shape \"plymesh\" \"string filename\" \"a.ply\"\nShape \"sphre\"\n";
    for (file, text, line) in [("a.xml", xml, 2), ("a.pbrt", pbrt, 0)] {
        editor.open(file, text);
        let found = editor.findings(file);
        let here = found
            .iter()
            .filter(|own| own["range"]["start"]["line"] == line);
        assert!(here.count() > 0, "{found:?}");
        let params = json!({"textDocument": {"uri": editor.uri(file)}});
        let links = editor.ask("textDocument/documentLink", params.clone());
        assert!(
            links[0]["target"].as_str().unwrap().ends_with("/a.ply"),
            "{links}"
        );
        for method in ["semanticTokens/full", "foldingRange", "codeLens"] {
            editor.ask(&format!("textDocument/{method}"), params.clone());
        }
    }
}

#[test]
fn plugins_of_other_renderers_say_how_they_are_read() {
    let mut editor = Editor::new(tempfile::tempdir().unwrap());
    let xml = "<scene version=\"3.0.0\">\n<shape type=\"linearcurve\"/>\n\
<bsdf type=\"conductor\"/>\n</scene>\n";
    let pbrt = "WorldBegin\nMaterial \"hair\"\nMaterial \"conductor\"\n";
    for (file, text, column) in [("a.xml", xml, 15), ("a.pbrt", pbrt, 12)] {
        editor.open(file, text);
        for (line, is_read) in [(1, false), (2, true)] {
            let document = json!({"uri": editor.uri(file)});
            let place = json!({"line": line, "character": column});
            let params = json!({"textDocument": document, "position": place});
            let hover = editor.ask("textDocument/hover", params);
            let text = hover["contents"]["value"].as_str().unwrap();
            assert_eq!(text.contains("read as it is"), is_read, "{text}");
        }
    }
}

#[test]
fn scenes_of_other_renderers_are_completed_while_they_are_typed() {
    let mut editor = Editor::new(tempfile::tempdir().unwrap());
    let xml = "<scene version=\"3.0.0\">\n<!-- 😀 --><shape type=\"sphere\"><float name=\"ra\n";
    let pbrt = "WorldBegin\nShape \"sphere\" # 😀\n  \"float ra\n";
    for (file, text, place, whole) in [
        ("a.xml", xml, (1, 47), ((1, 45), "radius")),
        ("a.pbrt", pbrt, (2, 11), ((2, 3), "float radius")),
    ] {
        editor.open(file, text);
        let (line, character) = place;
        let place = json!({"line": line, "character": character});
        let params = json!({"textDocument": {"uri": editor.uri(file)}, "position": place});
        let items = editor.ask("textDocument/completion", params);
        let ((line, start), name) = whole;
        let mut items = items.as_array().unwrap().iter();
        let item = items.find(|own| own["label"] == name).unwrap();
        let edit = json!({"range": {"start": {"line": line, "character": start}, "end": place},
            "newText": name});
        assert_eq!(item["textEdit"], edit);
        assert_eq!(item["documentation"], "The radius.");
    }
    let place = json!({"line": 1, "character": 9});
    let params = json!({"textDocument": {"uri": editor.uri("a.pbrt")}, "position": place});
    let hover = editor.ask("textDocument/hover", params);
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.starts_with("**`sphere`** A sphere"), "{text}");
    assert_eq!(hover["range"]["start"]["character"], 7);
}
