//! The accuracy parameters: numbers that trade work for error, and which of them apply to a scene.

use super::setting::Setting;
use rtc_ir::{Light, Material, Mode, Phong, Scene};
use rtc_passes::CountSetting;
use rtc_plan::{Arithmetic, Effect, EffectState, EffectStatus, Plan, RuleSet, focused_light, loss};
use rtc_valid::revalidate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter that trades work for accuracy.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "camelCase")]
pub enum Parameter {
    /// Sub-samples along each side of a pixel.
    Supersampling,
    /// Points of the lens.
    Aperture,
    /// Points of each soft light.
    Lights,
    /// Rays of each glossy lobe.
    Glossy,
    /// Paths per pixel, where paths are traced.
    Paths,
    /// Whether the caustics of small lights are estimated, where paths are traced: 0 or 1.
    Caustics,
    /// Whether the picture is denoised, where paths are traced: 0 or 1.
    Denoise,
    /// Bounces after the first hit.
    Depth,
    /// The arithmetic of ray intersection: its values number [`Arithmetic::ALL`] in ascending order
    /// of work.
    Precision,
}

impl Parameter {
    /// All variants.
    pub const ALL: [Self; 9] = [
        Self::Supersampling,
        Self::Aperture,
        Self::Lights,
        Self::Glossy,
        Self::Paths,
        Self::Caustics,
        Self::Denoise,
        Self::Depth,
        Self::Precision,
    ];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Supersampling => "supersampling",
            Self::Aperture => "aperture samples",
            Self::Lights => "light samples",
            Self::Glossy => "glossy samples",
            Self::Paths => "paths",
            Self::Caustics => "caustics",
            Self::Denoise => "denoising",
            Self::Depth => "depth",
            Self::Precision => "precision",
        }
    }

    /// The number of the overrides that it is; none for caustics, denoising and precision.
    #[must_use]
    pub fn count(self) -> Option<&'static CountSetting> {
        let flag = self.flag();
        CountSetting::ALL
            .iter()
            .find(|count| flag.strip_prefix("--") == Some(count.name))
    }

    /// The flag of `rtc render` that sets it.
    #[must_use]
    pub fn flag(self) -> &'static str {
        match self {
            Self::Supersampling => "--supersampling",
            Self::Aperture => "--aperture-samples",
            Self::Lights => "--light-samples",
            Self::Glossy => "--glossy-samples",
            Self::Paths => "--spp",
            Self::Caustics => "--set",
            Self::Denoise => "--denoise",
            Self::Depth => "--depth",
            Self::Precision => "--arithmetic",
        }
    }

    /// The short name.
    #[must_use]
    pub fn short(self) -> &'static str {
        match self {
            Self::Supersampling => "ss",
            Self::Aperture => "lens",
            Self::Lights => "light",
            Self::Glossy => "gloss",
            Self::Paths => "spp",
            Self::Caustics => "caus",
            Self::Denoise => "dn",
            Self::Depth => "depth",
            Self::Precision => "prec",
        }
    }

    /// The argument of `rtc render` that sets a value.
    #[must_use]
    pub fn argument(self, value: u32) -> String {
        match self.flag_value(value) {
            Some(value) => format!("{} {value}", self.flag()),
            None => self.flag().to_owned(),
        }
    }

    /// The value after the flag; `None` for a flag without a value.
    #[must_use]
    pub fn flag_value(self, value: u32) -> Option<String> {
        match self {
            Self::Caustics => Some(format!("caustics={}", value > 0)),
            Self::Denoise => None,
            Self::Supersampling
            | Self::Aperture
            | Self::Lights
            | Self::Glossy
            | Self::Paths
            | Self::Depth
            | Self::Precision => Some(self.cell(value)),
        }
    }

    /// A short form of a value, for example "4" or "plain".
    #[must_use]
    pub fn cell(self, value: u32) -> String {
        if self == Self::Precision {
            arithmetic(value).name().to_owned()
        } else if self.is_switch() {
            ["no", "yes"][usize::from(value > 0)].to_owned()
        } else {
            value.to_string()
        }
    }

    /// A value with its unit, for example "4×4" or "16 aperture samples".
    #[must_use]
    pub fn label(self, value: u32) -> String {
        match self {
            Self::Supersampling => format!("{value}×{value}"),
            Self::Aperture | Self::Lights | Self::Glossy | Self::Paths => {
                let name = self.name();
                format!(
                    "{value} {}",
                    if value == 1 {
                        name.trim_end_matches('s')
                    } else {
                        name
                    }
                )
            }
            Self::Caustics => {
                ["caustics by chance", "caustics estimated"][usize::from(value > 0)].to_owned()
            }
            Self::Denoise => ["plain", "denoised"][usize::from(value > 0)].to_owned(),
            Self::Depth => format!("depth {value}"),
            Self::Precision => format!("{} arithmetic", self.cell(value)),
        }
    }

    /// The values to try, in ascending order of work.
    pub fn levels(self) -> impl Iterator<Item = u32> {
        const DEPTHS: u32 = MAX_DEPTH + 1;
        let (count, step): (u32, fn(u32) -> u32) = match self {
            Self::Supersampling => (10, |i| [1, 2, 3, 4, 6, 8, 12, 16, 24, 32][i as usize]),
            Self::Aperture | Self::Lights | Self::Glossy => (11, |i| 1 << i),
            Self::Paths => (15, |i| 1 << i),
            Self::Caustics | Self::Denoise => (2, |i| i),
            Self::Depth => (DEPTHS, |i| i),
            Self::Precision => (3, |i| i),
        };
        (0..count).map(step)
    }

    /// The value with the least work.
    #[must_use]
    pub fn lowest(self) -> u32 {
        u32::from(self.samples_pixels())
    }

    /// Whether it is on or off.
    #[must_use]
    pub fn is_switch(self) -> bool {
        matches!(self, Self::Caustics | Self::Denoise)
    }

    /// Whether its values are numbers of samples.
    #[must_use]
    pub fn samples_pixels(self) -> bool {
        !self.is_switch() && !matches!(self, Self::Depth | Self::Precision)
    }

    /// The work of a value: samples or bounces.
    #[must_use]
    pub fn samples(self, value: u32) -> f64 {
        match self {
            Self::Supersampling => f64::from(value) * f64::from(value),
            Self::Aperture | Self::Lights | Self::Glossy | Self::Paths | Self::Depth => {
                f64::from(value)
            }
            Self::Caustics | Self::Denoise | Self::Precision => 1.0,
        }
    }
}

