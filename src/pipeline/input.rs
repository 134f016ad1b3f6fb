//! A scene from its files to validation, with its diagnostics.

use super::{ExportFormat, Options, SourceKind, load, stage, validate};
use rtc_diag::{Diagnostic, DiagnosticSink, codes};
use rtc_emit::{self as emit, ExportedScene, gltf::GltfAsset};
use rtc_front::{gltf, pixels};
use rtc_ir::{EntityField, EntityKind, Light, LoweredScene, Scene, SourceSpans, ValuePath};
use rtc_passes::{EnvironmentOverride, FillLight, Framing, SceneKind, StudioChoice, ViewAndLight};
use rtc_source::tree::DetachedTree;
use rtc_source::{ByteLimit, FileId, LoadError, Loader, MemoryFiles, Resource, SourceMap, Span};
use rtc_valid::ValidScene;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// The maximum size of an environment image in bytes: that of 32-bit floats with the maximum number
/// of pixels.
const MAX_ENVIRONMENT: u64 = 1 << 29;

/// Only the first copy of an input reads files.
const UNSHARED: &str = "files are read before an input is copied";

/// A scene that was read, could not be read, or was built in code. A copy shares the files and has
/// diagnostics of its own.
#[derive(Clone)]
pub struct Input {
    /// The name of the scene in messages.
    name: String,
    map: Arc<SourceMap>,
    sink: DiagnosticSink,
    file: Option<FileId>,
    options: Options,
    /// The overrides of view and light; `None` for a scene that is not rendered.
    stage: Option<ViewAndLight>,
}

/// A lowered scene, before overrides of view and light.
#[derive(Clone)]
pub struct LoadedScene {
    /// The scene with its source spans.
    pub lowered: LoweredScene,
    /// Whether it is an asset: glTF, or a mesh.
    is_asset: bool,
    /// Whether it has a camera of its own, which an asset may lack.
    has_camera: bool,
}

impl LoadedScene {
    /// A scene that was built in code.
    #[must_use]
    pub fn built(scene: Scene) -> Self {
        Self {
            lowered: LoweredScene {
                scene,
                source_spans: SourceSpans::default(),
            },
            is_asset: false,
            has_camera: true,
        }
    }

    /// Whether it has a camera of its own.
    #[must_use]
    pub fn has_camera(&self) -> bool {
        !self.is_asset || self.has_camera
    }

    /// Replaces the scene. From now on its camera is its own if `has_camera`.
    pub fn replace(&mut self, lowered: LoweredScene, has_camera: bool) {
        self.lowered = lowered;
        self.has_camera |= has_camera;
    }
}

/// A scene that was validated, with the IR that it was validated from.
pub struct ValidatedScene {
    /// The IR with its source spans.
    pub lowered: LoweredScene,
    /// The valid scene.
    pub scene: ValidScene,
}

/// The origin of a scene, and the choices made for it.
pub struct Provenance {
    /// Whether it is an asset: glTF, or a mesh.
    pub is_asset: bool,
    /// Whether it is an asset with lights that are not removed.
    pub is_lit_asset: bool,
    /// Whether all its materials are unlit.
    pub is_unlit: bool,
    /// Whether the studio may still add light to its own.
    pub fill: FillLight,
    /// Whether lamps may be added in closed rooms.
    pub adds_lamps: bool,
    /// The choice of its view, if it has none.
    pub framing: Option<Framing>,
}

impl Input {
    /// Reads the file at `path`.
    #[must_use]
    pub fn file(path: &Path, options: Options) -> Self {
        let name = path.display().to_string();
        Self::new(name, options, |_, map| Loader.file(path, map))
    }

    /// Reads these bytes as the content of the file at `path`.
    #[must_use]
    pub fn edited(path: &Path, bytes: Vec<u8>, options: Options) -> Self {
        let name = path.display().to_string();
        Self::new(name, options, |_, map| Ok(map.add_from(path, bytes)))
    }

