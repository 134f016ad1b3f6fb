//! The asset in the making: the document, the binary chunk, and what was written already.

use super::document::{
    Extras, Image, Index, Light, LightReference, Material, Mesh, Node, NodeExtensions, Root,
    Sampler, Texture,
};
use super::material::MaterialKey;
use super::mesh::MeshAccessors;
use crate::beside;
use crate::told::Told;
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
    pub(super) told: Told<'w>,
    /// The folder of files beside the asset, and what they hold; none if all is in one file.
    pub(super) folder: Option<&'w str>,
    pub(super) files: BTreeMap<String, Vec<u8>>,
    /// What was written of each kind, by what it was written for.
    pub(super) images: BTreeMap<u32, Index<Image>>,
    pub(super) textures: BTreeMap<u32, Index<Texture>>,
    pub(super) samplers: BTreeMap<[u32; 3], Index<Sampler>>,
    pub(super) materials: BTreeMap<MaterialKey, Index<Material>>,
    pub(super) attributes: BTreeMap<u32, MeshAccessors>,
    pub(super) meshes: BTreeMap<(u32, u32), Index<Mesh>>,
    /// The picture that stands for the colours (u, 0, v).
    pub(super) uv_image: Option<Index<Image>>,
}

impl<'w> GltfWriter<'w> {
    pub(super) fn new(
        scene: &'w Scene,
        folder: Option<&'w str>,
        budget: &'w Budget,
        told: Told<'w>,
    ) -> Self {
        Self {
            scene,
            root: Root::default(),
            bin: Vec::new(),
            budget,
            told,
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

    /// Adds a file in `folder`; its URI. The words are what it is of, what stands for that where it has
    /// no name, and the extension.
    pub(super) fn file(
        &mut self,
        folder: &str,
        (of, word, extension): (&str, &str, &str),
        bytes: Vec<u8>,
    ) -> String {
        let path = beside::path(folder, of, word, xxh3_64(&bytes), extension);
        let uri = uri_path(&path).to_string();
        self.files.insert(path, bytes);
        uri
    }

    /// Adds a node that the scene shows; `columns` are those of the map from it to the world.
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

/// A number as a 32-bit float.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
pub(super) fn single(number: f64) -> f32 {
    number as f32
}

/// An object of `extras` that holds this under `rtc`; none if there is nothing to hold.
pub(super) fn extras(rtc: Map<String, Value>) -> Extras {
    (!rtc.is_empty()).then(|| json!({ "rtc": rtc }))
}

/// A node that a light hangs on.
pub(super) fn lit(light: Index<Light>) -> Node {
    Node {
        extensions: Some(NodeExtensions {
            punctual: LightReference { light },
        }),
        ..Node::default()
    }
}

/// The number of an image of the scene.
pub(super) fn number(ImageId(id): ImageId) -> u32 {
    id
}
