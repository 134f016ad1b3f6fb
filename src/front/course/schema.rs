//! The JSON Schema of the format, generated from the declarations.
//!
//! It accepts exactly what the decoder accepts with `--strict`: it rejects unknown keys, and `Eye`
//! beside `Camera`.

use super::decode::Decode;
use super::keyword::enumeration;
use super::object::{KINDS, ObjectKind};
use super::reader::{COMMENT, MATERIAL};
use super::record::{FieldDeclaration, FieldRequirement, Record};
use super::settings::Scene;
use super::snippet::example;
use serde_json::{Map, Value as Json, json};

/// The schemas of the records so far, by their names.
#[derive(Default)]
pub(super) struct SchemaDefinitions {
    schemas: Map<String, Json>,
}

impl SchemaDefinitions {
    /// The example of a record whose schema is known.
    pub(super) fn example(&self, name: &str) -> Json {
        let schema = self.schemas.get(name).unwrap_or(&Json::Null);
        schema["defaultSnippets"][0]["body"].clone()
    }
}

/// The JSON Schema (2020-12) of the format.
#[must_use]
pub fn schema() -> Json {
    let mut definitions = SchemaDefinitions::default();
    let root = Scene::schema(&mut definitions);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "rtc scene",
        "$ref": root["$ref"],
        "$defs": definitions.schemas,
    })
}

/// A reference to the schema of a record. The schema is generated at the first reference.
pub(super) fn record(record: &Record, definitions: &mut SchemaDefinitions) -> Json {
    let name = record.name.replace('`', "").replace(' ', "-");
    definition(&name, definitions, |definitions| {
        record_schema(record, definitions)
    })
}

