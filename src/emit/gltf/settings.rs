//! Writes settings, display and environment to `extras.rtc` of the asset.

use super::writer::{GltfWriter, extras, number};
use crate::picture::ColorCoding;
use rtc_color::Tone;
use rtc_ir::{Display, EntityField, EntityKind, Environment, Pixels, Settings, ValuePath};
use serde_json::{Map as JsonObject, Value, json};

impl GltfWriter<'_> {
    /// Writes the display settings, the settings, unless they are the defaults for glTF, and the
    /// environment.
    pub(super) fn settings(&mut self) {
        let mut rtc_extras = JsonObject::new();
        if self.scene.settings != Settings::paths() {
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.reporter.in_extras("how the picture is made", path);
            rtc_extras = settings(&self.scene.settings);
        }
        if !self.scene.display.is_plain() {
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.reporter.in_extras("how the picture is shown", path);
        }
        // Without them rtc would choose an exposure and a tone map, as for any asset.
        let Display { exposure, tone } = &self.scene.display;
        let tone = tone.map_or("mode", Tone::name);
        rtc_extras.insert(
            "display".to_owned(),
            json!({ "exposure": exposure, "tone": tone }),
        );
        if let Some(environment) = &self.scene.environment {
            self.environment(environment, &mut rtc_extras);
        }
        if let Some(medium) = &self.scene.medium {
            let path = ValuePath::new(EntityKind::Medium, 0, EntityField::Whole);
            self.reporter
                .in_extras("the medium around the camera", path);
            rtc_extras.insert("medium".to_owned(), json!(medium));
        }
        self.root.extras = extras(rtc_extras);
    }

    fn environment(
        &mut self,
        environment: &Environment,
        rtc_extras: &mut JsonObject<String, Value>,
    ) {
        let Environment {
            radiance,
            image,
            image_from_world,
        } = environment;
        let path = ValuePath::new(EntityKind::Environment, 0, EntityField::Whole);
        self.reporter.in_extras("what surrounds the scene", path);
        let mut values = json!({ "radiance": radiance });
        if let Some(id) = image {
            let image = &self.scene.images[id.0 as usize];
            match image.kind {
                Pixels::Rgb8 | Pixels::Rgba8 => {
                    values["image"] = self.image(number(*id), ColorCoding::Srgb).value().into();
                }
                Pixels::Rgb32f => {
                    values["pixels"] = self.pixels(image).value().into();
                    values["width"] = image.width.into();
                }
            }
        }
        if let Some(rows) = image_from_world {
            values["rotation"] = rows.as_flattened().into();
        }
        rtc_extras.insert("environment".to_owned(), values);
    }
}

/// The fields of the text form; the mode is its word, with its parameters apart.
fn settings(settings: &Settings) -> JsonObject<String, Value> {
    let Ok(Value::Object(mut fields)) = serde_json::to_value(settings) else {
        return JsonObject::new();
    };
    if let Some(Value::Object(mode)) = fields.get("mode").cloned() {
        for (word, parameters) in mode {
            fields.insert("mode".to_owned(), word.as_str().into());
            fields.insert(word, parameters);
        }
    }
    fields
}
