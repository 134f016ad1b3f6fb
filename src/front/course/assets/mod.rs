//! The files a scene names, brought into its IR: textures and meshes.
//!
//! Every fault has its place: in the scene for a file that can't be had, in the mesh file for what
//! is wrong there. A lenient run goes on without the file and says what is missing.

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
use crate::pixels::PICTURES;
use missing::missing;
use rtc_diag::{Diagnostic, Severity, Sink, clip_path, codes, nearest};
use rtc_image::Opacity;
use rtc_ir::{EntityKind, Field, ImageId, Lowered, MeshId, Photometry, ValuePath};
use rtc_source::{FileId, FileKind, Found, Identity, Loader, Missing, Search, SourceMap, Span};
use std::collections::BTreeMap;

/// A file that a scene names, for a place in the IR that waits for it.
#[derive(Clone, Debug, PartialEq)]
pub struct PendingAsset {
    /// What the file is for.
    pub target: AssetTarget,
    /// Its path as the scene writes it.
    pub path: String,
    /// Where the scene writes it.
    pub span: Option<Span>,
}

/// The place in the IR that a file is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AssetTarget {
    /// An image, of one pixel until its file is there.
    Image(ImageId),
    /// An image with its opacity, of one pixel until its file is there.
    Sampled(ImageId),
    /// A mesh, empty until its file is there.
    Mesh(MeshId),
    /// The image of the environment, of one dark pixel until its file is there.
    Environment(ImageId),
    /// A glTF asset, placed by a transform as of an instance: nothing until its file is there.
    Gltf([[f64; 3]; 4]),
    /// The profile of the lamp of this index, dark until its file is there.
    Photometry(usize),
    /// An image that a material of a mesh file names, of one pixel until its file is there.
    Map(ImageId),
    /// The same with its opacity.
    Mask(ImageId),
    /// The materials of a mesh.
    Materials,
}

impl AssetTarget {
    /// The noun of the IR that the file becomes, if it is one.
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
        .map(|(entity, index)| ValuePath::new(entity, index as usize, Field::Whole))
    }
}

/// Reads each file wanted by a scene that was lowered from `scene`, and puts it in its place; then
/// sees to the sizes and the materials of its meshes.
///
/// Mesh files come into the source map, so that findings can point into them.
pub fn load(
    draft: UnfinishedScene,
    scene: FileId,
    options: &FrontOptions,
    map: &mut SourceMap,
    sink: &mut Sink,
) -> Lowered {
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
    let search = Search::new(folder, options.asset_root.as_deref())
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

/// What was brought so far.
struct AssetImport<'run> {
    loader: AssetLoader<'run>,
    images: FileCache<ImageId>,
    /// Those with their opacity.
    sampled: FileCache<ImageId>,
    /// Which image came of each that was wanted.
    image_of: BTreeMap<u32, Option<ImageId>>,
    meshes: mesh::MeshFiles,
    assets: gltf::GltfAssets,
    profiles: FileCache<Photometry>,
}

