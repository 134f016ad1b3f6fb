//! The state of the glTF writer: the document, the binary chunk, and the objects written so far.

use super::document::{
    Extras, Image, Index, Light, LightReference, Material, Mesh, Node, NodeExtensions, Root,
    Sampler, Texture,
};
use super::material::MaterialKey;
use super::mesh::MeshAccessors;
use crate::reporter::Reporter;
use crate::sidecar;
use rtc_ir::{ImageId, Scene};
use rtc_source::{Budget, uri_path};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::xxh3_64;

/// Writes a scene of meshes.
pub(super) struct GltfWriter<'w> {
    pub(super) scene: &'w Scene,
    pub(super) root: Root,
    pub(super) bin: Vec<u8>,
    pub(super) budget: &'w Budget,
    pub(super) reporter: Reporter<'w>,
    /// The folder of sidecar files and their contents; `None` if there is one file only.
    pub(super) folder: Option<&'w str>,
    pub(super) files: BTreeMap<String, Vec<u8>>,
    /// The objects written so far, by what they were written for.
    pub(super) images: BTreeMap<u32, Index<Image>>,
    pub(super) textures: BTreeMap<u32, Index<Texture>>,
    pub(super) samplers: BTreeMap<[u32; 3], Index<Sampler>>,
    pub(super) materials: BTreeMap<MaterialKey, Index<Material>>,
    pub(super) attributes: BTreeMap<u32, MeshAccessors>,
    pub(super) meshes: BTreeMap<(u32, u32), Index<Mesh>>,
    /// The image of the colours (u, 0, v).
    pub(super) uv_image: Option<Index<Image>>,
}

impl<'w> GltfWriter<'w> {
    pub(super) fn new(
        scene: &'w Scene,
        folder: Option<&'w str>,
        budget: &'w Budget,
        reporter: Reporter<'w>,
    ) -> Self {
        Self {
            scene,
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
            uv_image: None,
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
        let index = Index::push(&mut self.root.nodes, Node { matrix, ..node });
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
pub(super) fn lit(light: Index<Light>) -> Node {
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
