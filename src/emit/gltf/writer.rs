//! The state of the glTF writer: the document, the binary chunk, and the objects written so far.

use super::document::{
    ARRAY_BUFFER, Accessor, BufferView, ELEMENT_ARRAY_BUFFER, Extras, FLOAT, GltfIndex, Image,
    Light, LightReference, Material, Mesh, Node, NodeExtensions, Root, Sampler, Texture,
    UNSIGNED_INT, UNSIGNED_SHORT,
};
use super::material::GltfMaterialKey;
use super::mesh::MeshAccessors;
use crate::picture::ColorCoding;
use crate::reporter::ExportReporter;
use crate::sidecar;
use crate::texture_area::TextureAreas;
use rtc_diag::codes;
use rtc_ir::{self as ir, ImageId, Scene, ValuePath};
use rtc_source::{Budget, uri_path};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::xxh3_64;

/// Writes a scene of meshes.
pub(super) struct GltfWriter<'w> {
    pub(super) scene: &'w Scene,
    pub(super) areas: TextureAreas,
    pub(super) root: Root,
    pub(super) bin: Vec<u8>,
    pub(super) budget: &'w Budget,
    pub(super) reporter: ExportReporter<'w>,
    /// The folder of sidecar files and their contents; `None` if there is one file only.
    pub(super) folder: Option<&'w str>,
    pub(super) files: BTreeMap<String, Vec<u8>>,
    /// The objects written so far, by their source.
    pub(super) images: BTreeMap<(u32, bool), GltfIndex<Image>>,
    pub(super) textures: BTreeMap<(u32, ColorCoding), GltfIndex<Texture>>,
    pub(super) samplers: BTreeMap<[u32; 3], GltfIndex<Sampler>>,
    pub(super) materials: BTreeMap<GltfMaterialKey, GltfIndex<Material>>,
    pub(super) attributes: BTreeMap<u32, MeshAccessors>,
    pub(super) meshes: BTreeMap<(u32, u32), GltfIndex<Mesh>>,
}

impl<'w> GltfWriter<'w> {
    pub(super) fn new(
        scene: &'w Scene,
        folder: Option<&'w str>,
        budget: &'w Budget,
        reporter: ExportReporter<'w>,
    ) -> Self {
        Self {
            scene,
            areas: TextureAreas::of(scene),
            root: Root::default(),
            bin: Vec::new(),
            budget,
            reporter,
            folder,
            files: BTreeMap::new(),
            images: BTreeMap::new(),
            textures: BTreeMap::new(),
            samplers: BTreeMap::new(),
            materials: BTreeMap::new(),
            attributes: BTreeMap::new(),
            meshes: BTreeMap::new(),
        }
    }

    /// Adds a sidecar file in `folder` and returns its URI. The name consists of its source, a
    /// fallback for a source without a name, and the extension.
    pub(super) fn file(
        &mut self,
        folder: &str,
        (source_name, fallback, extension): (&str, &str, &str),
        bytes: Vec<u8>,
    ) -> String {
        let path = sidecar::path(folder, source_name, fallback, xxh3_64(&bytes), extension);
        let uri = uri_path(&path).to_string();
        self.files.insert(path, bytes);
        uri
    }

    /// Adds a root node; `columns` is its transform to the world.
    pub(super) fn node(&mut self, node: Node, columns: [[f64; 3]; 4]) {
        const IDENTITY: [[f64; 3]; 4] =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
        let [[a, b, c], [d, e, f], [g, h, i], [x, y, z]] = columns;
        let matrix = (columns != IDENTITY)
            .then_some([a, b, c, 0.0, d, e, f, 0.0, g, h, i, 0.0, x, y, z, 1.0]);
        let index = GltfIndex::push(&mut self.root.nodes, Node { matrix, ..node });
        self.root.scenes[0].nodes.push(index);
    }
}

/// A number rounded to f32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
pub(super) fn single(number: f64) -> f32 {
    number as f32
}

/// An `extras` object with this under `rtc`; `None` if it is empty.
pub(super) fn extras(rtc: Map<String, Value>) -> Extras {
    (!rtc.is_empty()).then(|| json!({ "rtc": rtc }))
}

