//! The polyhedra: box, tetrahedron and prism. They are lowered to triangles.

use super::LowerObject;
use super::quad::FOUR_CORNERS;
use super::triangle::{CORNERS, VERTICES};
use crate::course::decode::{Decode, DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{Degrees, Real, json_number};
use crate::course::object::SurfaceProperties;
use crate::course::record::{FieldResult, record};
use crate::course::rotation::{Rotation, RotationKeys};
use crate::course::schema::SchemaDefinitions;
use crate::course::synonym::{POSITION, ROTATION, ROTATION_ANGLE, ROTATION_AXIS, with_canonical};
use crate::course::value::{Angles, AnyScalar, Point, Scale, Vector};
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_math::{Vec3, shortest, unit, unit_scale};
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A box, given by two opposite corners; by its centre and its lengths along x, y and z, with
    /// or without a rotation; or by a corner and its three edges.
    struct Cuboid, "box" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// One of two opposite corners of an axis-aligned box.
        extremes: [Spanned<Point>; 2], optional, &[
            &["min", "max"], &["minimum", "maximum"], &["corner1", "corner2"], &["p1", "p2"],
            &["p0", "p1"],
            &["point1", "point2"], &["v0", "v1"], &["lower", "upper"], &["from", "to"],
        ];
        /// The centre beside `dimension`; a corner beside `up`, `side` and `depth`.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position");
        /// The lengths along x, y and z before the rotation, or one length for all.
        dimension: Spanned<Scale>, optional,
            &[&["dimension"], &["dimensions"], &["size"], &["extent"], &["extents"]];
        /// The rotation about its centre by angles in radians: first about x, then y, then z;
        /// beside `angle` the axis of rotation.
        rotation: Spanned<Rotation<Angles>>, optional, &ROTATION;
        /// The axis of a rotation about its centre by `angle`.
        axis: Spanned<Vector>, optional, &ROTATION_AXIS;
        /// The angle of rotation about the axis, in degrees.
        angle: Spanned<Degrees>, optional, &ROTATION_ANGLE;
        /// An edge from the corner `position`.
        edges: [Spanned<Vector>; 2], optional, &[&["up", "side"]];
        /// The third edge; or only its length, for an edge along `up` × `side`.
        depth: Spanned<ThirdEdge>, optional, &[&["depth"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants {
        [extremes] [position dimension] [position dimension rotation]
        [position dimension rotation angle]
        [position dimension axis angle] [position edges depth]
    }
}

record! {
    /// A tetrahedron.
    struct Tetrahedron, "tetrahedron" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// A corner.
        corners: [Spanned<Point>; 4], required, FOUR_CORNERS;
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

record! {
    /// A triangular prism, given by its base and the vector to its top, or by the corners of both.
    struct Prism, "prism" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// A corner of the base.
        corners: [Spanned<Point>; 3], optional, CORNERS;
        /// From the base to the top.
        up: Spanned<Vector>, optional, &[&["up"], &["direction"], &["axis"]];
        /// A corner of the base, and those of the top in the same order.
        ends: [Spanned<Point>; 6], optional,
            &[&["t1point1", "t1point2", "t1point3", "t2point1", "t2point2", "t2point3"]];
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [corners up] [ends] }
}

/// The indices of the corners of a face, counter-clockwise as seen from outside. The first of four
/// corners is the lower left of its texture.
type FaceCorners = &'static [usize];

/// Bit k of a corner's index selects the end of edge k.
const BOX: &[FaceCorners] = &[
    &[0, 4, 6, 2],
    &[5, 1, 3, 7],
    &[0, 1, 5, 4],
    &[6, 7, 3, 2],
    &[1, 0, 2, 3],
    &[4, 5, 7, 6],
];
const TETRAHEDRON: &[FaceCorners] = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
const PRISM: &[FaceCorners] = &[
    &[0, 2, 1],
    &[3, 4, 5],
    &[0, 1, 4, 3],
    &[1, 2, 5, 4],
    &[2, 0, 3, 5],
];

/// The third edge of a box: a vector or a length.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ThirdEdge {
    Edge([f64; 3]),
    Length(f64),
}

impl ThirdEdge {
    /// The vector of the edge, from the two other edges.
    fn edge(self, up: Vec3, side: Vec3) -> Vec3 {
        // Both are scaled by powers of two, so that no product leaves the range of f64.
        let [up, side] =
            [up, side].map(|edge| unit_scale(edge).map_or(Vec3::ZERO, |(scaled, _)| scaled));
        match self {
            Self::Edge(edge) => Vec3::from_array(edge),
            Self::Length(length) => unit(up.cross(side)).map_or(Vec3::ZERO, |n| n * length),
        }
    }
}

impl Decode for ThirdEdge {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_list(node) {
            Vector::decode(node, context).map(|edge| Self::Edge(edge.0))
        } else {
            Real::decode(node, context).map(|length| Self::Length(length.0))
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        json!({ "anyOf": [Vector::schema(definitions), Real::schema(definitions)] })
    }

    fn json(&self) -> Json {
        match self {
            Self::Edge(edge) => edge.map(json_number).to_vec().into(),
            Self::Length(length) => json_number(*length),
        }
    }
}

impl LowerObject for Cuboid {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let props = lowering.surface_props(
            &self.kind,
            &self.material,
            (&self.shadow, &self.velocity),
            context,
        );
        if let (Some(props), Some((corners, span))) = (props, box_corners(self, context)) {
            report_assumed_depth(&self.depth, corners[4] - corners[0], context);
            lowering.add_box(&props, &corners, span, context);
        }
    }
}

