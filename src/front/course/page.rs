//! The documentation of the format as Markdown, generated from the declarations: every key with its
//! other spellings, type, default and meaning.

use super::camera::Camera;
use super::environment::Environment;
use super::light::Light;
use super::material::PhongMaterial;
use super::medium::MediumCoefficients;
use super::object::{KINDS, ObjectKind};
use super::path_settings::PathParameters;
use super::pattern::PatternTexture;
use super::record::{FieldDeclaration, FieldRequirement, HasRecord, Record};
use super::sampling::SamplingMap;
use super::schema::SchemaDefinitions;
use super::settings::{Gooch, Scene};
use super::standard::{StandardMaterial, TextureMap};
use super::view_size::SizeMap;
use serde_json::Value as Json;
use std::fmt::Write as _;

const HEAD: &str = "\
# The scene format

A scene is a YAML file. This page is generated from the declarations of the format, as the decoder
and the schema are.

Every key has one canonical spelling, and often others that occur in files; all of them are read.
Several keys in one cell are given together. Keys that are not on this page are ignored with a
warning, and are errors with `--strict`; only `comment` is allowed in every map and has no meaning.
A list of one item is read as that item. Keys are case-insensitive unless `--strict` is on. A scene
may be JSON, which is YAML too: the third column has the keys of the course's JSON files. Lengths
are in scene units; points, directions and colours are lists of three numbers.
";

const INFALLIBLE: &str = "writing to a string does not fail";

/// The page, in Markdown.
#[must_use]
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    for (title, record) in [
        ("The file", Scene::RECORD),
        ("`Camera`", Camera::RECORD),
        ("`ImageSize` as a map", SizeMap::RECORD),
        ("`SuperSampling`", SamplingMap::RECORD),
        ("`GoochParameters`", Gooch::RECORD),
        ("`PathParameters`", PathParameters::RECORD),
        ("`Environment`", Environment::RECORD),
        ("`Lights`", Light::RECORD),
        ("`material`", PhongMaterial::RECORD),
        ("`material` of `type: standard`", StandardMaterial::RECORD),
        ("`Medium`", MediumCoefficients::RECORD),
        ("A texture of a `standard` material", TextureMap::RECORD),
        ("A pattern as a texture", PatternTexture::RECORD),
    ] {
        section(title, record, &mut page);
    }
    for ObjectKind { names, record, .. } in KINDS {
        section(&format!("`type: {}`", names[0]), record, &mut page);
        if let [_, others @ ..] = names
            && !others.is_empty()
        {
            writeln!(page, "\nOther names of this type: {}.", code(others)).expect(INFALLIBLE);
        }
    }
    page
}

fn section(title: &str, record: &Record, page: &mut String) {
    writeln!(page, "\n## {title}\n\n{}\n", record.doc.trim()).expect(INFALLIBLE);
    page.push_str(
        "| key | other spellings | in JSON files | type | default | meaning |\n\
         | --- | --- | --- | --- | --- | --- |\n",
    );
    for FieldDeclaration {
        name,
        doc,
        spellings,
        json,
        requirement,
        is_own: _,
        schema,
    } in record.fields
    {
        // The spellings.
        let (canonical, others) = spellings.split_first().expect("a field has a row of keys");
        let others: Vec<_> = others.iter().map(|row| code(row)).collect();
        let in_json = json.iter().map(|first| {
            let row = spellings.iter().find(|row| row[0] == *first);
            code(row.expect("what JSON files have is a row of the field"))
        });
        let in_json = in_json.collect::<Vec<_>>().join("; ");
        let in_variant = record.variants.iter().any(|variant| variant.contains(name));
        // The default.
        let default = match requirement {
            FieldRequirement::Required => "required".to_owned(),
            FieldRequirement::Unless(other) => {
                let other = record.fields.iter().find(|field| field.name == *other);
                let other = other.map_or_else(String::new, |field| code(field.spellings[0]));
                format!("required without {other}")
            }
            FieldRequirement::Optional if in_variant => "see below".to_owned(),
            FieldRequirement::Optional => "none".to_owned(),
            FieldRequirement::Default(default) => format!("`{}`", default()),
        };
        let kind = kind(&schema(&mut SchemaDefinitions::default()));
        let (key, others, meaning) = (code(canonical), others.join("; "), doc.trim());
        writeln!(
            page,
            "| {key} | {others} | {in_json} | {kind} | {default} | {meaning} |"
        )
        .expect(INFALLIBLE);
    }
    // The variants.
    if record.variants.len() > 1 {
        let keys = |name: &&str| {
            record
                .fields
                .iter()
                .find(|field| field.name == *name)
                .map(|field| code(field.spellings[0]))
        };
        let variants = record.variants.iter().map(|variant| {
            variant
                .iter()
                .filter_map(keys)
                .collect::<Vec<_>>()
                .join(" ")
        });
        writeln!(
            page,
            "\nOne of these sets of keys: {}.",
            variants.collect::<Vec<_>>().join("; ")
        )
        .expect(INFALLIBLE);
    }
}

fn code(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(" ")
}

/// A short description of the values that a schema accepts.
fn kind(schema: &Json) -> String {
    if let (Some(title), true) = (schema["title"].as_str(), schema["anyOf"].is_array()) {
        return title.to_owned();
    }
    if let Some(variants) = schema["anyOf"].as_array() {
        let current = variants
            .iter()
            .filter(|variant| variant["deprecated"] != true || variant["enum"].is_array())
            .filter(|variant| variant["pattern"].is_null());
        return current.map(kind).collect::<Vec<_>>().join(", or ");
    }
    if let Some(names) = schema["enum"].as_array() {
        return names
            .iter()
            .filter_map(Json::as_str)
            .map(|name| format!("`{name}`"))
            .collect::<Vec<_>>()
            .join(", ");
    }
    if schema["$ref"].is_string() {
        return "map".to_owned();
    }
    match schema["type"].as_str() {
        Some("array") => list(schema),
        Some("object") => "map".to_owned(),
        Some("integer") => format!("integer{}", range(schema)),
        Some("number") => format!("number{}", range(schema)),
        Some("boolean") => "`true` or `false`".to_owned(),
        Some("string") => "string".to_owned(),
        Some(_) | None => "scalar".to_owned(),
    }
}

fn list(schema: &Json) -> String {
    match (&schema["prefixItems"], schema["minItems"].as_u64()) {
        (Json::Array(items), _) => format!(
            "list of {}",
            items.iter().map(kind).collect::<Vec<_>>().join(" and ")
        ),
        (_, Some(count)) => format!("{count} × {}", kind(&schema["items"])),
        (_, None) => format!("list of {}s", kind(&schema["items"])),
    }
}

fn range(schema: &Json) -> String {
    let bound = |key: &str, sign: &str| {
        schema[key]
            .as_f64()
            .map(|bound| (bound, format!(" {sign} {}", schema[key])))
    };
    // Bounds that only keep arithmetic finite are omitted.
    let stated = |bound: Option<(f64, String)>| {
        bound
            .filter(|(bound, _)| bound.abs() < 1e9)
            .map(|(_, text)| text)
    };
    let bounds = [
        bound("exclusiveMinimum", ">"),
        bound("minimum", "≥"),
        bound("maximum", "≤"),
    ]
    .map(stated);
    bounds.into_iter().flatten().collect::<Vec<_>>().join(",")
}
