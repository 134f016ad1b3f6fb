//! The lights of the Whitted integrator that certainly add no direct terms.
//!
//! Only the proof in this module makes a [`Dark`], without which no light is dropped.

use super::rules::Rule;
use super::visibility::VisibleSurfaces;
use super::{LightPlan, SceneFacts};
use rtc_math::Vec3;
use rtc_valid::{Ambient, CourseLight, Mode};

/// The proof that a light adds no direct term to any visible surface.
pub(super) struct Dark {
    rule: Rule,
    /// Whether its ambient term must be left.
    has_ambient: bool,
}

impl Dark {
    /// The proof for a light, if a rule that may be applied has one.
    pub(super) fn of(
        light: &CourseLight,
        facts: &SceneFacts<'_>,
        visibility: &VisibleSurfaces,
    ) -> Option<Self> {
        let settings = facts.scene.settings();
        let surfaces =
            || (0..facts.surface_bounds.len()).filter(|surface| visibility.visible[*surface]);
        let is_unlit = |surface: usize| !facts.summaries[surface].is_illuminated();
        let adds_none =
            |surface: usize| facts.adds_no_direct(surface, visibility.sides[surface], light);
        let rule = match settings.mode {
            Mode::Gooch(_) | Mode::Path(_) => None,
            Mode::Normal | Mode::Depth => facts.allowed(Rule::Mode),
            Mode::Phong if light.color == Vec3::ZERO && facts.rules.contains(Rule::LightBlack) => {
                Some(Rule::LightBlack)
            }
            Mode::Phong if surfaces().all(is_unlit) => facts.allowed(Rule::LightUnreached),
            Mode::Phong if surfaces().all(adds_none) => facts.allowed(Rule::LightBehind),
            Mode::Phong => None,
        }?;
        // The ambient term is 0 with the colour, and a buffer has none.
        let is_zero = matches!(rule, Rule::LightBlack | Rule::Mode);
        let ambient = || {
            settings.ambient == Ambient::PerLight
                && surfaces().any(|surface| facts.summaries[surface].ambient)
        };
        let has_ambient = !is_zero && (ambient() || !facts.rules.contains(Rule::LightUnreached));
        Some(Self { rule, has_ambient })
    }
}

impl LightPlan {
    /// The plan of a light that may shine on all of so many surfaces.
    pub(super) fn full(surfaces: usize) -> Self {
        Self {
            is_used: true,
            direct: true,
            shadowed: vec![true; surfaces],
            occluders: match surfaces {
                0..=64 => vec![u64::MAX; surfaces],
                _ => Vec::new(),
            },
        }
    }

    /// Drops the direct terms of the light, and its ambient term if that is 0 as well; returns the
    /// rule.
    pub(super) fn drop_light(&mut self, dark: Dark) -> Rule {
        (self.is_used, self.direct) = (dark.has_ambient, false);
        dark.rule
    }
}
