//! Infinite planes, and the bounded planes of some files.

use super::quad::EDGES;
use super::triangle::CORNERS;
use super::{LowerObject, report_negative};
use crate::course::decode::{DecodeContext, SharedValue, Spanned, SpannedVector};
use crate::course::keyword::{Keyword, KeywordTable};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Real};
use crate::course::record::{FieldResult, record};
use crate::course::synonym::{AXIS, POSITION, RADIUS, with_canonical, with_last};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_math::{Vec3, length, shortest, unit, unit_scale};

record! {
    /// An infinite plane, given by a point and a normal, a normal and a distance from the origin,
    /// three points, a point and two directions, or the four numbers of its equation.
    struct Plane, "plane" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]], json "type";
        /// The coefficients of the equation a·x + b·y + c·z + d = 0. Some programs use the opposite
        /// sign of `d`.
        equation: [Spanned<Real>; 4], optional, &[&["a", "b", "c", "d"]], json "a";
        /// One of three points of the plane.
        corners: [Spanned<Point>; 3], optional, CORNERS, json "A";
        /// A point of the plane.
        position: Spanned<Point>, optional, &with_last::<_, 9>(POSITION, &["a"]), json "position";
        /// The normal, of any length but 0.
        normal: Spanned<Vector>, optional, &with_canonical(AXIS, "normal"), json "normal";
        /// The distance from the origin, along the normal.
        distance: Spanned<Real>, optional, &[&["distance"], &["d"]];
        /// A direction in the plane.
        edges: [Spanned<Vector>; 2], optional, EDGES;
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]], json "material";
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], json "shadow";
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [position normal] [normal distance] [corners] [position edges] [equation] }
}

record! {
    /// A bounded plane: a square with sides along the axes, or a disc. Better written as a `quad`
    /// or `circle`.
    struct BoundedPlane, "bounded plane" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The outline: `quad` for a square, `circle` for a disc.
        outline: Spanned<PlaneOutline>, required, &[&["typ"]];
        /// The centre.
        center: Spanned<Point>, required, &with_canonical(POSITION, "center");
        /// The normal; that of a square is along an axis.
        normal: Spanned<Vector>, required, &with_canonical(AXIS, "normal");
        /// The radius, or half the side of the square; 0 is invisible.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius");
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

/// The outline of a bounded plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PlaneOutline {
    Square,
    Circle,
}

impl Keyword for PlaneOutline {
    const KEYWORDS: KeywordTable<Self> = &[
        ("quad", PlaneOutline::Square, "A square."),
        ("circle", PlaneOutline::Circle, "A disc."),
    ];
}

impl LowerObject for Plane {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let props = lowering.surface_props(
            &self.kind,
            &self.material,
            (&self.shadow, &self.velocity),
            context,
        );
        report_sign(self, context);
        if let (Some(props), Some((center, normal))) = (props, center_and_normal(self)) {
            let value_spans = [("center", center.span), ("normal", normal.span)];
            let shape = ir::Plane {
                center: center.value,
                normal: normal.value,
            };
            lowering.add_surface(&props, ir::Shape::Plane(shape), &value_spans);
        }
    }
}

impl LowerObject for BoundedPlane {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let BoundedPlane {
            kind,
            outline,
            center,
            normal,
            radius,
            material,
            shadow,
            velocity,
        } = self;
        let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context)
        else {
            return;
        };
        // A bounded plane is a disc or a square.
        match outline.value {
            PlaneOutline::Circle => {
                let shape = ir::Disc {
                    center: center.value.0,
                    normal: normal.value.0,
                    radius: radius.value.0,
                };
                let value_spans = [
                    ("center", center.span),
                    ("normal", normal.span),
                    ("radius", radius.span),
                ];
                lowering.add_surface(&props, ir::Shape::Disc(shape), &value_spans);
            }
            // A square of size 0 is invisible.
            PlaneOutline::Square if radius.value.0 == 0.0 => lowering.invisible(radius.span),
            PlaneOutline::Square if radius.value.0 < 0.0 => {
                report_negative(radius, "radius", context)
            }
            PlaneOutline::Square => {
                let fields = ["vertices/0", "vertices/1", "vertices/2", "vertices/3"];
                let value_spans = fields.map(|field| (field, center.span));
                match square_corners(center.value.0, normal.value.0, radius.value.0) {
                    Some(vertices) => lowering.add_surface(
                        &props,
                        ir::Shape::Quad(ir::Quad { vertices }),
                        &value_spans,
                    ),
                    None => report_oblique(normal, context),
                }
            }
        }
    }
}

/// The corners of a square with sides along the axes; `None` if its normal is not along an axis.
fn square_corners(center: [f64; 3], normal: [f64; 3], half: f64) -> Option<[[f64; 3]; 4]> {
    let center = Vec3::from_array(center);
    let (u, v) = match normal.map(|component| component != 0.0) {
        [true, false, false] => (Vec3::Y, Vec3::Z),
        [false, true, false] => (Vec3::Z, Vec3::X),
        [false, false, true] => (Vec3::X, Vec3::Y),
        _ => return None,
    };
    let corner = |a: f64, b: f64| (center + u * (a * half) + v * (b * half)).to_array();
    Some([
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ])
}

