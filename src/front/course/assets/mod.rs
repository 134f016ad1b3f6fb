//! The files a scene names, brought into its IR: textures and meshes.
//!
//! Every fault has its place: in the scene for a file that can't be had, in the mesh file for what
//! is wrong there. A lenient run goes on without the file and says what is missing.

mod alone;
mod dress;
mod environment;
mod gltf;
mod image;
mod mesh;
mod missing;
mod mtl;
mod photometry;
mod text;

pub use alone::alone;
pub use dress::{Dress, Dressing};

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
pub struct Wanted {
    /// What the file is for.
    pub asset: Asset,
    /// Its path as the scene writes it.
    pub path: String,
    /// Where the scene writes it.
    pub span: Option<Span>,
}

/// The place in the IR that a file is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asset {
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

impl Asset {
    /// The noun of the IR that the file becomes, if it is one.
    pub(super) fn place(&self) -> Option<ValuePath> {
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
pub fn bring(
    draft: UnfinishedScene,
    scene: FileId,
    options: &FrontOptions,
    map: &mut SourceMap,
    sink: &mut Sink,
) -> Lowered {
    let UnfinishedScene {
        mut lowered,
        wanted,
        sizings,
        dressings,
    } = draft;
    if wanted.is_empty() {
        return lowered;
    }
    let folder = map.folder(scene);
    let search = Search::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut port = Port::new(search, options, map, sink);
    port.unload(wanted, &mut lowered);
    lowered.source_spans.finish();
    port.meshes.settle(&mut lowered.scene);
    for sizing in sizings {
        object::sizing::settle(sizing, &mut lowered, port.porter.sink);
    }
    port.finish(&dressings, &mut lowered);
    lowered
}

/// What was brought so far.
struct Port<'run> {
    porter: Porter<'run>,
    images: Known<ImageId>,
    /// Those with their opacity.
    sampled: Known<ImageId>,
    /// Which image came of each that was wanted.
    image_of: BTreeMap<u32, Option<ImageId>>,
    meshes: mesh::MeshFiles,
    assets: gltf::Assets,
    profiles: Known<Photometry>,
}

impl<'run> Port<'run> {
    fn new(
        search: Search,
        options: &'run FrontOptions,
        map: &'run mut SourceMap,
        sink: &'run mut Sink,
    ) -> Self {
        Self {
            porter: Porter {
                search,
                options,
                loader: Loader,
                map,
                sink,
                compared: 0,
            },
            images: Known::default(),
            sampled: Known::default(),
            image_of: BTreeMap::new(),
            meshes: mesh::MeshFiles::default(),
            assets: gltf::Assets::default(),
            profiles: Known::default(),
        }
    }

    /// Dresses the meshes, and has textures look at the images that came.
    fn finish(mut self, dressings: &[Dressing], lowered: &mut Lowered) {
        let cache = dress::dress(dressings, &self.meshes, lowered, &mut self.porter);
        self.unload(cache.wanted, lowered);
        image::settle(&self.image_of, &mut lowered.scene);
        mtl::bake(cache.bakes, &self.image_of, lowered, &mut self.porter);
        image::find_normal_maps(lowered, self.porter.sink);
        lowered.source_spans.finish();
    }

