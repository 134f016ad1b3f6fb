//! The JSON schema of glTF 2.0 as tables, and its validation.
//!
//! `core` holds the objects of glTF, `extension` those of extensions, and `rtc_extras` those
//! that `rtc` writes into `extras`. An [`ObjectSchema`] lists its properties, each with the kind of
//! its [`Value`]. `traverse` visits the JSON with a stack, finds the table of each object, and
//! reports unknown and missing properties; `value` checks one value. `json` writes the tables as
//! the JSON Schema and the documentation in `schema/`, with the descriptions of `about.txt`.

mod core;
mod extension;
mod json;
mod rtc_extras;
mod traverse;
mod value;

pub(super) use extension::{find, rows as extension_rows};
pub(super) use json::schema;
pub(super) use traverse::traverse;

/// A kind of object.
#[derive(Debug)]
pub(super) struct ObjectSchema {
    /// As messages call it, and as extensions say where they belong.
    name: &'static str,
    /// Its properties, but for `extensions` and `extras`, which all have.
    keys: &'static [PropertySchema],
}

/// A property.
#[derive(Debug)]
struct PropertySchema {
    name: &'static str,
    value: Value,
    required: bool,
}

const fn required(name: &'static str, value: Value) -> PropertySchema {
    PropertySchema {
        name,
        value,
        required: true,
    }
}

const fn optional(name: &'static str, value: Value) -> PropertySchema {
    PropertySchema {
        name,
        value,
        required: false,
    }
}

/// The value of a property.
#[derive(Debug)]
enum Value {
    Boolean,
    Text,
    /// One of these keywords.
    Keyword(&'static [&'static str]),
    /// `major.minor`.
    Version,
    /// A JSON pointer.
    Pointer,
    /// A whole number within bounds, both included.
    Integer(u64, u64),
    /// One of these numbers.
    Choice(&'static [u64]),
    Number(NumberRange),
    /// A list of as many numbers as one of these says; at least one if none does.
    Numbers(&'static [usize], NumberRange),
    /// A list of numbers, as many and of the kind that other properties say.
    PerComponent,
    /// A list of different texts.
    Texts,
    /// A reference.
    Index(IndexTarget),
    /// A list of different references.
    Indices(IndexTarget),
    /// Names of attributes and the accessors that hold them.
    Attributes,
    /// A list of such.
    Targets,
    One(&'static ObjectSchema),
    Many(&'static ObjectSchema),
}

/// The range of a number; an infinite bound does not limit it.
#[derive(Clone, Copy, Debug)]
struct NumberRange {
    min: f64,
    max: f64,
    /// The minimum itself is out.
    above: bool,
}

const FREE: NumberRange = NumberRange {
    min: f64::NEG_INFINITY,
    max: f64::INFINITY,
    above: false,
};
const UNIT: NumberRange = NumberRange {
    min: 0.0,
    max: 1.0,
    above: false,
};
const SIGNED: NumberRange = NumberRange {
    min: -1.0,
    max: 1.0,
    above: false,
};
const FACTOR: NumberRange = NumberRange {
    min: 0.0,
    max: f64::INFINITY,
    above: false,
};
const POSITIVE: NumberRange = NumberRange {
    min: 0.0,
    max: f64::INFINITY,
    above: true,
};

/// The lists that references count in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum IndexTarget {
    Accessors,
    Buffers,
    BufferViews,
    Cameras,
    Images,
    Materials,
    Meshes,
    Nodes,
    Samplers,
    Scenes,
    Skins,
    Textures,
    Lights,
    Variants,
    /// The samplers of the animation itself, which the walk does not know.
    Own,
}

/// Each index target at one path, with the path.
const TARGETS: [(IndexTarget, &[&str]); 14] = [
    (IndexTarget::Accessors, &["accessors"]),
    (IndexTarget::Buffers, &["buffers"]),
    (IndexTarget::BufferViews, &["bufferViews"]),
    (IndexTarget::Cameras, &["cameras"]),
    (IndexTarget::Images, &["images"]),
    (IndexTarget::Materials, &["materials"]),
    (IndexTarget::Meshes, &["meshes"]),
    (IndexTarget::Nodes, &["nodes"]),
    (IndexTarget::Samplers, &["samplers"]),
    (IndexTarget::Scenes, &["scenes"]),
    (IndexTarget::Skins, &["skins"]),
    (IndexTarget::Textures, &["textures"]),
    (
        IndexTarget::Lights,
        &["extensions", "KHR_lights_punctual", "lights"],
    ),
    (
        IndexTarget::Variants,
        &["extensions", "KHR_materials_variants", "variants"],
    ),
];
