//! A scene from its files to its proof, with what was found about it on the way.

use super::{Options, load, stage, validate};
use rtc_codec as codec;
use rtc_diag::{Diagnostic, Sink, codes};
use rtc_emit::{self as emit, ExportedScene, gltf::GltfAsset};
use rtc_front::{gltf, mesh, pixels};
use rtc_ir::{EntityKind, Field, Light, Lowered, Scene, ValuePath};
use rtc_passes::{EnvironmentOverride, FillLight, Framing, SceneKind, ViewAndLight};
use rtc_source::{FileId, LoadError, Loader, MemoryFiles, Resource, SourceMap, Span};
use rtc_valid::ValidScene;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// The largest picture of surroundings that is read, in bytes: one of 32-bit floats with every
/// pixel allowed.
const MAX_ENVIRONMENT: u64 = 1 << 29;

/// A scene that was read, or could not be.
pub struct Input {
    /// The name of the scene in messages.
    name: String,
    map: SourceMap,
    sink: Sink,
    file: Option<FileId>,
    options: Options,
    /// Its view and light; none for a scene that is not to be shown.
    stage: Option<ViewAndLight>,
}

/// A scene that was lowered, before its view and light are set.
#[derive(Clone)]
pub struct Loaded {
    /// The scene and where its values were written.
    pub lowered: Lowered,
    /// It is an asset: glTF, or a mesh.
    is_asset: bool,
}

/// A scene that was proven, and that from which it was.
pub struct Proven {
    /// The scene and where its values were written.
    pub lowered: Lowered,
    /// The proof.
    pub scene: ValidScene,
}

/// Where a scene comes from, and what was chosen for it.
pub struct Provenance {
    /// It is an asset: glTF, or a mesh.
    pub is_asset: bool,
    /// It is one with lights of its own, and they are not left out.
    pub is_lit_asset: bool,
    /// It is one of colours that no light changes.
    pub is_unlit: bool,
    /// Whether the studio is still to fill in, beside its own light.
    pub fill: FillLight,
    /// How its view was found, if it has none of its own.
    pub framing: Option<Framing>,
}

impl Input {
    /// Reads the file at `path`.
    #[must_use]
    pub fn file(path: &Path, options: Options) -> Self {
        let name = path.display().to_string();
        Self::new(name, options, |_, map| Loader.file(path, map))
    }

    /// Takes these bytes as if they were those of the file at `path`.
    #[must_use]
    pub fn edited(path: &Path, bytes: Vec<u8>, options: Options) -> Self {
        let name = path.display().to_string();
        Self::new(name, options, |_, map| Ok(map.add_from(path, bytes)))
    }

    /// Reads all of `reader`, for instance standard input, under the name given.
    #[must_use]
    pub fn reader(name: String, reader: impl Read, options: Options) -> Self {
        Self::new(name, options, |name, map| Loader.reader(name, reader, map))
    }

