//! How the picture is made, and what surrounds the scene, as `extras.rtc` of the asset says it.

use super::super::field::Fields;
use super::Lowering;
use crate::color::Tone;
use crate::ir::{
    Display, Environment, Field, Gooch, Mode, Noun, PathSettings, Pattern, Place, Settings,
};

impl Lowering<'_, '_, '_> {
    /// Takes over what the asset says of the settings and of the environment.
    pub(super) fn own_settings(&mut self) {
        let root = Fields::new(self.report.json, self.report.json.root());
        let Some(own) = root.own() else { return };
        if own.has("mode") {
            let place = Place::new(Noun::Settings, 0, Field::Whole);
            self.origins.record(place, self.report.json.span(own.at));
        }
        read(own, &mut self.scene.settings);
        if let Some(display) = own.object("display") {
            let name = display.text("tone");
            self.scene.display = Display {
                exposure: display.number_or("exposure", 0.0),
                tone: Tone::ALL
                    .into_iter()
                    .find(|tone| Some(tone.name()) == name.as_deref()),
            };
        }
        if let Some(environment) = own.object("environment") {
            let place = Place::new(Noun::Environment, 0, Field::Whole);
            self.origins
                .record(place, self.report.json.span(environment.at));
            self.scene.environment = Some(Environment {
                radiance: environment.vector_or("radiance", [0.0; 3]),
                image: None,
                image_from_world: None,
            });
        }
    }
}

/// Changes the settings that are named.
fn read(own: Fields<'_, '_>, settings: &mut Settings) {
    let Settings {
        mode,
        shadows,
        max_depth,
        supersampling,
        pattern,
        light_samples,
        toon,
    } = settings;
    if let Some(own) = own.text("mode").and_then(|word| mode_of(&word, own)) {
        *mode = own;
    }
    if own.has("shadows") {
        *shadows = own.truth("shadows");
    }
    *max_depth = own.count_or("maxDepth", *max_depth);
    *supersampling = own.count_or("supersampling", *supersampling);
    *light_samples = own.count_or("lightSamples", *light_samples);
    *toon = own.truth("toon");
    *pattern = match own.text("pattern").as_deref() {
        Some("jitter") => Pattern::Jitter,
        Some("random") => Pattern::Random,
        _ => Pattern::Grid,
    };
}

fn mode_of(word: &str, own: Fields<'_, '_>) -> Option<Mode> {
    let parameters = own.object(word);
    Some(match word {
        "phong" => Mode::Phong,
        "zbuffer" => Mode::Zbuffer,
        "normal" => Mode::Normal,
        "gooch" => {
            let number = |key| parameters.map_or(0.0, |own| own.number_or(key, 0.0));
            Mode::Gooch(Gooch {
                b: number("b"),
                y: number("y"),
                alpha: number("alpha"),
                beta: number("beta"),
            })
        }
        "path" => {
            let default = PathSettings::default();
            let samples = parameters.map(|own| own.count_or("samples", default.samples));
            let scatters = parameters.filter(|own| own.has("multipleScattering"));
            Mode::Path(PathSettings {
                samples: samples.unwrap_or(default.samples),
                multiple_scattering: scatters.map_or(default.multiple_scattering, |own| {
                    own.truth("multipleScattering")
                }),
            })
        }
        _ => return None,
    })
}
