//! Boxes and the hierarchies over them. Nothing here knows a shape: a hierarchy is asked by a ray
//! and calls back with the numbers of the items that the ray may meet.

pub(crate) mod bounds;
pub(crate) mod bundle;
pub(crate) mod bvh;
pub(crate) mod conservative_ray;
pub(crate) mod lanes;
mod packet;
mod pages;
pub(crate) mod simd;
pub(crate) mod wide;
