//! The quadrilateral.

use super::Lower;
use crate::front::course::decode::{Context, Numbers, SharedValue, Spanned};
use crate::front::course::lower::Lowering;
use crate::front::course::material::Material;
use crate::front::course::record::{FieldOutcome, Rows, keys, record};
use crate::front::course::value::{Point, Text, Vector};
use crate::ir;
use crate::math::Vec3;

/// How people name four corners.
pub(in crate::front::course) const FOUR_CORNERS: Rows = &[
    &["v0", "v1", "v2", "v3"],
    &["v1", "v2", "v3", "v4"],
    &["a", "b", "c", "d"],
    &["p0", "p1", "p2", "p3"],
    &["p1", "p2", "p3", "p4"],
    &["point1", "point2", "point3", "point4"],
    &["corner1", "corner2", "corner3", "corner4"],
    &["position1", "position2", "position3", "position4"],
];

/// How people name the two edges from a corner: upward, and to the side.
pub(in crate::front::course) const EDGES: Rows = &[&["up", "side"], &["edge1", "edge2"]];

record! {
    /// A quadrilateral, seen from both sides: four corners in order around it, or one corner and the two edges from it.
    /// Four corners out of a plane span a curved patch.
    struct Quad, "quad" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// One of four corners, in order around it; a texture has its lower left at the first and its lower right at the second.
        corners: [Spanned<Point>; 4], optional, FOUR_CORNERS;
        /// The corner at the lower left of a texture.
        position: Spanned<Point>, optional, keys!["position" "corner"];
        /// An edge from that corner: `up` is the left one of a texture, `side` the lower one.
        edges: [Spanned<Vector>; 2], optional, EDGES;
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
    }
    forms { [corners] [position edges] }
}

impl Lower for Quad {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let clothes = lowering.clothe(&self.kind, &self.material, context);
        if let (Some(clothes), Some(corners)) = (clothes, corners(self)) {
            let fields = ["vertices/0", "vertices/1", "vertices/2", "vertices/3"];
            let places = [0, 1, 2, 3].map(|k| (fields[k], corners[k].span));
            let vertices = corners.map(|corner| corner.value);
            lowering.put(&clothes, ir::Shape::Quad(ir::Quad { vertices }), &places);
        }
    }
}

/// The corners in order around it.
fn corners(quad: &Quad) -> Option<[Numbers; 4]> {
    let Quad {
        kind: _,
        corners,
        position,
        edges,
        material: _,
    } = quad;
    match (corners, position, edges) {
        (FieldOutcome::Read(corners), ..) => {
            Some(corners.map(|corner| corner.map(|point| point.0)))
        }
        (_, FieldOutcome::Read(position), FieldOutcome::Read([up, side])) => {
            let [corner, v, u] = [position.value.0, up.value.0, side.value.0].map(Vec3::from_array);
            let second = side.map(|_| (corner + u).to_array());
            let third = side.map(|_| (corner + u + v).to_array());
            Some([
                position.map(|point| point.0),
                second,
                third,
                up.map(|_| (corner + v).to_array()),
            ])
        }
        _ => None,
    }
}
