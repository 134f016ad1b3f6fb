//! The inventory of an asset for `rtc info`: a row for each scene, mesh, material, texture and
//! animation, as its JSON describes them, without validation.

use super::container::AssetParts;
use super::field::ObjectFields;
use super::image::ImageCoding;
use super::uri::{self, Uri};
use rtc_image::{OpacityUse, PixelFile};
use rtc_source::tree::{NodeId, SyntaxTree};
use rtc_source::{FileId, FileSearch, Loader, SourceMap};
use schemars::JsonSchema;
use serde::Serialize;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

/// The most bytes that are read for the sizes of images.
const MAX_BYTES: u64 = 1 << 30;

/// The most scenes with a row.
const MAX_SCENES: usize = 100;

/// The largest number of pixels of an image whose header is read.
const MAX_PIXELS: u64 = 1 << 32;

/// The rows of an asset.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Inventory {
    /// The scenes, at most 100.
    pub scenes: Vec<SceneRow>,
    /// The meshes.
    pub meshes: Vec<MeshRow>,
    /// The materials.
    pub materials: Vec<MaterialRow>,
    /// The images of textures.
    pub textures: Vec<TextureRow>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct SceneRow {
    /// Its name; empty if it has none.
    pub name: String,
    /// The names of its root nodes.
    pub roots: Vec<String>,
    /// The number of its nodes.
    pub nodes: usize,
    /// The number of vertices that are rendered, instances counted each.
    pub vertices: u64,
}

/// A mesh.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct MeshRow {
    /// Its name; empty if it has none.
    pub name: String,
    /// The modes of its primitives, as glTF numbers them: 4 is triangles.
    pub modes: Vec<u64>,
    /// The number of its primitives in the file.
    pub primitives: usize,
    /// The number of points, lines or triangles that they consist of.
    pub elements: u64,
    /// The number of vertices.
    pub vertices: u64,
    /// The names of the vertex attributes.
    pub attributes: Vec<String>,
    /// The number of nodes with the mesh.
    pub instances: usize,
    /// The bytes of its accessors, each counted once.
    pub bytes: u64,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct MaterialRow {
    /// Its name; empty if it has none.
    pub name: String,
    /// The number of primitives with the material.
    pub instances: usize,
    /// The properties with a texture.
    pub slots: Vec<String>,
    /// `OPAQUE`, `MASK` or `BLEND`.
    pub alpha_mode: String,
    /// Whether its back is seen.
    pub double_sided: bool,
}

/// The image of textures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct TextureRow {
    /// The name of the image, or else of its texture; empty if it has none.
    pub name: String,
    /// The path of its file; empty if its bytes are in the asset.
    pub uri: String,
    /// The properties of materials that it is for.
    pub slots: Vec<String>,
    /// The number of these properties, counted for each material.
    pub instances: usize,
    /// The media type (MIME), by its first bytes; empty if they are not known.
    pub mime_type: String,
    /// Width and height in pixels; null if they can't be read.
    pub resolution: Option<[u32; 2]>,
    /// The bytes of its file.
    pub bytes: u64,
    /// The bytes on a GPU, with all mip levels: uncompressed RGBA of 8 bits, or the blocks of a
    /// KTX2 file; null if the resolution is unknown.
    pub gpu_bytes: Option<u64>,
}

/// An asset whose rows are made.
pub(super) struct InventoryReader<'t, 's> {
    pub(super) tree: &'t SyntaxTree<'s>,
    pub(super) map: &'t SourceMap,
    pub(super) file: FileId,
    pub(super) parts: &'t AssetParts,
    /// The bytes that were read for the sizes of images.
    pub(super) read: Cell<u64>,
}

/// How often each number occurs.
fn counts(numbers: impl Iterator<Item = usize>) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    numbers.for_each(|number| *counts.entry(number).or_default() += 1);
    counts
}

/// A property of a material with a texture.
struct TextureSlot {
    material: usize,
    property: String,
    texture: usize,
}

impl<'t, 's> InventoryReader<'t, 's> {
    fn list(&self, key: &str) -> Vec<ObjectFields<'t, 's>> {
        ObjectFields::new(self.tree, self.tree.root())
            .objects(key)
            .collect()
    }

