//! FlattenedInstances instances: meshes whose triangles are in one world-space BVH.

use super::{Surface, SurfaceId, SurfacePrimitive};
use crate::accel::simd::SimdLevel;
use crate::accel::wide::{BvhBuilders, BvhTopology, Candidate, MOST, VERSION, WideBvh};
use crate::ray::Ray;
use crate::shape::geometry::{Intersect, LocalRay};
use crate::shape::mesh::MAX_PREPARED;
use crate::shape::triangle::{self, WatertightRay};
use rtc_math::{IdTable, StoredTree, to_u32};
use rtc_valid::{self as valid, MAX_MESH_TRIANGLES, ValidScene};

/// The triangles of all flattened instances, numbered surface by surface.
pub(super) struct FlattenedInstances {
    /// The surfaces in their order, and the number of the first triangle of each.
    starts: Vec<(SurfaceId, u32)>,
    pub(super) hierarchy: WideBvh,
}

/// A mesh with several instances is flattened if its instances have at most this many triangles
/// together.
const MAX_TRIANGLES: usize = 1 << 18;

const _: () = assert!(MAX_MESH_TRIANGLES == MOST, "a proven mesh has a hierarchy");

/// One ray against flattened triangles. The ray is brought to the coordinates of a surface once for
/// a run of its triangles.
pub(super) struct FlattenedRay<'traverse, S> {
    surfaces: &'traverse IdTable<Surface, Surface<S>>,
    flattened: &'traverse FlattenedInstances,
    ray: Ray,
    /// The primitive that the ray starts at.
    from: SurfacePrimitive,
    /// The watertight ray, computed on first use.
    watertight: Option<WatertightRay>,
    /// The surface of the triangle before, and the ray in its coordinates.
    local: Option<(SurfaceId, LocalRay)>,
}

impl<'traverse, S: Intersect> FlattenedRay<'traverse, S> {
    /// Meets no triangle yet.
    #[inline]
    pub(super) fn new(
        ray: &Ray,
        from: SurfacePrimitive,
        surfaces: &'traverse IdTable<Surface, Surface<S>>,
        flattened: &'traverse FlattenedInstances,
    ) -> Self {
        Self {
            surfaces,
            flattened,
            ray: *ray,
            from,
            watertight: None,
            local: None,
        }
    }

    /// The root above 0 of a triangle of the BVH, and its surface and primitive; `None` for the
    /// triangle that the ray starts at.
    #[inline(always)]
    pub(super) fn root(&mut self, candidate: &Candidate<'_>) -> Option<(f64, SurfacePrimitive)> {
        let key = self.flattened.key(candidate.item);
        if key == self.from {
            return None;
        }
        let ray = self.ray;
        let t = if let Some(corners) = candidate.corners() {
            let watertight = self
                .watertight
                .get_or_insert_with(|| WatertightRay::new(&ray));
            triangle::root(&corners, &ray, watertight, candidate.is_fused)
        } else {
            let (shape, local) = self.brought_to(key.0);
            shape.intersect_prim(local, key.1)
        };
        Some((t?, key))
    }

    /// As [`Self::root`], of a root below `t_max` alone.
    #[inline(always)]
    pub(super) fn root_before(
        &mut self,
        candidate: &Candidate<'_>,
        t_max: f64,
    ) -> Option<(f64, SurfacePrimitive)> {
        if candidate.corners().is_some() {
            return self.root(candidate).filter(|(t, _)| *t < t_max);
        }
        let key = self.flattened.key(candidate.item);
        if key == self.from {
            return None;
        }
        let (shape, local) = self.brought_to(key.0);
        Some((shape.intersect_prim_before(local, key.1, t_max)?, key))
    }

    /// Whether the ray starts at a triangle of the BVH.
    #[inline]
    pub(super) fn starts_at(&self, item: u32) -> bool {
        self.flattened.key(item) == self.from
    }

    /// The shape of a surface, and the ray in its coordinates.
    #[inline(always)]
    fn brought_to(&mut self, surface: SurfaceId) -> (&'traverse S, &LocalRay) {
        let shape = &self.surfaces[surface].shape;
        if self.local.as_ref().is_some_and(|(of, _)| *of != surface) {
            self.local = None;
        }
        let ray = self.ray;
        let local = || (surface, shape.local(&ray));
        let (_, local) = self.local.get_or_insert_with(local);
        (shape, local)
    }
}

