//! The alpha-tested surfaces of a world. They fix the order in which the transmittances along a
//! shadow ray are multiplied.

use super::flattened::flattened_surfaces;
use crate::shape::geometry::Intersect;
use rtc_math::IdTable;
use rtc_plan::facts::material::{self, has_media};
use rtc_valid::{Alpha, Material, ValidScene};

/// The alpha-tested surfaces of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum AlphaTested {
    #[default]
    None,
    /// Only flattened triangles.
    Triangles,
    /// Other surfaces as well.
    Solids,
}

impl AlphaTested {
    /// The alpha-tested surfaces of a path-traced scene. The plan may prove some of them opaque, or
    /// remove them, but that must not change the order of products.
    pub(super) fn of<S: Intersect>(scene: &ValidScene) -> Self {
        let alpha = |of: &Material| material::standard(of).alpha;
        let tested = scene.materials().iter().map(|m| alpha(m) != Alpha::Opaque);
        let tested: IdTable<Material, bool> = tested.collect();
        let surfaces = scene.surfaces().iter().zip(flattened_surfaces(scene));
        let surfaces = surfaces.filter(|(surface, _)| {
            let mut parts = scene.blended(surface.material);
            parts.any(|part| tested[part])
        });
        let mut surfaces = surfaces.peekable();
        // Light through media crosses one surface after another.
        if has_media(scene) && surfaces.peek().is_some() {
            return Self::Solids;
        }
        surfaces.fold(Self::None, |all, (_, is_flattened)| match all {
            Self::None | Self::Triangles if is_flattened && S::FLATTENS => Self::Triangles,
            Self::None | Self::Triangles | Self::Solids => Self::Solids,
        })
    }
}
