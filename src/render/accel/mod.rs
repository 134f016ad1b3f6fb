//! Boxes and the hierarchies over them. Nothing here knows a shape: a hierarchy is asked by a ray
//! and calls back with the numbers of the items that the ray may meet.

pub(in crate::render) mod beam;
pub(in crate::render) mod bounds;
pub(in crate::render) mod bundle;
pub(in crate::render) mod bvh;
pub(in crate::render) mod lanes;
mod packet;
mod pages;
pub(in crate::render) mod simd;
pub(in crate::render) mod wide;
