//! The scene format of Mitsuba (XML, versions 0.5 to 3) lowered to the IR.
//!
//! ```text
//! bytes ─ xml ─▶ PluginNode ─ sensor, bsdf, emitter, shape ─▶ … ─ assets ─▶ LoweredScene
//! ```
//!
//! - [`xml`] reads the text. It resolves `<default>`, `<include>` and `<ref>`, converts the names
//!   of older versions (`toWorld`) to those of version 3 (`to_world`), and collects all mistakes.
//!   Each [`PluginNode`] keeps the spans of its element and of its properties.
//! - [`plugins`] lists the elements, and all plugins with their parameters, for the reader and for
//!   editors; [`completion`] is what these propose at a place of a text.
//! - [`value`] parses numbers, vectors, matrices, colours and spectra.
//! - [`sensor`], [`bsdf`], [`medium`], [`emitter`] and [`shape`] lower one kind of plugin each; [`one_sided`]
//!   covers the backs of lights. A plugin that
//!   is not supported is replaced by the closest one, and a property without effect is ignored,
//!   both with a warning: the picture is made all the same.
//! - Meshes, textures and environment maps become pending assets, which `course::assets` loads
//!   within the limits and search paths of all scenes.
//!
//! Every Mitsuba scene is path-traced. Colours are linear Rec. 709; spectra are converted to it
//! when they are read.

#![expect(
    clippy::wildcard_enum_match_arm,
    clippy::string_slice,
    reason = "a value of another type counts as none; slices end where a character was found"
)]

mod bounds;
mod bsdf;
mod clip;
pub(crate) mod completion;
mod emitter;
mod facets;
mod medium;
mod number;
mod one_sided;
// A table, one entry a line.
#[rustfmt::skip]
pub(crate) mod plugins;
mod sensor;
mod serialized;
mod shape;
mod sky;
mod transform;
mod unused;
mod value;
mod xml;

use crate::course::UnfinishedScene;
use crate::course::assets::{self, AssetTarget, PendingAsset};
use crate::exchange::{SpannedText, transform::AffineTransform};
use crate::foreign::xml_root;
use crate::mesh::{PlyColors, TextParseError, parse_colored_ply};
use crate::{FrontOptions, over_limit};
use rtc_diag::{Diagnostic, DiagnosticSink, clip, clip_path, codes};
use rtc_ir::{
    EntityField, EntityKind, Image, ImageId, LoweredScene, MaterialId, Medium, Mesh, MeshId,
    Pixels, Scene, Settings, SourceSpans, Standard, TextureId, ValuePath, VertexColumn,
};
use rtc_source::{
    Budget, FileId, FileKind, FileSearch, LimitExceeded, Loader, Resource, SourceMap, Span,
};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::rc::Rc;
use xml::PluginNode;

/// The name of the root element.
pub(crate) const ROOT: &str = "scene";

/// Whether bytes are a scene of Mitsuba: an XML document whose root element is `scene`.
#[must_use]
pub fn is_mitsuba(bytes: &[u8]) -> bool {
    let head = bytes.get(..4096).unwrap_or(bytes);
    xml_root(head).is_some_and(|(name, _)| name == ROOT.as_bytes())
}

/// Lowers a scene. Files that it includes come into the map; meshes and pictures are loaded.
///
/// `None` if the text is not XML, or is not a scene; the sink has the error.
pub fn lower(
    file: FileId,
    map: &mut SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    let root = xml::read(file, map, options, sink)?;
    let folder = map.folder(file);
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut lowering = Lowering::new(&root, search, map, sink);
    lowering.scene(&root);
    let flat = std::mem::take(&mut lowering.flat);
    let turned = std::mem::take(&mut lowering.turned);
    let clips = std::mem::take(&mut lowering.clips);
    let one_sided = std::mem::take(&mut lowering.one_sided);
    let colorless: Vec<MeshId> = std::mem::take(&mut lowering.meshes).into_values().collect();
    let projectors = std::mem::take(&mut lowering.projectors);
    let numbers = std::mem::take(&mut lowering.numbers);
    let raw_colors = std::mem::take(&mut lowering.raw_colors);
    let draft = UnfinishedScene::new(
        LoweredScene {
            scene: lowering.scene,
            source_spans: lowering.source_spans,
        },
        lowering.pending,
    );
    let mut lowered = assets::load(draft, file, options, map, sink);
    // The colours of vertices show only where a texture asks for them.
    for MeshId(mesh) in colorless {
        if let Some(mesh) = lowered.scene.meshes.get_mut(mesh as usize) {
            mesh.colors = VertexColumn::default();
        }
    }
    number::read_raw_colors(&mut lowered.scene, &raw_colors, map.budget(), sink);
    number::read_numbers(&mut lowered.scene, &numbers, map.budget(), sink);
    shape::turn_round(&mut lowered.scene, &turned);
    one_sided::cover_backs(&mut lowered, &one_sided, sink);
    shape::flatten(&mut lowered.scene, &flat);
    clip::report_clipped(&lowered.scene, &clips, sink);
    for (light, node) in projectors {
        emitter::fit_projector(&mut lowered.scene, light, &node);
    }
    lowered.source_spans.finish();
    Some(lowered)
}

