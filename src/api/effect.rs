//! What a picture needs, and what is left out of it with the reason.

use rtc_plan::{EffectStatus, State};

/// An effect of light or of the film, and whether pictures of a scene simulate it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Effect {
    /// Its name, as `shadows`.
    pub name: &'static str,
    /// The address of the one light, material or surface that it is about; `None` for the whole scene.
    pub of: Option<String>,
    /// Whether it is simulated.
    pub state: State,
    /// The rule that proves that the picture is the same without it, if one does; `rtc explain` has
    /// its proof.
    pub rule: Option<&'static str>,
    /// The reason in plain words: one line, lower case, without a full stop.
    pub because: String,
}

impl Effect {
    pub(super) fn new(status: &EffectStatus) -> Self {
        Self {
            name: status.effect.name(),
            of: status.of.map(|place| place.to_string()),
            state: status.state,
            rule: status.rule.map(rtc_plan::Rule::name),
            because: status.reason.clone(),
        }
    }
}
