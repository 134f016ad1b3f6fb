//! What `extras.rtc` holds: values for which glTF has no words, as `emit/gltf` writes them.

use super::Value::{Index, Number, Numbers, One, Text, Truth, Whole, Word};
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
const fn own(keys: &'static [Key]) -> Object {
    Object {
        name: "part of `extras.rtc`",
        keys,
    }
}

/// How the picture is made, and what surrounds the scene.
static SETTINGS: Object = own(&[
    optional(
        "mode",
        Word(&["phong", "zbuffer", "normal", "gooch", "path"]),
    ),
    optional("shadows", Truth),
    optional("maxDepth", Whole(0, MANY)),
    optional("supersampling", Whole(1, MANY)),
    optional("pattern", Word(&["grid", "jitter", "random"])),
    optional("lightSamples", Whole(1, MANY)),
    optional("toon", Truth),
    optional("ambient", Word(&["perLight", "once"])),
    optional("gooch", One(&GOOCH)),
    optional("path", One(&PATH)),
    optional("display", One(&DISPLAY)),
    optional("environment", One(&ENVIRONMENT)),
]);
static GOOCH: Object = own(&[
    required("b", Number(FREE)),
    required("y", Number(FREE)),
    required("alpha", Number(FREE)),
    required("beta", Number(FREE)),
]);
static PATH: Object = own(&[
    required("samples", Whole(1, MANY)),
    optional("multipleScattering", Truth),
]);
/// An exposure in stops, and a tone map or that of the mode.
static DISPLAY: Object = own(&[
    optional("exposure", Number(FREE)),
    optional(
        "tone",
        Word(&["mode", "none", "srgb", "agx", "pbr-neutral"]),
    ),
]);
/// Its radiance; a picture of all directions, an image or rows of so many floating-point pixels; the
/// rows of the rotation from the world to the picture.
static ENVIRONMENT: Object = own(&[
    required("radiance", Numbers(&[3], FACTOR)),
    optional("image", Index(IndexTarget::Images)),
    optional("pixels", Index(IndexTarget::Accessors)),
    optional("width", Whole(1, MANY)),
    optional("rotation", Numbers(&[9], FREE)),
]);

/// The size of the picture, the plane of focus, the middle in halves of the picture, the lens.
static CAMERA: Object = own(&[
    required("width", Whole(1, MANY)),
    required("height", Whole(1, MANY)),
    required("focusDistance", Number(POSITIVE)),
    optional("shift", Numbers(&[2], FREE)),
    optional("lensRadius", Number(FACTOR)),
    optional("lensSamples", Whole(1, MANY)),
]);

/// A light without falloff, or a lamp as it was measured.
static LIGHT: Object = own(&[
    optional("point", One(&POINT)),
    optional("photometry", One(&PHOTOMETRY)),
]);
static POINT: Object = own(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("radius", Number(FACTOR)),
]);
static PHOTOMETRY: Object = own(&[
    optional("name", Text),
    required("factor", Numbers(&[3], FACTOR)),
    required("vertical", Numbers(&[], FREE)),
    required("horizontal", Numbers(&[], FREE)),
    required("candela", Numbers(&[], FACTOR)),
]);

/// Phong's model.
static MATERIAL: Object = own(&[optional("phong", One(&PHONG))]);
static PHONG: Object = own(&[
    required("color", Numbers(&[3], FACTOR)),
    optional("ka", Number(FACTOR)),
    optional("kd", Number(FACTOR)),
    optional("ks", Number(FACTOR)),
    optional("n", Number(FACTOR)),
    optional("kt", Number(FACTOR)),
    optional("eta", Number(POSITIVE)),
    optional("glossySamples", Whole(1, MANY)),
    optional("colorMap", Index(IndexTarget::Textures)),
    optional("specularMap", Index(IndexTarget::Textures)),
    optional("normalMap", Index(IndexTarget::Textures)),
    optional("bumpMap", Index(IndexTarget::Textures)),
    optional("bumpHeight", Number(FREE)),
]);

/// Whether lights shine through what the node shows.
static NODE: Object = own(&[optional("castsNoShadow", Truth)]);
