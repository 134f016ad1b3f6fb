//! Caustics: light that smooth metal and glass throw onto other surfaces. Paths from the camera find it
//! by chance, or not at all.

use super::{EnvironmentUse, LightUse, PathPlan};
use rtc_math::{UnitInterval, Vec3};
use rtc_valid::Standard;

/// How traced paths find the caustics of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caustics {
    /// A path that scatters meets a light by way of a smooth surface: seldom, so they are noise.
    ByChance,
    /// Some not at all: no path meets a light without size by way of a perfect mirror or lens.
    LeftOut,
}

impl PathPlan {
    /// How caustics are found; `None` where nothing throws any. Materials count as they are, on a
    /// surface or not.
    #[must_use]
    pub fn caustics(&self) -> Option<Caustics> {
        let has_punctual = self.has_punctual();
        let shines = |m: &Standard| !m.unlit && m.emissive != Vec3::ZERO;
        let has_wide = self.environment != EnvironmentUse::Nothing;
        let has_light = has_punctual || has_wide || self.materials.iter().any(shines);
        let is_thrown = has_light && self.materials.iter().any(casts_caustics);
        let is_exact = |m: &Standard| casts_caustics(m) && m.roughness == UnitInterval::ZERO;
        let is_missed = has_punctual && self.materials.iter().any(is_exact);
        is_thrown.then_some(match is_missed {
            true => Caustics::LeftOut,
            false => Caustics::ByChance,
        })
    }

    /// Whether a path may come upon a light without size by way of metal or glass that is smooth,
    /// but not perfectly so: what it carries then grows as the lobe narrows, and has no useful
    /// bound.
    #[must_use]
    pub fn has_unbounded_caustics(&self) -> bool {
        let is_mapped = |m: &Standard| m.metallic_roughness_map.is_some();
        let is_narrow = |m: &Standard| casts_caustics(m) && m.roughness != UnitInterval::ZERO;
        let may_be_narrow =
            |m: &Standard| is_narrow(m) || (is_mapped(m) && reflects_or_refracts(m));
        self.has_punctual() && self.materials.iter().any(may_be_narrow)
    }

    fn has_punctual(&self) -> bool {
        self.lights.contains(&LightUse::All)
    }
}

impl Caustics {
    /// How they are found, in words.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::ByChance => "found by chance alone, as noise; `--clamp` bounds it",
            Self::LeftOut => "those of lights without size are left out, as no path finds them",
        }
    }
}

/// Whether a material mirrors or refracts most light in nearly one direction.
fn casts_caustics(m: &Standard) -> bool {
    /// So rough, light is spread over tens of degrees.
    const ROUGH: f64 = 0.4;
    m.roughness.get() < ROUGH && reflects_or_refracts(m)
}

/// Whether a material mirrors or refracts most light.
fn reflects_or_refracts(m: &Standard) -> bool {
    !m.unlit && (m.metallic.get() > 0.5 || m.transmission.get() > 0.0)
}
