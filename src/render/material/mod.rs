//! What surfaces are made of, as the integrators ask for it.

pub(in crate::render) mod phong;
pub(in crate::render) mod point;
pub(in crate::render) mod standard;
