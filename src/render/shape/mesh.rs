//! A mesh in object space, prepared once for all its instances.

use crate::accel::simd::SimdLevel;
use crate::accel::wide::{BvhBuilders, WideBvh};
use crate::shape::baseline::real::Real;
use crate::shape::geometry::LocalRay;
use crate::shape::plane::PlaneNormal;
use crate::shape::triangle::{self, BaselineTriangle, Triangle};
use rayon::prelude::*;
use rtc_math::{SharedList, Vec3, VertexColumn};
use std::sync::{Arc, OnceLock};

/// The attributes of a mesh's corners except their positions; an empty column has no values. All
/// are shared with the scene.
#[derive(Clone, Debug, Default)]
pub struct Attributes {
    /// The shading normals, of any length, or zero where there is none.
    pub normals: VertexColumn<3>,
    /// The texture coordinates.
    pub uvs: VertexColumn<2>,
    /// The second set of them.
    pub second_uvs: VertexColumn<2>,
    /// The direction of growing u, and ±1 for the side of growing v.
    pub tangents: VertexColumn<4>,
    /// The colour, with alpha.
    pub colors: VertexColumn<4>,
}

/// Up to this many triangles are prepared in advance, since they stay in the caches; more are
/// prepared on demand, since rays wait for memory.
pub(crate) const MAX_PREPARED: usize = 1 << 14;

/// A mesh ready to be hit.
#[derive(Debug)]
pub struct PreparedMesh {
    /// The attributes of the corners.
    pub(crate) attributes: Attributes,
    /// The positions of the corners, shared with the scene.
    positions: VertexColumn<3>,
    /// The corners of each triangle that has an area, by their numbers in the mesh.
    corners: SharedList<[u32; 3]>,
    /// The prepared triangles, if they are few.
    prepared_triangles: Vec<Triangle>,
    /// What its BVH is searched with.
    simd: SimdLevel,
    /// Built when a ray first needs it: the triangles of most meshes are in the BVH of their world.
    hierarchy: OnceLock<Option<WideBvh>>,
}

impl PreparedMesh {
    /// Prepares a mesh of these triangles with corners at these positions.
    #[must_use]
    pub fn new(
        positions: &VertexColumn<3>,
        triangles: &SharedList<[u32; 3]>,
        attributes: Attributes,
        simd: SimdLevel,
    ) -> Self {
        let has_area = |corners: &[u32; 3]| has_area(places(positions, *corners));
        let corners = if triangles.par_iter().all(has_area) {
            triangles.clone()
        } else {
            triangles.iter().copied().filter(has_area).collect()
        };
        let prepared_triangles = if corners.len() <= MAX_PREPARED {
            let prepared = |corners: &[u32; 3]| Triangle::new(places(positions, *corners));
            corners.iter().filter_map(prepared).collect()
        } else {
            Vec::new()
        };
        Self {
            attributes,
            positions: positions.clone(),
            corners,
            prepared_triangles,
            simd,
            hierarchy: OnceLock::new(),
        }
    }

    /// The number of triangles with an area.
    #[inline]
    pub(crate) fn count(&self) -> usize {
        self.corners.len()
    }

    /// The numbers of the corners of one of them.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.corners[triangle as usize]
    }

    /// The positions of the corners of one of them.
    #[inline(always)]
    pub(crate) fn vertices(&self, triangle: u32) -> [Vec3; 3] {
        places(&self.positions, self.corners(triangle))
    }

    /// Where all corners of all of them are.
    pub(crate) fn all_vertices(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let corners = self.corners.iter();
        corners.map(|corners| places(&self.positions, *corners))
    }

    /// Visits the positions of all used vertices, each at least once.
    pub(crate) fn visit_places(&self, mut visit: impl FnMut(Vec3)) {
        // The list of vertices may be longer than the part that this mesh uses.
        if self.positions.len() > 3 * self.count() {
            self.all_vertices().flatten().for_each(visit);
            return;
        }
        let mut is_used = vec![false; self.positions.len()];
        for corner in self.corners.iter().flatten() {
            is_used[*corner as usize] = true;
        }
        for (vertex, _) in is_used.iter().enumerate().filter(|(_, is_used)| **is_used) {
            visit(Vec3::from_array(self.positions.at(vertex)));
        }
    }

    /// One of them.
    #[inline]
    pub(crate) fn triangle(&self, triangle: u32) -> Triangle {
        match self.prepared_triangles.get(triangle as usize) {
            Some(triangle) => *triangle,
            None => Triangle::with_area(self.vertices(triangle)),
        }
    }

    /// The root above 0 of one of them, of a ray in its coordinates.
    #[inline(always)]
    pub(crate) fn root(&self, ray: &LocalRay, triangle: u32) -> Option<f64> {
        match self.prepared_triangles.get(triangle as usize) {
            Some(triangle) => triangle.intersect(&ray.ray, &ray.watertight),
            None => triangle::root(&self.vertices(triangle), &ray.ray, &ray.watertight, false),
        }
    }

    /// Whether a cheap test shows that [`Self::root`] finds none below `t_max`.
    #[inline(always)]
    pub(crate) fn is_beyond(&self, ray: &LocalRay, triangle: u32, t_max: f64) -> bool {
        let triangle = self.prepared_triangles.get(triangle as usize);
        triangle.is_some_and(|triangle| triangle.is_beyond(&ray.ray, t_max))
    }

    /// The BVH of the triangles, if there are any.
    pub(crate) fn hierarchy(&self) -> Option<&WideBvh> {
        let vertices = |item: u32| self.vertices(item);
        let build = || {
            let mut hierarchy =
                WideBvh::build(BvhBuilders::One, self.simd, self.count(), 0.0, vertices)?;
            if !self.prepared_triangles.is_empty() {
                hierarchy.forget_corners();
            }
            Some(hierarchy)
        };
        self.hierarchy.get_or_init(build).as_ref()
    }
}

/// Whether three corners are not collinear, as [`PlaneNormal::of`] decides; by uncompensated
/// arithmetic where that is certain.
fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    /// A sine this large is not an error of rounding.
    const MIN_AREA: f64 = 1e-6;
    /// Above this no product is below the normal numbers.
    const NORMAL: f64 = 1e-290;
    let (first, second) = (b - a, c - a);
    let size = first.abs().max_element() * second.abs().max_element();
    let area = first.cross(second).abs().max_element();
    size > NORMAL && area > MIN_AREA * size || PlaneNormal::of([a, b, c]).is_some()
}

/// Where three corners are.
#[inline(always)]
fn places(positions: &VertexColumn<3>, [a, b, c]: [u32; 3]) -> [Vec3; 3] {
    // Written out: `map` of an array is a call here.
    let place = |corner: u32| Vec3::from_array(positions.at(corner as usize));
    [place(a), place(b), place(c)]
}

/// A mesh ready to be hit by baseline formulas, in object coordinates.
#[derive(Debug)]
pub struct BaselineMesh<R> {
    /// The robust mesh: the same triangles in the same order, their BVH, and their attributes.
    pub(crate) robust: Arc<PreparedMesh>,
    pub(in crate::shape) triangles: Vec<BaselineTriangle<R>>,
}

impl<R: Real> BaselineMesh<R> {
    pub(crate) fn new(robust: PreparedMesh) -> Self {
        let triangles = robust
            .all_vertices()
            .map(|vertices| BaselineTriangle::new(&vertices))
            .collect();
        Self {
            robust: Arc::new(robust),
            triangles,
        }
    }
}
