//! The front end for glTF 2.0: it reads a `.gltf` or `.glb` file, validates it, and lowers it to
//! the IR.
//!
//! # Stages
//!
//! 1. `container` finds the JSON text and the binary chunk. The JSON becomes a tree with the byte
//!    range of each node.
//! 2. `header` checks the version of glTF and the extensions.
//! 3. `schema` checks each object against a table of its properties: types, ranges, required
//!    properties, unknown properties, and references.
//! 4. `document` builds typed objects from the tree (`accessor`, `buffer`, `mesh`, `node`, `skin`,
//!    `material`, `texture`, `animation`, `camera`, `light`). References are indices. Each object
//!    keeps its node, so each diagnostic has a location.
//! 5. The `check` functions of these modules test rules between objects: buffer views within their
//!    buffer, a tree of nodes, attributes of equal length.
//! 6. `resource` loads buffers and images: data URIs, and files in the folder of the asset.
//!    `meshopt` and `draco` decompress geometry. `image` decodes pictures.
//! 7. `contents` reads the elements of accessors and checks them against their bounds and against
//!    the constraints of each use (`constraint`).
//! 8. `lower` builds the IR of one scene, at one time of one animation, in one material variant.
//!
//! # Findings
//!
//! All errors are reported, not only the first. `report` adds the byte range, the JSON pointer, and
//! the code of Khronos' glTF validator, where it has one. With `--lenient` an error that importers
//! usually repair becomes a warning, and the value is repaired.
//!
//! # Limits
//!
//! Assets are not trusted. No function recurses over the depth of the asset. Memory is charged to
//! the budget of the run before it is allocated. Only files in the folder of the asset are read.

mod accessor;
mod accessor_reader;
mod advice;
mod animation;
mod attribute;
mod buffer;
mod camera;
mod channel;
mod constraint;
mod container;
mod contents;
mod document;
mod draco;
mod features;
mod field;
mod header;
mod image;
mod influences;
mod inventory;
mod layout;
mod light;
mod lower;
mod material;
mod mesh;
mod meshopt;
mod node;
mod pointer;
mod primitive;
mod report;
mod resource;
mod schema;
mod skin;
mod summary;
mod texture;
mod unused;
mod uri;
mod usage;

pub use inventory::{Inventory, MaterialRow, MeshRow, SceneRow, TextureRow};
pub(super) use lower::{SURFACE, empty, looking_at, pixel};
pub use summary::{AnimationSummary, AssetSummary, summary};

use super::FrontOptions;
use buffer::BufferViewUsages;
use constraint::AccessorConstraints;
use container::AssetParts;
use document::Document;
use report::AssetReport;
use resource::ResourceReader;
use rtc_diag::{Diagnostic, DiagnosticSink, Severity, codes};
use rtc_ir::LoweredScene;
use rtc_source::tree::{SyntaxTree, json};
use rtc_source::{FileId, FileSearch, Resource, SourceMap, Span};
use usage::AccessorUsages;

/// `schema/gltf-extensions.md`: the extensions that are read and drawn.
#[must_use]
pub fn extensions() -> String {
    format!(
        "# Extensions of glTF\n\n\
         The extensions of glTF 2.0 that rtc supports, printed by `rtc schema extensions`. An\n\
         asset may require each of these. Requiring another one is an error; using another one is\n\
         a warning, and it is ignored.\n\n\
         | extension | in | properties |\n| --- | --- | --- |\n{}",
        schema::extension_rows()
    )
}

/// A JSON Schema of glTF 2.0 and its extensions with descriptions, defaults and units (`x-unit`).
/// Constraints between several properties are not part of it.
#[must_use]
pub fn schema() -> serde_json::Value {
    schema::schema()
}

/// The mark that some programs put before a text, and glTF forbids.
const BOM: &str = "\u{feff}";

/// True if the bytes are a glTF asset: a `.glb`, or a JSON object that is not the IR. `name` is
/// that of the file.
#[must_use]
pub fn is_gltf(name: &str, bytes: &[u8]) -> bool {
    let is_declared = || memchr::memmem::find(bytes, b"\"asset\"").is_some();
    container::is_glb(name, bytes)
        || name.ends_with(".gltf")
        || (opens_object(bytes) && is_declared())
}