impl LowerObject for Tetrahedron {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Tetrahedron {
            kind,
            corners,
            material,
            shadow,
            velocity,
        } = self;
        let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context)
        else {
            return;
        };
        let span = corners[0].span;
        let corners = corners.map(|corner| Vec3::from_array(corner.value.0));
        let edges = [
            corners[1] - corners[0],
            corners[2] - corners[0],
            corners[3] - corners[0],
        ];
        lowering.add_polyhedron(
            &props,
            &Polyhedron {
                name: "tetrahedron",
                corners: &corners,
                faces: TETRAHEDRON,
                edges,
            },
            span,
            context,
        );
    }
}

impl LowerObject for Prism {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Prism {
            kind,
            corners,
            up,
            ends,
            material,
            shadow,
            velocity,
        } = self;
        let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context)
        else {
            return;
        };
        // The six corners, from either variant.
        let (span, corners, up) = match (corners, up, ends) {
            (FieldResult::Read(corners), FieldResult::Read(up), _) => {
                let [a, b, c] = corners.map(|corner| Vec3::from_array(corner.value.0));
                let up = Vec3::from_array(up.value.0);
                let top = [a + up, b + up, c + up];
                (corners[0].span, [a, b, c, top[0], top[1], top[2]], up)
            }
            (.., FieldResult::Read(ends)) => {
                let corners = ends.map(|corner| Vec3::from_array(corner.value.0));
                let [a, b, c, d, e, f] = corners;
                (ends[0].span, corners, (d - a) + (e - b) + (f - c))
            }
            _ => return,
        };
        let [a, b, c, ..] = corners;
        lowering.add_polyhedron(
            &props,
            &Polyhedron {
                name: "prism",
                corners: &corners,
                faces: PRISM,
                edges: [b - a, c - a, up],
            },
            span,
            context,
        );
    }
}

impl Lowering {
    /// Adds the faces of a box with these corners.
    pub(super) fn add_box(
        &mut self,
        props: &SurfaceProperties,
        corners: &[Vec3; 8],
        span: Option<Span>,
        context: &mut DecodeContext<'_>,
    ) {
        let polyhedron = Polyhedron {
            name: "box",
            corners,
            faces: BOX,
            edges: [1, 2, 4].map(|far| corners[far] - corners[0]),
        };
        self.add_polyhedron(props, &polyhedron, span, context);
    }

    /// Adds the faces of a polyhedron as triangles, counter-clockwise as seen from outside.
    fn add_polyhedron(
        &mut self,
        props: &SurfaceProperties,
        polyhedron: &Polyhedron<'_>,
        span: Option<Span>,
        context: &mut DecodeContext<'_>,
    ) {
        // Only the sign of the volume is used. Edges are scaled so that it does not underflow.
        let [x, y, z] = polyhedron
            .edges
            .map(|edge| unit_scale(edge).map_or(Vec3::ZERO, |(scaled, _)| scaled));
        let volume = x.cross(y).dot(z);
        if polyhedron.edges == [Vec3::ZERO; 3] {
            self.invisible(span);
            return;
        }
        if volume == 0.0 {
            span.into_iter()
                .for_each(|span| report_flat(polyhedron.name, span, context));
            return;
        }
        // A fan of triangles for each face, reversed if the volume is negative.
        let value_spans = VERTICES.map(|field| (field, span));
        for face in polyhedron.faces {
            for k in 1..face.len() - 1 {
                let at = if volume > 0.0 {
                    [0, k, k + 1]
                } else {
                    [0, k + 1, k]
                };
                let vertices = at.map(|k| polyhedron.corners[face[k]].to_array());
                let uvs = (face.len() == 4).then(|| at.map(|k| UNIT_SQUARE[k]));
                self.add_surface(
                    props,
                    ir::Shape::Triangle(ir::Triangle { vertices, uvs }),
                    &value_spans,
                );
            }
        }
    }
}

