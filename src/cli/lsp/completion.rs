//! Completions at a position: keys, keywords, anchors, and files beside the scene.

use super::hover::{default, plain};
use super::open_text::{OpenText, tree};
use super::path_at::{PathStep, path_at};
use super::protocol::{CompletionItem, CompletionItemKind, InsertTextFormat, Position};
use super::snippet;
use super::text::Columns;
use super::vocabulary::Vocabulary;
use rtc_front::course;
use rtc_source::tree::SyntaxTree;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The placeholder for text that is not typed yet.
const BLANK: &str = "rtc0blank";

/// The maximum number of suggested files, and the depth of folders below the scene.
const MOST_FILES: usize = 500;
const DEPTH: usize = 3;

/// The completions at a position, those of whole objects in a form that the editor knows.
pub(super) fn completions(
    document: &OpenText,
    position: Position,
    vocabulary: &Vocabulary,
    columns: Columns,
    form: InsertTextFormat,
) -> Vec<CompletionItem> {
    let lines = document.lines(columns);
    let offset = lines.offset(position);
    let before = lines.before(offset);
    let typed = before.len() - before.trim_end_matches(is_of_word).len();
    let start = offset - typed;
    let (before, keyword) = before.split_at(before.len() - typed);
    let as_value = before.trim_end().ends_with(':') || keyword.starts_with('*');
    // The completion replaces the rest of the token under the cursor.
    let rest = document.text.get(offset..).unwrap_or_default();
    let end = offset + rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
    let is_key = rest
        .get(end - offset..)
        .is_some_and(|rest| rest.trim_start_matches('"').starts_with(':'));
    let quotes = QuoteStyle::of(&document.text, before);
    let blanks = match as_value || is_key {
        true => vec![BLANK.to_owned()],
        // A key that still wants its value, or an item.
        false => vec![format!("{BLANK}: 0"), BLANK.to_owned()],
    };
    let mut items: Vec<CompletionItem> = Vec::new();
    for blank in blanks {
        let mut text = document.text.to_string();
        text.replace_range(start..end, &blank);
        let Some(tree) = tree(&text) else {
            continue;
        };
        for item in proposed(document, &tree, start, vocabulary, quotes, form) {
            if !items.iter().any(|known| known.label == item.label) {
                items.push(item);
            }
        }
    }
    // Editors sort by names otherwise.
    let numbered = items.into_iter().enumerate().map(|(at, item)| {
        let sort_text = Some(format!("{at:04}"));
        CompletionItem { sort_text, ..item }
    });
    numbered.map(|item| quotes.around(item)).collect()
}

/// Whether the inserted text needs quotes.
#[derive(Clone, Copy)]
enum QuoteStyle {
    /// It needs none.
    None,
    /// They are there.
    There,
    /// JSON wants them around it.
    Wanted,
}

impl QuoteStyle {
    fn of(text: &str, before: &str) -> Self {
        if before.ends_with('"') {
            return Self::There;
        }
        match text.trim_start().starts_with('{') {
            true => Self::Wanted,
            false => Self::None,
        }
    }

    fn around(self, item: CompletionItem) -> CompletionItem {
        let name = &item.label;
        let is_key = item.kind == CompletionItemKind::PROPERTY;
        let is_text = serde_json::from_str::<Value>(name).is_err();
        if item.kind == CompletionItemKind::SNIPPET {
            return item;
        }
        let insert_text = match self {
            Self::None => return item,
            Self::There => name.clone(),
            Self::Wanted if is_key => format!("\"{name}\": "),
            Self::Wanted if is_text => format!("\"{name}\""),
            Self::Wanted => name.clone(),
        };
        CompletionItem {
            insert_text: Some(insert_text),
            ..item
        }
    }
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '-' | '.' | '/' | '*' | '$')
}

/// The values allowed at a byte of a tree with a placeholder there.
fn proposed(
    document: &OpenText,
    tree: &SyntaxTree<'_>,
    offset: usize,
    vocabulary: &Vocabulary,
    quotes: QuoteStyle,
    form: InsertTextFormat,
) -> Vec<CompletionItem> {
    let steps = path_at(tree, offset);
    let Some(last) = steps.last() else {
        return Vec::new();
    };
    if let PathStep::Key { map, key, .. } = *last
        && tree.is(key, BLANK)
    {
        let to_map = &steps[..steps.len() - 1];
        let is_there = |name: &str| tree.get(map, name).is_some();
        let keys = vocabulary.keys(tree, to_map).into_iter();
        return keys
            .filter(|(name, _)| !is_there(name))
            .map(key_item)
            .collect();
    }
    let schemas = vocabulary.at(tree, &steps);
    let mut items: Vec<CompletionItem> = words(&schemas).into_iter().map(word_item).collect();
    let is_json = match quotes {
        QuoteStyle::None => Some(false),
        QuoteStyle::Wanted => Some(true),
        // An object does not stand between quotes.
        QuoteStyle::There => None,
    };
    items.extend(
        is_json
            .map(|is_json| snippet::items(&schemas, is_json, form))
            .into_iter()
            .flatten(),
    );
    if is_file(&schemas) {
        items.extend(files(document.path.parent().unwrap_or(Path::new("."))));
    }
    items.extend(anchors(&document.text));
    items
}

