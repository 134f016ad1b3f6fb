//! The objects of glTF 2.0 itself (specification, chapter 5).

use super::Value::{
    Attributes, Boolean, Choice, Index, Indices, Integer, Keyword, Many, Number, Numbers, One,
    PerComponent, Targets, Text, Texts, Version,
};
use super::{
    FACTOR, FREE, IndexTarget, ObjectSchema, POSITIVE, PropertySchema, SIGNED, UNIT, optional,
    required,
};

/// The greatest number a property takes that has no other bound: up to it floats hold every whole
/// number.
pub(super) const MAX_INTEGER: u64 = (1 << 53) - 1;
const NAME: PropertySchema = optional("name", Text);

pub(super) static ROOT: ObjectSchema = ObjectSchema {
    name: "asset",
    keys: &[
        optional("extensionsUsed", Texts),
        optional("extensionsRequired", Texts),
        optional("accessors", Many(&ACCESSOR)),
        optional("animations", Many(&ANIMATION)),
        required("asset", One(&ASSET)),
        optional("buffers", Many(&BUFFER)),
        optional("bufferViews", Many(&BUFFER_VIEW)),
        optional("cameras", Many(&CAMERA)),
        optional("images", Many(&IMAGE)),
        optional("materials", Many(&MATERIAL)),
        optional("meshes", Many(&MESH)),
        optional("nodes", Many(&NODE)),
        optional("samplers", Many(&SAMPLER)),
        optional("scene", Index(IndexTarget::Scenes)),
        optional("scenes", Many(&SCENE)),
        optional("skins", Many(&SKIN)),
        optional("textures", Many(&TEXTURE)),
    ],
};

static ASSET: ObjectSchema = ObjectSchema {
    name: "asset header",
    keys: &[
        optional("copyright", Text),
        optional("generator", Text),
        required("version", Version),
        optional("minVersion", Version),
    ],
};

