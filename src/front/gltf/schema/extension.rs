//! The known extensions: the objects that carry them, and their properties. An asset may require
//! each of them.

use super::Value;
use super::Value::{
    Attributes, Boolean, Index, Indices, Integer, Keyword, Many, Number, Numbers, One, Pointer,
    Text,
};
use super::core::{MAX_INTEGER, NORMAL_TEXTURE, TEXTURE_INFO};
use super::{
    FACTOR, FREE, IndexTarget, NumberRange, ObjectSchema, POSITIVE, PropertySchema, UNIT, optional,
    required,
};
use rtc_tables::{MATERIAL_EXTENSIONS, PropertyKind};
use std::sync::LazyLock;

/// An extension.
#[derive(Debug)]
pub(crate) struct Extension {
    pub(super) name: &'static str,
    /// The kinds of objects that carry it, and the object of the extension.
    pub(super) places: &'static [(&'static str, &'static ObjectSchema)],
}

/// The extension of this name.
pub(crate) fn find(name: &str) -> Option<&'static Extension> {
    all().find(|extension| extension.name == name)
}

/// All of them.
pub(super) fn all() -> impl Iterator<Item = &'static Extension> {
    EXTENSIONS.iter().chain(&*OF_MATERIALS)
}

/// A Markdown row for each extension, by name: the objects that carry it, and the supported
/// properties.
pub(crate) fn rows() -> String {
    let mut sorted: Vec<_> = all().collect();
    sorted.sort_unstable_by_key(|extension| extension.name);
    sorted.into_iter().map(row).collect()
}

fn row(extension: &Extension) -> String {
    let Extension { name, places } = extension;
    let carriers: Vec<_> = places.iter().map(|(kind, _)| *kind).collect();
    let all = places.iter().flat_map(|(_, object)| object.keys);
    let mut keys: Vec<_> = all.map(|key| format!("`{}`", key.name)).collect();
    keys.dedup();
    format!(
        "| `{name}` | {} | {} |\n",
        carriers.join(", "),
        keys.join(", ")
    )
}

const RIGHT_ANGLE: NumberRange = NumberRange {
    min: 0.0,
    max: std::f64::consts::FRAC_PI_2,
    above: false,
};
const FROM_ONE: NumberRange = NumberRange {
    min: 1.0,
    max: f64::INFINITY,
    above: false,
};

/// An extension whose objects occur in one kind of object.
const fn extension(
    name: &'static str,
    places: &'static [(&'static str, &'static ObjectSchema)],
) -> Extension {
    Extension { name, places }
}

static EXTENSIONS: &[Extension] = &[
    extension("EXT_mesh_gpu_instancing", &[("node", &INSTANCING)]),
    extension(
        "EXT_meshopt_compression",
        &[("buffer view", &MESHOPT), ("buffer", &FALLBACK)],
    ),
    extension("EXT_texture_webp", &[("texture", &SOURCE)]),
    extension(
        "KHR_animation_pointer",
        &[("channel target", &ANIMATION_POINTER)],
    ),
    extension("KHR_draco_mesh_compression", &[("primitive", &DRACO)]),
    extension("KHR_gaussian_splatting", &[("primitive", &SPLATTING)]),
    extension(
        "KHR_lights_punctual",
        &[("asset", &LIGHTS), ("node", &LIGHT_REFERENCE)],
    ),
    extension(
        "KHR_materials_emissive_strength",
        &[("material", &EMISSIVE_STRENGTH)],
    ),
    extension("KHR_materials_iridescence", &[("material", &IRIDESCENCE)]),
    extension(
        "KHR_materials_pbrSpecularGlossiness",
        &[("material", &SPECULAR_GLOSSINESS)],
    ),
    extension("KHR_materials_unlit", &[("material", &UNLIT)]),
    extension(
        "KHR_materials_variants",
        &[("asset", &VARIANTS), ("primitive", &VARIANT_MAPPINGS)],
    ),
    extension("KHR_mesh_quantization", &[]),
    extension(
        "KHR_meshopt_compression",
        &[("buffer view", &MESHOPT), ("buffer", &FALLBACK)],
    ),
    extension("KHR_node_visibility", &[("node", &VISIBILITY)]),
    extension("KHR_texture_basisu", &[("texture", &SOURCE)]),
    extension(
        "KHR_texture_transform",
        &[("texture info", &TEXTURE_TRANSFORM)],
    ),
    extension(
        "MSFT_lod",
        &[("node", &NODE_LEVELS), ("material", &MATERIAL_LEVELS)],
    ),
];

/// A property of a kind.
const fn value(kind: PropertyKind) -> Value {
    match kind {
        PropertyKind::Fraction => Number(UNIT),
        PropertyKind::Number => Number(FREE),
        PropertyKind::NonNegative => Number(FACTOR),
        PropertyKind::Distance => Number(POSITIVE),
        PropertyKind::Color => Numbers(&[3], FACTOR),
        PropertyKind::FractionColor => Numbers(&[3], UNIT),
        PropertyKind::Map => One(&TEXTURE_INFO),
        PropertyKind::NormalMap => One(&NORMAL_TEXTURE),
    }
}

/// The extensions of the table of parameters.
static OF_MATERIALS: LazyLock<Vec<Extension>> = LazyLock::new(|| {
    let rows = MATERIAL_EXTENSIONS.iter().map(|(name, properties)| {
        let keys = properties.iter();
        let keys = keys.map(|(key, kind, _)| optional(key, value(*kind)));
        let object: &ObjectSchema = Box::leak(Box::new(object(keys.collect::<Vec<_>>().leak())));
        extension(name, vec![("material", object)].leak())
    });
    rows.collect()
});

