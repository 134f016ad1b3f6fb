//! Numbers: vectors, bases, ranges, and arithmetic that gives the same bits on every machine.
//!
//! Everything geometric is f64. `u` in comments is the unit round-off, 2⁻⁵³.

mod basis;
mod bounds;
mod column;
mod count;
mod direction;
mod double;
mod exact;
mod flat;
mod func;
mod hash;
mod number;
mod onb;
mod rotation;
mod set;
mod solid_texture;
mod turns;
mod weight;

pub use basis::{BasisFault, camera_basis, fallback_up, view_basis};
pub use bounds::Bounds;
pub use column::{Column, Shared};
pub use count::to_u32;
pub use direction::{length, unit, unit_scale};
pub use double::DoubleDouble;
pub use exact::{
    SPLITTER, cross, difference_of_products, dot, two_difference, two_product, two_sum,
};
pub use flat::is_flat;
pub use func::{acos, atan2, cos, exp, ldexp, ln, pow, sin, sin_cos};
pub use glam::DVec3 as Vec3;
pub use glam::Vec4 as Lanes;
pub use hash::{GAMMA, fraction, mix};
pub use number::{NonNegative, Positive, UnitInterval, shortest};
pub use onb::Basis;
pub use rotation::{axis_and_angle, rotated_about, rotated_to_z};
pub use set::{MAX_SET_OPERANDS, SetStep, evaluate_set, is_set_expression};
pub use solid_texture::{GradientNoise, SolidTexture, TextureMapping, TexturePattern};
pub use turns::{cos_sin_revolutions, golden_revolutions};
pub use weight::Weight;

/// The unit round-off of f64, u = 2⁻⁵³.
pub const U: f64 = f64::EPSILON / 2.0;
