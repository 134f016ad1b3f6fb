//! An asset as typed objects, each with the JSON node that it was read from. References are
//! indices.

use super::accessor::Accessor;
use super::animation::{Animation, Keyframes};
use super::buffer::{Buffer, BufferView};
use super::channel::AnimationChannel;
use super::field::ObjectFields;
use super::image::Image;
use super::mesh::Mesh;
use super::node::Node;
use super::primitive::Primitive;
use super::skin::Skin;
use super::texture::{Texture, TextureSampler};
use rtc_source::tree::{NodeId, SyntaxTree};
use std::collections::BTreeSet;

/// An asset.
#[derive(Debug)]
pub(super) struct Document<'s> {
    pub(super) buffers: Vec<Buffer<'s>>,
    pub(super) views: Vec<BufferView>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) images: Vec<Image>,
    /// The decoded images, without names.
    pub(super) pictures: Vec<rtc_ir::Image>,
    pub(super) samplers: Vec<TextureSampler>,
    pub(super) textures: Vec<Texture>,
    /// Where each material was written; its many optional parts are read when it is lowered.
    pub(super) materials: Vec<NodeId>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) nodes: Vec<Node>,
    pub(super) skins: Vec<Skin>,
    pub(super) animations: Vec<Animation>,
    /// Where each camera was written.
    pub(super) cameras: Vec<NodeId>,
    /// Where each light was written.
    pub(super) lights: Vec<NodeId>,
    pub(super) scenes: Vec<Scene>,
    /// The scene that is shown.
    pub(super) scene: Option<usize>,
    /// The names in `extensionsUsed`.
    pub(super) extensions: BTreeSet<String>,
    /// It is a `.glb`.
    pub(super) is_glb: bool,
}

/// A scene: the roots that it shows.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) at: NodeId,
    pub(super) nodes: Vec<usize>,
}

/// Bytes that a value of the text becomes, its node in the tree included.
const VALUE: u64 = 40;
/// Bytes that a node takes while the asset is lowered, beside its part of the document.
const PLACED: usize = 256;

/// Bytes that the parts of an asset take. An item of a list counts as a part, whatever it is.
pub(super) fn cost(json: &SyntaxTree<'_>) -> u64 {
    let count = |map: NodeId, key| json.list(map, key).count();
    let inner = |key, part| {
        json.list(json.root(), key)
            .map(|map| count(map, part))
            .sum::<usize>()
    };
    let parts = [
        (count(json.root(), "bufferViews"), size_of::<BufferView>()),
        (count(json.root(), "accessors"), size_of::<Accessor>()),
        (count(json.root(), "images"), size_of::<Image>()),
        (count(json.root(), "meshes"), size_of::<Mesh>()),
        (inner("meshes", "primitives"), size_of::<Primitive>()),
        (count(json.root(), "nodes"), size_of::<Node>() + PLACED),
        (count(json.root(), "skins"), size_of::<Skin>()),
        (count(json.root(), "animations"), size_of::<Animation>()),
        (
            inner("animations", "channels"),
            size_of::<AnimationChannel>(),
        ),
        (inner("animations", "samplers"), size_of::<Keyframes>()),
    ];
    let parts: u64 = parts
        .iter()
        .map(|(count, size)| *count as u64 * *size as u64)
        .sum();
    parts.saturating_add(VALUE * json.count() as u64)
}

impl Document<'_> {
    /// Reads the parts; buffers are still empty.
    pub(super) fn read(json: &SyntaxTree<'_>, is_glb: bool) -> Self {
        fn each<'t, 's: 't, T>(
            root: ObjectFields<'t, 's>,
            key: &str,
            read: impl Fn(ObjectFields<'t, 's>) -> T,
        ) -> Vec<T> {
            root.objects(key).map(read).collect()
        }
        let root = ObjectFields::new(json, json.root());
        // Lights exist only if the asset declares their extension.
        let texts = json
            .list(json.root(), "extensionsUsed")
            .filter_map(|item| json.text(item));
        let extensions: BTreeSet<String> = texts.map(str::to_owned).collect();
        let has_lights = extensions.contains("KHR_lights_punctual");
        let lights = root.extension("KHR_lights_punctual").filter(|_| has_lights);
        // Read each array of the root object.
        Self {
            buffers: each(root, "buffers", Buffer::read),
            views: each(root, "bufferViews", BufferView::read),
            accessors: each(root, "accessors", Accessor::read),
            images: each(root, "images", Image::read),
            pictures: Vec::new(),
            samplers: each(root, "samplers", TextureSampler::read),
            textures: each(root, "textures", Texture::read),
            materials: each(root, "materials", |fields| fields.at),
            meshes: each(root, "meshes", Mesh::read),
            nodes: each(root, "nodes", Node::read),
            skins: each(root, "skins", Skin::read),
            animations: each(root, "animations", Animation::read),
            cameras: each(root, "cameras", |fields| fields.at),
            lights: lights.map_or_else(Vec::new, |lights| {
                each(lights, "lights", |fields| fields.at)
            }),
            scenes: each(root, "scenes", |fields| Scene {
                at: fields.at,
                nodes: fields.indices("nodes"),
            }),
            scene: root.index("scene"),
            extensions,
            is_glb,
        }
    }

    pub(super) fn uses(&self, extension: &str) -> bool {
        self.extensions.contains(extension)
    }
}
