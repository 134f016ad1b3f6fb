//! How a picture shows its values: the tone map and the exposure.

use super::decode::{Context, Value};
use super::lower::Lowering;
use super::record::FieldOutcome;
use super::schema::Definitions;
use super::settings::Scene;
use super::value::{word, word_schema};
use rtc_color::Tone;
use rtc_ir as ir;
use rtc_source::tree::NodeId;
use serde_json::Value as Json;

/// A tone map.
#[derive(Clone, Copy, Debug)]
pub(super) struct ToneWord(Tone);

/// The words for tone maps.
const TONES: &[(&str, Tone)] = &[
    ("none", Tone::None),
    ("srgb", Tone::Srgb),
    ("agx", Tone::Agx),
    ("pbr-neutral", Tone::PbrNeutral),
];

impl Value for ToneWord {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        word(node, TONES, context).map(Self)
    }

    fn schema(_: &mut Definitions) -> Json {
        word_schema(TONES)
    }
}

impl Lowering {
    /// Lowers what the file says of it.
    pub(super) fn display(&mut self, scene: &Scene) {
        self.scene.display = ir::Display {
            exposure: scene.exposure.value.0,
            tone: match &scene.tone {
                FieldOutcome::Read(tone) => Some(tone.value.0),
                FieldOutcome::Absent | FieldOutcome::Broken => None,
            },
        };
    }
}