/// The maximum path length of a study.
pub(super) const MAX_DEPTH: u32 = 64;

/// The arithmetic of a precision value; the robust one for an invalid value.
#[must_use]
pub fn arithmetic(value: u32) -> Arithmetic {
    Arithmetic::ALL
        .into_iter()
        .rev()
        .nth(value as usize)
        .unwrap_or_default()
}

/// The precision value of an arithmetic.
pub(super) fn precision_value(arithmetic: Arithmetic) -> u32 {
    (0..)
        .zip(Arithmetic::ALL.into_iter().rev())
        .find(|(_, other)| *other == arithmetic)
        .map_or(0, |(value, _)| value)
}

/// Whether no visible loss is expected from an arithmetic.
pub(super) fn tolerates(scene: &Scene, arithmetic: Arithmetic) -> bool {
    loss(&revalidate(scene), arithmetic).is_none()
}

/// The reason why a parameter does not apply to a scene, or `None`: the scene does not require its
/// effect, the plan prunes the effect at all values, or only one value is valid.
#[must_use]
pub fn not_applicable(parameter: Parameter, scene: &Scene) -> Option<String> {
    unused_reason(parameter, scene)
        .map(str::to_owned)
        .or_else(|| pruned_reason(parameter, scene))
}

/// Like [`not_applicable`], in a study of the whole picture or of tiles.
pub(super) fn not_applicable_in(
    parameter: Parameter,
    scene: &Scene,
    is_whole: bool,
) -> Option<String> {
    let is_only_tiles = parameter == Parameter::Denoise && !is_whole;
    let tiles = "only whole pictures can be denoised, and only tiles were rendered";
    not_applicable(parameter, scene).or_else(|| is_only_tiles.then(|| tiles.to_owned()))
}

