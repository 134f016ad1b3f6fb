//! The quadrilateral.

use super::solid::UNIT_SQUARE;
use super::triangle::VERTICES;
use super::{LowerObject, SurfaceProperties};
use crate::course::decode::{DecodeContext, SharedValue, Spanned, SpannedVector};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::record::{FieldResult, Spellings, record};
use crate::course::synonym::CORNER;
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_math::{Vec3, unit};

/// The spellings of four corners.
pub(crate) const FOUR_CORNERS: Spellings = &[
    &["v0", "v1", "v2", "v3"],
    &["v1", "v2", "v3", "v4"],
    &["a", "b", "c", "d"],
    &["A", "B", "C", "D"],
    &["vertex0", "vertex1", "vertex2", "vertex3"],
    &["vertex1", "vertex2", "vertex3", "vertex4"],
    &["p0", "p1", "p2", "p3"],
    &["p1", "p2", "p3", "p4"],
    &["point1", "point2", "point3", "point4"],
    &["corner1", "corner2", "corner3", "corner4"],
    &["position1", "position2", "position3", "position4"],
];

/// The spellings of the two edges from a corner: upward, and to the side.
pub(crate) const EDGES: Spellings = &[&["up", "side"], &["edge1", "edge2"]];

record! {
    /// A two-sided quadrilateral: four corners in order around it, or one corner and its two edges.
    /// Crossing edges are reported, and `--lenient` repairs them.
    struct Quad, "quad" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// One of four corners, in order around it. The first is the lower left of a texture, the
        /// second the lower right.
        corners: [Spanned<Point>; 4], optional, FOUR_CORNERS, json "vertex0", json "A", json "p0";
        /// The corner at the lower left of a texture.
        position: Spanned<Point>, optional, &CORNER;
        /// An edge from that corner: `up` is the left edge of a texture, `side` the lower one.
        edges: [Spanned<Vector>; 2], optional, EDGES;
        /// Whether four corners that are not coplanar span a curved patch, or two triangles that
        /// share the diagonal from the first to the third. Programs do either.
        curved: Spanned<bool>, optional, &[&["curved"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [corners] [position edges] }
}

impl LowerObject for Quad {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let props = lowering.surface_props(
            &self.kind,
            &self.material,
            (&self.shadow, &self.velocity),
            context,
        );
        if let (Some(props), Some(mut corners)) = (props, corners(self)) {
            if let Some(swap) =
                corners_to_swap(&corners.map(|corner| Vec3::from_array(corner.value)))
            {
                report_crossed(&mut corners, swap, context);
            }
            let vertices = corners.map(|corner| corner.value);
            let quad = ir::Quad { vertices };
            if quad.is_bent() && !is_curved(self, &corners, context) {
                lowering.add_two_triangles(&props, &corners);
                return;
            }
            let fields = ["vertices/0", "vertices/1", "vertices/2", "vertices/3"];
            let value_spans = [0, 1, 2, 3].map(|k| (fields[k], corners[k].span));
            lowering.add_surface(&props, ir::Shape::Quad(quad), &value_spans);
        }
    }
}

impl Lowering {
    /// Adds two triangles instead of a quad, which share the diagonal from its first corner to its
    /// third.
    fn add_two_triangles(&mut self, props: &SurfaceProperties, corners: &[SpannedVector; 4]) {
        for at in [[0, 1, 2], [0, 2, 3]] {
            let triangle = ir::Triangle {
                vertices: at.map(|k| corners[k].value),
                uvs: Some(at.map(|k| UNIT_SQUARE[k])),
            };
            let value_spans = [0, 1, 2].map(|k| (VERTICES[k], corners[at[k]].span));
            self.add_surface(props, ir::Shape::Triangle(triangle), &value_spans);
        }
    }
}

/// Whether four corners that are not coplanar span a curved patch. Reports it if the file does not
/// say.
fn is_curved(quad: &Quad, corners: &[SpannedVector; 4], context: &mut DecodeContext<'_>) -> bool {
    if let FieldResult::Read(curved) = quad.curved {
        return curved.value;
    }
    if let Some(span) = corners[3].span {
        let message =
            || "the corners of the quad are not coplanar: it becomes two triangles".to_owned();
        context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
            d.at(span, "a curved patch in some programs")
                .hint("`curved: true` makes a patch, `curved: false` two triangles")
        });
    }
    false
}

