//! Which surfaces of a world the alpha test concerns: it decides in which order the transmittances
//! of a shadow ray are multiplied.

use super::World;
use crate::plan::facts::material;
use crate::render::shape::geometry::Geometry;
use crate::valid::{Alpha, Material, Proof};

/// The alpha-tested surfaces of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::render) enum AlphaTested {
    #[default]
    None,
    /// Only flattened triangles.
    Triangles,
    /// Other surfaces as well.
    Solids,
}

impl AlphaTested {
    /// Those of a world of paths. A material that a plan proves opaque counts as the scene has it,
    /// so that plans keep the order of products.
    pub(super) fn of<S: Geometry>(world: &World<S>, scene: &Proof) -> Self {
        let alpha = |of: &Material| material::standard(of).alpha;
        let tested = scene.materials().iter().map(|m| alpha(m) != Alpha::Opaque);
        let tested: Vec<bool> = tested.collect();
        let surfaces = world.surfaces.iter().enumerate();
        let surfaces = surfaces.filter(|(_, surface)| tested[surface.material]);
        surfaces.fold(Self::None, |all, (index, _)| match all {
            Self::None | Self::Triangles if world.is_flattened(index) => Self::Triangles,
            Self::None | Self::Triangles | Self::Solids => Self::Solids,
        })
    }
}
