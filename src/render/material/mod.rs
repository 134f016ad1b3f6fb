//! Prepared materials, as the integrators evaluate them.
//!
//! `phong` and `standard` are the two models of the IR with their textures resolved: slots refer to
//! images, defaults are filled in, and constant maps are folded into factors. `point` has the
//! parameters of the standard material at a hit, from which `bsdf` builds its lobes.

pub(crate) mod phong;
pub(crate) mod point;
pub(crate) mod standard;