    /// All rows.
    pub(super) fn inventory(&self) -> Inventory {
        let slots = self.slots();
        Inventory {
            scenes: self.scenes(),
            meshes: self.meshes(),
            materials: self.materials(&slots),
            textures: self.textures(&slots),
        }
    }

    /// The accessors of a primitive: those of its attributes, then its indices.
    fn accessors(&self, primitive: ObjectFields<'t, 's>) -> (Vec<(String, usize)>, Option<usize>) {
        let attributes = primitive.object("attributes").into_iter().flat_map(|own| {
            let pairs = self.tree.pairs(own.at).map(|(key, _)| key);
            pairs.filter_map(move |key| {
                let name = own.json.text(key)?.to_owned();
                let index = own.index(&name)?;
                Some((name, index))
            })
        });
        (attributes.collect(), primitive.index("indices"))
    }

    fn meshes(&self) -> Vec<MeshRow> {
        let accessors = self.list("accessors");
        let count = |index: usize| accessors.get(index).and_then(|own| own.integer("count"));
        let nodes = self.list("nodes").into_iter();
        let instances = counts(nodes.filter_map(|node| node.index("mesh")));
        let row = |(at, mesh): (usize, ObjectFields<'t, 's>)| {
            let (mut modes, mut names) = (BTreeSet::new(), BTreeSet::new());
            let (mut used, mut vertices, mut elements) = (BTreeSet::new(), 0, 0);
            let primitives: Vec<_> = mesh.objects("primitives").collect();
            for primitive in &primitives {
                let mode = primitive.integer("mode").unwrap_or(4);
                let (attributes, indices) = self.accessors(*primitive);
                let own = attributes.iter().find(|(name, _)| name == "POSITION");
                let own = own.and_then(|(_, index)| count(*index)).unwrap_or(0);
                modes.insert(mode);
                vertices += own;
                elements += elements_of(mode, indices.and_then(count).unwrap_or(own));
                used.extend(attributes.iter().map(|(_, index)| *index).chain(indices));
                names.extend(attributes.into_iter().map(|(name, _)| name));
            }
            let used = used.iter().filter_map(|index| accessors.get(*index));
            MeshRow {
                name: mesh.name(),
                modes: modes.into_iter().collect(),
                primitives: primitives.len(),
                elements,
                vertices,
                attributes: names.into_iter().collect(),
                instances: instances.get(&at).copied().unwrap_or(0),
                bytes: used.map(accessor_bytes).sum(),
            }
        };
        self.list("meshes")
            .into_iter()
            .enumerate()
            .map(row)
            .collect()
    }

    fn scenes(&self) -> Vec<SceneRow> {
        let (nodes, meshes) = (self.list("nodes"), self.meshes());
        let row = |scene: ObjectFields<'t, 's>| {
            let roots = scene.indices("nodes");
            // A node has one parent in a valid asset, and is counted once in any other.
            let (mut open, mut seen, mut vertices) = (roots.clone(), BTreeSet::new(), 0);
            while let Some(index) = open.pop() {
                let Some(node) = nodes.get(index).filter(|_| seen.insert(index)) else {
                    continue;
                };
                open.extend(node.indices("children"));
                let mesh = node.index("mesh").and_then(|mesh| meshes.get(mesh));
                vertices += mesh.map_or(0, |mesh| mesh.vertices);
            }
            let root = |index: &usize| nodes.get(*index).map(ObjectFields::name);
            SceneRow {
                name: scene.name(),
                roots: roots.iter().filter_map(root).collect(),
                nodes: seen.len(),
                vertices,
            }
        };
        let scenes = self.list("scenes").into_iter().take(MAX_SCENES);
        scenes.map(row).collect()
    }

    /// The properties with textures of all materials, those of extensions too.
    fn slots(&self) -> Vec<TextureSlot> {
        let mut slots = Vec::new();
        for (material, fields) in self.list("materials").into_iter().enumerate() {
            let mut open: Vec<NodeId> = vec![fields.at];
            while let Some(node) = open.pop() {
                for (key, value) in self.tree.pairs(node) {
                    let property = self.tree.text(key).unwrap_or_default();
                    let texture = ObjectFields::new(self.tree, value).index("index");
                    match texture.filter(|_| property.ends_with("Texture")) {
                        Some(texture) => slots.push(TextureSlot {
                            material,
                            property: property.to_owned(),
                            texture,
                        }),
                        None if self.tree.is_map(value) => open.push(value),
                        None => {}
                    }
                }
            }
        }
        slots
    }

