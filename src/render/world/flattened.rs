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
    /// The surface of the triangle before, and the ray in its coordinates.
    local: Option<(usize, LocalRay)>,
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
            local: None,
        }
    }

    /// The surface and the primitive of a triangle of the hierarchy, and its root above 0; `None`
    /// for the triangle that the ray starts at.
    #[inline(always)]
    pub(super) fn root(&mut self, item: u32, from: (usize, u32)) -> Option<(f64, (usize, u32))> {
        let key = self.key(item, from)?;
        let (shape, local) = self.brought_to(key.0);
        Some((shape.intersect_prim(local, key.1)?, key))
    }

    /// As [`Self::root`], of a root below `t_max` alone.
    #[inline(always)]
    pub(super) fn root_before(
        &mut self,
        t_max: f64,
        item: u32,
        from: (usize, u32),
    ) -> Option<(f64, (usize, u32))> {
        let key = self.key(item, from)?;
        let (shape, local) = self.brought_to(key.0);
        Some((shape.intersect_prim_before(local, key.1, t_max)?, key))
    }

    /// The surface and the primitive of a triangle of the hierarchy, unless the ray starts there.
    #[inline(always)]
    fn key(&self, item: u32, from: (usize, u32)) -> Option<(usize, u32)> {
        let [surface, prim_id] = self.prims[item as usize];
        let key = (surface as usize, prim_id);
        (key != from).then_some(key)
    }

    /// The shape of a surface, and the ray in its coordinates.
    #[inline(always)]
    fn brought_to(&mut self, surface: usize) -> (&'walk S, &LocalRay) {
        let shape = &self.surfaces[surface].shape;
        if self.local.as_ref().is_some_and(|(of, _)| *of != surface) {
            self.local = None;
        }
        let ray = self.ray;
        let local = || (surface, shape.local(ray));
        let (_, local) = self.local.get_or_insert_with(local);
        (shape, local)
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