/// A reference to a schema, which may hold references to itself. It is generated at the first
/// reference.
fn definition(
    name: &str,
    definitions: &mut SchemaDefinitions,
    generate: impl FnOnce(&mut SchemaDefinitions) -> Json,
) -> Json {
    if !definitions.schemas.contains_key(name) {
        definitions.schemas.insert(name.to_owned(), Json::Null);
        let schema = generate(definitions);
        definitions.schemas.insert(name.to_owned(), schema);
    }
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// A reference to the schema of an object within another, whose material it has if it has none.
pub(super) fn operand(definitions: &mut SchemaDefinitions) -> Json {
    definition("operand", definitions, |definitions| {
        let mut choices = Vec::new();
        for kind in KINDS {
            let schema = record(kind.record, definitions);
            choices.extend(kind.names.iter().map(|name| choice(name, &schema)));
        }
        let mut kind = json!({ "anyOf": enumeration(KINDS.iter().flat_map(words)) });
        kind["description"] = json!("What kind of object this is.");
        let snippets = KINDS.iter().map(|kind| {
            let body = example(kind.record, definitions);
            snippet(kind.names[0], kind.record.doc, &body)
        });
        json!({
            "defaultSnippets": snippets.collect::<Vec<_>>(),
            "type": "object",
            "properties": { "type": kind },
            "required": ["type"],
            "allOf": choices,
        })
    })
}

/// An object that editors propose to insert.
fn snippet(label: &str, doc: &str, body: &Json) -> Json {
    json!({ "label": label, "description": doc.trim(), "body": body })
}

/// The names of a type of objects, and the meaning of the first.
fn words(kind: &ObjectKind) -> impl Iterator<Item = (&'static str, &'static str)> {
    let docs = std::iter::once(kind.record.doc.trim()).chain(std::iter::repeat(""));
    kind.names.iter().copied().zip(docs)
}

/// The schema that a value of `type` selects.
fn choice(name: &str, schema: &Json) -> Json {
    let is_kind = json!({ "properties": { "type": { "const": name } }, "required": ["type"] });
    json!({ "if": is_kind, "then": schema })
}

/// A reference to the schema of an object. Without a material it must be of a type that needs none;
/// the objects within it need theirs then.
pub(super) fn object(definitions: &mut SchemaDefinitions) -> Json {
    let operand = operand(definitions);
    definition("object", definitions, |_| {
        let needs_none = |kind: &&ObjectKind| !kind.record.fields.iter().any(is_own_material);
        let names = KINDS.iter().filter(needs_none).flat_map(words);
        let mut properties = Map::new();
        properties.insert("type".to_owned(), json!({ "anyOf": enumeration(names) }));
        let object = json!({ "$ref": "#/$defs/object" });
        for field in KINDS.iter().flat_map(|kind| kind.record.fields) {
            let within = match field.name {
                "both" => object.clone(),
                "of" => json!({ "items": object }),
                _ => continue,
            };
            properties.extend(keys(field).map(|key| (key.to_owned(), within.clone())));
        }
        let has_material = json!({ "required": [MATERIAL] });
        json!({ "allOf": [operand, { "if": has_material, "else": { "properties": properties } }] })
    })
}

/// Whether this is the required material of an object, or the object itself.
fn is_own_material(field: &FieldDeclaration) -> bool {
    field.name == MATERIAL && matches!(field.requirement, FieldRequirement::Required)
}

fn record_schema(record: &Record, definitions: &mut SchemaDefinitions) -> Json {
    // The properties.
    let mut properties = Map::new();
    for field in record.fields {
        field_properties(field, definitions, &mut properties);
    }
    let comment = json!({ "description": "Anything, for people to read." });
    properties.insert(COMMENT.to_owned(), comment);
    let in_variant = |field: &FieldDeclaration| {
        record
            .variants
            .iter()
            .any(|variant| variant.contains(&field.name))
    };
    let mut required = Vec::new();
    let mut rules = Vec::new();
    for field in record.fields.iter().filter(|field| !in_variant(field)) {
        if is_own_material(field) {
            continue;
        }
        match (&field.requirement, field.spellings) {
            (FieldRequirement::Required, [[key]]) => required.push(*key),
            (FieldRequirement::Required, _) => rules.push(one_row(field)),
            (FieldRequirement::Unless(other), _) => {
                let other = record.fields.iter().find(|field| field.name == *other);
                let either = [Some(field), other].into_iter().flatten().map(one_row);
                rules.push(json!({ "anyOf": either.collect::<Vec<_>>() }));
            }
            (FieldRequirement::Optional | FieldRequirement::Default(_), [[_]]) => {}
            (FieldRequirement::Optional | FieldRequirement::Default(_), _) => {
                rules.push(json!({ "anyOf": [one_row(field), absent(field)] }))
            }
        }
    }
    // The variants.
    if !record.variants.is_empty() {
        let variants: Vec<_> = record
            .variants
            .iter()
            .map(|variant| one_variant(record, variant))
            .collect();
        rules.push(json!({ "oneOf": variants }));
    }
    let example = example(record, definitions);
    let name = record.name.replace('`', "");
    let snippets = (example != json!({})).then(|| vec![snippet(&name, record.doc, &example)]);
    let mut record_schema = json!({
        "description": record.doc.trim(),
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    let snippets = json!(snippets.unwrap_or_default());
    for (key, list) in [
        ("required", json!(required)),
        ("allOf", json!(rules)),
        ("defaultSnippets", snippets),
    ] {
        if list.as_array().is_some_and(|list| !list.is_empty()) {
            record_schema[key] = list;
        }
    }
    record_schema
}

/// Adds one property for each key. The description of other spellings names the canonical one.
fn field_properties(
    field: &FieldDeclaration,
    definitions: &mut SchemaDefinitions,
    properties: &mut Map<String, Json>,
) {
    let value = (field.schema)(definitions);
    let canonical = field.spellings.first().copied().unwrap_or_default();
    for row in field.spellings {
        for (key, canonical_key) in row.iter().zip(canonical) {
            if properties.contains_key(*key) {
                continue;
            }
            let Json::Object(mut property) = value.clone() else {
                properties.insert((*key).to_owned(), value.clone());
                continue;
            };
            let doc = field.doc.trim();
            let is_canonical = canonical.contains(key);
            let doc = if is_canonical {
                doc.to_owned()
            } else {
                format!("{doc} Better written `{canonical_key}`.")
            };
            property.insert("description".to_owned(), json!(doc));
            // Editors insert keys with a default when they complete an object, so only one key of
            // each field has it.
            match field.requirement {
                FieldRequirement::Default(default) if is_canonical => {
                    drop(property.insert("default".to_owned(), default()))
                }
                FieldRequirement::Required
                | FieldRequirement::Optional
                | FieldRequirement::Unless(_)
                | FieldRequirement::Default(_) => {}
            }
            if !is_canonical {
                property.insert("deprecated".to_owned(), json!(true));
            }
            properties.insert((*key).to_owned(), Json::Object(property));
        }
    }
}

fn keys(field: &FieldDeclaration) -> impl Iterator<Item = &'static str> {
    field.spellings.iter().copied().flatten().copied()
}

fn forbid(keys: impl Iterator<Item = &'static str>) -> Json {
    keys.map(|key| (key.to_owned(), Json::Bool(false)))
        .collect::<Map<_, _>>()
        .into()
}

fn absent(field: &FieldDeclaration) -> Json {
    json!({ "properties": forbid(keys(field)) })
}

/// Exactly one spelling of the field, and no key of its other spellings. If all spellings are
/// single keys, `oneOf` alone ensures that.
fn one_row(field: &FieldDeclaration) -> Json {
    let is_group = field.spellings.iter().any(|row| row.len() > 1);
    let spellings = field.spellings.iter().map(|row| {
        if !is_group {
            return json!({ "required": row });
        }
        let others = keys(field).filter(|key| !row.contains(key));
        json!({ "required": row, "properties": forbid(others) })
    });
    let mut spellings: Vec<_> = spellings.collect();
    if spellings.len() == 1 {
        spellings.remove(0)
    } else {
        json!({ "oneOf": spellings })
    }
}

/// The fields of the variant, and no key of fields of other variants.
fn one_variant(record: &Record, variant: &[&str]) -> Json {
    let members = || {
        record
            .fields
            .iter()
            .filter(|field| variant.contains(&field.name))
    };
    let variant_keys: Vec<_> = members().flat_map(keys).collect();
    let others = record.fields.iter().filter(|field| {
        record
            .variants
            .iter()
            .any(|variant| variant.contains(&field.name))
    });
    let others = others
        .flat_map(keys)
        .filter(|key| !variant_keys.contains(key));
    let rules: Vec<_> = members().map(one_row).collect();
    json!({ "allOf": rules, "properties": forbid(others) })
}
