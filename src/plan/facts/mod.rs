//! What an integrator sees of what is proven: pure views from proven nouns to proven nouns.
//!
//! Each integrator knows one model of materials and one of lights; what a scene has of another
//! model it sees as the nearest thing of its own.

pub mod light;
pub mod material;
