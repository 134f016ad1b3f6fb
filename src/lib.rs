//! `rtc`, a compiler for 3-D scenes: it reads scenes, reports their errors, and renders them on the
//! CPU, deterministically.
//!
//! A [`Scene`] is opened from files on disk or in memory, checked, which yields [`Diagnostic`]s,
//! and rendered with [`Options`] into a [`Picture`]:
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
//! let scene = Scene::from_files("ball.yaml", [("ball.yaml".to_owned(), text.into())])?;
//! for diagnostic in scene.check() {
//!     println!("{diagnostic}");
//! }
//! let picture = scene.render(&Options::new().supersampling(2))?;
//! assert_eq!((picture.width(), picture.height()), (32, 24));
//! assert_eq!(picture.encode()?.get(1..4), Some(&b"PNG"[..]));
//! # Ok(())
//! # }
//! ```
//!
//! `Scene::open("scene.yaml")` reads a file and the files it refers to, `picture.save("scene.png")`
//! writes one. [`SceneBuilder`] builds a scene in code, and [`Scene::edit`] changes one. The
//! library does not print, exit or read the environment; it reads the clock only for options in
//! seconds. The number of threads does not change a picture. The cargo feature `cli`, on by
//! default, adds the command line (`run`); `default-features = false` leaves it out. The library
//! builds for `wasm32-unknown-unknown`, where scenes come from memory, one thread renders, and
//! there is no `Picture::save`.
//!
//! # Packages
//!
//! A scene passes through these stages, each a package below `src`. A package may use packages of
//! earlier lines only; packages of one line do not know each other (`tests/tidy.rs` checks it).
//!
//! 1. `math`, `color`, `tables`: arithmetic; colour spaces; tables of shapes and parameters.
//! 2. `profile`, `image`, `source`: light distributions; image files; files, spans, spanned trees.
//! 3. `diag`: the diagnostic type, the table of codes, the printers.
//! 4. `ir`: the intermediate representation, `ir::Scene`, with a version.
//! 5. `front`: text to IR. `emit`: IR to other formats. `codec`: IR to bytes and back. `passes`: IR
//!    to IR, as the options of one run require. `valid`: IR to `ValidScene`.
//! 6. `plan`: which effects a picture needs, each omission with its reason.
//! 7. `render`: a valid scene becomes a world, the world a film. It cannot fail.
//! 8. `study`: accuracy against time: renders, measures, reports.
//! 9. `pipeline` joins the stages, 10. `api` is the API of this page, 11. `cli` the command line.
//!
//! Code that receives a `valid::ValidScene` may rely on every number being in range.

#![forbid(unsafe_code)]

mod api;

pub use api::{
    Alpha, Aov, Bump, Camera, Diagnostic, Effect, EffectState, Environment, Error, Export, Filter,
    Format, Hint, Label, Light, Location, Material, MaterialId, MaterialRef, Medium, Mesh, MeshId,
    Object, ObjectId, Options, Phong, Picture, Progress, Reading, Scene, SceneBuilder,
    SceneContents, Severity, Shape, Standard, Statistics, Texture, TextureId, TextureMap, Tone,
    Transform, Vertices, Wrap, explain,
};
#[cfg(not(target_family = "wasm"))]
pub use api::{Cost, CostRow, Effort};
#[cfg(feature = "cli")]
pub use rtc_cli::run;

/// The packages, for the binary and for tests, benchmarks and fuzzing. They are not part of the
/// stable API.
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
