//! Numbers and vectors: arithmetic with the same bits on every machine.
//!
//! # Overview
//!
//! - Vectors: [`Vec3`] (glam, f64), [`Bounds`], [`OrthonormalBasis`], [`unit()`] and [`length()`]
//!   for vectors of any size, [`camera_basis`] and [`view_basis`], rotations ([`rotated_about`],
//!   [`axis_and_angle`]).
//! - [`Number`], over which a formula is written once, and its [`Vector`]s: f32, f64, four lanes of
//!   f64 ([`Double`] is one or the other), double-double, enclosures.
//! - Exact arithmetic: error-free transformations ([`two_sum`], [`two_product`]), compensated sums
//!   ([`dot`], [`cross`], [`difference_of_products`]), and [`DoubleDouble`] with 106 bits.
//! - Elementary functions from `libm`: [`sin`], [`pow`], [`ln`] and others. std's differ between
//!   platforms and are forbidden by a lint.
//! - Ranges as types: [`Positive`], [`NonNegative`], [`UnitInterval`], [`Weight`]. A value of such
//!   a
//!   type needs no further check.
//! - [`PixelFilter`]: the reconstruction filters of pixels.
//! - [`ComplexIndex`]: the Fresnel equations of conductors.
//! - [`Medium`]: a homogeneous participating medium.
//! - Mesh data: [`VertexColumn`], a shared list of vectors in the precision of its source.
//! - Hashes and angles for sampling: [`mix`], [`cos_sin_revolutions`], [`golden_revolutions`].
//! - Sets in postfix notation ([`SetStep`], [`evaluate_set`]), which CSG solids use; procedural
//!   textures ([`SolidTexture`]).
//! - [`shortest`] prints a number with the fewest digits that read back to the same bits.
//!
//! # Conventions
//!
//! Geometry is f64. `u` in comments is the unit round-off [`U`], 2⁻⁵³. A bound such as "3 u" is
//! relative to the result, unless stated otherwise.
//!
//! # Guarantees
//!
//! - Results depend on the arguments only: no platform function, no fused multiply-add unless it is
//!   exact everywhere, no random state.
//! - Functions accept any f64. Where a result may be undefined, the type says so (`Option`,
//!   [`Weight`]).

mod arithmetic;
mod basis;
mod bounds;
mod column;
mod complex_index;
mod count;
mod direction;
mod double;
mod exact;
mod facets;
mod flat;
mod func;
mod hash;
mod id;
mod medium;
mod number;
mod onb;
mod pixel_filter;
mod rotation;
mod set;
mod solid_texture;
mod stored_tree;
mod turns;
mod vector;
mod weight;

pub use arithmetic::{Double, Number, fuses};
pub use basis::{CameraBasisError, camera_basis, fallback_up, view_basis};
pub use bounds::Bounds;
pub use column::{SharedList, VertexColumn};
pub use complex_index::ComplexIndex;
pub use count::to_u32;
pub use direction::{length, unit, unit_scale};
pub use double::DoubleDouble;
pub use exact::{
    cross, cross_by, difference_of_products, dot, dot_by, two_difference, two_product, two_sum,
};
pub use facets::{Microfacets, Plastic};
pub use flat::is_flat;
pub use func::{acos, atan2, cos, erf, exp, ldexp, ln, pow, sin, sin_cos};
pub use glam::DVec3 as Vec3;
pub use glam::Vec4 as Lanes;
pub use hash::{GAMMA, fraction, mix};
pub use id::{Id, IdTable};
pub use medium::Medium;
pub use number::{NonNegative, Positive, UnitInterval, shortest};
pub use onb::OrthonormalBasis;
pub use pixel_filter::PixelFilter;
pub use rotation::{axis_and_angle, rotated_about, rotated_to_z};
pub use set::{MAX_SET_OPERANDS, SetStep, evaluate_set, is_set_expression};
pub use solid_texture::{GradientNoise, SolidTexture, TextureMapping, TexturePattern};
pub use stored_tree::StoredTree;
pub use turns::{cos_sin_revolutions, golden_revolutions};
pub use vector::Vector;
pub use weight::Weight;

/// The unit round-off of f64, u = 2⁻⁵³.
pub const U: f64 = f64::EPSILON / 2.0;
