//! The proof as an integrator sees it: functions from proven nouns to proven nouns.
//!
//! Each integrator knows one model of materials and one of lights. It sees other models as the
//! nearest ones of its own.

pub mod light;
pub mod material;
