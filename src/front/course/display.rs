//! The display settings: tone map and exposure.

use super::keyword::{Keyword, KeywordTable};
use super::lower::Lowering;
use super::record::FieldResult;
use super::settings::Scene;
use rtc_color::Tone;
use rtc_ir as ir;

impl Keyword for Tone {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "none",
            Tone::None,
            "Linear values as they are, clamped to 1.",
        ),
        ("srgb", Tone::Srgb, "Clamped to 1, and sRGB-encoded."),
        (
            "agx",
            Tone::Agx,
            "AgX: bright colours fade to white as on film.",
        ),
        (
            "pbr-neutral",
            Tone::PbrNeutral,
            "Khronos PBR Neutral: colours of products stay, highlights fade to white.",
        ),
    ];
}

impl Lowering {
    /// Lowers the display settings.
    pub(super) fn display(&mut self, scene: &Scene) {
        self.scene.display = ir::Display {
            exposure: scene.exposure.value.0,
            tone: match &scene.tone {
                FieldResult::Read(tone) => Some(tone.value),
                FieldResult::Absent | FieldResult::Broken => None,
            },
        };
    }
}
