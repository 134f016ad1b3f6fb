//! `rtc`, a compiler for 3-D scenes.
//!
//! A scene passes through these rooms, each of which names only rooms above it in this list:
//!
//! 1. [`math`], [`color`], [`image`]: numbers, rays, bases, robust arithmetic; colour; pixel files.
//! 2. [`source`]: files, their bytes, and spans into them.
//! 3. [`diag`]: one diagnostic type, the table of codes, the printers.
//! 4. [`ir`]: the intermediate representation, [`ir::Scene`], with a version.
//! 5. [`front`] lowers what people write to the IR, and [`emit`] writes it back; [`codec`] turns the
//!    IR into bytes and back;
//!    [`passes`] change a scene as one run asks; [`valid`] proves a scene sound.
//! 6. [`plan`]: what the picture really needs, each omission with its reason.
//! 7. [`render`]: a proven scene becomes a world, the world a film. It cannot fail.
//! 8. [`study`]: accuracy against time: renders, measures, reports.
//! 9. [`pipeline`]: the doors the stages are joined by.
//! 10. [`cli`]: arguments, streams, exit codes.
//!
//! The promise between the rooms: whoever holds a [`valid::Proof`] need not doubt a number.

#![forbid(unsafe_code)]

pub mod cli;
pub mod codec;
pub mod color;
pub mod diag;
pub mod emit;
pub mod front;
pub mod image;
pub mod ir;
pub mod math;
pub mod passes;
pub mod pipeline;
pub mod plan;
pub mod render;
pub mod source;
pub mod study;
pub mod valid;
