//! `rtc`, a compiler for 3-D scenes.
//!
//! A scene passes through these rooms. A room may name only rooms of earlier lines; rooms of one line
//! do not know each other (`tests/tidy.rs` checks it).
//!
//! 1. [`math`], [`color`]: vectors, exact and robust arithmetic; colour spaces and tone curves.
//!    `standard`: the table of the parameters of the glTF material, which every later room reads.
//! 2. [`profile`]: how the intensity of a light depends on the direction. [`image`]: pixel files. [`source`]: files, spans into them, limits, and
//!    [`source::tree`], the spanned tree that YAML and JSON become.
//! 3. [`diag`]: one diagnostic type, the table of codes, the printers.
//! 4. [`ir`]: the intermediate representation, [`ir::Scene`] and its nouns, with a version.
//! 5. [`front`]: text to IR: the course's YAML, glTF, mesh files. [`emit`]: IR to text that people
//!    read. [`codec`]: IR to bytes and back. [`passes`]: IR to IR, as one run asks: other settings,
//!    another view, other light. [`valid`]: IR to proof.
//! 6. [`plan`]: what the picture really needs, each omission with its reason.
//! 7. [`render`]: a proven scene becomes a world, the world a film. It cannot fail.
//! 8. [`study`]: accuracy against time: renders, measures, reports.
//! 9. [`pipeline`]: the doors the stages are joined by.
//! 10. [`cli`]: arguments, streams, exit codes.
//!
//! The promise between the rooms: whoever holds a [`valid::Proof`] need not doubt a number.

#![forbid(unsafe_code)]

// First, since the rooms below use its table of shapes.
#[macro_use]
pub mod ir;

pub mod cli;
pub mod codec;
pub mod color;
pub mod diag;
pub mod emit;
pub mod front;
pub mod image;
pub mod math;
pub mod passes;
pub mod pipeline;
pub mod plan;
pub mod profile;
pub mod render;
pub mod source;
mod standard;
pub mod study;
pub mod valid;