/// An extension object with these properties.
const fn object(keys: &'static [PropertySchema]) -> ObjectSchema {
    ObjectSchema {
        name: "extension",
        keys,
    }
}

static INSTANCING: ObjectSchema = object(&[required("attributes", Attributes)]);
static MESHOPT: ObjectSchema = object(&[
    required("buffer", Index(IndexTarget::Buffers)),
    optional("byteOffset", Integer(0, MAX_INTEGER)),
    required("byteLength", Integer(1, MAX_INTEGER)),
    required("byteStride", Integer(2, 256)),
    required("count", Integer(1, MAX_INTEGER)),
    required("mode", Keyword(&["ATTRIBUTES", "TRIANGLES", "INDICES"])),
    optional(
        "filter",
        Keyword(&["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"]),
    ),
]);
static FALLBACK: ObjectSchema = object(&[optional("fallback", Boolean)]);
static SOURCE: ObjectSchema = object(&[optional("source", Index(IndexTarget::Images))]);
static ANIMATION_POINTER: ObjectSchema = object(&[required("pointer", Pointer)]);
static DRACO: ObjectSchema = object(&[
    required("bufferView", Index(IndexTarget::BufferViews)),
    required("attributes", Attributes),
]);
static LIGHTS: ObjectSchema = object(&[required("lights", Many(&LIGHT))]);
static LIGHT_REFERENCE: ObjectSchema = object(&[required("light", Index(IndexTarget::Lights))]);
static LIGHT: ObjectSchema = ObjectSchema {
    name: "light",
    keys: &[
        optional("name", Text),
        optional("color", Numbers(&[3], UNIT)),
        optional("intensity", Number(FACTOR)),
        optional("spot", One(&SPOT)),
        required("type", Keyword(&["directional", "point", "spot"])),
        optional("range", Number(POSITIVE)),
    ],
};
static SPOT: ObjectSchema = ObjectSchema {
    name: "spot",
    keys: &[
        optional("innerConeAngle", Number(RIGHT_ANGLE)),
        optional("outerConeAngle", Number(RIGHT_ANGLE)),
    ],
};
static EMISSIVE_STRENGTH: ObjectSchema = object(&[optional("emissiveStrength", Number(FACTOR))]);
static IRIDESCENCE: ObjectSchema = object(&[
    optional("iridescenceFactor", Number(UNIT)),
    optional("iridescenceTexture", One(&TEXTURE_INFO)),
    optional("iridescenceIor", Number(FROM_ONE)),
    optional("iridescenceThicknessMinimum", Number(FACTOR)),
    optional("iridescenceThicknessMaximum", Number(FACTOR)),
    optional("iridescenceThicknessTexture", One(&TEXTURE_INFO)),
]);
static SPECULAR_GLOSSINESS: ObjectSchema = object(&[
    optional("diffuseFactor", Numbers(&[4], UNIT)),
    optional("diffuseTexture", One(&TEXTURE_INFO)),
    optional("specularFactor", Numbers(&[3], UNIT)),
    optional("glossinessFactor", Number(UNIT)),
    optional("specularGlossinessTexture", One(&TEXTURE_INFO)),
]);
static UNLIT: ObjectSchema = object(&[]);
static VARIANTS: ObjectSchema = object(&[required("variants", Many(&VARIANT))]);
static VARIANT: ObjectSchema = ObjectSchema {
    name: "variant",
    keys: &[required("name", Text)],
};
static VARIANT_MAPPINGS: ObjectSchema = object(&[required("mappings", Many(&MAPPING))]);
static MAPPING: ObjectSchema = ObjectSchema {
    name: "mapping",
    keys: &[
        required("variants", Indices(IndexTarget::Variants)),
        required("material", Index(IndexTarget::Materials)),
        optional("name", Text),
    ],
};
static NODE_LEVELS: ObjectSchema = object(&[required("ids", Indices(IndexTarget::Nodes))]);
static MATERIAL_LEVELS: ObjectSchema = object(&[required("ids", Indices(IndexTarget::Materials))]);
static SPLATTING: ObjectSchema = object(&[
    optional("kernel", Text),
    optional("colorSpace", Text),
    optional("projection", Text),
    optional("sortingMethod", Text),
]);
static VISIBILITY: ObjectSchema = object(&[optional("visible", Boolean)]);
static TEXTURE_TRANSFORM: ObjectSchema = object(&[
    optional("offset", Numbers(&[2], FREE)),
    optional("rotation", Number(FREE)),
    optional("scale", Numbers(&[2], FREE)),
    optional("texCoord", Integer(0, MAX_INTEGER)),
]);

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::{Map, Standard};

    /// Readers and writers find the parameter by its name and its type.
    #[test]
    fn each_property_is_a_parameter_of_its_kind() {
        let standard = Standard::default();
        for (key, kind, name) in MATERIAL_EXTENSIONS.iter().flat_map(|(_, all)| *all) {
            let parameter = standard.parameter(name).expect(name);
            let is_right = match kind {
                PropertyKind::Fraction | PropertyKind::Number | PropertyKind::NonNegative => {
                    parameter.is::<f64>()
                }
                PropertyKind::Distance => parameter.is::<Option<f64>>(),
                PropertyKind::Color | PropertyKind::FractionColor => parameter.is::<[f64; 3]>(),
                PropertyKind::Map | PropertyKind::NormalMap => parameter.is::<Option<Map>>(),
            };
            assert!(is_right, "{key}");
        }
    }
}
