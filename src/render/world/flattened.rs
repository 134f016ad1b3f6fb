//! Flattened instances: meshes whose triangles are in one world-space hierarchy.

use super::Surface;
use crate::render::accel::bvh4::Bvh4;
use crate::render::shape::geometry::Geometry;
use crate::valid::{self, Proof};

/// The triangles of all flattened instances.
pub(super) struct Flattened {
    /// The surface and the primitive id of each triangle.
    pub(super) prims: Vec<[u32; 2]>,
    pub(super) hierarchy: Bvh4,
}

/// A mesh with several instances is flattened if its instances have at most this many triangles
/// together.
const MAX_TRIANGLES: usize = 1 << 18;

impl Flattened {
    /// Flattens the surfaces with these indices.
    pub(super) fn new<S: Geometry>(surfaces: &[Surface<S>], indices: &[u32]) -> Option<Self> {
        let shape = |surface: u32| &surfaces[surface as usize].shape;
        let prims_of = |surface: u32| {
            (0..)
                .take(shape(surface).triangles())
                .map(move |prim_id| [surface, prim_id])
        };
        let prims = indices
            .iter()
            .copied()
            .flat_map(prims_of)
            .collect::<Vec<_>>();
        let error_bound = indices
            .iter()
            .map(|surface| shape(*surface).error_bound())
            .fold(0.0, f64::max);
        let corners = |item: u32| {
            let [surface, prim_id] = prims[item as usize];
            shape(surface).corners(prim_id).unwrap_or_default()
        };
        let hierarchy = Bvh4::build(prims.len(), error_bound, corners)?;
        Some(Self { prims, hierarchy })
    }
}

/// For each surface of a scene, whether it is an instance to be flattened.
pub(super) fn flattened_surfaces(scene: &Proof) -> Vec<bool> {
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
    let flattens = |mesh: usize| {
        uses[mesh] == 1 || uses[mesh] * scene.meshes()[mesh].triangles.len() <= MAX_TRIANGLES
    };
    scene
        .surfaces()
        .iter()
        .map(|surface| mesh(surface).is_some_and(flattens))
        .collect()
}