/// The texture coordinates of the corners of a face with four corners.
pub(super) const UNIT_SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// The corners and faces of a polyhedron, and three edges whose triple product has the sign of its
/// volume.
struct Polyhedron<'c> {
    name: &'static str,
    corners: &'c [Vec3],
    faces: &'static [FaceCorners],
    edges: [Vec3; 3],
}

fn report_flat(name: &str, span: Span, context: &mut DecodeContext<'_>) {
    context.report(
        &codes::FLAT_SOLID,
        span,
        || format!("the {name} has no volume"),
        |d| {
            d.at(span, "flat")
                .hint("a flat shape is written as a `quad` or `triangle`")
        },
    );
}

/// Reports the assumed direction of a depth that is only a length.
fn report_assumed_depth(
    depth: &FieldResult<Spanned<ThirdEdge>>,
    edge: Vec3,
    context: &mut DecodeContext<'_>,
) {
    if let FieldResult::Read(Spanned {
        value: ThirdEdge::Length(_),
        span: Some(span),
    }) = *depth
    {
        let [x, y, z] = edge
            .to_array()
            .map(|part| shortest((part * 1e3).round() / 1e3));
        let message = || "the `depth` of a box is a length: taken along `up` × `side`".to_owned();
        context.report(&codes::ASSUMED, span, message, |d| {
            d.at(span, "no direction")
                .hint(format!("as an edge it is about `depth: [{x}, {y}, {z}]`"))
        });
    }
}

/// The corners of a box, and the span of its size.
fn box_corners(
    add_box: &Cuboid,
    context: &mut DecodeContext<'_>,
) -> Option<([Vec3; 8], Option<Span>)> {
    let Cuboid {
        kind: _,
        extremes,
        position,
        dimension,
        rotation,
        axis,
        angle,
        edges,
        depth,
        material: _,
        shadow: _,
        velocity: _,
    } = add_box;
    // Bit k of a corner's index tells its end of axis k.
    let end = |index: usize, axis: usize| (index >> axis) & 1;
    // One form has a corner and its edges.
    if let (FieldResult::Read(corner), FieldResult::Read([up, side]), FieldResult::Read(depth)) =
        (position, edges, depth)
    {
        let corner = Vec3::from_array(corner.value.0);
        let [side_edge, up_edge] = [side, up].map(|edge| Vec3::from_array(edge.value.0));
        let depth = depth.value.edge(up_edge, side_edge);
        return Some((box_from_edges(corner, [side_edge, up_edge, depth]), up.span));
    }
    // The others have two opposite corners, or a centre with a rotation.
    match (extremes, position, dimension) {
        (FieldResult::Read(ends), ..) => {
            let corner = |index| {
                Vec3::from_array([0, 1, 2].map(|axis| ends[end(index, axis)].value.0[axis]))
            };
            Some((std::array::from_fn(corner), ends[0].span))
        }
        (_, FieldResult::Read(center), FieldResult::Read(dimension)) => {
            let axes = RotationKeys {
                rotation,
                axis,
                angle,
            };
            let axes = axes.axes(context)?;
            let center = Vec3::from_array(center.value.0);
            Some((box_around(center, dimension.value.0, axes), dimension.span))
        }
        _ => None,
    }
}

/// The corners of a box from its centre, its lengths and its axes.
pub(super) fn box_around(center: Vec3, size: [f64; 3], axes: [Vec3; 3]) -> [Vec3; 8] {
    let half = |index: usize, axis: usize| match (index >> axis) & 1 {
        1 => size[axis] / 2.0,
        _ => -size[axis] / 2.0,
    };
    std::array::from_fn(|index| {
        center + axes[0] * half(index, 0) + axes[1] * half(index, 1) + axes[2] * half(index, 2)
    })
}

/// The corners of a box from one corner and its three edges.
fn box_from_edges(from: Vec3, edges: [Vec3; 3]) -> [Vec3; 8] {
    let along = |index: usize| (0..3).filter(move |axis| (index >> axis) & 1 == 1);
    std::array::from_fn(|index| from + along(index).map(|axis| edges[axis]).sum::<Vec3>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_depth_is_an_edge_or_at_right_angles_to_the_others() {
        let (up, side) = (Vec3::Y * 2.0, Vec3::X * 5.0);
        assert_eq!(ThirdEdge::Length(3.0).edge(up, side), Vec3::Z * -3.0);
        assert_eq!(
            ThirdEdge::Edge([1.0, 2.0, 3.0]).edge(up, side),
            Vec3::new(1.0, 2.0, 3.0)
        );
        assert_eq!(ThirdEdge::Length(3.0).edge(up, up), Vec3::ZERO);
    }
}
