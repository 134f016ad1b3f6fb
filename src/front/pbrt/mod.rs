//! The scene format of pbrt (versions 3 and 4) lowered to the IR.
//!
//! ```text
//! bytes ─ token ─▶ parameter ─▶ directive (state) ─ camera, material, light, shape ─▶ LoweredScene
//! ```
//!
//! - [`token`] splits the text into words with their spans, [`parameter`] reads typed parameters.
//! - [`plugins`] lists the directives, and all plugins with their parameters, for the reader and for
//!   editors; [`completion`] is what these propose at a place of a text.
//! - [`directive`] reads a file and its included files, one directive after the other, and keeps
//!   the graphics state of [`state`]: transform, material, area light, attributes.
//! - [`camera`], [`material`], [`texture`], [`light`] and [`shape`] lower one kind of plugin each.
//!   Names of version 3 (`matte`, `Kd`, `mapname`) have the meaning that they had there. A plugin
//!   that is not supported is replaced by the closest one, and a parameter without effect is
//!   ignored, both with a warning: the picture is made all the same.
//! - [`file`](mod@file) finds and reads the files that a scene names. If one is missing, a warning
//!   names the replacement, and the scene is still rendered.
//!
//! Every scene is path-traced. Colours are linear Rec. 709; spectra are converted to it when they
//! are read. pbrt's camera is left-handed: the picture shows +x of the camera on its right.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "a value of another type counts as none"
)]

mod camera;
pub(crate) mod completion;
mod directive;
mod equal_area;
mod file;
mod image;
mod light;
mod loop_subdivision;
mod material;
mod medium;
mod parameter;
// A table, one entry a line.
#[rustfmt::skip]
pub(crate) mod plugins;
mod shape;
mod spectrum;
mod state;
mod texture;
mod token;

use crate::exchange::texture::SampledTextures;
use crate::exchange::{SpannedText, transform::AffineTransform};
use crate::plugin::PluginKind;
use crate::{FrontOptions, over_limit};
use parameter::Parameters;
use rtc_diag::{Code, Diagnostic, DiagnosticSink, clip, codes, nearest};
use rtc_ir::{
    EntityField, EntityKind, ImageId, LoweredScene, MaterialId, Medium, Mesh, MeshId, Scene,
    SourceSpans, ValuePath,
};
use rtc_source::{FileId, FileSearch, LimitExceeded, Resource, SourceMap, Span};
use shape::PlacedShape;
use state::{GraphicsState, StateStack};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use texture::ScaledTexture;
use token::TokenReader;

/// Whether a file is a scene of pbrt, or a part of one: by its name, or by the first directive of
/// its text, which may be compressed.
#[must_use]
pub fn is_pbrt(name: &str, bytes: &[u8]) -> bool {
    is_pbrt_gzip(name, bytes)
        || !file::is_gzip(bytes)
            && (name.to_ascii_lowercase().ends_with(".pbrt") || directive::begins_scene(bytes))
}

/// Whether a file is such a scene, compressed by gzip.
pub(crate) fn is_pbrt_gzip(name: &str, bytes: &[u8]) -> bool {
    file::is_gzip(bytes)
        && (name.to_ascii_lowercase().ends_with(".pbrt.gz")
            || directive::begins_scene(&file::inflated_head(bytes)))
}

/// Whether such a file is a scene by itself, not a file that another one includes: it has a camera
/// or a world.
#[must_use]
pub fn is_whole(bytes: &[u8]) -> bool {
    if file::is_gzip(bytes) {
        return directive::has_view(&file::inflated_head(bytes));
    }
    directive::has_view(bytes)
}