/// Frees the memory of a lowered asset, except for its text, which diagnostics point into.
pub fn release(file: FileId, map: &mut SourceMap) {
    map.release(file, container::text_end(map.bytes(file)));
}

/// Whether a file that begins so may be a glTF asset.
#[must_use]
pub fn begins(head: &[u8]) -> bool {
    container::is_glb("", head) || opens_object(head)
}

/// True if the bytes open a JSON object with a key.
fn opens_object(bytes: &[u8]) -> bool {
    let text = bytes
        .strip_prefix(BOM.as_bytes())
        .unwrap_or(bytes)
        .trim_ascii_start();
    text.strip_prefix(b"{")
        .map(<[u8]>::trim_ascii_start)
        .is_some_and(|key| key.starts_with(b"\""))
}

/// Checks an asset and lowers its scene. `None` if it has errors, which are in the sink.
pub fn lower(
    file: FileId,
    map: &SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    let bytes = map.bytes(file);
    // Find the JSON text in the file and parse it.
    let parts = parts(file, map, options.lenient, sink)?;
    let (base, text) = text(file, bytes, &parts, options.lenient, sink)?;
    let tree = match json::parse(file, base, text) {
        Ok(tree) => tree,
        Err(fault) => {
            let at = base + u32::try_from(fault.at).unwrap_or(u32::MAX - base);
            sink.push(not_json(
                Span::new(file, at, at),
                &format!("the text is not JSON: {}", fault.message),
            ));
            return None;
        }
    };
    check_keys(&tree, options.lenient, sink);
    // Charge the nodes before the document is built.
    let mut report = AssetReport::new(&tree, sink, options, map.budget());
    let root = tree.root();
    let is_small = report.charge(Resource::Nodes, tree.count() as u64, root, "the asset")
        && report.charge(Resource::Memory, document::cost(&tree), root, "the asset");
    if !is_small {
        return None;
    }
    // Check the document by the schema and its links.
    let doc = shape(&tree, parts.is_glb, &mut report).filter(|_| parts.is_whole)?;
    let folder = map.folder(file);
    // Load images and buffers, and check the accessors by their contents.
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let chunk = parts.bin.map(|range| &bytes[range]);
    let resources = ResourceReader::new(search, map);
    let doc = fill(doc, chunk, resources, options.threads, &mut report);
    // Lower only an asset without errors.
    let lowered = (!report.has_errors()).then(|| lower::lower(&doc, options, &mut report));
    lowered.filter(|_| !report.has_errors())
}

fn parts(
    file: FileId,
    map: &SourceMap,
    is_lenient: bool,
    sink: &mut DiagnosticSink,
) -> Option<AssetParts> {
    let bytes = map.bytes(file);
    let is_glb = container::is_glb(map.name(file), bytes);
    let is_misnamed = is_glb && opens_object(bytes);
    if is_misnamed {
        let message = "the file is named `.glb` but contains the JSON of a `.gltf`";
        let diagnostic = container::fault(&codes::GLB_HEADER, "GLB_INVALID_MAGIC", message);
        let diagnostic = repair(diagnostic, is_lenient, "it is read as `.gltf`");
        sink.push(diagnostic.at(Span::new(file, 0, 1), "JSON begins here"));
    }
    match (is_glb, is_misnamed) {
        (true, false) => container::open(file, bytes, is_lenient, sink),
        (true, true) if !is_lenient => None,
        _ => Some(AssetParts {
            json: 0..bytes.len(),
            bin: None,
            is_glb: false,
            is_whole: true,
        }),
    }
}

/// The text of an asset, and where it begins in its file.
fn text<'s>(
    file: FileId,
    bytes: &'s [u8],
    parts: &AssetParts,
    is_lenient: bool,
    sink: &mut DiagnosticSink,
) -> Option<(u32, &'s str)> {
    let offset = |at: usize| u32::try_from(parts.json.start + at).unwrap_or(u32::MAX);
    let text = match std::str::from_utf8(&bytes[parts.json.clone()]) {
        Ok(text) => text,
        Err(error) => {
            let at = offset(error.valid_up_to());
            sink.push(not_json(
                Span::new(file, at, at + 1),
                "the text is not UTF-8",
            ));
            return None;
        }
    };
    let Some(rest) = text.strip_prefix(BOM) else {
        return Some((offset(0), text));
    };
    let mark = Span::new(file, offset(0), offset(BOM.len()));
    let diagnostic = not_json(mark, "the text starts with a byte order mark");
    sink.push(repair(diagnostic, is_lenient, "it is ignored"));
    Some((offset(BOM.len()), rest))
}

