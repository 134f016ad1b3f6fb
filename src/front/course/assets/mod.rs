//! Loads the files that a scene names: images, meshes, MTL libraries, environments, photometric
//! profiles and glTF assets.
//!
//! Lowering leaves a placeholder in the IR for each file and a [`PendingAsset`] with its path, its
//! span and its [`AssetTarget`]. [`load`] works through them in these steps:
//!
//! 1. `AssetLoader` finds each file (near the scene, see `rtc_source::FileSearch`) and reads it. A
//!    file with several names is loaded once (`FileCache`).
//! 2. The module of its format decodes it into the placeholder: `image`, `mesh`, `environment`,
//!    `photometry` or `gltf`.
//! 3. Instances and sizings are resolved, since they depend on the bounds of loaded meshes.
//! 4. `material_binder` assigns MTL materials to meshes, and splits surfaces that have several.
//! 5. The images of these materials are loaded, textures are pointed to them, and `mtl::bake`
//!    makes the textures that combine several images.
//!
//! [`lower_standalone_mesh`] takes the same steps for a mesh file that is the input itself.
//!
//! What callers may rely on:
//!
//! * Every error has a span: in the scene for a file that cannot be read, in a text file for an
//!   error in its content. Bytes of a file of another format are never quoted.
//! * Without a file the scene stays valid. That is an error, or with `lenient` a warning which
//!   states the consequence (`MissingAssetPolicy`). Files that only an MTL names are optional.
//! * Memory is charged to the budget before it is allocated.

mod environment;
mod gltf;
mod image;
mod material_binder;
mod mesh;
mod missing;
mod mtl;
mod photometry;
mod standalone;
mod text_file;

pub use material_binder::{MaterialSource, PendingMaterial};
pub use standalone::lower_standalone_mesh;

use super::lower::UnfinishedScene;
use super::object;
use crate::FrontOptions;
use crate::pixels::{PICTURES, TEXTURES};
use missing::missing;
use rtc_diag::{Diagnostic, DiagnosticSink, Severity, clip_path, codes, nearest};
use rtc_image::OpacityUse;
use rtc_ir::{EntityField, EntityKind, ImageId, LoweredScene, MeshId, Photometry, ValuePath};
use rtc_source::{
    FileId, FileIdentity, FileKind, FileSearch, FoundFile, Loader, MissingFile, SourceMap, Span,
};
use std::collections::BTreeMap;

/// A file that a scene names and that is not loaded yet.
#[derive(Clone, Debug, PartialEq)]
pub struct PendingAsset {
    /// The entity of the IR that the file is loaded into.
    pub target: AssetTarget,
    /// The path as written in the scene.
    pub path: String,
    /// The span of the path in the scene.
    pub span: Option<Span>,
}

/// The entity of the IR that a file is loaded into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssetTarget {
    /// An image without alpha; one pixel until the file is loaded.
    Image(ImageId),
    /// An image with alpha; one pixel until the file is loaded.
    Sampled(ImageId),
    /// A mesh; empty until the file is loaded.
    Mesh(MeshId),
    /// The image of the environment; one black pixel until the file is loaded.
    Environment(ImageId),
    /// A glTF asset with the transform of its placement; absent until the file is loaded.
    Gltf([[f64; 3]; 4]),
    /// The profile of the light with this index; dark until the file is loaded.
    Photometry(usize),
    /// An image without alpha that an MTL material names.
    Map(ImageId),
    /// An image with alpha that an MTL material names.
    Mask(ImageId),
    /// The MTL library of a mesh.
    Materials,
}

impl AssetTarget {
    /// The path of the image or mesh in the IR.
    pub(super) fn value_path(&self) -> Option<ValuePath> {
        match self {
            Self::Image(id)
            | Self::Sampled(id)
            | Self::Environment(id)
            | Self::Map(id)
            | Self::Mask(id) => Some((EntityKind::Image, id.0)),
            Self::Mesh(id) => Some((EntityKind::Mesh, id.0)),
            Self::Gltf(_) | Self::Photometry(_) | Self::Materials => None,
        }
        .map(|(entity, index)| ValuePath::new(entity, index as usize, EntityField::Whole))
    }
}

