//! The effects of a picture: which are rendered, which are omitted, and why.

use rtc_plan::{EffectState, EffectStatus};

/// An effect of light or of the film, and whether the renderer simulates it for a scene.
///
/// ```
/// use rtc::{Camera, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// for effect in scene.effects(&Options::new())? {
///     println!("{} ({:?}): {}", effect.name, effect.state, effect.because);
/// }
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Effect {
    /// Its name, for example `shadows`.
    pub name: &'static str,
    /// The path of the light, material or surface that it concerns; `None` for the whole scene.
    pub of: Option<String>,
    /// Whether it is simulated.
    pub state: EffectState,
    /// The rule that proves that the picture is the same without it, if any; `rtc explain` prints
    /// the proof.
    pub rule: Option<&'static str>,
    /// The reason: one line, lower case, without a full stop.
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