/// Lowers a scene. Files that it includes come into the map; meshes and pictures are loaded.
///
/// `None` if the file cannot be unpacked, or exceeds the budget; the sink has the error.
pub fn lower(
    file: FileId,
    map: &mut SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<LoweredScene> {
    let folder = map.folder(file);
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut lowering = Lowering::new(search, map, sink);
    lowering.read(file)?;
    lowering.finish();
    let mut lowered = LoweredScene {
        scene: lowering.scene,
        source_spans: lowering.source_spans,
    };
    lowered.source_spans.finish();
    Some(lowered)
}

/// A scene while it is lowered.
struct Lowering<'run> {
    scene: Scene,
    source_spans: SourceSpans,
    search: FileSearch,
    map: &'run mut SourceMap,
    sink: &'run mut DiagnosticSink,
    /// Whether the text is one of version 3: it has a `WorldEnd`.
    is_version_3: bool,
    state: GraphicsState,
    stack: StateStack,
    /// The coordinate systems by name: the map from each to the world.
    systems: BTreeMap<String, AffineTransform>,
    view: camera::ViewDirectives,
    in_world: bool,
    /// The factor of all light by the film: its `scale`, or its `iso` and the exposure.
    exposure: f64,
    materials: BTreeMap<String, Rc<material::LoweredMaterial>>,
    /// The participating media by name; none for one that is left out.
    media: BTreeMap<String, Option<Medium>>,
    /// Whether the integrator knows no media.
    ignores_media: bool,
    material_count: usize,
    /// The materials of the IR: a material with an emission and an opacity.
    placed_materials: BTreeMap<material::EmittingMaterialKey, MaterialId>,
    /// The materials that a map of an opacity covers, by their index and the map.
    covered_materials: BTreeMap<(usize, String), Rc<material::LoweredMaterial>>,
    colors: BTreeMap<String, ScaledTexture>,
    floats: BTreeMap<String, ScaledTexture>,
    images: BTreeMap<image::ImageKey, Option<ImageId>>,
    textures: SampledTextures,
    /// The images of normals by their paths.
    normal_images: BTreeMap<String, Option<ImageId>>,
    meshes: BTreeMap<String, Option<MeshId>>,
    objects: BTreeMap<String, Rc<Vec<PlacedShape>>>,
    /// The object between `ObjectBegin` and `ObjectEnd`.
    open_object: Option<(SpannedText, Vec<PlacedShape>)>,
    /// The files that are open, the innermost last.
    files: Vec<file::OpenFile>,
    /// The number of included files.
    included: usize,
    /// The number of searched files.
    lookups: usize,
    /// The included files by the paths that the scene names; none without a file.
    parts: BTreeMap<String, Option<TokenReader>>,
    /// The same by their canonical paths.
    texts: BTreeMap<PathBuf, TokenReader>,
    spectra: BTreeMap<String, spectrum::SpectrumPairs>,
    /// Whether the budget is used up, so that the rest is not read.
    is_exhausted: bool,
}

impl<'run> Lowering<'run> {
    fn new(search: FileSearch, map: &'run mut SourceMap, sink: &'run mut DiagnosticSink) -> Self {
        Self {
            scene: Scene::new(camera::default_camera(), camera::default_settings()),
            source_spans: SourceSpans::default(),
            search,
            map,
            sink,
            is_version_3: false,
            state: GraphicsState::default(),
            stack: StateStack::default(),
            systems: BTreeMap::new(),
            view: camera::ViewDirectives::default(),
            in_world: false,
            exposure: 1.0,
            materials: BTreeMap::new(),
            media: BTreeMap::new(),
            ignores_media: false,
            material_count: 0,
            placed_materials: BTreeMap::new(),
            covered_materials: BTreeMap::new(),
            colors: BTreeMap::new(),
            floats: BTreeMap::new(),
            images: BTreeMap::new(),
            textures: SampledTextures::default(),
            normal_images: BTreeMap::new(),
            meshes: BTreeMap::new(),
            objects: BTreeMap::new(),
            open_object: None,
            files: Vec::new(),
            included: 0,
            lookups: 0,
            parts: BTreeMap::new(),
            texts: BTreeMap::new(),
            spectra: BTreeMap::new(),
            is_exhausted: false,
        }
    }

