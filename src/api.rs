//! The public library API: [`Scene::open`], [`Scene::check`], [`Scene::render`], [`Picture::save`].
//!
//! It contains no rules about scenes. Like the command line it calls [`rtc_pipeline`], so both
//! report the same diagnostics and render the same bytes.
//!
//! - [`Scene`] is a scene that was read or built; [`Reading`] has the options of reading it.
//! - [`SceneBuilder`] builds a scene in code, and changes one: [`Camera`], [`Shape`], [`Mesh`],
//!   [`Material`], [`Texture`], [`Light`], [`Environment`]. [`SceneContents`] lists
//!   what a scene contains.
//! - [`Diagnostic`] is an error, a warning or a note about a scene, with [`Label`]s and [`Hint`]s.
//! - [`Options`] has the options of rendering, [`Progress`] is its progress, [`Picture`] is the
//!   result.
//! - [`Cost`] is the cost of accuracy, [`Export`] is the scene as a file of another program.
//! - [`Effect`] is the status of an effect such as shadows, with the reason; [`explain()`] gives
//!   the long text of a code or a rule.
//! - [`Error`] is returned if there is no scene or no picture.

mod builder;
mod camera;
mod clock;
#[cfg(not(target_family = "wasm"))]
mod cost;
mod diagnostic;
mod effect;
mod error;
mod explain;
mod export;
mod light;
mod mesh;
mod options;
mod path;
mod picture;
mod progress;
mod reexports;
mod scene;
mod shape;
mod texture;
mod tree;

pub use builder::{MaterialRef, ObjectId, SceneBuilder};
pub use camera::Camera;
#[cfg(not(target_family = "wasm"))]
pub use cost::{Cost, CostRow, Effort};
pub use diagnostic::{Diagnostic, Hint, Label, Location};
pub use effect::Effect;
pub use error::Error;
pub use explain::explain;
pub use export::Export;
pub use light::Light;
pub use mesh::{Mesh, Vertices};
pub use options::{Format, Options, Reading};
pub use picture::{Picture, Statistics};
pub use progress::Progress;
pub use reexports::*;
pub use scene::Scene;
pub use shape::{Shape, Transform};
pub use texture::{Environment, Texture};
pub use tree::{Object, SceneContents};
