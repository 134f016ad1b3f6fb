//! `rtc`, a compiler for 3-D scenes: it reads them, says what is wrong with them, and renders them on
//! the CPU, the same bytes every time.
//!
//! A [`Scene`] is opened from files on disk or in memory, checked into [`Finding`]s, and rendered
//! into a [`Picture`] as [`Options`] say:
//!
//! ```
//! use rtc::{Error, Options, Scene};
//!
//! # fn main() -> Result<(), Error> {
//! let text = "\
//! Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [32, 24], fov: 30}
//! Lights:
//! - {position: [5, 5, 9], color: [1, 1, 1]}
//! Objects:
//! - type: sphere
//!   position: [0, 0, 0]
//!   radius: 1
//!   material: {color: [1, 0.2, 0.1], ka: 0.2, kd: 0.8, ks: 0, n: 1}
//! ";
//! let mut scene = Scene::from_files("ball.yaml", [("ball.yaml".to_owned(), text.into())])?;
//! for finding in scene.check() {
//!     println!("{finding}");
//! }
//! let picture = scene.render(&Options::new().supersampling(2))?;
//! assert_eq!((picture.width(), picture.height()), (32, 24));
//! assert_eq!(picture.encode()?.get(1..4), Some(&b"PNG"[..]));
//! # Ok(())
//! # }
//! ```
//!
//! `Scene::open("scene.yaml")` reads a file and what it names, `picture.save("scene.png")` writes one.
//! Nothing here prints, exits, looks at a clock or reads the environment, and pictures are the same
//! for any number of threads. The cargo feature `cli`, on by default, is for the binary and for `run`,
//! which is all of it: `default-features = false` leaves it out. The library builds for `wasm32-unknown-unknown`, where
//! scenes come from memory, one thread renders, and there is no `Picture::save`.
//!
//! # Within
//!
//! A scene passes through these rooms, each a package of its own below `src`. A room may name only rooms of
//! earlier lines; rooms of one line do not know each other (their manifests say so, and `tests/tidy.rs` reads them).
//!
//! 1. `math`, `color`: vectors, exact and robust arithmetic; colour spaces and tone curves.
//!    `tables`: the shapes and the parameters of the glTF material, which every later room reads.
//! 2. `profile`: how the intensity of a light depends on the direction. `image`: pixel files. `source`: files, spans into them, limits, and
//!    `source::tree`, the spanned tree that YAML and JSON become.
//! 3. `diag`: one diagnostic type, the table of codes, the printers.
//! 4. `ir`: the intermediate representation, `ir::Scene` and its nouns, with a version.
//! 5. `front`: text to IR: the course's YAML, glTF, mesh files. `emit`: IR back to the course's
//!    YAML, and to glTF. `codec`: IR to bytes and back. `passes`: IR to IR, as one run asks:
//!    other settings, another view, other light. `valid`: IR to proof.
//! 6. `plan`: what the picture really needs, each omission with its reason.
//! 7. `render`: a proven scene becomes a world, the world a film. It cannot fail.
//! 8. `study`: accuracy against time: renders, measures, reports.
//! 9. `pipeline`: the doors the stages are joined by.
//! 10. `api`: the door for callers: what this page shows.
//! 11. `cli`: arguments, streams, exit codes (cargo feature `cli`).
//!
//! The promise between the rooms: whoever holds a `valid::ValidScene` need not doubt a number.

#![forbid(unsafe_code)]

mod api;

pub use api::{
    Aov, Effect, EffectState, Error, Finding, Format, Hint, Label, Light, Location, Options,
    Picture, Reading, Scene, Severity, Statistics, Tone,
};
#[cfg(feature = "cli")]
pub use rtc_cli::run;

/// The rooms, for the binary and for what judges them beside this crate: tests, benches, fuzzing.
/// Nothing here is promised to stay as it is.
#[doc(hidden)]
pub mod internals {
    #[cfg(feature = "cli")]
    pub use rtc_cli as cli;
    pub use rtc_codec as codec;
    pub use rtc_color as color;
    pub use rtc_diag as diag;
    pub use rtc_emit as emit;
    pub use rtc_front as front;
    pub use rtc_image as image;
    pub use rtc_ir as ir;
    pub use rtc_math as math;
    pub use rtc_passes as passes;
    pub use rtc_pipeline as pipeline;
    pub use rtc_plan as plan;
    pub use rtc_render as render;
    pub use rtc_source as source;
    pub use rtc_study as study;
    pub use rtc_valid as valid;
}