    fn materials(&self, slots: &[TextureSlot]) -> Vec<MaterialRow> {
        let meshes = self.list("meshes");
        let primitives = meshes.iter().flat_map(|mesh| mesh.objects("primitives"));
        let used = counts(primitives.filter_map(|own| own.index("material")));
        let row = |(at, material): (usize, ObjectFields<'t, 's>)| {
            // The slots are in the order of the materials.
            let start = slots.partition_point(|slot| slot.material < at);
            let own = slots.iter().skip(start);
            let own = own.take_while(|slot| slot.material == at);
            let names: BTreeSet<&str> = own.map(|slot| slot.property.as_str()).collect();
            MaterialRow {
                name: material.name(),
                instances: used.get(&at).copied().unwrap_or(0),
                slots: names.into_iter().map(str::to_owned).collect(),
                alpha_mode: material.text("alphaMode").unwrap_or("OPAQUE".to_owned()),
                double_sided: material.boolean("doubleSided"),
            }
        };
        self.list("materials")
            .into_iter()
            .enumerate()
            .map(row)
            .collect()
    }

    fn textures(&self, slots: &[TextureSlot]) -> Vec<TextureRow> {
        let textures = self.list("textures");
        let source = |texture: &ObjectFields<'t, 's>| {
            let names = ["KHR_texture_basisu", "EXT_texture_webp"].iter();
            let mut others = names.filter_map(|name| texture.extension(name)?.index("source"));
            others.next().or_else(|| texture.index("source"))
        };
        let sources: Vec<Option<usize>> = textures.iter().map(source).collect();
        // The slots and the first texture of each image.
        let mut slots_of: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
        for slot in slots {
            if let Some(Some(image)) = sources.get(slot.texture) {
                slots_of.entry(*image).or_default().push(&slot.property);
            }
        }
        let mut names: BTreeMap<usize, String> = BTreeMap::new();
        for (source, texture) in sources.iter().zip(&textures) {
            if let Some(image) = source {
                names.entry(*image).or_insert_with(|| texture.name());
            }
        }
        let lists = ["bufferViews", "buffers"].map(|key| self.list(key));
        let row = |(at, image): (usize, ObjectFields<'t, 's>)| {
            let own = slots_of.get(&at).map(Vec::as_slice).unwrap_or_default();
            let distinct: BTreeSet<&str> = own.iter().copied().collect();
            let name = Some(image.name()).filter(|name| !name.is_empty());
            let name = name.or_else(|| names.get(&at).cloned());
            let uri = image.text("uri").unwrap_or_default();
            let bytes = self.image_bytes(image, &lists).unwrap_or_default();
            let resolution = resolution(&bytes);
            TextureRow {
                name: name.unwrap_or_default(),
                uri: if uri.starts_with("data:") {
                    String::new()
                } else {
                    uri
                },
                slots: distinct.into_iter().map(str::to_owned).collect(),
                instances: own.len(),
                mime_type: ImageCoding::of(&bytes)
                    .map_or("", ImageCoding::media)
                    .to_owned(),
                resolution,
                bytes: bytes.len() as u64,
                gpu_bytes: resolution.map(|size| gpu_bytes(&bytes, size)),
            }
        };
        self.list("images")
            .into_iter()
            .enumerate()
            .map(row)
            .collect()
    }

