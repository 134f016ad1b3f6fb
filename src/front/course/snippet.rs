//! Example values of records, which editors insert: the required keys, of the first variant, each
//! with a value that the decoder takes without a diagnostic.

use super::object::KINDS;
use super::reader::MATERIAL;
use super::record::{FieldDeclaration, FieldRequirement, Record};
use super::schema::SchemaDefinitions;
use super::standard;
use serde_json::{Map, Value as Json, json};

/// The values of keys for which the example of their type is a scene that shows nothing.
const EXAMPLES: &[(&str, &str, &str)] = &[
    ("camera", "eye", "[0, 0, 10]"),
    ("camera", "view_size", "[400, 300]"),
    ("camera", "up", "[0, 0.02, 0]"),
    ("light", "position", "[10, 10, 10]"),
    ("light", "color", "[1, 1, 1]"),
    ("material", "ka", "0.1"),
    ("material", "kd", "0.7"),
    ("material", "ks", "0.2"),
    ("material", "n", "20"),
    ("standard material", "color", "[0.8, 0.8, 0.8]"),
    ("texture", "file", "\"image.png\""),
    ("mesh", "file", "\"mesh.obj\""),
    ("glTF asset", "file", "\"model.glb\""),
    ("prism", "up", "[0, 0, 1]"),
    ("torus", "radius", "2"),
];

/// The points of keys of one group, by the count of its keys.
const CORNERS: &[[[i8; 3]; 6]] = &[
    [[0, 0, 0]; 6],
    [[0, 0, 0], [1, 1, 1], [0; 3], [0; 3], [0; 3], [0; 3]],
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0; 3], [0; 3], [0; 3]],
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0; 3], [0; 3]],
];

/// The example of a record.
pub(super) fn example(record: &Record, definitions: &mut SchemaDefinitions) -> Json {
    let variant = record.variants.first().copied().unwrap_or_default();
    let in_variant = |field: &FieldDeclaration| {
        let mut variants = record.variants.iter();
        variants.any(|variant| variant.contains(&field.name))
    };
    let is_wanted = |field: &&FieldDeclaration| match field.requirement {
        _ if in_variant(field) => variant.contains(&field.name),
        FieldRequirement::Required | FieldRequirement::Unless(_) => true,
        // Without one a mesh is grey, and a `csg` a union, with a warning.
        FieldRequirement::Optional => {
            [("mesh", MATERIAL), ("csg", "operation")].contains(&(record.name, field.name))
        }
        FieldRequirement::Default(_) => false,
    };
    let mut example = Map::new();
    for field in record.fields.iter().filter(is_wanted) {
        let keys = field.spellings.first().copied().unwrap_or_default();
        for (at, key) in keys.iter().enumerate() {
            let value = value(record, field, [at, keys.len()], definitions);
            example.insert((*key).to_owned(), value);
        }
    }
    Json::Object(example)
}

/// The example of a key: that of its record, or that of its type.
fn value(
    record: &Record,
    field: &FieldDeclaration,
    [at, count]: [usize; 2],
    definitions: &mut SchemaDefinitions,
) -> Json {
    let mut examples = EXAMPLES.iter();
    let own = examples.find(|(name, key, _)| *name == record.name && *key == field.name);
    if let Some(value) = own.and_then(|(_, _, text)| serde_json::from_str(text).ok()) {
        return value;
    }
    if field
        .spellings
        .first()
        .is_some_and(|keys| keys.contains(&"type"))
    {
        return kind(record, field, definitions);
    }
    if record.name == "tetrahedron" && at == 3 {
        return json!([0, 0, 1]);
    }
    let schema = (field.schema)(definitions);
    let corners = CORNERS.get(count.saturating_sub(1));
    let is_point = schema["items"]["x-unit"] == "scene units";
    match corners.and_then(|corners| corners.get(at)) {
        Some(corner) if is_point => json!(corner),
        Some(_) | None => of_schema(&schema, definitions),
    }
}

/// The word of a key `type`.
fn kind(record: &Record, field: &FieldDeclaration, definitions: &mut SchemaDefinitions) -> Json {
    let mut kinds = KINDS.iter();
    if let Some(kind) = kinds.find(|kind| kind.record.name == record.name) {
        return json!(kind.names[0]);
    }
    match record.name {
        "standard material" => json!(standard::KEYWORD),
        _ => of_schema(&(field.schema)(definitions), definitions),
    }
}

/// A value of a schema.
fn of_schema(schema: &Json, definitions: &mut SchemaDefinitions) -> Json {
    if let Some(target) = schema["$ref"].as_str() {
        let name = target.rsplit('/').next().unwrap_or_default();
        return match name {
            // Within its own schema, too, which is not known yet.
            "operand" | "object" => example(KINDS[0].record, definitions),
            _ => definitions.example(name),
        };
    }
    if schema["else"].is_object() {
        return of_schema(&schema["else"], definitions);
    }
    for list in ["anyOf", "enum"] {
        match (list, schema[list].get(0)) {
            ("anyOf", Some(first)) => return of_schema(first, definitions),
            (_, Some(first)) => return first.clone(),
            (_, None) => {}
        }
    }
    match schema["type"].as_str() {
        Some("array") => {
            let count = schema["minItems"].as_u64().unwrap_or(0);
            let is_direction = count == 3 && schema["items"]["minimum"] == -1e60;
            if is_direction && schema["items"]["x-unit"].is_null() {
                return json!([0, 1, 0]);
            }
            let item = of_schema(&schema["items"], definitions);
            (0..count).map(|_| item.clone()).collect()
        }
        Some("number" | "integer") => {
            // Any number but an offset or an angle.
            let bounds = ["minimum", "exclusiveMinimum"];
            let is_size = bounds.iter().any(|key| schema[*key].is_number());
            json!(u8::from(is_size))
        }
        Some("boolean") => json!(true),
        Some(_) | None => json!(""),
    }
}
