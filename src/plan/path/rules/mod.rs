//! The rules for path tracing. Each rule proves that a part of the scene contributes exactly zero
//! and removes it from the [`PlanBuilder`].
//!
//! A rule is a [`PathRule`] constant beside the functions of its proof: [`light`] for lights, light
//! sampling and shadows, [`material`] for material parameters, [`texture`] for maps, [`paths`] for
//! the path length and the surfaces of the world. The rules run in the order of [`ALL`] until none
//! changes anything. To add a rule: a variant of [`Rule`], a constant here, its entry in [`ALL`],
//! and a test in `tests/plan`.

mod light;
mod material;
mod paths;
mod texture;

use super::builder::PlanBuilder;
use crate::rules::Rule;
use rtc_ir::ValuePath;

/// A rule: its name, its statement and its proof.
pub(crate) struct PathRule {
    /// The switch of the rule.
    pub(crate) rule: Rule,
    /// The name in reports.
    pub(crate) name: &'static str,
    /// The statement of the rule and its proof.
    pub(crate) text: &'static str,
    /// The reason why an effect is not needed: lower case, no full stop.
    pub(crate) reason: &'static str,
    /// Removes the parts that contribute zero; returns the scene values that decided, or an empty
    /// list if nothing changed.
    pub(super) apply: fn(&mut PlanBuilder<'_>) -> Vec<ValuePath>,
}

/// All rules for paths.
pub(crate) const ALL: [&PathRule; 16] = [
    &light::ZERO_INTENSITY,
    &light::BLACK_ENVIRONMENT,
    &light::CONSTANT_ENVIRONMENT,
    &material::ZERO,
    &material::UNLIT,
    &texture::UNSEEN,
    &texture::CONSTANT,
    &material::OPAQUE,
    &light::OUT_OF_RANGE,
    &paths::NO_EMISSION,
    &paths::UNLIT_ONLY,
    &paths::LAST_RAY,
    &light::DELTA_ONLY,
    &light::SINGLE_CONVEX,
    &paths::CULL,
    &paths::CULL_SHADOW,
];

/// The item of a rule, if it is one for paths.
pub(crate) fn find(rule: Rule) -> Option<&'static PathRule> {
    ALL.into_iter().find(|item| item.rule == rule)
}
