//! Sets one setting by the name that it has in the text form of the IR.

use rtc_diag::{clip, clip_words};
use rtc_ir::{Mode, PathSettings, Settings};

/// Replaces one value, by its name in the text form: a field of the settings, or of the parameters
/// of the mode. A value that is not JSON is a string.
///
/// # Errors
/// A message if there is no field of this name, or if the value is invalid.
pub fn set(settings: &mut Settings, name: &str, value: &str) -> Result<(), String> {
    let wrong = |fault: serde_json::Error| {
        format!(
            "`{name}` can't be `{}`: {}",
            clip(value),
            clip_words(&fault.to_string())
        )
    };
    // Convert the settings to JSON, and the value: not JSON means a string.
    let mut json = serde_json::to_value(&*settings).map_err(wrong)?;
    let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
    // Collect the parameter names of the mode.
    let parameters = json["mode"]
        .as_object()
        .and_then(|mode| mode.values().next()?.as_object());
    let parameters = match &settings.mode {
        Mode::Path(_) => PathSettings::names(),
        Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => parameters
            .into_iter()
            .flat_map(|fields| fields.keys().cloned())
            .collect(),
    };
    // Replace the field, or the parameter of the mode.
    let fields = Settings::names();
    if fields.iter().any(|field| field == name) {
        json[name] = value;
    } else if parameters.iter().any(|parameter| parameter == name) {
        let mode = json["mode"]
            .as_object_mut()
            .and_then(|mode| mode.values_mut().next());
        mode.into_iter()
            .for_each(|fields| fields[name] = value.clone());
    } else {
        let names = [fields, parameters].concat().join(", ");
        return Err(format!(
            "there is no setting `{}`; there are {names}",
            clip(name)
        ));
    }
    // Convert back, which checks the value.
    *settings = serde_json::from_value(json).map_err(wrong)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::{Ambient, Pattern, StereoView};

    fn paths() -> Settings {
        Settings {
            mode: Mode::Path(PathSettings {
                samples: 64,
                multiple_scattering: true,
                caustics: false,
                filter: rtc_math::PixelFilter::PIXEL,
            }),
            shadows: true,
            max_depth: 16,
            supersampling: 1,
            pattern: Pattern::Jitter,
            light_samples: 2,
            toon: true,
            ambient: Ambient::Once,
            ambient_light: [0.5; 3],
            background: Some([1.0, 0.0, 0.0]),
            stereo: 0.1,
            stereo_view: StereoView::Anaglyph,
            shutter: [0.0, 0.5],
        }
    }

    #[test]
    fn every_field_can_be_set_by_its_name() {
        let json = serde_json::to_value(paths()).unwrap();
        let names: Vec<_> = json.as_object().unwrap().keys().collect();
        assert_eq!(names, Settings::names().iter().collect::<Vec<_>>());
        let mut settings = paths();
        let values = [
            ("multipleScattering", "false"),
            ("caustics", "true"),
            ("samples", "9"),
            ("maxDepth", "3"),
            ("pattern", "random"),
            ("shadows", "false"),
        ];
        for (name, value) in values {
            set(&mut settings, name, value).unwrap();
        }
        let mode = Mode::Path(PathSettings {
            samples: 9,
            multiple_scattering: false,
            caustics: true,
            filter: rtc_math::PixelFilter::PIXEL,
        });
        let expected = Settings {
            mode,
            max_depth: 3,
            pattern: Pattern::Random,
            shadows: false,
            ..paths()
        };
        assert_eq!(settings, expected);
        set(&mut settings, "mode", "normal").unwrap();
        assert_eq!(settings.mode, Mode::Normal);
    }

    #[test]
    fn an_invalid_value_is_reported_and_changes_nothing() {
        let mut settings = paths();
        let unknown = set(&mut settings, "sample", "3").unwrap_err();
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
            assert!(set(&mut settings, name, value).is_err(), "{name} {value}");
        }
        assert_eq!(settings, paths());
    }
}