/// Why a mesh file is not read.
enum MeshReadError {
    /// The file is damaged, with the error.
    Damaged(String),
    Limit(LimitExceeded),
}

impl MeshReadError {
    fn damaged(error: &str) -> Self {
        Self::Damaged(error.to_owned())
    }
}

impl From<io::Error> for MeshReadError {
    fn from(_: io::Error) -> Self {
        Self::damaged("its compressed data are damaged or too short")
    }
}

impl From<LimitExceeded> for MeshReadError {
    fn from(exceeded: LimitExceeded) -> Self {
        Self::Limit(exceeded)
    }
}

impl From<TextParseError> for MeshReadError {
    fn from(error: TextParseError) -> Self {
        match error {
            TextParseError::Limit(exceeded) => Self::Limit(exceeded),
            TextParseError::Faults(faults) => {
                let messages = faults.into_iter().map(|fault| fault.message);
                Self::Damaged(messages.collect::<Vec<_>>().join("; "))
            }
        }
    }
}

/// A scene while it is lowered.
struct Lowering<'run> {
    scene: Scene,
    source_spans: SourceSpans,
    pending: Vec<PendingAsset>,
    search: FileSearch,
    map: &'run mut SourceMap,
    sink: &'run mut DiagnosticSink,
    /// The shared elements, such as `<bsdf id="…">`, by id.
    shared: BTreeMap<&'run str, &'run PluginNode>,
    /// Materials that were lowered, by the span of their element and what else distinguishes them.
    materials: BTreeMap<bsdf::MaterialKey, Option<MaterialId>>,
    /// The participating media, by the span of their element.
    media: BTreeMap<Span, Option<Medium>>,
    /// Whether the integrator knows no media.
    ignores_media: bool,
    /// Images and meshes that are pending, by path.
    images: BTreeMap<String, ImageId>,
    meshes: BTreeMap<String, MeshId>,
    /// The bytes of `.serialized` files by path, as each may have many meshes.
    files: BTreeMap<String, Option<Rc<[u8]>>>,
    /// The meshes of `.serialized` files, by path and index.
    serialized: BTreeMap<(String, u32), Option<MeshId>>,
    /// The meshes of PLY files whose colours are a texture, by path and whether those of faces.
    colored: BTreeMap<(String, bool), Option<MeshId>>,
    /// The meshes of shapes without a file, by name.
    built: BTreeMap<&'static str, MeshId>,
    /// The surfaces without vertex normals, by index.
    flat: BTreeSet<usize>,
    /// The surfaces whose meshes are turned round, by index.
    turned: BTreeSet<usize>,
    /// The clip planes of the sensor.
    clips: Vec<clip::ClipPlane>,
    /// The lights that emit on one side.
    one_sided: Vec<one_sided::OneSided>,
    /// The material of backs that scatter no light.
    black: Option<MaterialId>,
    /// What is inside BSDFs and textures, by their span.
    contents: BTreeMap<Span, one_sided::BsdfContents<'run>>,
    /// The BSDFs that were lowered, by their span and whether v points down.
    standards: BTreeMap<(Span, bool), Option<Standard>>,
    /// The textures of numbers.
    numbers: Vec<number::NumberTexture>,
    /// The textures of colours that are not coded as sRGB.
    raw_colors: Vec<(TextureId, Span)>,
    /// Whether the budget is exceeded, which is reported once.
    is_exhausted: bool,
    has_sensor: bool,
    /// The projectors, by the index of the light.
    projectors: Vec<(usize, PluginNode)>,
    /// The folders of `<path>`.
    paths: Vec<&'run str>,
    /// The files as the scene names them, and where they were found.
    located: BTreeMap<String, String>,
}

