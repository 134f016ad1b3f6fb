//! The triangle.

use super::decode::{SharedValue, Spanned};
use super::lower::Lowering;
use super::material::Material;
use super::record::{FieldOutcome, Rows, keys, record};
use super::value::{Point, Text, Uv};
use crate::ir::{self, Field};

/// How people name three corners.
pub(super) const CORNERS: Rows = &[
    &["v0", "v1", "v2"],
    &["v1", "v2", "v3"],
    &["a", "b", "c"],
    &["p0", "p1", "p2"],
    &["p1", "p2", "p3"],
    &["point1", "point2", "point3"],
    &["corner1", "corner2", "corner3"],
    &["position1", "position2", "position3"],
];

record! {
    /// A triangle, seen from both sides.
    struct Triangle, "triangle" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// A corner.
        corners: [Spanned<Point>; 3], required, CORNERS;
        /// The place of a corner in the texture: (0, 0) is its lower left, (1, 1) its upper right.
        uvs: [Spanned<Uv>; 3], optional, &[&["uv0", "uv1", "uv2"], &["uv1", "uv2", "uv3"]];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
    }
}

/// The places of the corners, from where they were written.
pub(super) const VERTICES: [Field; 3] = [
    Field::TriangleVertex0,
    Field::TriangleVertex1,
    Field::TriangleVertex2,
];

impl Lowering {
    /// Lowers a triangle.
    pub(super) fn triangle(&mut self, triangle: &Triangle) {
        let Triangle {
            kind,
            corners,
            uvs,
            material,
        } = triangle;
        let uvs = if let FieldOutcome::Read(uvs) = uvs {
            Some(uvs.map(|uv| uv.value.0))
        } else {
            None
        };
        let shape = ir::Shape::Triangle(ir::Triangle {
            vertices: corners.map(|corner| corner.value.0),
            uvs,
        });
        let spans = corners.map(|corner| corner.span);
        let places = [0, 1, 2].map(|k| (VERTICES[k], spans[k]));
        if let Some(clothes) = self.clothe(kind, material) {
            self.put(&clothes, shape, &places);
        }
    }
}
