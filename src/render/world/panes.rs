//! The panes of a world: smooth thin walls, through which light goes straight on.

use rtc_math::{IdTable, UnitInterval};
use rtc_plan::facts::material;
use rtc_valid::{Alpha, Material, Standard, ValidScene};

/// Whether each material may be a pane, and whether one of a surface is.
///
/// They are those of the scene as it is, so that rules do not change which samples are taken.
pub(super) fn panes(scene: &ValidScene) -> (IdTable<Material, bool>, bool) {
    let panes = scene.materials().iter();
    let panes: IdTable<Material, bool> = panes.map(|m| is_pane(&material::standard(m))).collect();
    let mut surfaces = scene.surfaces().iter();
    let has_some = surfaces.any(|surface| panes[surface.material]);
    (panes, has_some)
}

/// Whether a wall of a material may be smooth and clear. A point of it still decides.
fn is_pane(m: &Standard) -> bool {
    /// A facet's width is the square of the roughness.
    const SMOOTH: f64 = 0.004;
    let may_be_smooth = m.roughness.get() < SMOOTH
        || m.metallic_roughness_map.is_some()
        || m.specular_glossiness.is_some();
    may_be_smooth
        && m.transmission > UnitInterval::ZERO
        && m.thickness.get() == 0.0
        && m.alpha == Alpha::Opaque
        && m.blend_with.is_none()
        && !m.unlit
}