impl<'run> Lowering<'run> {
    fn new(
        root: &'run PluginNode,
        search: FileSearch,
        map: &'run mut SourceMap,
        sink: &'run mut DiagnosticSink,
    ) -> Self {
        let mut shared: BTreeMap<&str, &PluginNode> = BTreeMap::new();
        root.visit(&mut |node| {
            let target = match node.tag.as_str() {
                "alias" => shared.get(node.plugin.text.as_str()).copied(),
                _ => Some(node),
            };
            if let (Some(id), Some(target)) = (&node.id, target) {
                shared.insert(id.text.as_str(), target);
            }
        });
        Self {
            scene: Scene::new(sensor::default_camera(), sensor::default_settings()),
            source_spans: SourceSpans::default(),
            pending: Vec::new(),
            search,
            map,
            sink,
            shared,
            materials: BTreeMap::new(),
            media: BTreeMap::new(),
            ignores_media: false,
            images: BTreeMap::new(),
            meshes: BTreeMap::new(),
            serialized: BTreeMap::new(),
            colored: BTreeMap::new(),
            built: BTreeMap::new(),
            flat: BTreeSet::new(),
            turned: BTreeSet::new(),
            clips: Vec::new(),
            one_sided: Vec::new(),
            black: None,
            contents: BTreeMap::new(),
            standards: BTreeMap::new(),
            numbers: Vec::new(),
            raw_colors: Vec::new(),
            is_exhausted: false,
            has_sensor: false,
            projectors: Vec::new(),
            located: BTreeMap::new(),
            files: BTreeMap::new(),
            paths: root
                .children
                .iter()
                .filter(|node| node.tag == "path")
                .map(|node| node.plugin.text.as_str())
                .collect(),
        }
    }

