//! Meshes whose triangles stand in the world one by one, in one hierarchy.

use super::Surface;
use crate::render::accel::bvh4::Bvh4;
use crate::render::shape::geometry::Geometry;
use crate::valid::{self, Proof};

/// The triangles of meshes that stand in the world one by one.
pub(super) struct Merged {
    /// The surface of each, and the part of it.
    pub(super) parts: Vec<[u32; 2]>,
    pub(super) hierarchy: Bvh4,
}

/// A mesh that stands several times is merged into the world if all its triangles are no more than
/// this.
const MERGED: usize = 1 << 18;

impl Merged {
    /// Those of the surfaces with these indices.
    pub(super) fn new<S: Geometry>(surfaces: &[Surface<S>], indices: &[u32]) -> Option<Self> {
        let shape = |surface: u32| &surfaces[surface as usize].shape;
        let parts_of = |surface: u32| {
            (0..)
                .take(shape(surface).triangles())
                .map(move |part| [surface, part])
        };
        let parts = indices
            .iter()
            .copied()
            .flat_map(parts_of)
            .collect::<Vec<_>>();
        let blur = indices
            .iter()
            .map(|surface| shape(*surface).blur())
            .fold(0.0, f64::max);
        let corners = |item: u32| {
            let [surface, part] = parts[item as usize];
            shape(surface).corners(part).unwrap_or_default()
        };
        let hierarchy = Bvh4::build(parts.len(), blur, corners)?;
        Some(Self { parts, hierarchy })
    }
}

/// For each surface of a scene, whether it is a mesh that stands in the world triangle by triangle.
pub(super) fn merging(scene: &Proof) -> Vec<bool> {
    let mut uses = vec![0_usize; scene.meshes().len()];
    let mesh = |surface: &valid::Surface| {
        if let valid::Shape::Instance(instance) = &surface.shape {
            Some(instance.mesh)
        } else {
            None
        }
    };
    scene
        .surfaces()
        .iter()
        .filter_map(mesh)
        .for_each(|mesh| uses[mesh] += 1);
    let merges = |mesh: usize| {
        uses[mesh] == 1 || uses[mesh] * scene.meshes()[mesh].triangles.len() <= MERGED
    };
    scene
        .surfaces()
        .iter()
        .map(|surface| mesh(surface).is_some_and(merges))
        .collect()
}
