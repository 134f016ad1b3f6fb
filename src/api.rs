//! The library's door: [`Scene::open`], [`Scene::check`], [`Scene::render`], [`Picture::save`].
//!
//! It holds no rule about scenes: it hands what is asked for to [`rtc_pipeline`], as the command
//! line does, so both find the same and render the same bytes.

mod effect;
mod error;
mod finding;
mod light;
mod options;
mod picture;
mod scene;

pub use effect::Effect;
pub use error::Error;
pub use finding::{Finding, Hint, Label, Location};
pub use light::Light;
pub use options::{Format, Options, Reading};
pub use picture::{Picture, Statistics};
pub use rtc_color::Tone;
pub use rtc_diag::Severity;
pub use rtc_plan::State as EffectState;
pub use rtc_render::Aov;
pub use scene::Scene;
