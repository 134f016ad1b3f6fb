//! Flattened instances: meshes whose triangles are in one world-space hierarchy.

use super::Surface;
use crate::render::accel::bvh4::Bvh4;
use crate::render::ray::Ray;
use crate::render::shape::geometry::{Geometry, LocalRay};
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

/// One ray against flattened triangles. The ray is brought to the coordinates of a surface once for
/// a run of its triangles.
pub(super) struct FlattenedRay<'walk, S> {
    surfaces: &'walk [Surface<S>],
    prims: &'walk [[u32; 2]],
    ray: &'walk Ray,
    /// The surface of the triangle before.
    surface: usize,
    local: LocalRay,
}

impl<'walk, S: Geometry> FlattenedRay<'walk, S> {
    /// Meets no triangle yet.
    #[inline]
    pub(super) fn new(
        ray: &'walk Ray,
        surfaces: &'walk [Surface<S>],
        flattened: &'walk Flattened,
    ) -> Self {
        Self {
            surfaces,
            prims: &flattened.prims,
            ray,
            surface: usize::MAX,
            local: LocalRay::UNKNOWN,
        }
    }

    /// The surface and the primitive of a triangle of the hierarchy, and its root above 0; `None`
    /// for the triangle that the ray starts at.
    #[inline(always)]
    pub(super) fn root(&mut self, item: u32, from: (usize, u32)) -> Option<(f64, (usize, u32))> {
        let key = self.bring_to(item, from)?;
        let shape = &self.surfaces[key.0].shape;
        Some((shape.intersect_prim(&self.local, key.1)?, key))
    }

    /// As [`Self::root`], of a root below `t_max` alone.
    #[inline(always)]
    pub(super) fn root_before(
        &mut self,
        t_max: f64,
        item: u32,
        from: (usize, u32),
    ) -> Option<(f64, (usize, u32))> {
        let key = self.bring_to(item, from)?;
        let shape = &self.surfaces[key.0].shape;
        Some((shape.intersect_prim_before(&self.local, key.1, t_max)?, key))
    }

    /// Brings the ray to the surface of a triangle, unless it starts at that triangle.
    #[inline(always)]
    fn bring_to(&mut self, item: u32, from: (usize, u32)) -> Option<(usize, u32)> {
        let [surface, prim_id] = self.prims[item as usize];
        let key = (surface as usize, prim_id);
        if key != from && key.0 != self.surface {
            let shape = &self.surfaces[key.0].shape;
            (self.surface, self.local) = (key.0, shape.local(self.ray));
        }
        (key != from).then_some(key)
    }
}

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
