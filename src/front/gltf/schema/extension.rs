//! The extensions that are known: where their objects stand, what is in them, and whether they can
//! be required.

use super::Value::{
    Attributes, Index, Indices, Many, Number, Numbers, One, Pointer, Text, Truth, Whole, Word,
};
use super::core::{NORMAL_TEXTURE, TEXTURE_INFO};
use super::{Bounds, FACTOR, FREE, Key, Object, POSITIVE, Pool, UNIT, optional, required};

/// An extension.
#[derive(Debug)]
pub(in super::super) struct Extension {
    name: &'static str,
    /// The kinds of objects that carry it, and what they carry.
    pub(super) places: &'static [(&'static str, &'static Object)],
    /// An asset that requires it can be read.
    supported: bool,
}

/// The extension of this name.
pub(in super::super) fn find(name: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.name == name)
}

/// True if an asset may require the extension.
pub(in super::super) fn is_supported(name: &str) -> bool {
    find(name).is_some_and(|extension| extension.supported)
}

const RIGHT_ANGLE: Bounds = Bounds {
    min: 0.0,
    max: std::f64::consts::FRAC_PI_2,
    above: false,
};
const FROM_ONE: Bounds = Bounds {
    min: 1.0,
    max: f64::INFINITY,
    above: false,
};
const MANY: u64 = (1 << 53) - 1;

/// An extension whose objects stand in one kind of object.
const fn known(
    name: &'static str,
    places: &'static [(&'static str, &'static Object)],
) -> Extension {
    Extension {
        name,
        places,
        supported: true,
    }
}

static EXTENSIONS: &[Extension] = &[
    known("EXT_mesh_gpu_instancing", &[("node", &INSTANCING)]),
    known(
        "EXT_meshopt_compression",
        &[("buffer view", &MESHOPT), ("buffer", &FALLBACK)],
    ),
    known("EXT_texture_webp", &[("texture", &SOURCE)]),
    Extension {
        name: "KHR_animation_pointer",
        places: &[("channel target", &ANIMATION_POINTER)],
        supported: false,
    },
    known("KHR_draco_mesh_compression", &[("primitive", &DRACO)]),
    known(
        "KHR_lights_punctual",
        &[("asset", &LIGHTS), ("node", &LIGHT_REFERENCE)],
    ),
    known("KHR_materials_anisotropy", &[("material", &ANISOTROPY)]),
    known("KHR_materials_clearcoat", &[("material", &CLEARCOAT)]),
    known("KHR_materials_dispersion", &[("material", &DISPERSION)]),
    known(
        "KHR_materials_emissive_strength",
        &[("material", &EMISSIVE_STRENGTH)],
    ),
    known("KHR_materials_ior", &[("material", &IOR)]),
    known("KHR_materials_iridescence", &[("material", &IRIDESCENCE)]),
    known(
        "KHR_materials_pbrSpecularGlossiness",
        &[("material", &SPECULAR_GLOSSINESS)],
    ),
    known("KHR_materials_sheen", &[("material", &SHEEN)]),
    known("KHR_materials_specular", &[("material", &SPECULAR)]),
    known("KHR_materials_transmission", &[("material", &TRANSMISSION)]),
    known("KHR_materials_unlit", &[("material", &UNLIT)]),
    known(
        "KHR_materials_variants",
        &[("asset", &VARIANTS), ("primitive", &VARIANT_MAPPINGS)],
    ),
    known("KHR_materials_volume", &[("material", &VOLUME)]),
    known("KHR_mesh_quantization", &[]),
    known(
        "KHR_meshopt_compression",
        &[("buffer view", &MESHOPT), ("buffer", &FALLBACK)],
    ),
    known("KHR_node_visibility", &[("node", &VISIBILITY)]),
    known(
        "KHR_texture_transform",
        &[("texture info", &TEXTURE_TRANSFORM)],
    ),
];

/// An extension object with these properties.
const fn object(keys: &'static [Key]) -> Object {
    Object {
        name: "extension",
        keys,
    }
}