impl FlattenedInstances {
    /// Flattens these surfaces, in the order of the world; one of the stored hierarchies spares
    /// building one, if it is over these surfaces.
    pub(super) fn new<S: Intersect>(
        surfaces: &IdTable<Surface, Surface<S>>,
        ids: &[SurfaceId],
        stored: &[StoredTree],
        simd: SimdLevel,
    ) -> Option<Self> {
        let shape = |surface: SurfaceId| &surfaces[surface].shape;
        let mut count = 0;
        let start = |surface: &SurfaceId| {
            let start = (*surface, to_u32(count));
            count += shape(*surface).triangles();
            start
        };
        let starts: Vec<_> = ids.iter().map(start).collect();
        let error_bound = ids
            .iter()
            .map(|surface| shape(*surface).error_bound())
            .fold(0.0, f64::max);
        let corners = |item: u32| {
            let (surface, prim_id) = key(&starts, item);
            surfaces[surface].shape.corners(prim_id).unwrap_or_default()
        };
        if count == 0 {
            return None;
        }
        let own = owners(&starts, count, surfaces);
        let mut stored = stored.iter().filter(|tree| tree.version == VERSION);
        let hierarchy = stored.find(|tree| *tree.surfaces == own).and_then(|tree| {
            let topology = BvhTopology {
                items: &tree.items,
                links: &tree.links,
            };
            WideBvh::of_topology(topology, simd, count, error_bound, corners)
        });
        let build = || WideBvh::build(BvhBuilders::All, simd, count, error_bound, corners);
        let mut hierarchy = hierarchy.or_else(build)?;
        // World-space corners are those of a mesh only if it is not transformed; few are prepared.
        if count <= MAX_PREPARED || !ids.iter().all(|surface| shape(*surface).is_in_place()) {
            hierarchy.forget_corners();
        }
        Some(Self { starts, hierarchy })
    }

    /// The hierarchy to be stored; `None` for a small one, or if triangles were left out as copies
    /// of others.
    pub(super) fn to_store<S: Intersect>(
        &self,
        surfaces: &IdTable<Surface, Surface<S>>,
    ) -> Option<StoredTree> {
        let triangles = self
            .starts
            .iter()
            .map(|(id, _)| surfaces[*id].shape.triangles());
        let count = triangles.sum();
        let (items, links) = self.hierarchy.topology(count)?;
        Some(StoredTree {
            version: VERSION,
            surfaces: owners(&self.starts, count, surfaces).into(),
            items: items.into(),
            links: links.into(),
        })
    }

    /// The surface and the primitive of a triangle.
    #[inline(always)]
    fn key(&self, item: u32) -> SurfacePrimitive {
        key(&self.starts, item)
    }
}

/// The index in the scene of each flattened surface, and the number of its triangles.
fn owners<S>(
    starts: &[(SurfaceId, u32)],
    count: usize,
    surfaces: &IdTable<Surface, Surface<S>>,
) -> Vec<[u32; 2]> {
    let ends = starts[1..].iter().map(|(_, start)| *start);
    let ends = ends.chain([to_u32(count)]);
    let owner =
        |((id, start), end): (&(SurfaceId, u32), u32)| [to_u32(surfaces[*id].index), end - start];
    starts.iter().zip(ends).map(owner).collect()
}

/// The surface and the primitive of a triangle, given where surfaces start.
#[inline(always)]
fn key(starts: &[(SurfaceId, u32)], item: u32) -> SurfacePrimitive {
    let after = match starts.len() {
        1 => 1,
        _ => starts.partition_point(|(_, start)| *start <= item),
    };
    let (surface, start) = starts[after - 1];
    (surface, item - start)
}

/// For each surface of a scene, whether it is an instance to be flattened: none if some move, as
/// each moment would need a hierarchy of its own.
pub(super) fn flattened_surfaces(scene: &ValidScene) -> Vec<bool> {
    if scene.moves() {
        return vec![false; scene.surfaces().len()];
    }
    let mut uses = IdTable::<valid::Mesh, _>::from(vec![0_usize; scene.meshes().len()]);
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
    let triangles = |mesh: valid::MeshId| scene.meshes()[mesh].triangles.len();
    let mut all = 0;
    let mut flattens = |mesh: valid::MeshId| {
        let is_worth = uses[mesh] == 1 || uses[mesh] * triangles(mesh) <= MAX_TRIANGLES;
        let fits = is_worth && all + triangles(mesh) <= MAX_MESH_TRIANGLES;
        all += usize::from(fits) * triangles(mesh);
        fits
    };
    scene
        .surfaces()
        .iter()
        .map(|surface| mesh(surface).is_some_and(&mut flattens))
        .collect()
}
