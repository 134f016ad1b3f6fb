//! The triangle.

use super::LowerObject;
use crate::course::decode::{DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::record::{FieldResult, Spellings, record};
use crate::course::value::{AnyScalar, Point, Uv};
use rtc_ir as ir;

/// The spellings of three corners.
pub(crate) const CORNERS: Spellings = &[
    &["v0", "v1", "v2"],
    &["v1", "v2", "v3"],
    &["a", "b", "c"],
    &["A", "B", "C"],
    &["vertex0", "vertex1", "vertex2"],
    &["vertex1", "vertex2", "vertex3"],
    &["p0", "p1", "p2"],
    &["p1", "p2", "p3"],
    &["point1", "point2", "point3"],
    &["corner1", "corner2", "corner3"],
    &["position1", "position2", "position3"],
];

record! {
    /// A two-sided triangle.
    struct Triangle, "triangle" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// A corner.
        corners: [Spanned<Point>; 3], required, CORNERS, json "vertex0", json "A", json "p0";
        /// The texture coordinates of a corner: (0, 0) is the lower left of the texture, (1, 1) the
        /// upper right.
        uvs: [Spanned<Uv>; 3], optional,
            &[&["uv0", "uv1", "uv2"], &["uv1", "uv2", "uv3"], &["UV1", "UV2", "UV3"]],
            json "UV1";
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

/// The paths of the corners in the IR.
pub(crate) const VERTICES: [&str; 3] = ["vertices/0", "vertices/1", "vertices/2"];

impl LowerObject for Triangle {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Triangle {
            kind,
            corners,
            uvs,
            material,
            shadow,
            velocity,
        } = self;
        let uvs = if let FieldResult::Read(uvs) = uvs {
            Some(uvs.map(|uv| uv.value.0))
        } else {
            None
        };
        let shape = ir::Shape::Triangle(ir::Triangle {
            vertices: corners.map(|corner| corner.value.0),
            uvs,
        });
        let spans = corners.map(|corner| corner.span);
        let value_spans = [0, 1, 2].map(|k| (VERTICES[k], spans[k]));
        if let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context) {
            lowering.add_surface(&props, shape, &value_spans);
        }
    }
}