/// The reason why the plan prunes the effect of a parameter, if it does.
fn pruned_reason(parameter: Parameter, scene: &Scene) -> Option<String> {
    let effect = match parameter {
        Parameter::Supersampling => Effect::Supersampling,
        Parameter::Aperture => Effect::Lens,
        Parameter::Lights => Effect::SoftLight,
        Parameter::Glossy => Effect::GlossyReflection,
        Parameter::Depth if scene.settings.mode == Mode::Phong => Effect::Depth,
        Parameter::Depth
        | Parameter::Paths
        | Parameter::Caustics
        | Parameter::Denoise
        | Parameter::Precision => {
            return None;
        }
    };
    let own = Setting::of(scene);
    let mut varied = scene.clone();
    Parameter::ALL
        .into_iter()
        .fold(own, |all, parameter| {
            all.with(parameter, own.get(parameter).max(2))
        })
        .apply(&mut varied);
    let plan = Plan::new(&revalidate(&varied), RuleSet::ALL);
    let status = plan
        .statuses
        .iter()
        .find(|status| status.effect == effect && status.of.is_none())?;
    let EffectStatus { reason, rule, .. } = status;
    let reason = rule.map_or_else(
        || reason.clone(),
        |rule| format!("{reason} ({})", rule.name()),
    );
    (status.state != EffectState::Needed).then_some(reason)
}

fn unused_reason(parameter: Parameter, scene: &Scene) -> Option<&'static str> {
    // List the reasons why the scene does not depend on the parameter.
    let mode = &scene.settings.mode;
    let (phong, paths) = (*mode == Mode::Phong, matches!(mode, Mode::Path(_)));
    let per_path = (paths, "each path takes its own sample");
    let weights = || scene.materials.iter().filter_map(Material::phong);
    let is_matte = |phong: &Phong| phong.ks == 0.0 && phong.kt == 0.0;
    let is_robust = |arithmetic: &Arithmetic| {
        *arithmetic == Arithmetic::Robust || !tolerates(scene, *arithmetic)
    };
    let tries_none = Setting::of(scene).denoised().next().is_none();
    let cases: &[(bool, &'static str)] = match parameter {
        Parameter::Supersampling => &[
            per_path,
            (*mode == Mode::Depth, "the z-buffer takes one ray per pixel"),
        ],
        Parameter::Aperture => &[
            per_path,
            (*mode == Mode::Depth, "the z-buffer takes one ray per pixel"),
            (scene.camera.lens.radius == 0.0, "the lens has no radius"),
        ],
        Parameter::Lights => &[
            per_path,
            (!phong, "the mode samples only the centre of a light"),
            (
                scene
                    .lights
                    .iter()
                    .filter_map(Light::point)
                    .all(|light| light.radius == 0.0),
                "no light has a radius",
            ),
        ],
        Parameter::Glossy => &[
            per_path,
            (!phong, "the mode has no reflection"),
            (
                weights().all(|phong| phong.glossy_samples == 1),
                "no material is glossy",
            ),
        ],
        Parameter::Paths => &[(!paths, "the mode does not trace paths")],
        Parameter::Caustics => &[
            (!paths, "the mode does not trace paths"),
            (
                paths && focused_light(&revalidate(scene)).is_none(),
                "no smooth surface leads the light of a small light to another",
            ),
        ],
        Parameter::Denoise => &[(
            tries_none,
            "the mode does not trace paths, or they are too few to reduce",
        )],
        Parameter::Depth => &[
            (
                !phong && !paths,
                "the mode has no reflection and no refraction",
            ),
            (
                phong && weights().all(is_matte),
                "no material reflects or transmits light",
            ),
        ],
        Parameter::Precision => &[(
            Arithmetic::ALL.iter().all(is_robust),
            "every other arithmetic would have a visible loss",
        )],
    };
    // Tell the first that holds.
    cases
        .iter()
        .find(|(holds, _)| *holds)
        .map(|(_, reason)| *reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_ascend_from_the_lowest() {
        for parameter in Parameter::ALL {
            let values: Vec<_> = parameter.levels().collect();
            assert!(
                values[0] == parameter.lowest() && values.is_sorted_by(|a, b| a < b),
                "{parameter:?}: {values:?}"
            );
        }
        assert_eq!(
            [Arithmetic::F32, Arithmetic::Plain, Arithmetic::Robust].map(precision_value),
            [0, 1, 2]
        );
    }
}
