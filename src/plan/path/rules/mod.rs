//! The rules for path tracing. Each rule proves that a part of the scene contributes exactly zero
//! and removes it from the [`PathPlanBuilder`].
//!
//! A rule is a [`PathRule`] constant beside the functions of its proof: [`light`] for lights, light
//! sampling and shadows, [`material`] for material parameters, [`texture`] for maps, [`paths`] for
//! the path length and the surfaces of the world. What drops lights and surfaces is proven in
//! [`super::dark`] and [`crate::unseen`]. The rules run in the order of the table in
//! [`crate::rules`] until none changes anything. To add a rule: a constant here, its row in that
//! table, and a test in `tests/plan`.

pub(crate) mod light;
pub(crate) mod material;
pub(crate) mod paths;
pub(crate) mod texture;

use super::builder::PathPlanBuilder;
use rtc_ir::ValuePath;

/// A rule: its name, its statement and its proof.
pub(crate) struct PathRule {
    /// The name in reports.
    pub(crate) name: &'static str,
    /// The statement of the rule and its proof.
    pub(crate) text: &'static str,
    /// The reason why an effect is not needed: lower case, no full stop.
    pub(crate) reason: &'static str,
    /// Removes the parts that contribute zero; returns the scene values that decided, or an empty
    /// list if nothing changed.
    pub(super) apply: fn(&mut PathPlanBuilder<'_>) -> Vec<ValuePath>,
}
