//! The properties of `extras.rtc`: values that glTF can't express, as `emit/gltf` writes them.

use super::Value::{Boolean, Index, Integer, Keyword, Number, Numbers, One, Text};
use super::{FACTOR, FREE, IndexTarget, Key, Object, POSITIVE, optional, required};

/// The object that `extras.rtc` of a kind of object is, if it is read there.
pub(super) fn find(owner: &str) -> Option<&'static Object> {
    let found = PLACES.iter().find(|(place, _)| *place == owner);
    found.map(|(_, object)| *object)
}

static PLACES: &[(&str, &Object)] = &[
    ("asset", &SETTINGS),
    ("camera", &CAMERA),
    ("light", &LIGHT),
    ("material", &MATERIAL),
    ("node", &NODE),
];

/// The greatest count.
const MANY: u64 = u32::MAX as u64;

/// An object of `extras.rtc`.
const fn rtc_object(keys: &'static [Key]) -> Object {
    Object {
        name: "part of `extras.rtc`",
        keys,
    }
}

/// The settings of the picture, and the environment.
static SETTINGS: Object = rtc_object(&[
    optional(
        "mode",
        Keyword(&["phong", "zbuffer", "normal", "gooch", "path"]),
    ),
    optional("shadows", Boolean),
    optional("maxDepth", Integer(0, MANY)),
    optional("supersampling", Integer(1, MANY)),
    optional("pattern", Keyword(&["grid", "jitter", "random"])),
    optional("lightSamples", Integer(1, MANY)),
    optional("toon", Boolean),
    optional("ambient", Keyword(&["perLight", "once"])),
    optional("gooch", One(&GOOCH)),
    optional("path", One(&PATH)),
    optional("display", One(&DISPLAY)),
    optional("environment", One(&ENVIRONMENT)),
]);
static GOOCH: Object = rtc_object(&[
    required("b", Number(FREE)),
    required("y", Number(FREE)),
    required("alpha", Number(FREE)),
    required("beta", Number(FREE)),
]);
static PATH: Object = rtc_object(&[
    required("samples", Integer(1, MANY)),
    optional("multipleScattering", Boolean),
]);
/// An exposure in stops, and a tone map or that of the mode.
static DISPLAY: Object = rtc_object(&[
    optional("exposure", Number(FREE)),
    optional(
        "tone",
        Keyword(&["mode", "none", "srgb", "agx", "pbr-neutral"]),
    ),
]);
/// Its radiance; an image of all directions, by index or as rows of floating-point pixels; the rows
/// of the rotation from the world to the image.
static ENVIRONMENT: Object = rtc_object(&[
    required("radiance", Numbers(&[3], FACTOR)),
    optional("image", Index(IndexTarget::Images)),
    optional("pixels", Index(IndexTarget::Accessors)),
    optional("width", Integer(1, MANY)),
    optional("rotation", Numbers(&[9], FREE)),
]);

/// The size of the picture, the plane of focus, the middle in halves of the picture, the lens.
static CAMERA: Object = rtc_object(&[
    required("width", Integer(1, MANY)),
    required("height", Integer(1, MANY)),
    required("focusDistance", Number(POSITIVE)),
    optional("shift", Numbers(&[2], FREE)),
    optional("lensRadius", Number(FACTOR)),
    optional("lensSamples", Integer(1, MANY)),
]);

/// A light without falloff, or a lamp as it was measured.
static LIGHT: Object = rtc_object(&[
    optional("point", One(&POINT)),
    optional("photometry", One(&PHOTOMETRY)),
]);
static POINT: Object = rtc_object(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("radius", Number(FACTOR)),
]);
static PHOTOMETRY: Object = rtc_object(&[
    optional("name", Text),
    required("factor", Numbers(&[3], FACTOR)),
    required("vertical", Numbers(&[], FREE)),
    required("horizontal", Numbers(&[], FREE)),
    required("candela", Numbers(&[], FACTOR)),
]);

/// Phong's model.
static MATERIAL: Object = rtc_object(&[optional("phong", One(&PHONG))]);
static PHONG: Object = rtc_object(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("ka", Number(FACTOR)),
    optional("kd", Number(FACTOR)),
    optional("ks", Number(FACTOR)),
    optional("kr", Number(FACTOR)),
    optional("n", Number(FACTOR)),
    optional("kt", Number(FACTOR)),
    optional("eta", Number(POSITIVE)),
    optional("glossySamples", Integer(1, MANY)),
    optional("colorMap", Index(IndexTarget::Textures)),
    optional("specularMap", Index(IndexTarget::Textures)),
    optional("normalMap", Index(IndexTarget::Textures)),
    optional("bumpMap", Index(IndexTarget::Textures)),
    optional("bumpHeight", Number(FREE)),
]);

/// Whether the surfaces of the node cast no shadow.
static NODE: Object = rtc_object(&[optional("castsNoShadow", Boolean)]);
