//! The metadata of a picture, as the setup that renders it again.

use super::super::{Exposure, OutputTransform, PictureSetup, RenderError};
use rtc_color::Tone;
use rtc_image::{BackgroundFill, FileFormat};
use rtc_ir::{Lens, Settings};
use rtc_passes::Overrides;
use rtc_plan::{Arithmetic, Rule, RuleSet};
use rtc_render::{Aov, Crop};
use serde::Deserialize;

/// The settings in the metadata of a picture; [`PictureSetup::metadata`] writes them.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct ClaimedSettings {
    size: [u32; 2],
    lens: Lens,
    settings: Settings,
    crop: Option<[u32; 4]>,
    #[serde(default)]
    target_error: Option<f64>,
    #[serde(default)]
    time_budget: Option<f64>,
    #[serde(default)]
    denoiser: Option<String>,
    #[serde(default)]
    clamp: Option<f64>,
    #[serde(default)]
    glossy_samples: Option<u32>,
    #[serde(default)]
    arithmetic: Arithmetic,
    #[serde(default)]
    approx: bool,
    #[serde(default)]
    exposure: f64,
    #[serde(default)]
    tonemap: Option<String>,
    #[serde(default)]
    background: ClaimedBackground,
}

/// `"transparent"`, or a colour.
#[derive(Default, Deserialize)]
#[serde(untagged)]
enum ClaimedBackground {
    #[default]
    Film,
    Word(String),
    Color([f64; 3]),
}

impl ClaimedSettings {
    /// The reason why such a picture can't be rendered again in parts, if any.
    fn obstacle(&self) -> Option<&'static str> {
        let obstacles = [
            (
                self.denoiser.is_some(),
                "it is denoised, so each pixel depends on pixels around it",
            ),
            (
                self.target_error.is_some(),
                "it was sampled to a target error, so the samples of a pixel depend on the whole \
                 picture; `--spp` fixes them",
            ),
            (
                self.time_budget.is_some(),
                "it was sampled within a time, so it depends on the machine",
            ),
        ];
        let mut found = obstacles.into_iter().filter(|(is_so, _)| *is_so);
        found.next().map(|(_, words)| words)
    }
}

/// The setup of a picture whose metadata has these settings, of this form and with these layers.
///
/// # Errors
/// If they can't be read, or a part of such a picture can't be rendered separately.
pub(super) fn setup(
    settings: &str,
    form: FileFormat,
    layers: &[Aov],
) -> Result<PictureSetup, RenderError> {
    let refused = |words: String| RenderError::Refused(words);
    // Parse the settings that the picture claims.
    let claim: ClaimedSettings = serde_json::from_str(settings)
        .map_err(|_| refused("its settings are not those of this program".to_owned()))?;
    if let Some(words) = claim.obstacle() {
        return Err(refused(words.to_owned()));
    }
    // Restore the output transform.
    let tone = claim.tonemap.as_deref();
    let tone = tone.and_then(|name| Tone::ALL.into_iter().find(|tone| tone.name() == name));
    let exposure = Exposure::Stops(claim.exposure);
    let background = match claim.background {
        ClaimedBackground::Color(color) => BackgroundFill::Color(color),
        ClaimedBackground::Word(word) if word == "transparent" => BackgroundFill::Transparent,
        ClaimedBackground::Word(_) | ClaimedBackground::Film => BackgroundFill::Film,
    };
    let look = OutputTransform::new(form, tone, Some(exposure), background, layers);
    // Restore the plan's rules and the sampling.
    let rules = match claim.approx {
        true => RuleSet::ALL.with(Rule::Cut),
        false => RuleSet::ALL,
    };
    Ok(PictureSetup {
        overrides: Overrides {
            size: Some(claim.size),
            glossy_samples: claim.glossy_samples,
            ..Overrides::default()
        },
        settings: Some((claim.lens, claim.settings)),
        arithmetic: claim.arithmetic,
        crop: claim.crop.map(|[x, y, width, height]| Crop {
            x,
            y,
            width,
            height,
        }),
        clamp: claim.clamp,
        rules,
        ..PictureSetup::new(look.map_err(|words| refused(words.to_owned()))?)
    })
}