fn report_oblique(normal: &Spanned<Vector>, context: &mut DecodeContext<'_>) {
    let Some(span) = normal.span else { return };
    let message = || "a square `bplane` has its normal along an axis".to_owned();
    context.report(&codes::UNSUPPORTED, span, message, |d| {
        d.at(span, "along none")
            .hint("write it as a `quad` with four corners, or as a `circle`")
    });
}

/// The point and the normal of a plane, from the variant that is given.
fn center_and_normal(plane: &Plane) -> Option<(SpannedVector, SpannedVector)> {
    let Plane {
        kind: _,
        equation,
        corners,
        position,
        normal,
        distance,
        edges,
        material: _,
        shadow: _,
        velocity: _,
    } = plane;
    // An equation comes first.
    if let FieldResult::Read(equation) = equation {
        return Some(plane_of_equation(equation));
    }
    // Other forms are three points, a point with a normal, a distance or two edges.
    match (corners, position, normal, distance, edges) {
        (FieldResult::Read(corners), ..) => Some(plane_of_points(corners)),
        (_, FieldResult::Read(position), FieldResult::Read(normal), ..) => {
            Some((position.map(|point| point.0), normal.map(|vector| vector.0)))
        }
        (_, _, FieldResult::Read(normal), FieldResult::Read(distance), _) => {
            Some(plane_at_distance(normal, distance))
        }
        (_, FieldResult::Read(position), .., FieldResult::Read([up, side])) => {
            let [up_vector, side_vector] = [up, side].map(|edge| Vec3::from_array(edge.value.0));
            let span = up.span.zip(side.span).map(|(first, last)| first.to(last));
            let normal = cross(side_vector, up_vector);
            Some((
                position.map(|point| point.0),
                Spanned {
                    value: normal,
                    span,
                },
            ))
        }
        _ => None,
    }
}

/// A point and the normal of the plane a·x + b·y + c·z + d = 0.
fn plane_of_equation([a, b, c, d]: &[Spanned<Real>; 4]) -> (SpannedVector, SpannedVector) {
    let normal = Vec3::new(a.value.0, b.value.0, c.value.0);
    // The validator rejects a normal of length 0.
    let point = unit(normal).map_or(Vec3::ZERO, |n| n * (-d.value.0 / length(normal)));
    let ends = a.span.zip(c.span).map(|(first, last)| first.to(last));
    (
        Spanned {
            value: point.to_array(),
            span: d.span,
        },
        Spanned {
            value: normal.to_array(),
            span: ends,
        },
    )
}

/// Reports the sign convention of the last coefficient.
fn report_sign(plane: &Plane, context: &mut DecodeContext<'_>) {
    let FieldResult::Read([.., d]) = &plane.equation else {
        return;
    };
    if let (Some(span), true) = (d.span, d.value.0 != 0.0) {
        let message = || "a plane of four numbers is that of a·x + b·y + c·z + d = 0".to_owned();
        let other = shortest(-d.value.0);
        context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
            d.at(span, "on the other side of the origin in some programs")
                .hint(format!("a·x + b·y + c·z = d is meant by `d: {other}`"))
        });
    }
}

fn plane_of_points(corners: &[Spanned<Point>; 3]) -> (SpannedVector, SpannedVector) {
    let [a, b, c] = corners.map(|corner| Vec3::from_array(corner.value.0));
    let span = corners[0]
        .span
        .zip(corners[2].span)
        .map(|(first, last)| first.to(last));
    let normal = cross(b - a, c - a);
    (
        corners[0].map(|point| point.0),
        Spanned {
            value: normal,
            span,
        },
    )
}

/// The cross product of two directions, up to a positive factor. Both are scaled by powers of two,
/// so that no product leaves the range of f64.
fn cross(first: Vec3, second: Vec3) -> [f64; 3] {
    let [first, second] =
        [first, second].map(|edge| unit_scale(edge).map_or(Vec3::ZERO, |(scaled, _)| scaled));
    first.cross(second).to_array()
}

fn plane_at_distance(
    normal: &Spanned<Vector>,
    distance: &Spanned<Real>,
) -> (SpannedVector, SpannedVector) {
    // The validator rejects a normal of length 0.
    let direction = unit(Vec3::from_array(normal.value.0)).unwrap_or(Vec3::ZERO);
    (
        distance.map(|distance| (direction * distance.0).to_array()),
        normal.map(|vector| vector.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_of_the_equation_fulfils_it() {
        for [a, b, c, d] in [
            [0.0, 2.0, 0.0, 6.0],
            [1.0, -2.0, 3.0, -40.0],
            [1e200, 0.0, 0.0, 1e200],
        ] {
            let (point, normal) =
                plane_of_equation(&[a, b, c, d].map(|x| Spanned::without_span(Real(x))));
            assert_eq!(normal.value, [a, b, c]);
            let [x, y, z] = point.value;
            let rest = a * x + b * y + c * z + d;
            assert!(rest.abs() <= 1e-15 * d.abs(), "{point:?}");
        }
    }
}
