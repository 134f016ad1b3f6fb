//! The glTF document: the objects of glTF 2.0 that are written, with the names of the
//! specification.
//!
//! Properties with default values are omitted. The order of the fields is that of the file.

use rtc_math::to_u32;
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::marker::PhantomData;

/// Component type: u16.
pub(super) const UNSIGNED_SHORT: u32 = 5123;
/// Component type: u32.
pub(super) const UNSIGNED_INT: u32 = 5125;
/// Component type: f32.
pub(super) const FLOAT: u32 = 5126;
/// Buffer view target: vertex attributes.
pub(super) const ARRAY_BUFFER: u32 = 34962;
/// Buffer view target: vertex indices.
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34963;
/// Sampler filter: nearest.
pub(super) const NEAREST_FILTER: u32 = 9728;
/// Sampler filter: linear.
pub(super) const LINEAR: u32 = 9729;
/// Sampler filter: linear with linear mipmapping.
pub(super) const LINEAR_MIPMAP_LINEAR: u32 = 9987;
/// Wrap mode: clamp to edge.
pub(super) const CLAMP_TO_EDGE: u32 = 33071;
/// Wrap mode: mirrored repeat.
pub(super) const MIRRORED_REPEAT: u32 = 33648;
/// Wrap mode: repeat.
pub(super) const REPEAT: u32 = 10497;

/// Application-specific data, if any.
pub(super) type Extras = Option<Value>;

/// The index of an object in its array.
#[derive(Serialize)]
#[serde(transparent)]
pub(super) struct GltfIndex<T>(u32, PhantomData<fn() -> T>);

impl<T> GltfIndex<T> {
    /// Adds an object to its array.
    pub(super) fn push(list: &mut Vec<T>, part: T) -> Self {
        list.push(part);
        let last = to_u32(list.len() - 1);
        Self(last, PhantomData)
    }

    pub(super) fn value(self) -> u32 {
        self.0
    }
}

impl<T> Clone for GltfIndex<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for GltfIndex<T> {}

/// The root object. It has one scene.
#[derive(Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Root {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) accessors: Vec<Accessor>,
    pub(super) asset: Asset,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) buffers: Vec<Buffer>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) buffer_views: Vec<BufferView>,
    pub(super) scene: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<RootExtensions>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Extras,
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    pub(super) extensions_used: BTreeSet<&'static str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) cameras: Vec<Camera>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) images: Vec<Image>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) materials: Vec<Material>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) meshes: Vec<Mesh>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) nodes: Vec<Node>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) samplers: Vec<Sampler>,
    pub(super) scenes: [Scene; 1],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) textures: Vec<Texture>,
}

/// The generator and the glTF version.
#[derive(Default, Serialize)]
pub(super) struct Asset {
    pub(super) generator: &'static str,
    pub(super) version: &'static str,
}

/// The root nodes.
#[derive(Default, Serialize)]
pub(super) struct Scene {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) nodes: Vec<GltfIndex<Node>>,
}

/// A node. Its matrix is column-major.
#[derive(Default, Serialize)]
pub(super) struct Node {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) camera: Option<GltfIndex<Camera>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<NodeExtensions>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Extras,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) matrix: Option<[f64; 16]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<GltfIndex<Mesh>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
}

/// A mesh.
#[derive(Serialize)]
pub(super) struct Mesh {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    pub(super) primitives: [Primitive; 1],
}

/// A triangle primitive with one material.
#[derive(Serialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: GltfIndex<Accessor>,
    pub(super) material: GltfIndex<Material>,
}

/// Vertex attributes.
#[derive(Clone, Copy, Default, Serialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Attributes {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) position: Option<GltfIndex<Accessor>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) normal: Option<GltfIndex<Accessor>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) tangent: Option<GltfIndex<Accessor>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) color_0: Option<GltfIndex<Accessor>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) texcoord_0: Option<GltfIndex<Accessor>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) texcoord_1: Option<GltfIndex<Accessor>>,
}

/// A typed view of a buffer view.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: GltfIndex<BufferView>,
    pub(super) count: usize,
    pub(super) component_type: u32,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) min: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
}

/// A byte range of a buffer.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u32,
    pub(super) byte_length: usize,
    pub(super) byte_offset: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) target: Option<u32>,
}

/// A buffer: a file, or the binary chunk.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) byte_length: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) uri: Option<String>,
}

/// An image in a buffer view or in a file.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) buffer_view: Option<GltfIndex<BufferView>>,
    pub(super) mime_type: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) uri: Option<String>,
}

/// A texture sampler.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) mag_filter: u32,
    pub(super) min_filter: u32,
    pub(super) wrap_s: u32,
    pub(super) wrap_t: u32,
}

/// An image with its sampler.
#[derive(Serialize)]
pub(super) struct Texture {
    pub(super) sampler: GltfIndex<Sampler>,
    pub(super) source: GltfIndex<Image>,
}

/// A reference to a texture. A normal map has a scale.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: GltfIndex<Texture>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<f64>,
    pub(super) tex_coord: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<Value>,
}

/// A material, with its extensions by name.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) alpha_cutoff: Option<f64>,
    pub(super) alpha_mode: &'static str,
    pub(super) double_sided: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: PbrMetallicRoughness,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) normal_texture: Option<TextureInfo>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) emissive_texture: Option<TextureInfo>,
    pub(super) emissive_factor: [f64; 3],
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub(super) extensions: Map<String, Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Extras,
}

/// The metallic-roughness parameters.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct PbrMetallicRoughness {
    pub(super) base_color_factor: [f64; 4],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_factor: f64,
    pub(super) roughness_factor: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
}

/// A camera, which looks along its −z axis.
#[derive(Serialize)]
pub(super) struct Camera {
    #[serde(flatten)]
    pub(super) projection: Projection,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Extras,
}

/// A projection.
#[derive(Serialize)]
#[serde(rename_all = "camelCase", rename_all_fields = "camelCase")]
pub(super) enum Projection {
    /// Perspective, by vertical field of view.
    Perspective {
        aspect_ratio: f64,
        yfov: f64,
        znear: f64,
    },
    /// Orthographic, by half width and half height.
    Orthographic {
        xmag: f64,
        ymag: f64,
        zfar: f64,
        znear: f64,
    },
}

/// The extensions of the document.
#[derive(Default, Serialize)]
pub(super) struct RootExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) punctual: Lights,
}

/// All lights.
#[derive(Default, Serialize)]
pub(super) struct Lights {
    pub(super) lights: Vec<Light>,
}

/// A light of `KHR_lights_punctual`, which points along its −z axis.
#[derive(Serialize)]
pub(super) struct Light {
    pub(super) color: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Extras,
    pub(super) intensity: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) range: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) spot: Option<Spot>,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
}

/// The cone of a spot light.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Spot {
    pub(super) inner_cone_angle: f64,
    pub(super) outer_cone_angle: f64,
}

/// The extensions of a node.
#[derive(Serialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) punctual: LightReference,
}

/// The light of a node.
#[derive(Serialize)]
pub(super) struct LightReference {
    pub(super) light: GltfIndex<Light>,
}
