//! The settings: what a pixel shows and how much work goes into it.

use crate::diag::{clip, clip_words};
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// By which rules the picture is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Settings {
    /// What a pixel shows.
    pub mode: Mode,
    /// Whether surfaces hide lights from each other.
    pub shadows: bool,
    /// How many mirror or refraction bounces follow the first hit.
    pub max_depth: u32,
    /// Sub-samples along each side of a pixel, at least 1.
    #[schemars(range(min = 1))]
    pub supersampling: u32,
    /// Where in its cell each sub-sample lies.
    #[serde(default, skip_serializing_if = "Pattern::is_grid")]
    pub pattern: Pattern,
    /// How many points of each soft light are asked, at least 1; 1 asks its centre.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    #[schemars(range(min = 1))]
    pub light_samples: u32,
}

impl Settings {
    /// The names of the fields in the text form.
    const NAMES: [&str; 6] = [
        "mode",
        "shadows",
        "maxDepth",
        "supersampling",
        "pattern",
        "lightSamples",
    ];

    /// Replaces one value, by the name that the text form gives it: a field of the settings, or of
    /// the parameters of their mode. What is no JSON is a word.
    ///
    /// # Errors
    /// If there is no field of this name, or the value is none for it; in words.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let wrong = |fault: serde_json::Error| {
            format!(
                "`{name}` can't be `{}`: {}",
                clip(value),
                clip_words(&fault.to_string())
            )
        };
        let mut text = serde_json::to_value(&*self).map_err(wrong)?;
        let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
        let parameters = text["mode"]
            .as_object()
            .and_then(|mode| mode.values().next()?.as_object());
        let parameters: Vec<_> = parameters
            .into_iter()
            .flat_map(|fields| fields.keys().cloned())
            .collect();
        if Self::NAMES.contains(&name) {
            text[name] = value;
        } else if parameters.iter().any(|own| own == name) {
            let mode = text["mode"]
                .as_object_mut()
                .and_then(|mode| mode.values_mut().next());
            mode.into_iter()
                .for_each(|fields| fields[name] = value.clone());
        } else {
            let names = Self::NAMES
                .map(str::to_owned)
                .into_iter()
                .chain(parameters)
                .collect::<Vec<_>>()
                .join(", ");
            return Err(format!(
                "there is no setting `{}`; there are {names}",
                clip(name)
            ));
        }
        *self = serde_json::from_value(text).map_err(wrong)?;
        Ok(())
    }
}

fn one() -> u32 {
    1
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_one(count: &u32) -> bool {
    *count == 1
}

/// Where in its cell of the pixel each sub-sample lies.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Pattern {
    /// In the middle.
    #[default]
    Grid,
    /// Anywhere in its cell, seeded by pixel and sample.
    Jitter,
    /// Anywhere in the pixel, seeded by pixel and sample.
    Random,
}

impl Pattern {
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_grid(&self) -> bool {
        *self == Self::Grid
    }
}

/// What a pixel shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Mode {
    /// Phong's model with shadows, mirrors and refraction.
    Phong,
    /// The distance of the first hit: near is white, far is black.
    Zbuffer,
    /// The normal of the first hit, (N + 1)/2 per component.
    Normal,
    /// Gooch's cool-to-warm shading.
    Gooch(Gooch),
    /// The light that arrives along all paths, from the materials and lights in physical units.
    Path(PathSettings),
}

/// How paths are traced.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
#[schemars(rename = "Path")]
pub struct PathSettings {
    /// Paths a pixel, at least 1.
    #[schemars(range(min = 1))]
    pub samples: u32,
    /// Whether rough surfaces keep the light that bounces between their facets.
    pub multiple_scattering: bool,
}

impl PathSettings {
    /// Bounces of a path, where nobody says how many.
    pub const DEPTH: u32 = 16;
}

impl Default for PathSettings {
    /// What is good for a look.
    fn default() -> Self {
        Self {
            samples: 64,
            multiple_scattering: true,
        }
    }
}

/// The parameters of Gooch shading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Gooch {
    /// The blue of the cool colour.
    pub b: f64,
    /// The yellow of the warm colour.
    pub y: f64,
    /// How much of the surface's colour the cool tone takes.
    pub alpha: f64,
    /// How much of the surface's colour the warm tone takes.
    pub beta: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths() -> Settings {
        Settings {
            mode: Mode::Path(PathSettings {
                samples: 64,
                multiple_scattering: true,
            }),
            shadows: true,
            max_depth: 16,
            supersampling: 1,
            pattern: Pattern::Jitter,
            light_samples: 2,
        }
    }

    #[test]
    fn every_field_can_be_set_by_its_name() {
        let text = serde_json::to_value(paths()).unwrap();
        let names: Vec<_> = text.as_object().unwrap().keys().collect();
        assert_eq!(names, Settings::NAMES);
        let mut settings = paths();
        let values = [
            ("multipleScattering", "false"),
            ("samples", "9"),
            ("maxDepth", "3"),
            ("pattern", "random"),
            ("shadows", "false"),
        ];
        for (name, value) in values {
            settings.set(name, value).unwrap();
        }
        let mode = Mode::Path(PathSettings {
            samples: 9,
            multiple_scattering: false,
        });
        let expected = Settings {
            mode,
            max_depth: 3,
            pattern: Pattern::Random,
            shadows: false,
            ..paths()
        };
        assert_eq!(settings, expected);
        settings.set("mode", "normal").unwrap();
        assert_eq!(settings.mode, Mode::Normal);
    }

    #[test]
    fn what_is_wrong_is_said_and_changes_nothing() {
        let mut settings = paths();
        let unknown = settings.set("sample", "3").unwrap_err();
        assert!(
            unknown.starts_with("there is no setting `sample`; there are mode, ")
                && unknown.contains("samples")
        );
        for (name, value) in [
            ("samples", "-1"),
            ("shadows", "maybe"),
            ("mode", "{\"path\": {}}"),
            ("b", "1"),
        ] {
            assert!(settings.set(name, value).is_err(), "{name} {value}");
        }
        assert_eq!(settings, paths());
    }
}
