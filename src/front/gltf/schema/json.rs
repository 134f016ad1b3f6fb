//! The tables as a JSON Schema with descriptions, for editors of glTF. `about.txt` has the
//! description, the default and the unit of each property, except those of material parameters,
//! which are in their table.

use super::core::ROOT;
use super::extension::all;
use super::{NumberRange, ObjectSchema, PropertySchema, Value};
use rtc_ir::Standard;
use rtc_tables::MATERIAL_EXTENSIONS;
use serde_json::{Map, Value as Json, json};

/// Lines of `object.property | default | unit | description`.
const ABOUT: &str = include_str!("about.txt");

/// The schema of an asset.
pub(crate) fn schema() -> Json {
    let mut writer = JsonWriter::default();
    let root = writer.object(&ROOT, ROOT.name);
    let mut root = root.as_object().cloned().unwrap_or_default();
    root.insert("$defs".to_owned(), Json::Object(writer.definitions));
    Json::Object(root)
}

/// Collects the schemas of objects.
#[derive(Default)]
struct JsonWriter {
    definitions: Map<String, Json>,
}

impl JsonWriter {
    /// A reference to the schema of an object, whose properties are described under a name.
    fn object(&mut self, object: &'static ObjectSchema, name: &str) -> Json {
        // Kinds of texture infos differ in their last property.
        let id = format!("{name} {}", object.keys.last().map_or("", |key| key.name));
        let reference = json!({ "$ref": format!("#/$defs/{id}") });
        if self.definitions.contains_key(&id) {
            return reference;
        }
        self.definitions.insert(id.clone(), Json::Null);
        let keys = object.keys.iter();
        let mut properties: Map<String, Json> = keys
            .map(|key| (key.name.to_owned(), self.property(key, name)))
            .collect();
        let extensions: Map<String, Json> = all()
            .flat_map(|entry| entry.places.iter().map(move |place| (entry.name, place)))
            .filter(|(_, (kind, _))| *kind == object.name)
            .map(|(extension, (_, carried))| {
                let mut schema = self.object(carried, extension);
                schema["description"] = format!("The extension `{extension}`").into();
                (extension.to_owned(), schema)
            })
            .collect();
        let words = "What extensions say, by their names";
        properties.insert(
            "extensions".to_owned(),
            json!({ "description": words, "properties": extensions }),
        );
        let schema = json!({ "type": "object", "properties": properties });
        self.definitions.insert(id, schema);
        reference
    }

    fn property(&mut self, key: &PropertySchema, name: &str) -> Json {
        let mut schema = self.value(&key.value);
        let about = AboutText::of(name, key.name);
        if let Some(map) = schema.as_object_mut() {
            map.insert("description".to_owned(), about.words.into());
            map.extend(about.default.map(|value| ("default".to_owned(), value)));
            let unit = about.unit.map(|unit| ("x-unit".to_owned(), unit.into()));
            map.extend(unit);
            // As in the scenes of the course.
            map.extend((key.name == "uri").then(|| ("title".to_owned(), "file".into())));
        }
        schema
    }

    fn value(&mut self, value: &Value) -> Json {
        let index = || json!({ "type": "integer", "minimum": 0 });
        let list = |item: Json| json!({ "type": "array", "items": item });
        match value {
            Value::Boolean => json!({ "type": "boolean" }),
            Value::Text | Value::Version | Value::Pointer => json!({ "type": "string" }),
            Value::Keyword(words) => json!({ "type": "string", "enum": words }),
            Value::Integer(min, max) => {
                json!({ "type": "integer", "minimum": min, "maximum": max })
            }
            Value::Choice(numbers) => json!({ "type": "integer", "enum": numbers }),
            Value::Number(bounds) => number(bounds),
            Value::Numbers(_, bounds) => list(number(bounds)),
            Value::PerComponent => list(json!({ "type": "number" })),
            Value::Texts => list(json!({ "type": "string" })),
            Value::Index(_) => index(),
            Value::Indices(_) => list(index()),
            Value::Attributes => json!({ "type": "object" }),
            Value::Targets => list(json!({ "type": "object" })),
            Value::One(object) => self.object(object, object.name),
            Value::Many(object) => list(self.object(object, object.name)),
        }
    }
}

