//! The rules for traced paths. Each rule proves that a part of the scene adds exactly nothing, and
//! removes it from the draft. The rules run in this order until none changes the draft.

mod light;
mod material;
mod paths;
mod texture;

use super::builder::PlanBuilder;
use crate::rules::Rule;
use rtc_ir::ValuePath;

/// A rule: its name, its text and its proof.
pub(crate) struct PathRule {
    /// The switch of the rule.
    pub(crate) rule: Rule,
    /// The name that users know it by.
    pub(crate) name: &'static str,
    /// The text: what the rule says, and why it is right.
    pub(crate) text: &'static str,
    /// Why an effect is not needed then: lower case, no full stop.
    pub(crate) reason: &'static str,
    /// Removes the parts that add nothing; returns the values that decided, none if nothing
    /// changed.
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
