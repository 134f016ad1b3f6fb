//! Acceleration structures.
//!
//! They know no shapes. A query takes a ray and calls a visitor with the index of each item that
//! the ray may hit; the visitor computes the hit itself.
//!
//! - [`wide`]: an 8-wide BVH over triangles in f32, with traversal of one ray.
//! - [`bvh`]: a binary BVH over boxes in f64, for all other surfaces.
//! - [`ray_cone_cache`]: for small scenes, the items that a cone of similar rays may hit.
//! - [`conservative_ray`], [`lanes`]: the f32 ray of a BVH, and its SIMD tests against
//!   eight boxes or four triangles.
//! - [`bounds`]: the slab test in f64, and bounding spheres.
//! - [`simd`]: the SIMD instruction sets, chosen at run time. All give the same bits.
//!
//! All tests are conservative: rounding may add candidates, but never removes one. The scripts in
//! `docs/proofs` prove the error bounds.

pub(crate) mod bounds;
pub(crate) mod bvh;
pub(crate) mod conservative_ray;
pub(crate) mod lanes;
mod pages;
pub(crate) mod ray_cone_cache;
pub(crate) mod simd;
pub(crate) mod wide;
