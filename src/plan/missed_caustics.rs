//! Caustics that manifold sampling would find, and that camera paths find rarely or never: those of
//! a light that is small as seen from a smooth mirror or clear glass.

use crate::facts;
use crate::path::CausticMaterials;
use crate::surface_bounds::{SurfaceBounds, surface_bounds};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{Bounds, IdTable, Vec3};
use rtc_valid::{Material, MaterialId, Mode, Standard, ValidScene};

/// A light is small if its radius is at most this fraction of its distance from the caster;
/// manifold sampling leaves larger ones to BSDF sampling.
const MOST_EXTENT: f64 = 0.25;

/// The maximum number of casters that lights are compared with.
const MOST_CASTERS: usize = 16;

/// A small light, and a smooth surface that focuses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FocusedLight {
    /// The light: a punctual one, or an emissive surface.
    pub light: ValuePath,
    /// The mirror or the glass, as the IR index of its surface.
    pub caster: usize,
}

/// The first light of a path-traced scene whose caustics manifold sampling finds, whether or not it
/// is on; `None` if there is none. A surface that could receive the caustic has to exist: neither
/// caster nor black.
#[must_use]
pub fn focused_light(scene: &ValidScene) -> Option<FocusedLight> {
    if !matches!(scene.settings().mode, Mode::Path(_)) || scene.settings().max_depth < 2 {
        return None;
    }
    let materials = scene.materials().iter();
    let materials: IdTable<Material, Standard> = materials.map(facts::material::standard).collect();
    let known = CausticMaterials::of(&materials);
    // Most scenes end here: they have no caster, or nothing that receives its light.
    let surfaces = scene.surfaces();
    let casters = surfaces.iter().enumerate();
    let casters: Vec<_> = casters
        .filter(|(_, surface)| known.casters[surface.material])
        .take(MOST_CASTERS)
        .collect();
    let (_, first) = casters.first()?;
    let receives = |id: MaterialId| !known.casters[id] && is_receiver(&materials[id]);
    if !surfaces.iter().any(|surface| receives(surface.material)) {
        return None;
    }
    // A punctual light has no size at all.
    let punctual = facts::light::punctual(scene.lights());
    if let Some(light) = punctual.ids().next() {
        return Some(FocusedLight {
            light: ValuePath::new(EntityKind::Light, light.index(), EntityField::Whole),
            caster: first.index,
        });
    }
    // Compare each emissive surface with each caster.
    let extents = surface_bounds(scene);
    let emitters = surfaces.iter().enumerate();
    let mut emitters = emitters.filter(|(_, surface)| {
        known.emitters[surface.material] && !known.casters[surface.material]
    });
    let is_small =
        |index: usize| (casters.iter()).all(|(at, _)| is_small(&extents[index], &extents[*at]));
    emitters
        .find(|(index, _)| is_small(*index))
        .map(|(_, surface)| FocusedLight {
            light: ValuePath::new(EntityKind::Surface, surface.index, EntityField::Whole),
            caster: first.index,
        })
}

/// Whether an emissive surface is small as seen from a caster.
fn is_small(emitter: &SurfaceBounds, caster: &SurfaceBounds) -> bool {
    let (Some(emitter), Some(caster)) = (emitter.aabb(), caster.aabb()) else {
        return emitter.aabb().is_some();
    };
    let size = |bounds: &Bounds| (bounds.max - bounds.min).max_element();
    0.5 * size(emitter) <= MOST_EXTENT * caster.center().distance(emitter.center())
}

/// Whether light that a surface receives may be seen.
fn is_receiver(m: &Standard) -> bool {
    let [r, g, b, _] = m.base_color.map(rtc_math::UnitInterval::get);
    !m.unlit && (Vec3::new(r, g, b) != Vec3::ZERO || m.specular.get() > 0.0)
}