fn number(bounds: &NumberRange) -> Json {
    let mut schema = json!({ "type": "number" });
    let least = if bounds.above {
        "exclusiveMinimum"
    } else {
        "minimum"
    };
    for (keyword, bound) in [(least, bounds.min), ("maximum", bounds.max)] {
        if bound.is_finite() {
            schema[keyword] = bound.into();
        }
    }
    schema
}

/// The description of a property.
struct AboutText {
    words: String,
    default: Option<Json>,
    unit: Option<&'static str>,
}

impl AboutText {
    /// The description of a property of an object; empty if there is none.
    fn of(object: &str, key: &str) -> Self {
        // Both names of one extension.
        let object = &object.replace("KHR_meshopt", "EXT_meshopt");
        let line = ABOUT.lines().find_map(|line| {
            let mut cells = line.splitn(4, '|').map(str::trim);
            let (entry, cells) = (cells.next()?, [cells.next()?, cells.next()?, cells.next()?]);
            (entry.rsplit_once('.') == Some((object.as_str(), key))).then_some(cells)
        });
        if let Some([default, unit, words]) = line {
            return Self {
                words: words.to_owned(),
                default: serde_json::from_str(default).ok(),
                unit: Some(unit).filter(|unit| !unit.is_empty()),
            };
        }
        let words = match key {
            "name" => "What people call it".to_owned(),
            _ => of_parameter(key).unwrap_or_default(),
        };
        let (default, unit) = (None, None);
        Self {
            words,
            default,
            unit,
        }
    }
}

/// The description of an extension's property in the table of material parameters.
fn of_parameter(key: &str) -> Option<String> {
    let mut properties = MATERIAL_EXTENSIONS.iter().copied().flat_map(|(_, all)| all);
    let (.., own) = properties.find(|(known, ..)| *known == key)?;
    let mut parameters = Standard::PARAMETERS.iter().zip(Standard::ABOUT);
    let (_, about) = parameters.find(|(name, _)| *name == own)?;
    Some(about.trim().trim_end_matches('.').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paths of properties without a description.
    fn undescribed(schema: &Json, path: &str, found: &mut Vec<String>) {
        let properties = schema.get("properties").and_then(Json::as_object);
        for (name, property) in properties.into_iter().flatten() {
            let path = format!("{path}/{name}");
            if property["description"].as_str().is_none_or(str::is_empty) {
                found.push(path.clone());
            }
            undescribed(property, &path, found);
        }
    }

    #[test]
    fn each_property_is_told_of_and_each_line_is_of_one() {
        let (schema, mut found) = (schema(), Vec::new());
        let definitions = schema["$defs"].as_object().unwrap();
        for (name, definition) in definitions {
            undescribed(definition, name, &mut found);
        }
        assert_eq!(found, [""; 0]);
        let texts = definitions.values().map(Json::to_string);
        let all: String = texts.collect();
        for line in ABOUT.lines() {
            let words = line.rsplit('|').next().unwrap().trim();
            let written = Json::from(words).to_string();
            assert!(all.contains(&written), "{line}");
        }
    }

    #[test]
    fn a_property_has_its_range_its_default_and_its_unit() {
        let schema = schema();
        let definitions = schema["$defs"].as_object().unwrap();
        let spot = &definitions["spot outerConeAngle"]["properties"]["outerConeAngle"];
        assert_eq!(spot["x-unit"], "radians");
        assert_eq!(spot["default"], std::f64::consts::FRAC_PI_4);
        assert_eq!(spot["maximum"], std::f64::consts::FRAC_PI_2);
        let sheen = &definitions["KHR_materials_sheen sheenRoughnessTexture"];
        let words = &sheen["properties"]["sheenColorFactor"]["description"];
        assert_eq!(words, "The colour of a sheen as of cloth; black is none");
    }
}