    /// As [`Self::edited`], of a text of YAML or JSON that was parsed without a mistake.
    #[must_use]
    pub fn parsed(path: &Path, bytes: Vec<u8>, tree: Arc<DetachedTree>, options: Options) -> Self {
        let name = path.display().to_string();
        Self::new(name, options, |_, map| {
            let file = map.add_from(path, bytes);
            map.keep_tree(file, tree);
            Ok(file)
        })
    }

    /// Reads all of `reader`, for example standard input, under a name.
    #[must_use]
    pub fn reader(name: String, reader: impl Read, options: Options) -> Self {
        Self::new(name, options, |name, map| Loader.reader(name, reader, map))
    }

    /// Reads the scene at `path` from files in memory; it may refer to the others.
    #[must_use]
    pub fn memory(path: &str, files: MemoryFiles, options: Options) -> Self {
        let files = Arc::new(files);
        let name = path.to_owned();
        Self::new(name, options, |name, map| Loader.memory(name, &files, map))
    }

    fn new(
        name: String,
        options: Options,
        read: impl FnOnce(&str, &mut SourceMap) -> Result<FileId, LoadError>,
    ) -> Self {
        let limits = options.valid.limits;
        let map = SourceMap::with_limits(limits).with_edited(options.edited.clone());
        let map = match options.is_recorded {
            true => map.recording(),
            false => map,
        };
        let (mut map, mut sink) = (map, options.sink());
        let file = read(&name, &mut map);
        let file = file
            .map_err(|error| sink.push(unreadable(&name, &error)))
            .ok();
        Self {
            name,
            map: Arc::new(map),
            sink,
            file,
            options,
            stage: None,
        }
    }

    /// The input of a scene that was built in code: there is no file.
    #[must_use]
    pub fn built(name: String, options: Options) -> Self {
        let map = SourceMap::with_limits(options.valid.limits);
        Self {
            name,
            map: Arc::new(map),
            sink: options.sink(),
            file: None,
            options,
            stage: None,
        }
    }

    /// Reads an environment image; errors in it become diagnostics.
    ///
    /// # Errors
    /// A message, if the file can't be read.
    pub fn environment(&mut self, path: &Path) -> Result<Option<EnvironmentOverride>, String> {
        let name = path.display().to_string();
        let bytes = Loader.bytes(path, MAX_ENVIRONMENT, &self.map);
        let bytes = bytes.map_err(|error| format!("can't read `{name}`: {error}"))?;
        // The path is not part of the scene.
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let picture = pixels::environment(&file, &bytes, self.map.budget());
        Ok(picture
            .map_err(|fault| self.push(pixels::environment_rejection(&fault, &name)))
            .map(EnvironmentOverride::Picture)
            .ok())
    }

    /// Sets overrides of view and light.
    pub fn stage(&mut self, stage: ViewAndLight) {
        self.stage = Some(stage);
    }

    /// Removes the overrides of view and light.
    pub fn unstage(&mut self) {
        self.stage = None;
    }

    /// Changes the overrides of view and light.
    pub fn restage(&mut self, change: impl FnOnce(&mut ViewAndLight)) {
        self.stage.as_mut().map(change);
    }

    /// Sets the number of threads for loading, 0 for one per core.
    pub fn use_threads(&mut self, threads: usize) {
        self.options.front.threads = threads;
    }

    /// Lowers the scene. Call it once: loading may release the bytes of its files.
    pub fn load(&mut self) -> Option<LoadedScene> {
        // Detecting the format needs the whole file.
        let is_asset = self.is_asset();
        let map = Arc::get_mut(&mut self.map).expect(UNSHARED);
        let lowered = load(self.file?, map, &self.options, &mut self.sink)?;
        // An asset with its own settings is rendered like a scene text.
        let has_own = |entity| {
            let whole = ValuePath::new(entity, 0, EntityField::Whole);
            lowered.source_spans.span(whole).is_some()
        };
        Some(LoadedScene {
            is_asset: is_asset && !has_own(EntityKind::Settings),
            has_camera: has_own(EntityKind::Camera),
            lowered,
        })
    }