fn key_item((name, schema): (&str, &Value)) -> CompletionItem {
    let text = schema.get("description").and_then(Value::as_str);
    CompletionItem {
        detail: default(schema).map(|default| format!("default {default}")),
        documentation: text.map(str::to_owned),
        insert_text: Some(format!("{name}: ")),
        insert_text_format: Some(InsertTextFormat::PLAIN_TEXT),
        ..CompletionItem::new(name.to_owned(), CompletionItemKind::PROPERTY)
    }
}

fn word_item((word, text): (String, Option<&str>)) -> CompletionItem {
    CompletionItem {
        documentation: text.map(str::to_owned),
        ..CompletionItem::new(word, CompletionItemKind::VALUE)
    }
}

/// The words that a value may be, with their meanings; not the deprecated ones.
pub(super) fn words<'v>(schemas: &[&'v Map<String, Value>]) -> Vec<(String, Option<&'v str>)> {
    let mut found: Vec<(String, Option<&str>)> = Vec::new();
    let is_current = |schema: &&&'v Map<String, Value>| !schema.contains_key("deprecated");
    for schema in schemas.iter().filter(is_current) {
        let list = |key: &str| schema.get(key).and_then(Value::as_array);
        let docs = list("enumDescriptions").into_iter().flatten();
        let docs = docs.map(Value::as_str).chain(std::iter::repeat(None));
        let listed = list("enum").into_iter().flatten().map(plain).zip(docs);
        let alone = schema.get("const").map(|word| (plain(word), None));
        let is_boolean = schema.get("type").and_then(Value::as_str) == Some("boolean");
        let truths = ["true", "false"].iter().filter(|_| is_boolean);
        let truths = truths.map(|word| ((*word).to_owned(), None));
        for (word, doc) in listed.chain(alone).chain(truths) {
            if !found.iter().any(|(known, _)| *known == word) {
                found.push((word, doc));
            }
        }
    }
    found
}

/// Whether a value names a file.
pub(super) fn is_file(schemas: &[&Map<String, Value>]) -> bool {
    let mut titles = schemas.iter().filter_map(|schema| schema.get("title"));
    titles.any(|title| title == course::FILE)
}

/// Files that a scene in a folder may name.
fn files(folder: &Path) -> Vec<CompletionItem> {
    let mut open = vec![(folder.to_owned(), String::new(), 0)];
    let mut names = Vec::new();
    while let Some((folder, prefix, depth)) = open.pop() {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        for entry in entries.take(4 * MOST_FILES) {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if name.starts_with('.') || names.len() >= MOST_FILES {
                continue;
            }
            if is_folder && depth < DEPTH {
                open.push((entry.path(), format!("{prefix}{name}/"), depth + 1));
            } else if is_named_by_scenes(&name) {
                names.push(format!("{prefix}{name}"));
            }
        }
    }
    names.sort_unstable();
    let item = |label| CompletionItem::new(label, CompletionItemKind::FILE);
    names.into_iter().map(item).collect()
}

/// Whether scenes name files like this one: pictures, meshes, assets, profiles of lamps.
fn is_named_by_scenes(name: &str) -> bool {
    const KINDS: [&str; 14] = [
        "png", "jpg", "jpeg", "webp", "ktx2", "hdr", "exr", "obj", "off", "stl", "ply", "gltf",
        "glb", "ies",
    ];
    let extension = Path::new(name)
        .extension()
        .unwrap_or_default()
        .to_string_lossy();
    KINDS
        .iter()
        .any(|kind| extension.eq_ignore_ascii_case(kind))
}

/// The anchors of a text, as aliases.
fn anchors(text: &str) -> Vec<CompletionItem> {
    let (mut names, mut known) = (Vec::new(), BTreeSet::new());
    for piece in text.split('&').skip(1) {
        let end = piece.find(|c: char| c.is_whitespace() || ",[]{}".contains(c));
        let name = piece.split_at(end.unwrap_or(piece.len())).0;
        if !name.is_empty() && known.insert(name) {
            names.push(name);
        }
    }
    let item = |name: &str| CompletionItem::new(format!("*{name}"), CompletionItemKind::REFERENCE);
    names.into_iter().map(item).collect()
}
