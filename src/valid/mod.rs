//! The proof: [`validate`] alone makes a [`ValidScene`], and whoever holds one need not doubt a number.

use crate::diag::Sink;
use crate::ir::{Origins, Scene};

/// What the proof lets pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Lifts the limits on image size and rays.
    pub allow_huge: bool,
}

/// A proven scene.
#[derive(Clone, Debug)]
pub struct ValidScene {
    _private: (),
}

/// Proves the scene, or says in the sink why it can't be.
pub fn validate(_scene: &Scene, _origins: &Origins, _options: &Options, _sink: &mut Sink) -> Option<ValidScene> {
    None
}