impl<'run> AssetImport<'run> {
    fn new(
        search: Search,
        options: &'run FrontOptions,
        map: &'run mut SourceMap,
        sink: &'run mut Sink,
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

    /// Dresses the meshes, and has textures look at the images that came.
    fn finish(mut self, pending_materials: &[PendingMaterial], lowered: &mut Lowered) {
        let cache =
            material_binder::bind(pending_materials, &self.meshes, lowered, &mut self.loader);
        self.load_all(cache.pending_assets, lowered);
        image::resolve_images(&self.image_of, &mut lowered.scene);
        mtl::bake(cache.bakes, &self.image_of, lowered, &mut self.loader);
        image::find_normal_maps(lowered, self.loader.sink);
        lowered.source_spans.finish();
    }

    /// Brings files.
    fn load_all(&mut self, pending_assets: Vec<PendingAsset>, lowered: &mut Lowered) {
        let loader = &mut self.loader;
        for pending in pending_assets {
            match pending.target {
                AssetTarget::Image(id) | AssetTarget::Map(id) => {
                    let kind = (&mut self.images, Opacity::Dropped);
                    let image = image::load(id, &pending, lowered, kind, loader);
                    self.image_of.insert(id.0, image);
                }
                AssetTarget::Sampled(id) | AssetTarget::Mask(id) => {
                    let kind = (&mut self.sampled, Opacity::Kept);
                    let image = image::load(id, &pending, lowered, kind, loader);
                    self.image_of.insert(id.0, image);
                }
                AssetTarget::Mesh(id) => self.meshes.load(id, &pending, lowered, loader),
                AssetTarget::Environment(id) => environment::load(id, &pending, lowered, loader),
                AssetTarget::Gltf(place) => self.assets.load(place, &pending, lowered, loader),
                AssetTarget::Photometry(light) => {
                    photometry::load(light, &pending, lowered, &mut self.profiles, loader);
                }
                // Who wants materials reads them.
                AssetTarget::Materials => {}
            }
        }
    }
}

/// What became of the files read so far, each read once, however it is named; `None` if it can't be
/// used.
struct FileCache<T>(BTreeMap<Identity, Option<T>>);

impl<T> Default for FileCache<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T> FileCache<T> {
    /// What became of a file; `read` is called if that is not known.
    fn get_or_load(&mut self, found: &Found, read: impl FnOnce() -> Option<T>) -> Option<&T> {
        let Some(identity) = found.identity() else {
            // It has gone meanwhile: to read it reports that.
            read();
            return None;
        };
        self.0.entry(identity).or_insert_with(read).as_ref()
    }
}

/// Finds files, reads them, and reports on them.
struct AssetLoader<'run> {
    search: Search,
    options: &'run FrontOptions,
    loader: Loader,
    map: &'run mut SourceMap,
    sink: &'run mut Sink,
    /// How many names were compared with ones that are not there.
    compared: usize,
}

/// The most names that are compared so: of many files that are not there the first are told of
/// best.
const MAX_COMPARED: usize = 1 << 16;

/// What a lenient run does without a file.
#[derive(Clone, Copy)]
enum MissingAssetPolicy {
    Color,
    Environment,
    Light,
    /// The picture of a material of a mesh file.
    Map,
    /// The materials of a mesh file.
    Materials,
    Object,
}

impl MissingAssetPolicy {
    fn consequence(self) -> &'static str {
        match self {
            Self::Color | Self::Map => "the texture is left out",
            Self::Environment => "the environment is left out",
            Self::Light => "the light is dark",
            Self::Materials => "the mesh goes without its materials",
            Self::Object => "the object is left out",
        }
    }

    /// Whether a scene is worth showing without it, lenient or not: what it names does not ask for it.
    fn is_optional(self) -> bool {
        matches!(self, Self::Map | Self::Materials)
    }
}

impl AssetLoader<'_> {
    /// The file, unless there is none: that is reported.
    fn find(&mut self, pending: &PendingAsset, policy: MissingAssetPolicy) -> Option<Found> {
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

    /// A file in the place of the one that is wanted, with a similar name or another extension.
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

    fn report_location(&mut self, pending: &PendingAsset, found: &Found, elsewhere: bool) {
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

    /// Reports a file that can't be used; lenient, as a warning with what is done instead.
    fn reject(&mut self, mut finding: Diagnostic, policy: MissingAssetPolicy) {
        if self.options.lenient || policy.is_optional() {
            finding.message = format!("{}; {}", finding.message, policy.consequence());
            finding.severity = Severity::Warning;
        }
        self.sink.push(finding);
    }

    /// Reports a file that was found and can't be read.
    fn unreadable(
        &mut self,
        found: &Found,
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

/// The kind of file that an asset is in.
fn kind_of(target: &AssetTarget) -> &'static FileKind {
    match target {
        AssetTarget::Image(_)
        | AssetTarget::Sampled(_)
        | AssetTarget::Map(_)
        | AssetTarget::Mask(_) => &PICTURES,
        AssetTarget::Mesh(_) => &mesh::TEXT.file,
        AssetTarget::Environment(_) => &environment::KIND,
        AssetTarget::Gltf(_) => &gltf::KIND,
        AssetTarget::Photometry(_) => &photometry::TEXT.file,
        AssetTarget::Materials => &mtl::TEXT.file,
    }
}

/// True if the last component has a dot within: `cat.obj`, and `cat` has not.
fn has_extension(path: &str) -> bool {
    let name = path.trim().rsplit(['/', '\\']).next().unwrap_or_default();
    name.trim_start_matches('.').contains('.')
}