    /// Brings files.
    fn unload(&mut self, wanted: Vec<Wanted>, lowered: &mut Lowered) {
        let porter = &mut self.porter;
        for wish in wanted {
            match wish.asset {
                Asset::Image(id) | Asset::Map(id) => {
                    let kind = (&mut self.images, Opacity::Dropped);
                    let image = image::bring(id, &wish, lowered, kind, porter);
                    self.image_of.insert(id.0, image);
                }
                Asset::Sampled(id) | Asset::Mask(id) => {
                    let kind = (&mut self.sampled, Opacity::Kept);
                    let image = image::bring(id, &wish, lowered, kind, porter);
                    self.image_of.insert(id.0, image);
                }
                Asset::Mesh(id) => self.meshes.bring(id, &wish, lowered, porter),
                Asset::Environment(id) => environment::bring(id, &wish, lowered, porter),
                Asset::Gltf(place) => self.assets.bring(place, &wish, lowered, porter),
                Asset::Photometry(light) => {
                    photometry::bring(light, &wish, lowered, &mut self.profiles, porter);
                }
                // Who wants materials reads them.
                Asset::Materials => {}
            }
        }
    }
}

/// What became of the files read so far, each read once, however it is named; `None` if it can't be
/// used.
struct Known<T>(BTreeMap<Identity, Option<T>>);

impl<T> Default for Known<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T> Known<T> {
    /// What became of a file; `read` is called if that is not known.
    fn of(&mut self, found: &Found, read: impl FnOnce() -> Option<T>) -> Option<&T> {
        let Some(identity) = found.identity() else {
            // It has gone meanwhile: to read it reports that.
            read();
            return None;
        };
        self.0.entry(identity).or_insert_with(read).as_ref()
    }
}

/// Finds files, reads them, and reports on them.
struct Porter<'run> {
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
const MOST_COMPARED: usize = 1 << 16;

/// What a lenient run does without a file.
#[derive(Clone, Copy)]
enum Without {
    Color,
    Environment,
    Light,
    /// The picture of a material of a mesh file.
    Map,
    /// The materials of a mesh file.
    Materials,
    Object,
}

impl Without {
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
    fn is_spare(self) -> bool {
        matches!(self, Self::Map | Self::Materials)
    }
}

impl Porter<'_> {
    /// The file, unless there is none: that is reported.
    fn find(&mut self, wish: &Wanted, without: Without) -> Option<Found> {
        let extensions: &[&str] = match without {
            Without::Object if !has_extension(&wish.path) => &["", ".obj", ".off"],
            Without::Object
            | Without::Color
            | Without::Environment
            | Without::Light
            | Without::Map
            | Without::Materials => &[""],
        };
        let mut first_fault = None;
        for extension in extensions {
            match self
                .search
                .find(&format!("{}{extension}", wish.path), kind_of(&wish.asset))
            {
                Ok(found) => {
                    self.tell_where(wish, &found, found.elsewhere || !extension.is_empty());
                    return Some(found);
                }
                Err(fault) => drop(first_fault.get_or_insert(fault)),
            }
        }
        if let Some(fault) = first_fault {
            let similar = self.similar(wish);
            self.refuse(missing(wish, &fault, similar.as_deref()), without);
        }
        None
    }

    /// A file in the place of the one that is wanted, with a similar name or another extension.
    fn similar(&mut self, wish: &Wanted) -> Option<String> {
        if self.compared >= MOST_COMPARED {
            return None;
        }
        let path = wish.path.replace('\\', "/");
        let (folder, name) = path.rsplit_once('/').unwrap_or(("", &path));
        let names = self.search.neighbours(&path, kind_of(&wish.asset));
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

    fn tell_where(&mut self, wish: &Wanted, found: &Found, elsewhere: bool) {
        if elsewhere {
            let message = format!(
                "`{}` is taken from `{}`",
                clip_path(&wish.path),
                found.shown.display()
            );
            self.sink.push(
                Diagnostic::new(&codes::FILE_ELSEWHERE, message)
                    .at(wish.span, "found under another name"),
            );
        }
    }

    /// Reports a file that can't be used; lenient, as a warning with what is done instead.
    fn refuse(&mut self, mut finding: Diagnostic, without: Without) {
        if self.options.lenient || without.is_spare() {
            finding.message = format!("{}; {}", finding.message, without.consequence());
            finding.severity = Severity::Warning;
        }
        self.sink.push(finding);
    }

    /// Reports a file that was found and can't be read.
    fn unreadable(&mut self, found: &Found, why: &str, span: Option<Span>, without: Without) {
        let message = format!("can't read `{}`: {why}", found.shown.display());
        self.refuse(
            Diagnostic::new(&codes::CANNOT_READ, message).at(span, "named here"),
            without,
        );
    }
}

/// The kind of file that an asset is in.
fn kind_of(asset: &Asset) -> &'static FileKind {
    match asset {
        Asset::Image(_) | Asset::Sampled(_) | Asset::Map(_) | Asset::Mask(_) => &PICTURES,
        Asset::Mesh(_) => &mesh::TEXT.file,
        Asset::Environment(_) => &environment::KIND,
        Asset::Gltf(_) => &gltf::KIND,
        Asset::Photometry(_) => &photometry::TEXT.file,
        Asset::Materials => &mtl::TEXT.file,
    }
}

/// True if the last component has a dot within: `cat.obj`, and `cat` has not.
fn has_extension(path: &str) -> bool {
    let name = path.trim().rsplit(['/', '\\']).next().unwrap_or_default();
    name.trim_start_matches('.').contains('.')
}