/// Loads all pending files of a scene that was lowered from the file `scene`; then applies sizings
/// and assigns materials to meshes.
///
/// Mesh files are added to the source map, so that diagnostics can point into them.
pub fn load(
    draft: UnfinishedScene,
    scene: FileId,
    options: &FrontOptions,
    map: &mut SourceMap,
    sink: &mut DiagnosticSink,
) -> LoweredScene {
    let UnfinishedScene {
        mut lowered,
        pending_assets,
        sizings,
        pending_materials,
    } = draft;
    if pending_assets.is_empty() {
        return lowered;
    }
    let folder = map.folder(scene);
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut import = AssetImport::new(search, options, map, sink);
    import.load_all(pending_assets, &mut lowered);
    lowered.source_spans.finish();
    import.meshes.resolve_instances(&mut lowered.scene);
    for sizing in sizings {
        object::sizing::apply(sizing, &mut lowered, import.loader.sink);
    }
    import.finish(&pending_materials, &mut lowered);
    lowered
}

/// The state of loading the files of a scene.
struct AssetImport<'run> {
    loader: AssetLoader<'run>,
    images: FileCache<ImageId>,
    /// The images with alpha.
    sampled: FileCache<ImageId>,
    /// The loaded image for each pending one.
    image_of: BTreeMap<u32, Option<ImageId>>,
    meshes: mesh::MeshFiles,
    assets: gltf::GltfAssets,
    profiles: FileCache<Photometry>,
}

impl<'run> AssetImport<'run> {
    fn new(
        search: FileSearch,
        options: &'run FrontOptions,
        map: &'run mut SourceMap,
        sink: &'run mut DiagnosticSink,
    ) -> Self {
        Self {
            loader: AssetLoader {
                search,
                options,
                loader: Loader,
                map,
                sink,
                compared: 0,
            },
            images: FileCache::default(),
            sampled: FileCache::default(),
            image_of: BTreeMap::new(),
            meshes: mesh::MeshFiles::default(),
            assets: gltf::GltfAssets::default(),
            profiles: FileCache::default(),
        }
    }

    /// Assigns materials to the meshes, and points textures to the loaded images.
    fn finish(mut self, pending_materials: &[PendingMaterial], lowered: &mut LoweredScene) {
        let cache =
            material_binder::bind(pending_materials, &self.meshes, lowered, &mut self.loader);
        self.load_all(cache.pending_assets, lowered);
        image::resolve_images(&self.image_of, &mut lowered.scene);
        mtl::bake(cache.bakes, &self.image_of, lowered, &mut self.loader);
        image::find_normal_maps(lowered, self.loader.sink);
        lowered.source_spans.finish();
    }

    /// Loads files.
    fn load_all(&mut self, pending_assets: Vec<PendingAsset>, lowered: &mut LoweredScene) {
        let loader = &mut self.loader;
        for pending in pending_assets {
            match pending.target {
                AssetTarget::Image(id) | AssetTarget::Map(id) => {
                    let kind = (&mut self.images, OpacityUse::Dropped);
                    let image = image::load(id, &pending, lowered, kind, loader);
                    self.image_of.insert(id.0, image);
                }
                AssetTarget::Sampled(id) | AssetTarget::Mask(id) => {
                    let kind = (&mut self.sampled, OpacityUse::Kept);
                    let image = image::load(id, &pending, lowered, kind, loader);
                    self.image_of.insert(id.0, image);
                }
                AssetTarget::Mesh(id) => self.meshes.load(id, &pending, lowered, loader),
                AssetTarget::Environment(id) => environment::load(id, &pending, lowered, loader),
                AssetTarget::Gltf(place) => self.assets.load(place, &pending, lowered, loader),
                AssetTarget::Photometry(light) => {
                    photometry::load(light, &pending, lowered, &mut self.profiles, loader);
                }
                // The material binder reads libraries itself.
                AssetTarget::Materials => {}
            }
        }
    }
}

/// A cache of loaded files by identity: each is loaded once, whatever its name. `None` if loading
/// failed.
struct FileCache<T>(BTreeMap<FileIdentity, Option<T>>);

impl<T> Default for FileCache<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T> FileCache<T> {
    /// The result of loading a file; calls `read` the first time.
    fn get_or_load(&mut self, found: &FoundFile, read: impl FnOnce() -> Option<T>) -> Option<&T> {
        let Some(identity) = found.identity() else {
            // The file has been removed; reading it reports that.
            read();
            return None;
        };
        self.0.entry(identity).or_insert_with(read).as_ref()
    }
}

/// Finds and reads files, and reports failures.
struct AssetLoader<'run> {
    search: FileSearch,
    options: &'run FrontOptions,
    loader: Loader,
    map: &'run mut SourceMap,
    sink: &'run mut DiagnosticSink,
    /// The number of file names compared with missing ones.
    compared: usize,
}

/// The limit of file names compared to find suggestions.
const MAX_COMPARED: usize = 1 << 16;

/// What remains of the scene without a file.
#[derive(Clone, Copy)]
enum MissingAssetPolicy {
    Color,
    Environment,
    Light,
    /// An image of an MTL material.
    Map,
    /// The MTL library of a mesh file.
    Materials,
    Object,
}

