//! The files that a document names, as links: textures, meshes, assets, profiles of lamps, and
//! what scenes of Mitsuba and pbrt include.

use super::completion::is_file;
use super::open_text::OpenText;
use super::outline::{self, MOST};
use super::place;
use super::protocol::DocumentLink;
use super::text::Columns;
use super::traverse::traverse;
use super::vocabulary::Vocabulary;
use rtc_pipeline::SourceKind;
use std::path::Path;

/// The links of a document, to files that are there.
pub(super) fn links(
    document: &OpenText,
    vocabulary: &Vocabulary,
    columns: Columns,
) -> Vec<DocumentLink> {
    let mut links = match document.kind() {
        SourceKind::Mitsuba | SourceKind::Pbrt => of_strings(document, columns),
        SourceKind::Scene
        | SourceKind::Ir(_)
        | SourceKind::Gltf
        | SourceKind::Mesh
        | SourceKind::Usd => of_keys(document, vocabulary, columns),
    };
    links.sort_unstable_by_key(|link| link.range.start);
    links
}

/// The links of keys whose value is a file.
fn of_keys(document: &OpenText, vocabulary: &Vocabulary, columns: Columns) -> Vec<DocumentLink> {
    let Some(tree) = document.tree() else {
        return Vec::new();
    };
    let (lines, mut links) = (document.lines(columns), Vec::new());
    traverse(&tree, vocabulary, &(0..document.text.len()), |visited| {
        let name = tree.text(visited.node).filter(|_| is_file(visited.schemas));
        let target = name.and_then(|name| target(document, name));
        if let Some(target) = target.filter(|_| links.len() < MOST) {
            let range = outline::range(&tree, visited.node, &lines);
            links.push(DocumentLink { range, target });
        }
    });
    links
}

/// The links of all strings in quotes that are names of files.
fn of_strings(document: &OpenText, columns: Columns) -> Vec<DocumentLink> {
    let (lines, mut links) = (document.lines(columns), Vec::new());
    let mut start = 0;
    for (at, piece) in document.text.split('"').enumerate() {
        let end = start + piece.len();
        // Every second piece is between quotes; a comment with one quote may shift them, so what
        // is not a file is passed over.
        let is_name = at > 0 && !piece.is_empty() && piece.len() < 500 && !piece.contains('\n');
        let target = is_name.then(|| target(document, piece)).flatten();
        if let Some(target) = target.filter(|_| links.len() < MOST) {
            let range = lines.range(start, end);
            links.push(DocumentLink { range, target });
        }
        start = end + 1;
    }
    links
}

/// The file of a name, if there is one.
fn target(document: &OpenText, name: &str) -> Option<super::uri::DocumentUri> {
    let folder = document.path.parent().unwrap_or(Path::new("."));
    let path = folder.join(name);
    path.is_file().then(|| place::uri(&path))?
}
