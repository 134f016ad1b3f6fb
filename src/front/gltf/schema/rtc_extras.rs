//! The properties of `extras.rtc`: values that glTF can't express, as `emit/gltf` writes them.

use super::Value::{Boolean, Index, Integer, Keyword, Many, Number, Numbers, One, Text};
use super::core::TEXTURE_INFO;
use super::{
    FACTOR, FREE, IndexTarget, ObjectSchema, POSITIVE, PropertySchema, optional, required,
};
use rtc_ir::Settings;
use rtc_math::GradientNoise;
use serde_json::Value as Json;
use std::sync::LazyLock;

/// The object that `extras.rtc` of a kind of object is, if it is read there.
pub(super) fn find(owner: &str) -> Option<&'static ObjectSchema> {
    match owner {
        "asset" => Some(&SETTINGS),
        "camera" => Some(&CAMERA),
        "light" => Some(&LIGHT),
        "material" => Some(&MATERIAL),
        "node" => Some(&NODE),
        _ => None,
    }
}

/// The greatest count.
const MAX_COUNT: u64 = u32::MAX as u64;

/// An object of `extras.rtc`.
const fn rtc_object(keys: &'static [PropertySchema]) -> ObjectSchema {
    ObjectSchema {
        name: "part of `extras.rtc`",
        keys,
    }
}

/// The settings of the picture, by their names in the IR, and the environment; the mode is a word,
/// with its parameters apart.
static SETTINGS: LazyLock<ObjectSchema> = LazyLock::new(|| {
    let schema = Json::from(Settings::schema());
    let fields = schema["properties"].as_object().into_iter().flatten();
    let settings = fields.map(|(name, field)| {
        let definition = field["$ref"]
            .as_str()
            .and_then(|path| schema.pointer(path.trim_start_matches('#')));
        optional(name.clone().leak(), value_of(definition.unwrap_or(field)))
    });
    let parts = [
        optional("gooch", One(&GOOCH)),
        optional("path", One(&PATH)),
        optional("display", One(&DISPLAY)),
        optional("environment", One(&ENVIRONMENT)),
        optional("medium", One(&MEDIUM)),
    ];
    rtc_object(settings.chain(parts).collect::<Vec<_>>().leak())
});

/// What a setting takes, by its schema.
fn value_of(schema: &Json) -> super::Value {
    let bound = |key: &str, unbound| schema[key].as_f64().unwrap_or(unbound);
    match schema["type"]
        .as_str()
        .or_else(|| schema["type"][0].as_str())
    {
        Some("boolean") => Boolean,
        Some("integer") => Integer(schema["minimum"].as_u64().unwrap_or(0), MAX_COUNT),
        Some("number") => Number(super::NumberRange {
            min: bound("minimum", f64::NEG_INFINITY),
            max: bound("maximum", f64::INFINITY),
            above: false,
        }),
        // The moments of a shutter, or a colour.
        Some("array") if schema["minItems"] == 2 => Numbers(&[2], FREE),
        Some("array") => Numbers(&[3], FACTOR),
        _ => {
            // Variants: a word, or an object of parameters under one.
            let variants = schema["oneOf"].as_array().into_iter().flatten();
            let words = variants.filter_map(|variant| {
                let parameters = || variant["properties"].as_object()?.keys().next();
                let word = variant["const"].as_str();
                word.or_else(|| parameters().map(String::as_str))
                    .map(str::to_owned)
            });
            let words = words.map(|word| &*word.leak());
            Keyword(words.collect::<Vec<_>>().leak())
        }
    }
}

static GOOCH: ObjectSchema = rtc_object(&[
    required("b", Number(FREE)),
    required("y", Number(FREE)),
    required("alpha", Number(FREE)),
    required("beta", Number(FREE)),
]);
static PATH: ObjectSchema = rtc_object(&[
    required("samples", Integer(1, MAX_COUNT)),
    optional("multipleScattering", Boolean),
    optional("caustics", Boolean),
    optional("filter", One(&FILTER)),
]);
/// The filter of the pixels: the first of these.
static FILTER: ObjectSchema = rtc_object(&[
    optional("box", One(&FILTER_NUMBERS)),
    optional("tent", One(&FILTER_NUMBERS)),
    optional("gaussian", One(&FILTER_NUMBERS)),
    optional("mitchell", One(&FILTER_NUMBERS)),
    optional("lanczos", One(&FILTER_NUMBERS)),
]);
static FILTER_NUMBERS: ObjectSchema = rtc_object(&[
    required("radius", Number(POSITIVE)),
    optional("deviation", Number(POSITIVE)),
    optional("b", Number(FREE)),
    optional("c", Number(FREE)),
    optional("window", Number(POSITIVE)),
]);
/// An exposure in stops, and a tone map or that of the mode.
static DISPLAY: ObjectSchema = rtc_object(&[
    optional("exposure", Number(FREE)),
    optional(
        "tone",
        Keyword(&["mode", "none", "srgb", "agx", "pbr-neutral"]),
    ),
]);
/// Its radiance; an image of all directions, by index or as rows of floating-point pixels; the rows
/// of the rotation from the world to the image.
static ENVIRONMENT: ObjectSchema = rtc_object(&[
    required("radiance", Numbers(&[3], FACTOR)),
    optional("image", Index(IndexTarget::Images)),
    optional("pixels", Index(IndexTarget::Accessors)),
    optional("width", Integer(1, MAX_COUNT)),
    optional("rotation", Numbers(&[9], FREE)),
]);