    /// Takes the scene at `path` of files in memory; it may name the others.
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
        let (mut map, mut sink) = (map, options.sink());
        let file = read(&name, &mut map);
        let file = file
            .map_err(|error| sink.push(unreadable(&name, &error)))
            .ok();
        Self {
            name,
            map,
            sink,
            file,
            options,
            stage: None,
        }
    }

    /// The surroundings in a file; what is wrong in it is a finding.
    ///
    /// # Errors
    /// If the file can't be read, in words.
    pub fn environment(&mut self, path: &Path) -> Result<Option<EnvironmentOverride>, String> {
        let name = path.display().to_string();
        let bytes = Loader.bytes(path, MAX_ENVIRONMENT, &self.map);
        let bytes = bytes.map_err(|error| format!("can't read `{name}`: {error}"))?;
        // Where the file lies is no part of the scene.
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let picture = pixels::environment(&file, &bytes, self.map.budget());
        Ok(picture
            .map_err(|fault| self.push(pixels::environment_rejection(&fault, &name)))
            .map(EnvironmentOverride::Picture)
            .ok())
    }

    /// Has it shown in the view and the light given.
    pub fn stage(&mut self, stage: ViewAndLight) {
        self.stage = Some(stage);
    }

    /// Has it not shown.
    pub fn unstage(&mut self) {
        self.stage = None;
    }

    /// Changes how it is shown.
    pub fn restage(&mut self, change: impl FnOnce(&mut ViewAndLight)) {
        self.stage.as_mut().map(change);
    }

    /// Loads it with so many threads, 0 for one per core.
    pub fn use_threads(&mut self, threads: usize) {
        self.options.front.threads = threads;
    }

    /// Lowers the scene, once: loading may release the bytes of its files.
    pub fn load(&mut self) -> Option<Loaded> {
        // What a file is, is seen from all of it.
        let is_asset = self.is_asset();
        let lowered = load(self.file?, &mut self.map, &self.options, &mut self.sink)?;
        // What says how its picture is made is shown so, as a scene text is.
        let settings = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
        let is_asset = is_asset && lowered.source_spans.span(settings).is_none();
        Some(Loaded { lowered, is_asset })
    }

    /// Whether the input is an asset by itself, glTF or a mesh.
    fn is_asset(&self) -> bool {
        let recognise = |file| {
            let (name, bytes) = (self.map.name(file), self.map.bytes(file));
            gltf::recognise(name, bytes) || mesh::recognise(name, bytes)
        };
        self.file.is_some_and(recognise)
    }

    /// Whether it is a scene text whose images and meshes came from files that it names: none is of
    /// an asset.
    #[must_use]
    pub fn has_files_of_its_own(&self, lowered: &Lowered) -> bool {
        let Some(own) = self.file.filter(|_| !self.is_asset()) else {
            return false;
        };
        let is_ir = codec::detect_format(self.map.bytes(own)).is_some();
        let is_asset = |file| gltf::recognise(self.map.name(file), self.map.bytes(file));
        let of_asset = |entity, count| {
            let places = (0..count).map(move |index| ValuePath::new(entity, index, Field::Whole));
            let mut spans = places.filter_map(|place| lowered.source_spans.span(place));
            spans.any(|span| is_asset(span.file))
        };
        let Scene {
            images,
            meshes,
            materials,
            ..
        } = &lowered.scene;
        !is_ir
            && !of_asset(EntityKind::Image, images.len())
            && !of_asset(EntityKind::Mesh, meshes.len())
            && !of_asset(EntityKind::Material, materials.len())
    }

    /// Sets the stage of a scene that was loaded, lets `change` change it, and proves it.
    pub fn validate(
        &mut self,
        loaded: Loaded,
        change: impl FnOnce(&mut Lowered, &Provenance),
    ) -> Option<Proven> {
        let Loaded {
            mut lowered,
            is_asset,
        } = loaded;
        let provenance = self.set_stage(&mut lowered, is_asset);
        change(&mut lowered, &provenance);
        let scene = validate(&lowered, &self.options, &mut self.sink)?;
        Some(Proven { lowered, scene })
    }

    fn set_stage(&mut self, lowered: &mut Lowered, is_asset: bool) -> Provenance {
        let mut provenance = Provenance {
            is_asset,
            is_lit_asset: is_asset && lowered.scene.lights.iter().any(Light::emits),
            is_unlit: is_asset && lowered.scene.is_unlit(),
            fill: FillLight::Never,
            framing: None,
        };
        let Some(wanted) = &self.stage else {
            return provenance;
        };
        // An asset without a camera is seen by one that we choose.
        let camera = lowered
            .source_spans
            .span(ValuePath::new(EntityKind::Camera, 0, Field::Whole));
        let kind = match (is_asset, camera) {
            (false, _) => SceneKind::Text,
            (true, Some(_)) => SceneKind::Asset,
            (true, None) => SceneKind::BareAsset,
        };
        provenance.is_lit_asset &= !wanted.without_lights;
        if let Some(staged) = stage(lowered, wanted, kind, &mut self.sink) {
            // A scene that says how it is lit is shown as it says.
            let is_meant = staged.fill == FillLight::IfDim && !is_asset;
            provenance.fill = if is_meant {
                FillLight::Never
            } else {
                staged.fill
            };
            provenance.framing = staged.framing;
        }
        provenance
    }

    /// The scene as glTF, in one file or with others in a folder; `None` if that is not possible, with
    /// a finding that says why.
    pub fn gltf(
        &mut self,
        lowered: &Lowered,
        tolerance: Option<f64>,
        folder: Option<&str>,
    ) -> Option<GltfAsset> {
        let (
            Lowered {
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

    /// The scene as one of Mitsuba, whose meshes are files in the folder, or without a folder as one of
    /// POV-Ray; `None` if that is not possible, with a finding that says why.
    pub fn twin(&mut self, lowered: &Lowered, folder: Option<&str>) -> Option<ExportedScene> {
        let (
            Lowered {
                scene,
                source_spans,
            },
            budget,
        ) = (lowered, self.map.budget());
        match folder {
            Some(folder) => {
                emit::mitsuba::emit(scene, source_spans, folder, budget, &mut self.sink)
            }
            None => emit::pov::emit(scene, source_spans, budget, &mut self.sink),
        }
    }

    /// What was found since the last time.
    pub fn take_findings(&mut self) -> Sink {
        std::mem::replace(&mut self.sink, self.options.sink())
    }

    /// Puts what was found before in place of what was found since.
    pub fn put_findings(&mut self, found: Sink) {
        self.sink = found;
    }

    /// Whether the file of the scene could be read.
    #[must_use]
    pub fn is_read(&self) -> bool {
        self.file.is_some()
    }

    /// The scene as text; none if it could not be read, or is no UTF-8.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        self.map.text(self.file?)
    }

    /// What the text of an asset says that it holds, for before it is loaded; none of other scenes.
    #[must_use]
    pub fn asset(&self) -> Option<gltf::AssetSummary> {
        let file = self.file?;
        let is_asset = gltf::recognise(self.map.name(file), self.map.bytes(file))
            && codec::detect_format(self.map.bytes(file)).is_none();
        is_asset.then(|| gltf::summary(file, &self.map))?
    }

    /// Whether a span is of the text of the scene itself, not of a file that it names.
    #[must_use]
    pub fn is_own(&self, span: Span) -> bool {
        self.file == Some(span.file) && self.text().is_some()
    }

    /// Adds a text that is no part of the scene, for findings about it.
    pub fn add_text(&mut self, path: &Path, bytes: Vec<u8>) -> FileId {
        self.map.add(path.display().to_string(), bytes)
    }

    /// The file of the scene, unless it could not be read.
    pub fn file_id(&self) -> Option<FileId> {
        self.file
    }

    /// Adds a finding.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.sink.push(diagnostic);
    }

    /// How many rays a picture may take.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.options.valid.limits.of(Resource::Rays, 0)
    }

    /// Lets pictures take any number of rays.
    pub fn lift_rays(&mut self) {
        self.options.valid.limits.set(Resource::Rays, u64::MAX);
    }

    /// The file and the line at which a span begins.
    #[must_use]
    pub fn line(&self, span: Span) -> (&str, u32) {
        (
            self.map.name(span.file),
            self.map.line_column(span.file, span.start).line,
        )
    }

    /// Whether the file at a path was read: the scene, or what it names.
    #[must_use]
    pub fn has_read(&self, path: &Path) -> bool {
        self.map.has_read(path)
    }

    /// The name of the scene in messages.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its files.
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
            let limit = limit >> 20;
            Diagnostic::new(
                &codes::TOO_LARGE,
                format!("`{name}` is larger than {limit} MiB"),
            )
        }
        LoadError::NotRegular => {
            Diagnostic::new(&codes::CANNOT_READ, format!("can't read `{name}`: {error}"))
        }
    }
}