    /// Whether the input is an asset: glTF, or a mesh.
    fn is_asset(&self) -> bool {
        self.kind().is_some_and(SourceKind::is_asset)
    }

    /// The kind of the file; `None` if it was not read.
    fn kind(&self) -> Option<SourceKind> {
        let file = self.file?;
        Some(SourceKind::of(self.map.name(file), self.map.bytes(file)))
    }

    /// Whether it is a scene text whose images and meshes come from files that it refers to, not
    /// from an asset.
    #[must_use]
    pub fn has_original_files(&self, lowered: &LoweredScene) -> bool {
        let is_asset = |file| gltf::is_gltf(self.map.name(file), self.map.bytes(file));
        let of_asset = |entity, count| {
            let paths =
                (0..count).map(move |index| ValuePath::new(entity, index, EntityField::Whole));
            let mut spans = paths.filter_map(|path| lowered.source_spans.span(path));
            spans.any(|span| is_asset(span.file))
        };
        let Scene {
            images,
            meshes,
            materials,
            ..
        } = &lowered.scene;
        self.kind() == Some(SourceKind::Scene)
            && !of_asset(EntityKind::Image, images.len())
            && !of_asset(EntityKind::Mesh, meshes.len())
            && !of_asset(EntityKind::Material, materials.len())
    }

    /// Applies the overrides to a loaded scene, lets `change` modify it, and validates it.
    pub fn validate(
        &mut self,
        loaded: LoadedScene,
        change: impl FnOnce(&mut LoweredScene, &Provenance),
    ) -> Option<ValidatedScene> {
        let LoadedScene {
            mut lowered,
            is_asset,
            has_camera,
        } = loaded;
        let kind = match (is_asset, has_camera) {
            (false, _) => SceneKind::Text,
            (true, true) => SceneKind::Asset,
            // An asset without a camera gets a default camera.
            (true, false) => SceneKind::BareAsset,
        };
        let provenance = self.set_stage(&mut lowered, kind);
        change(&mut lowered, &provenance);
        let scene = validate(&lowered, &self.options, &mut self.sink)?;
        Some(ValidatedScene { lowered, scene })
    }

    fn set_stage(&mut self, lowered: &mut LoweredScene, kind: SceneKind) -> Provenance {
        let is_asset = kind != SceneKind::Text;
        let mut provenance = Provenance {
            is_asset,
            is_lit_asset: is_asset && lowered.scene.lights.iter().any(Light::emits),
            is_unlit: is_asset && lowered.scene.is_unlit(),
            fill: FillLight::Never,
            adds_lamps: false,
            framing: None,
        };
        let Some(overrides) = &self.stage else {
            return provenance;
        };
        let is_darkened = overrides.environment == Some(EnvironmentOverride::Color([0.0; 3]));
        provenance.adds_lamps = overrides.studio != StudioChoice::Off && !is_darkened;
        provenance.is_lit_asset &= !overrides.without_lights;
        if let Some(staged) = stage(lowered, overrides, kind, &mut self.sink) {
            // A scene text that has its own light keeps it.
            let has_own_light = staged.fill == FillLight::IfDim && !is_asset;
            provenance.fill = if has_own_light {
                FillLight::Never
            } else {
                staged.fill
            };
            provenance.framing = staged.framing;
        }
        provenance
    }

    /// The scene as glTF, in one file or with sidecar files in `folder`; `None` if it can't be
    /// exported, with an error diagnostic.
    pub fn gltf(
        &mut self,
        lowered: &LoweredScene,
        tolerance: Option<f64>,
        folder: Option<&str>,
    ) -> Option<GltfAsset> {
        let (
            LoweredScene {
                scene,
                source_spans,
            },
            budget,
        ) = (lowered, self.map.budget());
        emit::gltf::emit(
            scene,
            source_spans,
            tolerance,
            folder,
            budget,
            &mut self.sink,
        )
    }