    fn record(&mut self, entity: EntityKind, index: usize, span: Span) {
        let path = ValuePath::new(entity, index, EntityField::Whole);
        self.source_spans.record(path, span);
    }

    fn report(&mut self, code: &'static Code, span: Span, message: impl Into<String>) {
        self.sink.push(Diagnostic::new(code, message).at(span, ""));
    }

    /// Reports a mistake of the scene.
    fn mistake(&mut self, span: Span, message: impl Into<String>) {
        self.report(&codes::PBRT_VALUE, span, message);
    }

    /// Warns of what pbrt goes on after, and is probably not what was meant.
    fn doubtful(&mut self, span: Span, message: impl Into<String>) {
        self.report(&codes::PBRT_DOUBTFUL, span, message);
    }

    /// Warns of an approximation.
    fn approximate(&mut self, span: Span, message: impl Into<String>) {
        self.report(&codes::PBRT_APPROXIMATE, span, message);
    }

    /// Warns of a plugin that is left out or replaced by another one of the table.
    fn unsupported(&mut self, kind: &str, plugin: &SpannedText, table: &PluginKind, instead: &str) {
        let name = clip(&plugin.text);
        let message = format!("the {kind} `{name}` is not supported: {instead}");
        let mut diagnostic = Diagnostic::new(&codes::PBRT_PLUGIN, message).at(plugin.span, "");
        if let Some(near) = nearest(&plugin.text, table.names()) {
            diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
        }
        self.sink.push(diagnostic);
    }

    /// Warns of the parameters that were not read. The table has all that were.
    fn ignored(
        &mut self,
        kind: &str,
        plugin: &str,
        (table, parameters): (&PluginKind, &Parameters),
    ) {
        /// The maximum number of names that are searched for similar spellings.
        const COMPARED: usize = 32;
        let (unused, looked_up) = parameters.unused();
        debug_assert!(
            table.has_all(plugin, &looked_up),
            "not in the table: one of {looked_up:?} of the {kind} `{plugin}`"
        );
        for (count, parameter) in unused.into_iter().enumerate() {
            let plugin = clip(plugin);
            let name = &parameter.name;
            let own = clip(&name.text);
            let is_known = looked_up.contains(&name.text.as_str());
            let message = match is_known {
                true => format!(
                    "`{own}` of the {kind} `{plugin}` is no `{}`: it has no effect",
                    parameter.kind.name()
                ),
                false => format!("`{own}` of the {kind} `{plugin}` has no effect"),
            };
            let mut diagnostic = Diagnostic::new(&codes::PBRT_IGNORED, message).at(name.span, "");
            let known = looked_up
                .iter()
                .copied()
                .filter(|_| count < COMPARED && !is_known);
            if let Some(near) = nearest(&name.text, known) {
                diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
            }
            self.sink.push(diagnostic);
        }
    }

    /// Charges the budget. If it is exceeded, that is reported and reading ends.
    fn charge(&mut self, resource: Resource, amount: u64, span: Span) -> Option<()> {
        let charged = self.map.budget().charge(resource, amount);
        charged.map_err(|fault| self.exhaust(&fault, span)).ok()
    }

    fn exhaust(&mut self, fault: &LimitExceeded, span: Span) {
        if !self.is_exhausted {
            self.sink.push(over_limit("the scene", fault).at(span, ""));
        }
        self.is_exhausted = true;
    }

    /// Adds a mesh whose memory is charged.
    fn add_mesh(&mut self, mesh: Mesh, span: Span) -> MeshId {
        let index = self.scene.meshes.len();
        self.record(EntityKind::Mesh, index, span);
        self.scene.meshes.push(mesh);
        MeshId(u32::try_from(index).unwrap_or(u32::MAX))
    }
}
