//! Settings that the page overrides: the scene's own values, and the same as flags of `rtc render`.

use crate::args::IntegratorArg;
use clap::ValueEnum;
use rtc_ir::{Mode, Scene};
use rtc_passes::{IntegratorChoice, Overrides};
use rtc_pipeline::PictureSetup;
use rtc_study::{Parameter, Setting, arithmetic, not_applicable};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Values of parameters that override the scene's, and the integrator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SettingOverrides {
    values: BTreeMap<Parameter, u32>,
    /// A value of `--integrator`.
    integrator: Option<String>,
}

impl SettingOverrides {
    /// A choice as sent by the page; none of values that no flag takes.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let choice: Self = serde_json::from_slice(bytes).ok()?;
        let is_sound = |(parameter, value): (&Parameter, &u32)| {
            let is_known =
                keywords(*parameter).is_none_or(|keywords| (*value as usize) < keywords.len());
            *value >= parameter.lowest() && is_known
        };
        let is_known = choice.integrator.is_none() || choice.integrator().is_some();
        (is_known && choice.values.iter().all(is_sound)).then_some(choice)
    }

    /// The same integrator, with the scene's own values.
    pub(super) fn without_values(&self) -> Self {
        Self {
            values: BTreeMap::new(),
            integrator: self.integrator.clone(),
        }
    }

    pub(super) fn integrator(&self) -> Option<IntegratorChoice> {
        let keyword = self.integrator.as_deref()?;
        IntegratorArg::from_str(keyword, false)
            .ok()
            .map(IntegratorChoice::from)
    }

    /// The requested picture, in these settings.
    pub(super) fn settle(&self, setup: &PictureSetup) -> PictureSetup {
        let of = |parameter| self.values.get(&parameter).copied();
        let mut chosen = Overrides {
            caustics: of(Parameter::Caustics).map(|value| value > 0),
            ..Overrides::default()
        };
        for (parameter, value) in &self.values {
            if let Some(count) = parameter.count() {
                *(count.of)(&mut chosen) = Some(*value);
            }
        }
        PictureSetup {
            overrides: chosen.or(setup.overrides),
            arithmetic: of(Parameter::Precision).map_or(setup.arithmetic, arithmetic),
            denoise: of(Parameter::Denoise).map_or(setup.denoise, |value| value > 0),
            ..setup.clone()
        }
    }

    /// The flags of `rtc render`, with their values if they take one.
    pub(super) fn flags(&self) -> Vec<(&'static str, Option<String>)> {
        let is_given = |(parameter, value): &(&Parameter, &u32)| {
            **parameter != Parameter::Denoise || **value > 0
        };
        let values = self.values.iter().filter(is_given);
        let values =
            values.map(|(parameter, value)| (parameter.flag(), parameter.flag_value(*value)));
        let integrator = self.integrator.clone();
        let integrator = integrator.map(|keyword| ("--integrator", Some(keyword)));
        values.chain(integrator).collect()
    }
}

/// The text of a value of a parameter that is not a number.
fn keywords(parameter: Parameter) -> Option<Vec<String>> {
    let is_named = parameter.is_switch() || parameter == Parameter::Precision;
    is_named.then(|| {
        parameter
            .levels()
            .map(|value| parameter.cell(value))
            .collect()
    })
}

/// The setting of a scene without the values of a choice.
pub(super) fn own_setting(scene: &Scene, setup: &PictureSetup) -> Setting {
    Setting {
        precision: setup.arithmetic,
        denoise: setup.denoise,
        ..Setting::of(scene)
    }
}

/// The settings of a scene for the page, without the overrides: each parameter with its own value,
/// and why it does not apply, if so.
pub(super) fn reported(scene: &Scene, own: &Setting) -> Value {
    let parameter = |parameter: Parameter| {
        json!({
            "knob": parameter,
            "name": parameter.name(),
            "lowest": parameter.lowest(),
            "own": own.get(parameter),
            "words": keywords(parameter),
            "idle": not_applicable(parameter, scene),
        })
    };
    let integrator = match scene.settings.mode {
        Mode::Path(_) => Some("path"),
        Mode::Phong => Some("whitted"),
        Mode::Depth | Mode::Normal | Mode::Gooch(_) => None,
    };
    let parameters = Parameter::ALL.map(parameter);
    json!({ "knobs": parameters, "integrator": integrator })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_is_one_that_flags_can_say() {
        let read = |text: &str| SettingOverrides::read(text.as_bytes());
        let choice = r#"{"values": {"supersampling": 2, "precision": 0}, "integrator": "path"}"#;
        let flags = [
            ("--supersampling", Some("2".to_owned())),
            ("--arithmetic", Some("f32".to_owned())),
            ("--integrator", Some("path".to_owned())),
        ];
        assert_eq!(read(choice).unwrap().flags(), flags);
        let denoised = |value: u32| {
            let text = format!(r#"{{"values": {{"denoise": {value}}}, "integrator": null}}"#);
            read(&text).map(|choice| choice.flags())
        };
        assert_eq!(denoised(0), Some(Vec::new()));
        assert_eq!(denoised(1), Some(vec![("--denoise", None)]));
        assert_eq!(denoised(2), None);
        let caustics = read(r#"{"values": {"caustics": 0}, "integrator": null}"#).unwrap();
        let off = ("--set", Some("caustics=false".to_owned()));
        assert_eq!(caustics.flags(), [off]);
        for wrong in [
            r#"{"values": {"supersampling": 0}, "integrator": null}"#,
            r#"{"values": {"precision": 3}, "integrator": null}"#,
            r#"{"values": {"size": 3}, "integrator": null}"#,
            r#"{"values": {"depth": -1}, "integrator": null}"#,
            r#"{"values": {}, "integrator": "bdpt"}"#,
            r#"{"values": {}, "more": 1}"#,
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
