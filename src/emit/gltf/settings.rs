//! How the picture is made, and what surrounds the scene, in `extras.rtc` of the asset.

use super::writer::{GltfWriter, extras, number};
use rtc_color::Tone;
use rtc_ir::{
    Ambient, Display, EntityKind, Environment, Field, Gooch, Mode, PathSettings, Pattern, Pixels,
    Settings, ValuePath,
};
use serde_json::{Map as Block, Value, json};

impl GltfWriter<'_> {
    /// Writes the settings, unless they are those that glTF is rendered with, the display and the
    /// environment.
    pub(super) fn settings(&mut self) {
        let mut own = Block::new();
        if self.scene.settings != of_gltf() {
            let place = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.told.own_words("how the picture is made", place);
            own = settings(&self.scene.settings);
        }
        if !self.scene.display.is_plain() {
            let place = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.told.own_words("how the picture is shown", place);
            let Display { exposure, tone } = &self.scene.display;
            let tone = tone.map(Tone::name);
            own.insert(
                "display".to_owned(),
                json!({ "exposure": exposure, "tone": tone.unwrap_or("mode") }),
            );
        }
        if let Some(environment) = &self.scene.environment {
            self.environment(environment, &mut own);
        }
        self.root.extras = extras(own);
    }

    fn environment(&mut self, environment: &Environment, own: &mut Block<String, Value>) {
        let Environment {
            radiance,
            image,
            image_from_world,
        } = environment;
        let place = ValuePath::new(EntityKind::Environment, 0, Field::Whole);
        self.told.own_words("what surrounds the scene", place);
        let mut words = json!({ "radiance": radiance });
        if let Some(id) = image {
            let image = &self.scene.images[id.0 as usize];
            match image.kind {
                Pixels::Rgb8 | Pixels::Rgba8 => {
                    words["image"] = self.image(number(*id)).value().into();
                }
                Pixels::Rgb32f => {
                    words["pixels"] = self.pixels(image).value().into();
                    words["width"] = image.width.into();
                }
            }
        }
        if let Some(rows) = image_from_world {
            words["rotation"] = rows.as_flattened().into();
        }
        own.insert("environment".to_owned(), words);
    }
}

/// The settings that a glTF asset is rendered with where nobody says otherwise.
fn of_gltf() -> Settings {
    Settings {
        mode: Mode::Path(PathSettings::default()),
        shadows: true,
        max_depth: PathSettings::DEPTH,
        supersampling: 1,
        pattern: Pattern::Grid,
        light_samples: 1,
        toon: false,
        ambient: Ambient::PerLight,
    }
}

fn settings(settings: &Settings) -> Block<String, Value> {
    let Settings {
        mode,
        shadows,
        max_depth,
        supersampling,
        pattern,
        light_samples,
        toon,
        ambient,
    } = settings;
    let (mode, parameters) = match mode {
        Mode::Phong => ("phong", None),
        Mode::Zbuffer => ("zbuffer", None),
        Mode::Normal => ("normal", None),
        Mode::Gooch(Gooch { b, y, alpha, beta }) => {
            let own = json!({ "b": b, "y": y, "alpha": alpha, "beta": beta });
            ("gooch", Some(own))
        }
        Mode::Path(PathSettings {
            samples,
            multiple_scattering,
        }) => {
            let own = json!({ "samples": samples, "multipleScattering": multiple_scattering });
            ("path", Some(own))
        }
    };
    let pattern = match pattern {
        Pattern::Grid => "grid",
        Pattern::Jitter => "jitter",
        Pattern::Random => "random",
    };
    let ambient = match ambient {
        Ambient::PerLight => "perLight",
        Ambient::Once => "once",
    };
    let pairs = [
        ("mode", mode.into()),
        ("shadows", (*shadows).into()),
        ("maxDepth", (*max_depth).into()),
        ("supersampling", (*supersampling).into()),
        ("pattern", pattern.into()),
        ("lightSamples", (*light_samples).into()),
        ("toon", (*toon).into()),
        ("ambient", ambient.into()),
    ];
    let pairs = pairs
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value));
    pairs
        .chain(parameters.map(|own| (mode.to_owned(), own)))
        .collect()
}