/// A node with a light.
pub(super) fn lit(light: GltfIndex<Light>) -> Node {
    Node {
        extensions: Some(NodeExtensions {
            punctual: LightReference { light },
        }),
        ..Node::default()
    }
}

/// The index of an image of the scene.
pub(super) fn number(ImageId(id): ImageId) -> u32 {
    id
}

impl GltfWriter<'_> {
    /// Adds bytes as a buffer view, padded to a multiple of 4 bytes.
    pub(super) fn view(&mut self, bytes: &[u8], target: Option<u32>) -> GltfIndex<BufferView> {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = BufferView {
            buffer: 0,
            byte_length: bytes.len(),
            byte_offset: offset,
            target,
        };
        GltfIndex::push(&mut self.root.buffer_views, view)
    }

    /// Adds float vectors, one per vertex. Positions need their minimum and maximum.
    pub(super) fn floats<const N: usize>(
        &mut self,
        vectors: &[[f32; N]],
        needs_extent: bool,
    ) -> GltfIndex<Accessor> {
        let bytes: Vec<u8> = vectors
            .iter()
            .flatten()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let kind = match N {
            2 => "VEC2",
            3 => "VEC3",
            _ => "VEC4",
        };
        let [min, max] = match needs_extent {
            true => extent(vectors).map(Some),
            false => [None, None],
        };
        let accessor = Accessor {
            min,
            max,
            ..accessor(view, vectors.len(), FLOAT, kind)
        };
        GltfIndex::push(&mut self.root.accessors, accessor)
    }

    /// Adds the pixels of a float image, in rows from the top.
    pub(super) fn pixels(&mut self, image: &ir::Image) -> GltfIndex<Accessor> {
        let view = self.view(&image.pixels, None);
        let count = image.pixels.len() / image.kind.bytes();
        let accessor = Accessor {
            name: Some(image.name.clone()).filter(|name| !name.is_empty()),
            ..accessor(view, count, FLOAT, "VEC3")
        };
        GltfIndex::push(&mut self.root.accessors, accessor)
    }

    /// Adds the vertex indices of triangles, in the smallest type that fits `vertices`.
    pub(super) fn indices(
        &mut self,
        triangles: &[[u32; 3]],
        vertices: usize,
    ) -> GltfIndex<Accessor> {
        let corners = triangles.iter().flatten();
        // The largest value of a type is the primitive restart index (glTF 2.0, section 3.7.2.1).
        let short: Option<Vec<u8>> = (vertices <= usize::from(u16::MAX)).then(|| {
            let indices = corners
                .clone()
                .filter_map(|corner| u16::try_from(*corner).ok());
            indices.flat_map(u16::to_le_bytes).collect()
        });
        let (bytes, component) = match short {
            Some(bytes) => (bytes, UNSIGNED_SHORT),
            None => (
                corners.flat_map(|corner| corner.to_le_bytes()).collect(),
                UNSIGNED_INT,
            ),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let accessor = accessor(view, 3 * triangles.len(), component, "SCALAR");
        GltfIndex::push(&mut self.root.accessors, accessor)
    }
}

fn accessor(
    buffer_view: GltfIndex<BufferView>,
    count: usize,
    component_type: u32,
    kind: &'static str,
) -> Accessor {
    Accessor {
        buffer_view,
        count,
        component_type,
        kind,
        min: None,
        max: None,
        name: None,
    }
}

/// The minimum and maximum of each component.
fn extent<const N: usize>(vectors: &[[f32; N]]) -> [Vec<f64>; 2] {
    let mut extent = [[f32::INFINITY; N], [f32::NEG_INFINITY; N]];
    for vector in vectors {
        for (at, number) in vector.iter().enumerate() {
            extent[0][at] = extent[0][at].min(*number);
            extent[1][at] = extent[1][at].max(*number);
        }
    }
    extent.map(|bound| bound.map(f64::from).to_vec())
}

impl ExportReporter<'_> {
    /// Reports that `what` is written to `extras.rtc`.
    pub(super) fn in_extras(&mut self, what: &str, path: ValuePath) {
        let message = format!("{what} is written to `extras.rtc`, which only rtc reads");
        self.report(&codes::GLTF_OWN_WORDS, &message, path);
    }
}
