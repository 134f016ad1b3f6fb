//! Exports: writes the IR in other formats, one module per format.
//!
//! - [`course`]: YAML of the course, without loss.
//! - [`gltf`]: glTF 2.0. Values that it can't express go to `extras.rtc`, so that rtc reads them
//!   back.
//! - [`mitsuba`]: Mitsuba 3 (XML), for path-traced scenes.
//! - [`pbrt`]: pbrt-v4, for path-traced scenes.
//! - [`pov`]: POV-Ray 3.7, for scenes of the course.
//!
//! Each `emit` takes a validated scene, its source spans, a budget and a sink. It returns the text
//! and its sidecar files in memory ([`ExportedScene`] for the last three formats); it writes nothing
//! to disk. Values that a format can't express exactly are reported as diagnostics at their source
//! spans (`reporter`). `None` means that the scene can't be exported, and the sink has the error.
//!
//! Shared parts: `approximation` (the Phong model as a glTF material), `flat` (planes as squares),
//! `tessellate` (meshes instead of shapes), `ply` (meshes as PLY files), `picture` (textures as
//! image files), `texture_area` (the part of a texture that is seen), `sidecar` (names of sidecar
//! files), `export` (helpers for other renderers), `path_tracer` (what Mitsuba and pbrt have in
//! common).

mod approximation;
pub mod course;
mod export;
mod flat;
pub mod gltf;
pub mod mitsuba;
mod path_tracer;
pub mod pbrt;
mod picture;
mod ply;
pub mod pov;
mod reporter;
mod sidecar;
mod tessellate;
mod texture_area;

pub use export::ExportedScene;
