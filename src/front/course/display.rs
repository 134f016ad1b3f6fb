//! The display settings: tone map and exposure.

use super::keyword::Keyword;
use super::lower::Lowering;
use super::record::FieldOutcome;
use super::settings::Scene;
use rtc_color::Tone;
use rtc_ir as ir;

impl Keyword for Tone {
    const KEYWORDS: &'static [(&'static str, Self)] = &[
        ("none", Tone::None),
        ("srgb", Tone::Srgb),
        ("agx", Tone::Agx),
        ("pbr-neutral", Tone::PbrNeutral),
    ];
}

impl Lowering {
    /// Lowers the display settings.
    pub(super) fn display(&mut self, scene: &Scene) {
        self.scene.display = ir::Display {
            exposure: scene.exposure.value.0,
            tone: match &scene.tone {
                FieldOutcome::Read(tone) => Some(tone.value),
                FieldOutcome::Absent | FieldOutcome::Broken => None,
            },
        };
    }
}
