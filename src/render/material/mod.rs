//! Prepared materials, as the integrators evaluate them.

pub(crate) mod phong;
pub(crate) mod point;
pub(crate) mod standard;
