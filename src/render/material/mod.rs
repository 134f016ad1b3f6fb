//! Prepared materials, as the integrators evaluate them.

pub(in crate::render) mod phong;
pub(in crate::render) mod point;
pub(in crate::render) mod standard;