    /// The bytes of an image: of its URI, or of its buffer view.
    fn image_bytes(
        &self,
        image: ObjectFields<'t, 's>,
        [views, buffers]: &[Vec<ObjectFields<'t, 's>>; 2],
    ) -> Option<Vec<u8>> {
        if let Some(text) = image.text("uri") {
            return self.resource(&text);
        }
        let view = views.get(image.index("bufferView")?)?;
        let start = view.index("byteOffset").unwrap_or(0);
        let range = start..start.checked_add(view.index("byteLength")?)?;
        let index = view.index("buffer")?;
        let buffer = buffers.get(index)?;
        match (buffer.text("uri"), &self.parts.bin) {
            (Some(text), _) => self.resource(&text)?.get(range).map(<[u8]>::to_vec),
            (None, Some(bin)) if index == 0 => {
                let chunk = self.map.bytes(self.file).get(bin.clone())?;
                self.counted(chunk.get(range)?.to_vec())
            }
            (None, _) => None,
        }
    }

    /// The bytes of a URI: its data, or the file in the folder of the asset.
    fn resource(&self, text: &str) -> Option<Vec<u8>> {
        match uri::parse(text).ok()? {
            Uri::Data { bytes, media: _ } => self.counted(bytes),
            Uri::Path(path) => {
                let search = FileSearch::new(self.map.folder(self.file), None);
                let found = search.below(&path).ok()?;
                let left = MAX_BYTES.saturating_sub(self.read.get());
                self.counted(Loader.found(&found, left, self.map).ok()?)
            }
            Uri::Above(_) => None,
        }
    }

    /// The bytes, unless they are too many with those before.
    fn counted(&self, bytes: Vec<u8>) -> Option<Vec<u8>> {
        self.read
            .set(self.read.get().saturating_add(bytes.len() as u64));
        (self.read.get() <= MAX_BYTES).then_some(bytes)
    }
}

/// The points, lines or triangles of a primitive with some vertices (glTF 2.0, 3.7.2.1).
fn elements_of(mode: u64, vertices: u64) -> u64 {
    match mode {
        1 => vertices / 2,
        3 => vertices.saturating_sub(1),
        4 => vertices / 3,
        5 | 6 => vertices.saturating_sub(2),
        _ => vertices,
    }
}

/// The bytes of the values of an accessor.
fn accessor_bytes(accessor: &ObjectFields<'_, '_>) -> u64 {
    let component = match accessor.integer("componentType") {
        Some(5120 | 5121) => 1,
        Some(5122 | 5123) => 2,
        Some(_) | None => 4,
    };
    let components = match accessor.text("type").as_deref() {
        Some("VEC2") => 2,
        Some("VEC3") => 3,
        Some("VEC4" | "MAT2") => 4,
        Some("MAT3") => 9,
        Some("MAT4") => 16,
        Some(_) | None => 1,
    };
    accessor
        .integer("count")
        .unwrap_or(0)
        .saturating_mul(component * components)
}

/// The size of an image by its header.
fn resolution(bytes: &[u8]) -> Option<[u32; 2]> {
    let file = PixelFile::open(bytes, OpacityUse::Kept, MAX_PIXELS).ok()?;
    Some(file.size())
}

/// The bytes of an image and its mip levels on a GPU. The levels of a KTX2 file stay as they are in
/// it; Basis LZ, whose blocks are known once they are transcoded, takes a byte a pixel.
fn gpu_bytes(bytes: &[u8], size: [u32; 2]) -> u64 {
    let number = |at: usize, length: usize| {
        let bytes = bytes.get(at..at + length).unwrap_or_default();
        bytes
            .iter()
            .rev()
            .fold(0_u64, |sum, byte| sum << 8 | u64::from(*byte))
    };
    if ImageCoding::of(bytes) == Some(ImageCoding::Ktx2) {
        // KTX 2.0, "Level Index": offset, length and uncompressed length of each level.
        let levels = number(40, 4).clamp(1, 32) as usize;
        let lengths: u64 = (0..levels).map(|level| number(96 + 24 * level, 8)).sum();
        let pixels = mip_pixels(size).into_iter().take(levels).sum();
        return if lengths > 0 { lengths } else { pixels };
    }
    4 * mip_pixels(size).into_iter().sum::<u64>()
}

/// The pixels of each mip level, down to one pixel.
fn mip_pixels(size: [u32; 2]) -> Vec<u64> {
    let levels = 32 - size[0].max(size[1]).leading_zeros();
    let side = |side: u32, level: u32| u64::from((side >> level).max(1));
    (0..levels)
        .map(|level| side(size[0], level) * side(size[1], level))
        .collect()
}