/// The corners in order around the quad.
fn corners(quad: &Quad) -> Option<[SpannedVector; 4]> {
    let Quad {
        kind: _,
        corners,
        position,
        edges,
        curved: _,
        material: _,
        shadow: _,
        velocity: _,
    } = quad;
    match (corners, position, edges) {
        (FieldResult::Read(corners), ..) => Some(corners.map(|corner| corner.map(|point| point.0))),
        (_, FieldResult::Read(position), FieldResult::Read([up, side])) => {
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

/// The indices of the two corners to swap so that the edges of a flat quad do not cross; `None` if
/// they do not cross or the quad is not flat.
///
/// If two opposite edges cross, the quad turns left at both ends of one of the other edges, and
/// right at both ends of the last one.
fn corners_to_swap(corners: &[Vec3; 4]) -> Option<[usize; 2]> {
    /// The smallest sine between two edges that counts as a turn, and the largest deviation of a
    /// flat quad.
    const LEAST: f64 = 1e-6;
    let edge = |from: usize, to: usize| unit(corners[to % 4] - corners[from % 4]);
    let mut crosses = [Vec3::ZERO; 4];
    for (at, cross) in crosses.iter_mut().enumerate() {
        *cross = edge(at + 3, at)?.cross(edge(at, at + 1)?);
    }
    let normal = unit(crosses[0])?;
    let is_flat = edge(2, 3)?.dot(normal).abs() < LEAST && edge(1, 2)?.dot(normal).abs() < LEAST;
    let turns_left = crosses.map(|cross| cross.dot(normal) > 0.0);
    let is_bent = crosses.iter().all(|cross| cross.length() > LEAST);
    match turns_left {
        [true, true, false, false] if is_flat && is_bent => Some([2, 3]),
        [true, false, false, true] if is_flat && is_bent => Some([1, 2]),
        _ => None,
    }
}

/// Reports crossing edges; with `--lenient` swaps the corners.
fn report_crossed(
    corners: &mut [SpannedVector; 4],
    [a, b]: [usize; 2],
    context: &mut DecodeContext<'_>,
) {
    const WHICH: [&str; 4] = ["first", "second", "third", "fourth"];
    let (first, second) = (corners[a].span, corners[b].span);
    let lenient = context.options.lenient;
    if lenient {
        corners.swap(a, b);
    }
    let Some(span) = first else { return };
    let message = || "the edges of the quad cross".to_owned();
    context.report(&codes::CROSSED_QUAD, span, message, |d| {
        let d = d.at(span, format!("the {} corner", WHICH[a]));
        let d = d.also(second, format!("the {} corner", WHICH[b]));
        let order = "list the corners in their order around the quad";
        match lenient {
            true => d.hint(format!("these two were exchanged, because {order}")),
            false => d.hint(format!(
                "exchange these two, because {order}; `--lenient` does so"
            )),
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners to swap in a large, rotated square with this order of corners.
    fn found(order: [usize; 4]) -> Option<[usize; 2]> {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        corners_to_swap(&order.map(|k| {
            let [x, y] = square[k];
            Vec3::new(1e4 + 3.0 * x, 4.0 * y - x, 7.0 + x + 3.0 * y)
        }))
    }

    #[test]
    fn a_square_in_z_order_crosses_and_one_around_it_does_not() {
        assert_eq!(found([0, 1, 3, 2]), Some([2, 3]));
        assert_eq!(found([0, 2, 1, 3]), Some([1, 2]));
        for order in [[0, 1, 2, 3], [2, 1, 0, 3]] {
            assert_eq!(found(order), None, "{order:?}");
        }
    }

    #[test]
    fn darts_slits_and_curved_patches_do_not_cross() {
        let quad = |corners: [[f64; 3]; 4]| corners_to_swap(&corners.map(Vec3::from_array));
        let dart = [
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 4.0, 0.0],
        ];
        let slit = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
        ];
        let saddle = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 1.0],
            [1.0, 1.0, 0.0],
        ];
        let point = [
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 4.0, 0.0],
        ];
        for corners in [dart, slit, saddle, point] {
            assert_eq!(quad(corners), None, "{corners:?}");
        }
    }
}
