//! Display settings: how linear values become 8-bit or 16-bit values.

use arbitrary::Arbitrary;
use rtc_color::Tone;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How linear values are displayed. Float files store the linear values unchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Display {
    /// The exposure in stops, from -64 to 64: each stop doubles the values.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = -64.0, max = 64.0))]
    pub exposure: f64,
    /// The tone map; if absent, that of the mode.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tone: Option<Tone>,
}

impl Display {
    /// The largest exposure, in stops, up or down.
    pub const MOST_STOPS: f64 = 64.0;

    /// Whether all settings are the defaults.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        is_zero(&self.exposure) && self.tone.is_none()
    }
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(exposure: &f64) -> bool {
    exposure.to_bits() == 0
}
