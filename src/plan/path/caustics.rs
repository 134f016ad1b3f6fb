//! Caustics: light that smooth metal and glass focus onto other surfaces. Camera paths find it only
//! by BSDF sampling, or not at all.

use super::{PathPlan, RemainingEnvironment, RemainingLight};
use rtc_math::{IdTable, UnitInterval, Vec3};
use rtc_valid::{Alpha, Material, Standard};

/// How path tracing finds the caustics of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Caustics {
    /// A scattered path hits a light after a smooth surface. This is rare, so caustics are noisy.
    ByChance,
    /// Those of small lights through smooth surfaces are estimated, the others found by chance.
    Estimated,
    /// Some caustics are missing: no path hits a punctual light via a perfect mirror or lens.
    LeftOut,
}

impl PathPlan {
    /// How caustics are found, or `None` if the scene has none. All materials count, also unused
    /// ones.
    #[must_use]
    pub fn caustics(&self) -> Option<Caustics> {
        let has_punctual = self.has_punctual();
        let shines = |m: &Standard| !m.unlit && m.emissive != Vec3::ZERO;
        let has_environment = self.environment != RemainingEnvironment::Nothing;
        let has_light = has_punctual || has_environment || self.materials.iter().any(shines);
        let has_caustics = has_light && self.materials.iter().any(casts_caustics);
        let is_exact = |m: &Standard| casts_caustics(m) && m.roughness == UnitInterval::ZERO;
        let is_missed = has_punctual && self.materials.iter().any(is_exact);
        has_caustics.then_some(match (&self.caustics, is_missed) {
            (Some(_), _) => Caustics::Estimated,
            (None, true) => Caustics::LeftOut,
            (None, false) => Caustics::ByChance,
        })
    }

    /// Whether a path may sample a punctual light via metal or glass that is smooth, but not
    /// perfectly smooth. The radiance of such a path grows as the lobe narrows and has no useful
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
        self.lights.contains(&RemainingLight::All)
    }
}

impl Caustics {
    /// A description for reports.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::ByChance => "found only by BSDF sampling, as noise; `--clamp` bounds it",
            Self::Estimated => {
                "of small lights through smooth surfaces by manifold sampling; light that it finds \
                 in fewer than 1 of 1024 trials is partly lost; others only by BSDF sampling"
            }
            Self::LeftOut => "caustics of punctual lights are missing: no path finds them",
        }
    }
}

/// Whether a material reflects or refracts most light into nearly one direction.
fn casts_caustics(m: &Standard) -> bool {
    /// At this roughness, light is spread over tens of degrees.
    const MAX_ROUGHNESS: f64 = 0.4;
    m.roughness.get() < MAX_ROUGHNESS && reflects_or_refracts(m)
}

/// The materials that manifold sampling of caustics knows. They are those of the scene, so that
/// rules do not change the use of random numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct CausticMaterials {
    /// For each material, whether it is a mirror or clear glass, smooth and without normal maps.
    pub casters: IdTable<Material, bool>,
    /// For each material, whether it shines with the same radiance everywhere.
    pub emitters: IdTable<Material, bool>,
}

impl CausticMaterials {
    /// Those of a scene.
    pub(crate) fn of(materials: &IdTable<Material, Standard>) -> Self {
        Self {
            casters: materials.iter().map(is_smooth_caster).collect(),
            emitters: materials.iter().map(is_even_emitter).collect(),
        }
    }
}

fn is_smooth_caster(m: &Standard) -> bool {
    let is_smooth = m.roughness == UnitInterval::ZERO
        && m.metallic_roughness_map.is_none()
        && m.specular_glossiness.is_none();
    let is_plain = m.transmission_map.is_none()
        && m.normal_map.is_none()
        && m.bump_map.is_none()
        && m.clearcoat == UnitInterval::ZERO
        && m.anisotropy == UnitInterval::ZERO
        && m.dispersion.get() == 0.0;
    let is_whole = m.alpha == Alpha::Opaque && m.blend_with.is_none();
    is_smooth && is_plain && is_whole && reflects_or_refracts(m)
}

fn is_even_emitter(m: &Standard) -> bool {
    let is_whole = m.alpha == Alpha::Opaque && m.blend_with.is_none();
    !m.unlit && m.emissive_map.is_none() && m.emissive != Vec3::ZERO && is_whole
}

/// Whether a material reflects or refracts most light.
fn reflects_or_refracts(m: &Standard) -> bool {
    !m.unlit && (m.metallic.get() > 0.5 || m.transmission.get() > 0.0)
}