static INSTANCING: Object = object(&[required("attributes", Attributes)]);
static MESHOPT: Object = object(&[
    required("buffer", Index(Pool::Buffers)),
    optional("byteOffset", Whole(0, MANY)),
    required("byteLength", Whole(1, MANY)),
    required("byteStride", Whole(2, 256)),
    required("count", Whole(1, MANY)),
    required("mode", Word(&["ATTRIBUTES", "TRIANGLES", "INDICES"])),
    optional(
        "filter",
        Word(&["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"]),
    ),
]);
static FALLBACK: Object = object(&[optional("fallback", Truth)]);
static SOURCE: Object = object(&[optional("source", Index(Pool::Images))]);
static ANIMATION_POINTER: Object = object(&[required("pointer", Pointer)]);
static DRACO: Object = object(&[
    required("bufferView", Index(Pool::BufferViews)),
    required("attributes", Attributes),
]);
static LIGHTS: Object = object(&[required("lights", Many(&LIGHT))]);
static LIGHT_REFERENCE: Object = object(&[required("light", Index(Pool::Lights))]);
static LIGHT: Object = Object {
    name: "light",
    keys: &[
        optional("name", Text),
        optional("color", Numbers(&[3], UNIT)),
        optional("intensity", Number(FACTOR)),
        optional("spot", One(&SPOT)),
        required("type", Word(&["directional", "point", "spot"])),
        optional("range", Number(POSITIVE)),
    ],
};
static SPOT: Object = Object {
    name: "spot",
    keys: &[
        optional("innerConeAngle", Number(RIGHT_ANGLE)),
        optional("outerConeAngle", Number(RIGHT_ANGLE)),
    ],
};
static ANISOTROPY: Object = object(&[
    optional("anisotropyStrength", Number(UNIT)),
    optional("anisotropyRotation", Number(FREE)),
    optional("anisotropyTexture", One(&TEXTURE_INFO)),
]);
static CLEARCOAT: Object = object(&[
    optional("clearcoatFactor", Number(UNIT)),
    optional("clearcoatTexture", One(&TEXTURE_INFO)),
    optional("clearcoatRoughnessFactor", Number(UNIT)),
    optional("clearcoatRoughnessTexture", One(&TEXTURE_INFO)),
    optional("clearcoatNormalTexture", One(&NORMAL_TEXTURE)),
]);
static DISPERSION: Object = object(&[optional("dispersion", Number(FACTOR))]);
static EMISSIVE_STRENGTH: Object = object(&[optional("emissiveStrength", Number(FACTOR))]);
static IOR: Object = object(&[optional("ior", Number(FACTOR))]);
static IRIDESCENCE: Object = object(&[
    optional("iridescenceFactor", Number(UNIT)),
    optional("iridescenceTexture", One(&TEXTURE_INFO)),
    optional("iridescenceIor", Number(FROM_ONE)),
    optional("iridescenceThicknessMinimum", Number(FACTOR)),
    optional("iridescenceThicknessMaximum", Number(FACTOR)),
    optional("iridescenceThicknessTexture", One(&TEXTURE_INFO)),
]);
static SPECULAR_GLOSSINESS: Object = object(&[
    optional("diffuseFactor", Numbers(&[4], UNIT)),
    optional("diffuseTexture", One(&TEXTURE_INFO)),
    optional("specularFactor", Numbers(&[3], UNIT)),
    optional("glossinessFactor", Number(UNIT)),
    optional("specularGlossinessTexture", One(&TEXTURE_INFO)),
]);
static SHEEN: Object = object(&[
    optional("sheenColorFactor", Numbers(&[3], UNIT)),
    optional("sheenColorTexture", One(&TEXTURE_INFO)),
    optional("sheenRoughnessFactor", Number(UNIT)),
    optional("sheenRoughnessTexture", One(&TEXTURE_INFO)),
]);
static SPECULAR: Object = object(&[
    optional("specularFactor", Number(UNIT)),
    optional("specularTexture", One(&TEXTURE_INFO)),
    optional("specularColorFactor", Numbers(&[3], FACTOR)),
    optional("specularColorTexture", One(&TEXTURE_INFO)),
]);
static TRANSMISSION: Object = object(&[
    optional("transmissionFactor", Number(UNIT)),
    optional("transmissionTexture", One(&TEXTURE_INFO)),
]);
static UNLIT: Object = object(&[]);
static VARIANTS: Object = object(&[required("variants", Many(&VARIANT))]);
static VARIANT: Object = Object {
    name: "variant",
    keys: &[required("name", Text)],
};
static VARIANT_MAPPINGS: Object = object(&[required("mappings", Many(&MAPPING))]);
static MAPPING: Object = Object {
    name: "mapping",
    keys: &[
        required("variants", Indices(Pool::Variants)),
        required("material", Index(Pool::Materials)),
        optional("name", Text),
    ],
};
static VOLUME: Object = object(&[
    optional("thicknessFactor", Number(FACTOR)),
    optional("thicknessTexture", One(&TEXTURE_INFO)),
    optional("attenuationDistance", Number(POSITIVE)),
    optional("attenuationColor", Numbers(&[3], UNIT)),
]);
static VISIBILITY: Object = object(&[optional("visible", Truth)]);
static TEXTURE_TRANSFORM: Object = object(&[
    optional("offset", Numbers(&[2], FREE)),
    optional("rotation", Number(FREE)),
    optional("scale", Numbers(&[2], FREE)),
    optional("texCoord", Whole(0, MANY)),
]);
