//! The asset in the making: the document in the types of `gltf::json`, the binary chunk, and what
//! was written already.

use super::material::MaterialKey;
use super::mesh::MeshAccessors;
use crate::emit::beside;
use crate::emit::told::Told;
use crate::ir::{ImageId, Scene};
use crate::source::{Budget, uri_path};
use gltf::json;
use json::extensions::scene::Node as NodeExtensions;
use json::{Index, Node, Root, Value};
use serde_json::value::to_raw_value;
use std::collections::{BTreeMap, BTreeSet};
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
    /// Numbers that `gltf::json` rounds to 32 bits, as they are, by JSON pointers to where they
    /// stand.
    pub(super) exact: Vec<(String, Value)>,
    /// The extensions that are used.
    pub(super) used: BTreeSet<&'static str>,
    /// The nodes that the scene shows.
    pub(super) nodes: Vec<Index<Node>>,
    /// What was written of each kind, by what it was written for.
    pub(super) images: BTreeMap<u32, Index<json::Image>>,
    pub(super) textures: BTreeMap<u32, Index<json::Texture>>,
    pub(super) samplers: BTreeMap<[u8; 3], Index<json::texture::Sampler>>,
    pub(super) materials: BTreeMap<MaterialKey, Index<json::Material>>,
    pub(super) attributes: BTreeMap<u32, MeshAccessors>,
    pub(super) meshes: BTreeMap<(u32, usize), Index<json::Mesh>>,
    /// The picture that stands for the colours (u, 0, v).
    pub(super) uv_image: Option<Index<json::Image>>,
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
            exact: Vec::new(),
            used: BTreeSet::new(),
            nodes: Vec::new(),
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
        let mut matrix = None;
        if columns != IDENTITY {
            let [x, y, z, origin] = columns;
            let rows = [(x, 0.0), (y, 0.0), (z, 0.0), (origin, 1.0)];
            let numbers: Vec<f64> = rows
                .into_iter()
                .flat_map(|([x, y, z], w)| [x, y, z, w])
                .collect();
            let pointer = format!("/nodes/{}/matrix", self.root.nodes.len());
            matrix =
                <[f32; 16]>::try_from(numbers.iter().map(|n| single(*n)).collect::<Vec<_>>()).ok();
            self.exact.push((pointer, numbers.into()));
        }
        let index = self.root.push(Node { matrix, ..node });
        self.nodes.push(index);
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
pub(super) fn extras(rtc: serde_json::Map<String, Value>) -> json::Extras {
    if rtc.is_empty() {
        return None;
    }
    to_raw_value(&serde_json::json!({ "rtc": rtc })).ok()
}

/// A node that a light hangs on.
pub(super) fn lit(light: u32) -> Node {
    let reference = json::extensions::scene::khr_lights_punctual::KhrLightsPunctual {
        light: Index::new(light),
    };
    Node {
        extensions: Some(NodeExtensions {
            khr_lights_punctual: Some(reference),
            ..NodeExtensions::default()
        }),
        ..Node::default()
    }
}

/// The number of an image of the scene.
pub(super) fn number(ImageId(id): ImageId) -> u32 {
    id
}