    /// The scene as one of another renderer, with meshes and pictures in `folder`; without one it is
    /// a POV-Ray scene that lacks its pictures. `None` if it can't be exported, with an
    /// error diagnostic.
    pub fn export(
        &mut self,
        lowered: &LoweredScene,
        format: ExportFormat,
        folder: Option<&str>,
    ) -> Option<ExportedScene> {
        let LoweredScene {
            scene,
            source_spans,
        } = lowered;
        let budget = self.map.budget();
        match (format, folder) {
            (ExportFormat::Mitsuba, Some(folder)) => {
                emit::mitsuba::emit(scene, source_spans, folder, budget, &mut self.sink)
            }
            (ExportFormat::Pbrt, Some(folder)) => {
                emit::pbrt::emit(scene, source_spans, folder, budget, &mut self.sink)
            }
            _ => emit::pov::emit(scene, source_spans, folder, budget, &mut self.sink),
        }
    }

    /// The diagnostics since the last call.
    pub fn take_diagnostics(&mut self) -> DiagnosticSink {
        std::mem::replace(&mut self.sink, self.options.sink())
    }

    /// Replaces the diagnostics by earlier ones.
    pub fn restore_diagnostics(&mut self, found: DiagnosticSink) {
        self.sink = found;
    }

    /// Whether the file of the scene could be read.
    #[must_use]
    pub fn is_read(&self) -> bool {
        self.file.is_some()
    }

    /// The text of the scene; `None` if it could not be read or is not UTF-8.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        self.map.text(self.file?)
    }

    /// A summary of an asset before it is loaded; `None` for other scenes.
    #[must_use]
    pub fn asset(&self) -> Option<gltf::AssetSummary> {
        let file = self.file?;
        let is_asset = self.kind() == Some(SourceKind::Gltf);
        is_asset.then(|| gltf::summary(file, &self.map))?
    }

    /// Whether a span belongs to the text of the scene itself, not to a file that it refers to.
    #[must_use]
    pub fn is_own(&self, span: Span) -> bool {
        self.file == Some(span.file) && self.text().is_some()
    }

    /// Adds a text that is not part of the scene, for diagnostics about it.
    pub fn add_text(&mut self, path: &Path, bytes: Vec<u8>) -> FileId {
        let map = Arc::get_mut(&mut self.map).expect(UNSHARED);
        map.add(path.display().to_string(), bytes)
    }

    /// The file of the scene, if it could be read.
    pub fn file_id(&self) -> Option<FileId> {
        self.file
    }

    /// Adds a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.sink.push(diagnostic);
    }

    /// The limit on the rays of a picture.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.options.valid.limits.of(Resource::Rays, 0)
    }

    /// Removes the limit on rays.
    pub fn lift_rays(&mut self) {
        self.options.valid.limits.set(Resource::Rays, u64::MAX);
    }

    /// The file and the line at which a span starts.
    #[must_use]
    pub fn line(&self, span: Span) -> (&str, u32) {
        (
            self.map.name(span.file),
            self.map.line_column(span.file, span.start).line,
        )
    }

    /// Whether the file at a path was read: the scene, or a file that it refers to.
    #[must_use]
    pub fn has_read(&self, path: &Path) -> bool {
        self.map.has_read(path)
    }

    /// The name of the scene in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The source map.
    #[must_use]
    pub fn map(&self) -> &SourceMap {
        &self.map
    }
}

fn unreadable(name: &str, error: &LoadError) -> Diagnostic {
    match error {
        LoadError::Io(error) => {
            Diagnostic::new(&codes::CANNOT_READ, format!("can't read `{name}`: {error}"))
        }
        LoadError::TooLarge { limit } => {
            let limit = ByteLimit(*limit);
            let message = format!("`{name}` is larger than {limit}");
            Diagnostic::new(&codes::TOO_LARGE, message)
        }
        LoadError::NotRegular => {
            Diagnostic::new(&codes::CANNOT_READ, format!("can't read `{name}`: {error}"))
        }
    }
}