impl MissingAssetPolicy {
    fn consequence(self) -> &'static str {
        match self {
            Self::Color | Self::Map => "the texture is left out",
            Self::Environment => "the environment is left out",
            Self::Light => "the light is dark",
            Self::Materials => "its materials are left out",
            Self::Object => "the object is left out",
        }
    }

    /// Whether a missing file is only a warning without `--lenient` too, because another file names
    /// it, not the scene.
    fn is_optional(self) -> bool {
        matches!(self, Self::Map | Self::Materials)
    }
}

impl AssetLoader<'_> {
    /// Finds a file; reports a missing one.
    fn find(&mut self, pending: &PendingAsset, policy: MissingAssetPolicy) -> Option<FoundFile> {
        let extensions: &[&str] = match policy {
            MissingAssetPolicy::Object if !has_extension(&pending.path) => &["", ".obj", ".off"],
            MissingAssetPolicy::Object
            | MissingAssetPolicy::Color
            | MissingAssetPolicy::Environment
            | MissingAssetPolicy::Light
            | MissingAssetPolicy::Map
            | MissingAssetPolicy::Materials => &[""],
        };
        let mut first_fault = None;
        for extension in extensions {
            match self.search.find(
                &format!("{}{extension}", pending.path),
                kind_of(&pending.target),
            ) {
                Ok(found) => {
                    self.report_location(pending, &found, found.elsewhere || !extension.is_empty());
                    return Some(found);
                }
                Err(fault) => drop(first_fault.get_or_insert(fault)),
            }
        }
        if let Some(fault) = first_fault {
            let similar = self.similar(pending);
            self.reject(missing(pending, &fault, similar.as_deref()), policy);
        }
        None
    }

    /// The name of an existing file in the same folder, with a similar name or another extension.
    fn similar(&mut self, pending: &PendingAsset) -> Option<String> {
        if self.compared >= MAX_COMPARED {
            return None;
        }
        let path = pending.path.replace('\\', "/");
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", &path));
        let names = self.search.neighbours(&path, kind_of(&pending.target));
        self.compared += names.len();
        let stem = |name: &str| name.rsplit_once('.').map(|(stem, _)| stem.to_lowercase());
        let same = names.iter().find(|other| stem(other) == stem(name));
        let found = same.map(String::as_str);
        let found = found.or_else(|| nearest(name, names.iter().map(String::as_str)))?;
        Some(match folder {
            "" => found.to_owned(),
            _ => format!("{folder}/{found}"),
        })
    }

    fn report_location(&mut self, pending: &PendingAsset, found: &FoundFile, elsewhere: bool) {
        if elsewhere {
            let message = format!(
                "`{}` is taken from `{}`",
                clip_path(&pending.path),
                found.shown.display()
            );
            self.sink.push(
                Diagnostic::new(&codes::FILE_ELSEWHERE, message)
                    .at(pending.span, "found under another name"),
            );
        }
    }

    /// Reports a file that can't be used; with `--lenient` as a warning that states the
    /// consequence.
    fn reject(&mut self, mut diagnostic: Diagnostic, policy: MissingAssetPolicy) {
        if self.options.lenient || policy.is_optional() {
            diagnostic.message = format!("{}; {}", diagnostic.message, policy.consequence());
            diagnostic.severity = Severity::Warning;
        }
        self.sink.push(diagnostic);
    }

    /// Reports a file that was found and can't be read.
    fn unreadable(
        &mut self,
        found: &FoundFile,
        why: &str,
        span: Option<Span>,
        policy: MissingAssetPolicy,
    ) {
        let message = format!("can't read `{}`: {why}", found.shown.display());
        self.reject(
            Diagnostic::new(&codes::CANNOT_READ, message).at(span, "named here"),
            policy,
        );
    }
}

/// The file formats of an asset.
fn kind_of(target: &AssetTarget) -> &'static FileKind {
    match target {
        AssetTarget::Image(_) | AssetTarget::Sampled(_) | AssetTarget::Environment(_) => &TEXTURES,
        AssetTarget::Map(_) | AssetTarget::Mask(_) => &PICTURES,
        AssetTarget::Mesh(_) => &mesh::TEXT.file,
        AssetTarget::Gltf(_) => &gltf::KIND,
        AssetTarget::Photometry(_) => &photometry::TEXT.file,
        AssetTarget::Materials => &mtl::TEXT.file,
    }
}

/// Whether the last component of a path has an extension.
fn has_extension(path: &str) -> bool {
    let name = path.trim().rsplit(['/', '\\']).next().unwrap_or_default();
    name.trim_start_matches('.').contains('.')
}