    /// Lowers the children of the root. The integrator comes first, as sensors hold samples.
    fn scene(&mut self, root: &'run PluginNode) {
        self.record(EntityKind::Settings, 0, root.span);
        for node in root.children.iter().filter(|node| node.tag == "integrator") {
            self.integrator(node);
        }
        for node in &root.children {
            match node.tag.as_str() {
                "integrator" | "bsdf" | "texture" | "path" | "ref" | "alias" => {}
                "spectrum" | "rgb" | "srgb" => {}
                // What shapes and media refer to.
                "medium" | "phase" | "volume" => {}
                // An area light that shapes refer to.
                "emitter" if node.plugin.text == "area" => {}
                "sensor" => self.sensor(node),
                "emitter" => self.emitter(node),
                "shape" => self.shape(node, AffineTransform::IDENTITY),
                _ => self.ignored_element(node),
            }
        }
        if !self.has_sensor {
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, "the scene has no sensor");
            self.sink.push(diagnostic.at(root.span, "add a `<sensor>`"));
        }
        self.report_unused(root);
    }

    fn record(&mut self, entity: EntityKind, index: usize, span: Span) {
        let path = ValuePath::new(entity, index, EntityField::Whole);
        self.source_spans.record(path, span);
    }

    /// Whether a reference leads to an element of this kind.
    fn refers_to(&self, reference: &PluginNode, tag: &str) -> bool {
        let target = self.shared.get(reference.plugin.text.as_str());
        target.is_some_and(|target| target.tag == tag)
    }

    /// The BSDF of a shape, if it has one.
    fn bsdf_of(&mut self, shape: &'run PluginNode) -> Option<&'run PluginNode> {
        let is_bsdf = |node: &&'run PluginNode| node.tag == "bsdf" || self.refers_to(node, "bsdf");
        let node = shape.children.iter().find(is_bsdf)?;
        self.resolve(node)
    }

    /// Charges a resource. If the budget is exceeded, that is reported once.
    fn charge(&mut self, resource: Resource, amount: u64, span: Span) -> Option<()> {
        let charged = self.map.budget().charge(resource, amount);
        let Err(fault) = charged else {
            return Some(());
        };
        if !self.is_exhausted {
            self.sink.push(over_limit("the scene", &fault).at(span, ""));
        }
        self.is_exhausted = true;
        None
    }

    /// The element to which a reference or another name leads.
    fn shared_node(&self, node: &PluginNode) -> Option<&'run PluginNode> {
        let is_reference = matches!(node.tag.as_str(), "ref" | "alias");
        let target = self.shared.get(node.plugin.text.as_str()).copied();
        target.filter(|_| is_reference)
    }

    /// Follows a reference to the shared element; one that leads nowhere is reported apart.
    fn resolve(&self, node: &'run PluginNode) -> Option<&'run PluginNode> {
        match node.tag.as_str() {
            "ref" => self.shared_node(node),
            _ => Some(node),
        }
    }

    /// Warns of a plugin that is left out or replaced.
    fn unsupported(&mut self, node: &PluginNode, consequence: &str) {
        let message = match node.plugin.text.as_str() {
            "" => format!("`<{}>` is not supported: {consequence}", clip(&node.tag)),
            plugin => format!(
                "the {} `{}` is not supported: {consequence}",
                clip(&node.tag),
                clip(plugin)
            ),
        };
        let diagnostic = Diagnostic::new(&codes::MITSUBA_PLUGIN, message);
        self.sink.push(diagnostic.at(node.plugin.span, ""));
    }

    /// Warns of a plugin that is shown approximately.
    fn approximate(&mut self, span: Span, message: impl Into<String>) {
        let diagnostic = Diagnostic::new(&codes::MITSUBA_APPROXIMATE, message);
        self.sink.push(diagnostic.at(span, ""));
    }

    fn ignored_element(&mut self, node: &PluginNode) {
        let message = format!("`<{}>` has no effect here", clip(&node.tag));
        let diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
        self.sink.push(diagnostic.at(node.span, ""));
    }

    /// Warns of what is read, and is probably not what was meant.
    fn doubtful(&mut self, span: Span, message: impl Into<String>) {
        let diagnostic = Diagnostic::new(&codes::MITSUBA_DOUBTFUL, message);
        self.sink.push(diagnostic.at(span, ""));
    }

    /// A colour: a property, or what it refers to.
    fn color(&self, node: &'run PluginNode, name: &str) -> Option<[f64; 3]> {
        let referred = || self.resolve(node.child(name)?)?.constant();
        node.color(name).or_else(referred)
    }

    /// A file as the scene names it, below the first folder of `<path>` that has it.
    fn located(&mut self, name: &SpannedText) -> SpannedText {
        /// The work of looking for a file in a folder, in nodes.
        const LOOKUP: u64 = 16;
        const ANY: FileKind = FileKind {
            extensions: &[],
            begins: |_| true,
        };
        if let Some(known) = self.located.get(&name.text) {
            let text = known.clone();
            return SpannedText { text, ..*name };
        }
        let mut text = name.text.clone();
        for folder in self.paths.clone() {
            if self.charge(Resource::Nodes, LOOKUP, name.span).is_none() {
                break;
            }
            let path = format!("{folder}/{}", name.text).replace('\\', "/");
            if self.search.above(&path, Some(&ANY)).is_ok() {
                text = path;
                break;
            }
        }
        self.located.insert(name.text.clone(), text.clone());
        SpannedText { text, ..*name }
    }

    /// An image of one pixel that waits for its file.
    fn image(&mut self, path: &SpannedText, target: fn(ImageId) -> AssetTarget) -> ImageId {
        let path = &self.located(path);
        if let Some(id) = self.images.get(&path.text) {
            return *id;
        }
        let id = self.scene.add_image(Image {
            name: path.text.clone(),
            width: 1,
            height: 1,
            kind: Pixels::Rgb8,
            pixels: vec![128; 3].into(),
        });
        self.record(EntityKind::Image, id.0 as usize, path.span);
        self.images.insert(path.text.clone(), id);
        self.pending.push(PendingAsset {
            target: target(id),
            path: path.text.clone(),
            span: Some(path.span),
        });
        id
    }

    /// An empty mesh that waits for its file.
    fn mesh_file(&mut self, path: &SpannedText) -> MeshId {
        let path = &self.located(path);
        if let Some(id) = self.meshes.get(&path.text) {
            return *id;
        }
        let id = self.add_mesh(Mesh {
            name: path.text.clone(),
            ..Mesh::default()
        });
        self.record(EntityKind::Mesh, id.0 as usize, path.span);
        self.meshes.insert(path.text.clone(), id);
        self.pending.push(PendingAsset {
            target: AssetTarget::Mesh(id),
            path: path.text.clone(),
            span: Some(path.span),
        });
        id
    }

    /// A mesh of a `.serialized` file.
    fn serialized_mesh(&mut self, path: &SpannedText, index: u32) -> Option<MeshId> {
        let path = &self.located(path);
        let key = (path.text.clone(), index);
        if let Some(known) = self.serialized.get(&key) {
            return *known;
        }
        let parse = |bytes: &[u8], budget: &Budget| {
            let mesh = serialized::read(bytes, index, budget)?;
            Ok((mesh, None))
        };
        let bytes = match self.files.get(&path.text) {
            Some(known) => known.clone(),
            None => {
                let bytes = self.file_bytes(path, &serialized::KIND).map(Rc::from);
                self.files.insert(path.text.clone(), bytes.clone());
                bytes
            }
        };
        let id = bytes.and_then(|bytes| self.read_mesh(path, &bytes, parse));
        self.serialized.insert(key, id);
        id
    }

    /// A PLY with the colours of its vertices or faces, which are a texture there.
    fn colored_mesh(&mut self, path: &SpannedText, colors: PlyColors) -> Option<MeshId> {
        const PLY: FileKind = FileKind {
            extensions: &["ply"],
            begins: |head| head.starts_with(b"ply"),
        };
        let path = &self.located(path);
        let key = (path.text.clone(), colors == PlyColors::Faces);
        if let Some(known) = self.colored.get(&key) {
            return *known;
        }
        let parse = |bytes: &[u8], budget: &Budget| {
            let parsed = parse_colored_ply(bytes, colors, budget)?;
            let loss = parsed.loss();
            Ok((parsed.mesh, loss))
        };
        let bytes = self.file_bytes(path, &PLY);
        let id = bytes.and_then(|bytes| self.read_mesh(path, &bytes, parse));
        self.colored.insert(key, id);
        id
    }

    /// A mesh that is read at once; errors, and what is not drawn of it, are reported.
    fn read_mesh(
        &mut self,
        path: &SpannedText,
        bytes: &[u8],
        parse: impl Fn(&[u8], &Budget) -> Result<(Mesh, Option<String>), MeshReadError>,
    ) -> Option<MeshId> {
        let diagnostic = match parse(bytes, self.map.budget()) {
            Ok((mesh, loss)) => {
                if let Some(message) = loss {
                    let diagnostic = Diagnostic::new(&codes::NOT_DRAWN, message);
                    self.sink.push(diagnostic.at(path.span, "named here"));
                }
                let id = self.add_mesh(mesh);
                self.record(EntityKind::Mesh, id.0 as usize, path.span);
                return Some(id);
            }
            Err(MeshReadError::Limit(limit)) => over_limit("the mesh", &limit),
            Err(MeshReadError::Damaged(why)) => {
                let name = clip_path(&path.text);
                let message = format!("the mesh `{name}` cannot be read: {why}");
                Diagnostic::new(&codes::BAD_MESH_FILE, message)
            }
        };
        self.sink.push(diagnostic.at(path.span, "named here"));
        None
    }

    /// The bytes of a file that is read at once; errors are reported.
    fn file_bytes(&mut self, path: &SpannedText, kind: &FileKind) -> Option<Vec<u8>> {
        let name = clip_path(&path.text);
        let diagnostic = match self.search.find(&path.text, kind) {
            Err(_) => {
                let message = format!("there is no file `{name}`");
                Diagnostic::new(&codes::FILE_NOT_FOUND, message)
            }
            Ok(found) => match Loader.found(&found, serialized::MAX_BYTES, self.map) {
                Err(error) => {
                    let message = format!("can't read `{name}`: {error}");
                    Diagnostic::new(&codes::CANNOT_READ, message)
                }
                Ok(bytes) => return Some(bytes),
            },
        };
        self.sink.push(diagnostic.at(path.span, "named here"));
        None
    }

    fn add_mesh(&mut self, mesh: Mesh) -> MeshId {
        self.scene.meshes.push(mesh);
        MeshId(u32::try_from(self.scene.meshes.len() - 1).unwrap_or(u32::MAX))
    }

    fn settings(&mut self) -> &mut Settings {
        &mut self.scene.settings
    }
}