/// The size of the picture, the plane of focus, the middle in halves of the picture, the lens.
static CAMERA: ObjectSchema = rtc_object(&[
    required("width", Integer(1, MAX_COUNT)),
    required("height", Integer(1, MAX_COUNT)),
    required("focusDistance", Number(POSITIVE)),
    optional("shift", Numbers(&[2], FREE)),
    optional("lensRadius", Number(FACTOR)),
    optional("lensSamples", Integer(1, MAX_COUNT)),
]);

/// A light without falloff, or a lamp as it was measured.
static LIGHT: ObjectSchema = rtc_object(&[
    optional("point", One(&POINT)),
    optional("photometry", One(&PHOTOMETRY)),
]);
static POINT: ObjectSchema = rtc_object(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("radius", Number(FACTOR)),
]);
static PHOTOMETRY: ObjectSchema = rtc_object(&[
    optional("name", Text),
    required("factor", Numbers(&[3], FACTOR)),
    required("vertical", Numbers(&[], FREE)),
    required("horizontal", Numbers(&[], FREE)),
    required("candela", Numbers(&[], FACTOR)),
]);

/// Phong's model, or of the standard material the index of a metal with its base colour, the
/// distribution of facets, the kind of plastic, whether its back reflects nothing, the opacity, the
/// heights, whether it is a pane of two faces, the other material of a blend, and media; of both
/// the
/// patterns, for which other programs see pictures.
static MATERIAL: ObjectSchema = rtc_object(&[
    optional("phong", One(&PHONG)),
    optional("patterns", Many(&PATTERN)),
    optional("conductor", One(&CONDUCTOR)),
    optional("microfacets", Keyword(&["separableGgx", "beckmann"])),
    optional("plastic", Keyword(&["linear", "nonlinear", "single"])),
    optional("blackBack", Boolean),
    optional("surfaceTangents", Boolean),
    optional("opacityTexture", One(&TEXTURE_INFO)),
    optional("bumpTexture", One(&TEXTURE_INFO)),
    optional("bumpScale", Number(FREE)),
    optional("thinDielectric", Boolean),
    optional("blendWith", Index(IndexTarget::Materials)),
    optional("blendWeight", Number(FACTOR)),
    optional("blendTexture", One(&TEXTURE_INFO)),
    optional("interior", One(&MEDIUM)),
    optional("exterior", One(&MEDIUM)),
]);
/// A pattern in closed form: the parameter whose map it is, its two colours, its cells per unit of
/// coordinates, and the rows of the map to these from those of the surface.
static PATTERN: ObjectSchema = rtc_object(&[
    required("parameter", Text),
    required(
        "pattern",
        Keyword(&["uv", "checker", "stripes", "noise", "worley"]),
    ),
    optional("seed", Integer(0, MAX_COUNT)),
    optional("octaves", Integer(1, GradientNoise::MAX_OCTAVES as u64)),
    optional("colors", Numbers(&[6], FACTOR)),
    optional("scale", Number(POSITIVE)),
    optional("mapping", Keyword(&["world"])),
    optional("set", Integer(0, 1)),
    optional("textureFromSurface", Numbers(&[6], FREE)),
]);
/// A participating medium: its coefficients per unit of length and its mean cosine.
static MEDIUM: ObjectSchema = rtc_object(&[
    optional("sigmaA", Numbers(&[3], FACTOR)),
    optional("sigmaS", Numbers(&[3], FACTOR)),
    optional("g", Number(FREE)),
]);
static CONDUCTOR: ObjectSchema = rtc_object(&[
    required("eta", Numbers(&[3], FACTOR)),
    required("k", Numbers(&[3], FACTOR)),
    optional("baseColor", Numbers(&[3], FACTOR)),
]);
static PHONG: ObjectSchema = rtc_object(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("ka", Number(FACTOR)),
    optional("kd", Number(FACTOR)),
    optional("ks", Number(FACTOR)),
    optional("kr", Number(FACTOR)),
    optional("n", Number(FACTOR)),
    optional("kt", Number(FACTOR)),
    optional("fresnel", Boolean),
    optional("eta", Number(POSITIVE)),
    optional("glossySamples", Integer(1, MAX_COUNT)),
    optional("colorMap", Index(IndexTarget::Textures)),
    optional("specularMap", Index(IndexTarget::Textures)),
    optional("normalMap", Index(IndexTarget::Textures)),
    optional("bumpMap", Index(IndexTarget::Textures)),
    optional("bumpHeight", Number(FREE)),
]);

/// Whether the surfaces of the node cast no shadow, and how far they move per second in the world.
static NODE: ObjectSchema = rtc_object(&[
    optional("castsNoShadow", Boolean),
    optional("velocity", Numbers(&[3], FREE)),
]);
