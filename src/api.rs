//! The public library API: [`Scene::open`], [`Scene::check`], [`Scene::render`], [`Picture::save`].
//!
//! It contains no rules about scenes. Like the command line it calls [`rtc_pipeline`], so both
//! report the same diagnostics and render the same bytes.
//!
//! - [`Scene`] is a scene that was read; [`Reading`] has the options of reading it.
//! - [`Diagnostic`] is an error, a warning or a note about a scene, with [`Label`]s and [`Hint`]s.
//! - [`Options`] has the options of rendering, [`Picture`] is the result.
//! - [`Effect`] says whether a picture needs an effect such as shadows, and why not.
//! - [`Error`] is returned if there is no scene or no picture.

mod diagnostic;
mod effect;
mod error;
mod light;
mod options;
mod picture;
mod scene;

#[allow(deprecated, reason = "the alias is handed out for one more version")]
pub use diagnostic::Finding;
pub use diagnostic::{Diagnostic, Hint, Label, Location};
pub use effect::Effect;
pub use error::Error;
pub use light::Light;
pub use options::{Format, Options, Reading};
pub use picture::{Picture, Statistics};
pub use rtc_color::Tone;
pub use rtc_diag::Severity;
pub use rtc_plan::EffectState;
pub use rtc_render::Aov;
pub use scene::Scene;