/// A diagnostic of an error that importers repair: with `--lenient` a warning that describes the
/// repair, else an error with it as a hint.
fn repair(mut diagnostic: Diagnostic, is_lenient: bool, repair: &str) -> Diagnostic {
    if is_lenient {
        diagnostic.message = format!("{}: {repair}", diagnostic.message);
        diagnostic.severity(Severity::Warning)
    } else {
        diagnostic.hint(report::lenient(repair))
    }
}

fn not_json(span: Span, message: &str) -> Diagnostic {
    container::fault(&codes::GLTF_NOT_JSON, "INVALID_JSON", message).at(span, "here")
}

fn check_keys(tree: &SyntaxTree<'_>, is_lenient: bool, sink: &mut DiagnosticSink) {
    for (first, second) in tree.duplicate_keys() {
        let code = &codes::GLTF_KEY_TWICE;
        let are_equal = tree.are_alike(*first, *second);
        let severity = match are_equal && is_lenient {
            true => Severity::Warning,
            false => code.severity,
        };
        sink.push_with(code, severity, || {
            let key = report::shown(tree.text(*second).unwrap_or_default());
            let message = format!("the key `{key}` occurs twice in one object");
            let diagnostic =
                container::fault(code, "", message).at(tree.span(*second), "the second");
            let diagnostic = match are_equal {
                true => repair(diagnostic, is_lenient, "both values are equal"),
                false => diagnostic,
            };
            diagnostic
                .also(tree.span(*first), "the first")
                .pointer(tree.pointer(*second))
        });
    }
}

/// Checks the JSON of an asset. Of an asset that is not glTF 2 only the header is checked.
fn shape<'s>(
    tree: &'s SyntaxTree<'s>,
    is_glb: bool,
    report: &mut AssetReport<'_, 's>,
) -> Option<Document<'s>> {
    if header::is_refused(report) {
        return None;
    }
    let is_known = header::check_version(report);
    let extensions = schema::traverse(is_known, report);
    header::check_extensions(report);
    is_known.then(|| Document {
        extensions,
        ..Document::read(tree, is_glb)
    })
}

/// Loads the files of an asset, and checks its references and contents.
fn fill<'s>(
    mut doc: Document<'s>,
    chunk: Option<&'s [u8]>,
    mut resources: ResourceReader<'_>,
    threads: usize,
    report: &mut AssetReport<'_, 's>,
) -> Document<'s> {
    resources.load_buffers(&mut doc, chunk, report);
    resources.load_images(&mut doc, report);
    let constraints = check_links(&doc, report);
    meshopt::expand(&mut doc, report);
    draco::expand(&mut doc, report);
    accessor::check_claims(&doc, report);
    contents::check(&doc, constraints, report);
    image::inspect(&mut doc, threads, report);
    texture::check(&doc, report);
    doc
}

/// Checks references; returns the resulting constraints on accessors.
fn check_links(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) -> AccessorConstraints {
    let mut purposes = BufferViewUsages::new(doc);
    let mut usages = AccessorUsages::new(doc.accessors.len());
    let mut constraints = AccessorConstraints::default();
    buffer::check(doc, report);
    accessor::check(doc, &mut purposes, report);
    image::check(doc, &mut purposes, report);
    camera::check(doc, report);
    light::check(doc, report);
    material::check(doc, report);
    material::check_variants(doc, report);
    let mut streams = std::collections::BTreeMap::new();
    let mut links = mesh::CheckedMeshes {
        purposes: &mut purposes,
        usages: &mut usages,
        constraints: &mut constraints,
        streams: &mut streams,
        textures: std::collections::BTreeMap::new(),
    };
    mesh::check(doc, &mut links, report);
    let hierarchy = node::check(doc, report);
    skin::check(
        doc,
        &hierarchy,
        (&mut purposes, &mut usages, &mut constraints),
        report,
    );
    animation::check(
        doc,
        &mut (&mut purposes, &mut usages, &mut constraints),
        report,
    );
    constraints
}
