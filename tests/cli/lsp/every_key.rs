//! Every key of every scene of the repository has a hover text, and is proposed where it stands.

use super::*;
use crate::repo;
use rtc::internals::source::SourceMap;
use rtc::internals::source::tree::{SyntaxTree, yaml};
use std::collections::BTreeSet;
use std::fmt::Write;

/// A key in a text: its name, its line and column in UTF-16, and the path to it without indices.
struct WrittenKey {
    name: String,
    line: usize,
    column: usize,
    path: String,
}

/// All keys of a text.
fn keys(text: &str) -> Vec<WrittenKey> {
    let file = SourceMap::default().add("", Vec::new());
    let Some(tree) = yaml::parse(file, text.as_bytes(), &mut |_| ()) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let mut open = vec![(tree.root(), String::new())];
    while let Some((node, path)) = open.pop() {
        // What an alias names is written elsewhere.
        if tree.target(node) != node {
            continue;
        }
        if tree.is_list(node) {
            open.extend(tree.items(node).map(|item| (item, path.clone())));
        }
        for (key, value) in tree.pairs(node) {
            let name = tree.text(key).unwrap_or_default().to_owned();
            // Of a key in quotes what is between them.
            let start = tree.span(key).start as usize;
            let (line, column) = place(text, start + usize::from(tree.written(key) != name));
            let path = format!("{path}/{}{name}", kind(&tree, node));
            open.push((value, path.clone()));
            found.push(WrittenKey {
                name,
                line,
                column,
                path,
            });
        }
    }
    found
}

/// The `type` of a map, which decides about its keys.
fn kind(tree: &SyntaxTree<'_>, map: rtc::internals::source::tree::NodeId) -> String {
    let kind = tree.get(map, "type").and_then(|kind| tree.text(kind));
    kind.map(|kind| format!("{kind}.")).unwrap_or_default()
}

fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = text.split_at(offset).0;
    let line = before.rsplit('\n').next().unwrap();
    (before.matches('\n').count(), line.encode_utf16().count())
}

/// The YAML and JSON files of the repository that may be scenes.
fn texts() -> Vec<std::path::PathBuf> {
    let folders = ["scenes", "tests"].map(repo::root);
    let texts = |folder| repo::files(folder, &["yaml", "yml", "json"]);
    folders.iter().flat_map(|folder| texts(folder)).collect()
}

#[test]
fn every_key_of_every_scene_is_explained_and_proposed() {
    let mut editor = Editor::new(tempfile::tempdir().unwrap());
    let (mut scenes, mut hovers, mut missing) = (0, 0, String::new());
    // Of keys at equal paths one is completed.
    let mut completed = BTreeSet::new();
    for path in texts() {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        let uri = format!("file://{}", path.display());
        let own = json!({"uri": uri, "languageId": "yaml", "version": 1, "text": text});
        editor.note("textDocument/didOpen", json!({"textDocument": own}));
        let found = editor.findings_of(&uri);
        let is_sound = found.iter().all(|own| own["severity"] != 1);
        let keys = if is_sound { keys(&text) } else { Vec::new() };
        let is_scene = keys.iter().any(|key| key.path == "/Objects");
        let keys = if is_scene { keys } else { Vec::new() };
        scenes += usize::from(is_scene);
        let at = |key: &WrittenKey| {
            json!({"textDocument": {"uri": uri},
                "position": {"line": key.line, "character": key.column}})
        };
        let ask = |method: &'static str| keys.iter().map(move |key| (method, at(key)));
        let texts = editor.ask_all(ask("textDocument/hover").collect());
        let chosen: Vec<_> = keys
            .iter()
            .filter(|key| completed.insert(key.path.clone()))
            .collect();
        let asked = chosen
            .iter()
            .map(|key| ("textDocument/completion", at(key)));
        let proposals = editor.ask_all(asked.collect());
        let mut miss = |key: &WrittenKey, what: &str| {
            let (path, line) = (path.display(), key.line + 1);
            writeln!(missing, "{path}:{line}: {}: {what}", key.path).unwrap();
        };
        for (key, hover) in keys.iter().zip(&texts) {
            hovers += 1;
            let text = hover["contents"]["value"].as_str().unwrap_or_default();
            let is_known = text.starts_with(&format!("**`{}`** ", key.name));
            if !is_known && !text.contains("SC001") {
                miss(key, "no hover");
            }
        }
        for (key, items) in chosen.iter().zip(&proposals) {
            let at = keys.iter().position(|own| std::ptr::eq(own, *key)).unwrap();
            let hover = texts[at]["contents"]["value"].as_str().unwrap_or_default();
            let names = labels(items);
            let is_there = names
                .iter()
                .any(|name| name.eq_ignore_ascii_case(&key.name));
            if hover.contains("SC001") || hover.contains("Not read") {
                continue;
            }
            let better = hover.split_once("Better written `");
            let better = better.and_then(|(_, rest)| rest.split('`').next());
            if !is_there && !better.is_some_and(|name| names.contains(&name)) {
                miss(key, "not proposed");
            }
        }
        editor.note(
            "textDocument/didClose",
            json!({"textDocument": {"uri": uri}}),
        );
    }
    assert_eq!(missing, "");
    assert!(scenes > 200 && hovers > 3000, "{scenes} {hovers}");
}