static ACCESSOR: ObjectSchema = ObjectSchema {
    name: "accessor",
    keys: &[
        NAME,
        optional("bufferView", Index(IndexTarget::BufferViews)),
        optional("byteOffset", Integer(0, MAX_INTEGER)),
        required(
            "componentType",
            Choice(&[5120, 5121, 5122, 5123, 5125, 5126]),
        ),
        optional("normalized", Boolean),
        required("count", Integer(1, MAX_INTEGER)),
        required(
            "type",
            Keyword(&["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]),
        ),
        optional("min", PerComponent),
        optional("max", PerComponent),
        optional("sparse", One(&SPARSE)),
    ],
};

static SPARSE: ObjectSchema = ObjectSchema {
    name: "sparse part",
    keys: &[
        required("count", Integer(1, MAX_INTEGER)),
        required("indices", One(&SPARSE_INDICES)),
        required("values", One(&SPARSE_VALUES)),
    ],
};

static SPARSE_INDICES: ObjectSchema = ObjectSchema {
    name: "sparse indices",
    keys: &[
        required("bufferView", Index(IndexTarget::BufferViews)),
        optional("byteOffset", Integer(0, MAX_INTEGER)),
        required("componentType", Choice(&[5121, 5123, 5125])),
    ],
};

static SPARSE_VALUES: ObjectSchema = ObjectSchema {
    name: "sparse values",
    keys: &[
        required("bufferView", Index(IndexTarget::BufferViews)),
        optional("byteOffset", Integer(0, MAX_INTEGER)),
    ],
};

static BUFFER: ObjectSchema = ObjectSchema {
    name: "buffer",
    keys: &[
        NAME,
        optional("uri", Text),
        required("byteLength", Integer(1, MAX_INTEGER)),
    ],
};

static BUFFER_VIEW: ObjectSchema = ObjectSchema {
    name: "buffer view",
    keys: &[
        NAME,
        required("buffer", Index(IndexTarget::Buffers)),
        optional("byteOffset", Integer(0, MAX_INTEGER)),
        required("byteLength", Integer(1, MAX_INTEGER)),
        optional("byteStride", Integer(4, 252)),
        optional("target", Choice(&[34962, 34963])),
    ],
};

static CAMERA: ObjectSchema = ObjectSchema {
    name: "camera",
    keys: &[
        NAME,
        required("type", Keyword(&["perspective", "orthographic"])),
        optional("perspective", One(&PERSPECTIVE)),
        optional("orthographic", One(&ORTHOGRAPHIC)),
    ],
};

static PERSPECTIVE: ObjectSchema = ObjectSchema {
    name: "perspective",
    keys: &[
        optional("aspectRatio", Number(POSITIVE)),
        required("yfov", Number(POSITIVE)),
        optional("zfar", Number(POSITIVE)),
        required("znear", Number(POSITIVE)),
    ],
};

static ORTHOGRAPHIC: ObjectSchema = ObjectSchema {
    name: "orthographic projection",
    keys: &[
        required("xmag", Number(FREE)),
        required("ymag", Number(FREE)),
        required("zfar", Number(POSITIVE)),
        required("znear", Number(FACTOR)),
    ],
};

static IMAGE: ObjectSchema = ObjectSchema {
    name: "image",
    keys: &[
        NAME,
        optional("uri", Text),
        optional(
            "mimeType",
            Keyword(&["image/jpeg", "image/png", "image/webp", "image/ktx2"]),
        ),
        optional("bufferView", Index(IndexTarget::BufferViews)),
    ],
};

static TEXTURE: ObjectSchema = ObjectSchema {
    name: "texture",
    keys: &[
        NAME,
        optional("sampler", Index(IndexTarget::Samplers)),
        optional("source", Index(IndexTarget::Images)),
    ],
};

const WRAPS: super::Value = Choice(&[33071, 33648, 10497]);

static SAMPLER: ObjectSchema = ObjectSchema {
    name: "sampler",
    keys: &[
        NAME,
        optional("magFilter", Choice(&[9728, 9729])),
        optional("minFilter", Choice(&[9728, 9729, 9984, 9985, 9986, 9987])),
        optional("wrapS", WRAPS),
        optional("wrapT", WRAPS),
    ],
};

pub(super) static TEXTURE_INFO: ObjectSchema = ObjectSchema {
    name: "texture info",
    keys: &[
        required("index", Index(IndexTarget::Textures)),
        optional("texCoord", Integer(0, MAX_INTEGER)),
    ],
};

pub(super) static NORMAL_TEXTURE: ObjectSchema = ObjectSchema {
    name: "texture info",
    keys: &[
        required("index", Index(IndexTarget::Textures)),
        optional("texCoord", Integer(0, MAX_INTEGER)),
        optional("scale", Number(FREE)),
    ],
};

static OCCLUSION_TEXTURE: ObjectSchema = ObjectSchema {
    name: "texture info",
    keys: &[
        required("index", Index(IndexTarget::Textures)),
        optional("texCoord", Integer(0, MAX_INTEGER)),
        optional("strength", Number(UNIT)),
    ],
};

static MATERIAL: ObjectSchema = ObjectSchema {
    name: "material",
    keys: &[
        NAME,
        optional("pbrMetallicRoughness", One(&METALLIC_ROUGHNESS)),
        optional("normalTexture", One(&NORMAL_TEXTURE)),
        optional("occlusionTexture", One(&OCCLUSION_TEXTURE)),
        optional("emissiveTexture", One(&TEXTURE_INFO)),
        optional("emissiveFactor", Numbers(&[3], UNIT)),
        optional("alphaMode", Keyword(&["OPAQUE", "MASK", "BLEND"])),
        optional("alphaCutoff", Number(FACTOR)),
        optional("doubleSided", Boolean),
    ],
};

static METALLIC_ROUGHNESS: ObjectSchema = ObjectSchema {
    name: "metallic-roughness model",
    keys: &[
        optional("baseColorFactor", Numbers(&[4], UNIT)),
        optional("baseColorTexture", One(&TEXTURE_INFO)),
        optional("metallicFactor", Number(UNIT)),
        optional("roughnessFactor", Number(UNIT)),
        optional("metallicRoughnessTexture", One(&TEXTURE_INFO)),
    ],
};

static MESH: ObjectSchema = ObjectSchema {
    name: "mesh",
    keys: &[
        NAME,
        required("primitives", Many(&PRIMITIVE)),
        optional("weights", Numbers(&[], FREE)),
    ],
};

static PRIMITIVE: ObjectSchema = ObjectSchema {
    name: "primitive",
    keys: &[
        required("attributes", Attributes),
        optional("indices", Index(IndexTarget::Accessors)),
        optional("material", Index(IndexTarget::Materials)),
        optional("mode", Integer(0, 6)),
        optional("targets", Targets),
    ],
};

static NODE: ObjectSchema = ObjectSchema {
    name: "node",
    keys: &[
        NAME,
        optional("camera", Index(IndexTarget::Cameras)),
        optional("children", Indices(IndexTarget::Nodes)),
        optional("skin", Index(IndexTarget::Skins)),
        optional("matrix", Numbers(&[16], FREE)),
        optional("mesh", Index(IndexTarget::Meshes)),
        optional("rotation", Numbers(&[4], SIGNED)),
        optional("scale", Numbers(&[3], FREE)),
        optional("translation", Numbers(&[3], FREE)),
        optional("weights", Numbers(&[], FREE)),
    ],
};

static SCENE: ObjectSchema = ObjectSchema {
    name: "scene",
    keys: &[NAME, optional("nodes", Indices(IndexTarget::Nodes))],
};

static SKIN: ObjectSchema = ObjectSchema {
    name: "skin",
    keys: &[
        NAME,
        optional("inverseBindMatrices", Index(IndexTarget::Accessors)),
        optional("skeleton", Index(IndexTarget::Nodes)),
        required("joints", Indices(IndexTarget::Nodes)),
    ],
};

static ANIMATION: ObjectSchema = ObjectSchema {
    name: "animation",
    keys: &[
        NAME,
        required("channels", Many(&CHANNEL)),
        required("samplers", Many(&ANIMATION_SAMPLER)),
    ],
};

static CHANNEL: ObjectSchema = ObjectSchema {
    name: "channel",
    keys: &[
        required("sampler", Index(IndexTarget::Own)),
        required("target", One(&TARGET)),
    ],
};

static TARGET: ObjectSchema = ObjectSchema {
    name: "channel target",
    keys: &[
        optional("node", Index(IndexTarget::Nodes)),
        required(
            "path",
            Keyword(&["translation", "rotation", "scale", "weights", "pointer"]),
        ),
    ],
};

static ANIMATION_SAMPLER: ObjectSchema = ObjectSchema {
    name: "animation sampler",
    keys: &[
        required("input", Index(IndexTarget::Accessors)),
        optional("interpolation", Keyword(&["LINEAR", "STEP", "CUBICSPLINE"])),
        required("output", Index(IndexTarget::Accessors)),
    ],
};
