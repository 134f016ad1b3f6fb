//! Writes settings, display and environment to `extras.rtc` of the asset.

use super::writer::{GltfWriter, extras, number};
use rtc_color::Tone;
use rtc_ir::{
    Ambient, Display, EntityKind, Environment, Field, Gooch, Mode, PathSettings, Pattern, Pixels,
    Settings, ValuePath,
};
use serde_json::{Map as Block, Value, json};

impl GltfWriter<'_> {
    /// Writes the settings, unless they are the defaults for glTF, the display settings and the
    /// environment.
    pub(super) fn settings(&mut self) {
        let mut rtc_extras = Block::new();
        if self.scene.settings != of_gltf() {
            let path = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.reporter.in_extras("how the picture is made", path);
            rtc_extras = settings(&self.scene.settings);
        }
        if !self.scene.display.is_plain() {
            let path = ValuePath::new(EntityKind::Settings, 0, Field::Whole);
            self.reporter.in_extras("how the picture is shown", path);
            let Display { exposure, tone } = &self.scene.display;
            let tone = tone.map(Tone::name);
            rtc_extras.insert(
                "display".to_owned(),
                json!({ "exposure": exposure, "tone": tone.unwrap_or("mode") }),
            );
        }
        if let Some(environment) = &self.scene.environment {
            self.environment(environment, &mut rtc_extras);
        }
        self.root.extras = extras(rtc_extras);
    }

    fn environment(&mut self, environment: &Environment, rtc_extras: &mut Block<String, Value>) {
        let Environment {
            radiance,
            image,
            image_from_world,
        } = environment;
        let path = ValuePath::new(EntityKind::Environment, 0, Field::Whole);
        self.reporter.in_extras("what surrounds the scene", path);
        let mut values = json!({ "radiance": radiance });
        if let Some(id) = image {
            let image = &self.scene.images[id.0 as usize];
            match image.kind {
                Pixels::Rgb8 | Pixels::Rgba8 => {
                    values["image"] = self.image(number(*id)).value().into();
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

/// The default settings for a glTF asset.
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
        Mode::Depth => ("zbuffer", None),
        Mode::Normal => ("normal", None),
        Mode::Gooch(Gooch { b, y, alpha, beta }) => {
            let rtc_extras = json!({ "b": b, "y": y, "alpha": alpha, "beta": beta });
            ("gooch", Some(rtc_extras))
        }
        Mode::Path(PathSettings {
            samples,
            multiple_scattering,
        }) => {
            let rtc_extras =
                json!({ "samples": samples, "multipleScattering": multiple_scattering });
            ("path", Some(rtc_extras))
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
        .chain(parameters.map(|rtc_extras| (mode.to_owned(), rtc_extras)))
        .collect()
}
