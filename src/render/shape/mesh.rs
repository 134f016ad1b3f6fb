//! A mesh in its own coordinates, prepared once for all its instances.

use crate::math::{Column, Shared, Vec3};
use crate::render::accel::bvh4::Bvh4;
use crate::render::shape::plain::real::Real;
use crate::render::shape::triangle::{PlainTriangle, Triangle};
use std::sync::{Arc, OnceLock};

/// What a mesh says of its corners but for their places; an empty column says nothing. All is
/// shared with the scene.
#[derive(Clone, Debug, Default)]
pub struct Attributes {
    /// The shading normals, of any length, or zero where there is none.
    pub normals: Column<3>,
    /// The texture coordinates.
    pub uvs: Column<2>,
    /// The second set of them.
    pub second_uvs: Column<2>,
    /// The direction of growing u, and ±1 for the side of growing v.
    pub tangents: Column<4>,
    /// The colour, with alpha.
    pub colors: Column<4>,
}

/// A mesh ready to be hit.
#[derive(Debug)]
pub struct PreparedMesh {
    /// What is known of the corners.
    pub(in crate::render) attributes: Attributes,
    triangles: Vec<Triangle>,
    /// The corners of each triangle, by their numbers in the mesh.
    corners: Shared<[u32; 3]>,
    /// Built when a ray first asks for it: most meshes stand once, in the hierarchy of their
    /// world.
    hierarchy: OnceLock<Option<Bvh4>>,
}

impl PreparedMesh {
    /// Prepares a mesh of these triangles between corners at these places.
    #[must_use]
    pub fn new(
        positions: &Column<3>,
        triangles: &Shared<[u32; 3]>,
        attributes: Attributes,
    ) -> Self {
        let position = |corner: u32| Vec3::from_array(positions.at(corner as usize));
        // Written out: `map` of an array is a call here.
        let prepared =
            |[a, b, c]: &[u32; 3]| Triangle::new([position(*a), position(*b), position(*c)]);
        let all = triangles;
        let triangles = all.iter().filter_map(prepared).collect::<Vec<_>>();
        let corners = if triangles.len() == all.len() {
            all.clone()
        } else {
            let has_area = |corners: &[u32; 3]| prepared(corners).is_some();
            all.iter().copied().filter(has_area).collect()
        };
        Self {
            attributes,
            triangles,
            corners,
            hierarchy: OnceLock::new(),
        }
    }

    /// The triangles that have an area.
    #[inline]
    pub(in crate::render) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The numbers of the corners of one of them.
    #[inline]
    pub(in crate::render) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.corners[triangle as usize]
    }

    /// The hierarchy of the triangles, if there are any.
    pub(in crate::render) fn hierarchy(&self) -> Option<&Bvh4> {
        let corners = |item: u32| *self.triangles[item as usize].vertices();
        self.hierarchy
            .get_or_init(|| Bvh4::build(self.triangles.len(), 0.0, corners))
            .as_ref()
    }
}

/// A mesh ready to be hit by plain formulas, in object coordinates.
#[derive(Debug)]
pub struct PlainMesh<R> {
    /// The robust mesh: the same triangles in the same order, their hierarchy, and what is known
    /// of them.
    pub(in crate::render) robust: Arc<PreparedMesh>,
    pub(in crate::render::shape) triangles: Vec<PlainTriangle<R>>,
}

impl<R: Real> PlainMesh<R> {
    pub(in crate::render) fn new(robust: PreparedMesh) -> Self {
        let triangles = robust
            .triangles()
            .iter()
            .map(|triangle| PlainTriangle::new(triangle.vertices()))
            .collect();
        Self {
            robust: Arc::new(robust),
            triangles,
        }
    }
}
