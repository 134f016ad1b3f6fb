//! The objects: shapes, told apart by their `type`.

use super::decode::{Context, Key, Shared, Spanned, Value};
use super::lower::Lowering;
use super::material::Material;
use super::number::{Radius, Real};
use super::record::{Found, Rows, keys, look_up, missing_keys, record};
use super::schema::{self, Definitions};
use super::spelling::{clip, list, nearest};
use super::tree::NodeId;
use super::value::{Point, Text, Unsupported, Vector};
use crate::diag::{Severity, codes};
use crate::ir::{self, Field, Noun};
use crate::math::Vec3;
use crate::source::Span;
use serde_json::Value as Json;

/// How people name three corners.
const CORNERS: Rows = &[
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
    /// A sphere.
    struct Sphere, "sphere" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, keys!["position" "center"];
        /// The radius, above 0.
        radius: Spanned<Radius>, required, keys!["radius" "r"];
        /// How a texture is turned; this version can't show it.
        _turn: Spanned<Unsupported>, optional, keys!["angle"];
        /// The axis a texture is turned about; this version can't show it.
        _axis: Spanned<Unsupported>, optional, keys!["axis" "rotation"];
        /// What it is made of.
        material: Spanned<Shared<Material>>, required, keys!["material"];
    }
}

record! {
    /// An infinite plane: a point and a normal, a normal and a distance from the origin, or three points.
    struct Plane, "plane" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// One of three points of the plane.
        corners: [Spanned<Point>; 3], optional, CORNERS;
        /// A point of the plane.
        position: Spanned<Point>, optional, keys!["position" "center" "O" "a"];
        /// The direction at right angles to the plane, of any length but 0.
        normal: Spanned<Vector>, optional, keys!["normal" "N" "n"];
        /// The distance from the origin, along the normal.
        distance: Spanned<Real>, optional, keys!["distance" "d"];
        /// What it is made of.
        material: Spanned<Shared<Material>>, required, keys!["material"];
    }
    forms { [position normal] [normal distance] [corners] }
}

record! {
    /// A triangle, seen from both sides.
    struct Triangle, "triangle" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// A corner.
        corners: [Spanned<Point>; 3], required, CORNERS;
        /// What it is made of.
        material: Spanned<Shared<Material>>, required, keys!["material"];
    }
}

/// An object of any kind.
pub(super) enum Object {
    Sphere(Sphere),
    Plane(Plane),
    Triangle(Triangle),
}

/// A `type` and what it stands for.
struct Kind {
    word: &'static str,
    decode: fn(NodeId, &mut Context<'_>) -> Option<Object>,
    schema: fn(&mut Definitions) -> Json,
}

/// The kinds there are.
const KINDS: &[Kind] = &[
    Kind {
        word: "sphere",
        decode: |node, context| Sphere::decode(node, context).map(Object::Sphere),
        schema: Sphere::schema,
    },
    Kind {
        word: "plane",
        decode: |node, context| Plane::decode(node, context).map(Object::Plane),
        schema: Plane::schema,
    },
    Kind {
        word: "triangle",
        decode: |node, context| Triangle::decode(node, context).map(Object::Triangle),
        schema: Triangle::schema,
    },
];

/// Kinds of the format that this version can't show.
const NOT_YET: &[&str] = &[
    "quad",
    "quadrilateral",
    "circle",
    "disc",
    "disk",
    "cylinder",
    "cone",
    "torus",
    "box",
    "mesh",
    "model",
    "OBJModel",
    "triangleMesh",
    "triangleAggregate",
];

impl Value for Object {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if !context.tree.is_map(node) {
            return context.expected(node, "a map");
        }
        let Some(kind) = look_up("type", node, context) else {
            missing_keys("object", context.head(node), &["type"], context);
            return None;
        };
        let span = context.tree.span(kind);
        context.key = Key { text: "type", span: Some(span) };
        let Some(word) = context.tree.text(kind) else { return context.expected(kind, "a word") };
        match KINDS.iter().find(|kind| kind.word == word) {
            Some(kind) => (kind.decode)(node, context),
            None => {
                left_out(word, span, context);
                None
            }
        }
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let kinds: Vec<_> = KINDS.iter().map(|kind| (kind.word, (kind.schema)(definitions))).collect();
        schema::tagged("type", "What kind of object this is.", &kinds)
    }
}

/// Reports an object this version can't show.
fn left_out(word: &str, span: Span, context: &mut Context<'_>) {
    let known = NOT_YET.contains(&word);
    let lenient = context.options.lenient;
    let (code, message) = match known {
        true => (&codes::UNSUPPORTED, format!("the type `{word}` is not supported by this version")),
        false => (&codes::UNKNOWN_TYPE, format!("there is no type `{}`", clip(word))),
    };
    context.report(
        code,
        span,
        || message,
        |d| {
            let d = match lenient {
                true => d.at(span, "this object is left out").severity(Severity::Warning),
                false => d.at(span, "this object would be missing"),
            };
            let kinds = || KINDS.iter().map(|kind| kind.word);
            match nearest(word, kinds().chain(NOT_YET.iter().copied())).filter(|_| !known) {
                Some(meant) => d.replace(format!("did you mean `{meant}`?"), span, meant),
                None if lenient => d,
                None => d.hint(format!("the types are {}; `--lenient` leaves the object out", list(kinds()))),
            }
        },
    );
}

impl Lowering {
    /// Lowers an object; one without a sound material or form is left out, and the sink has an error.
    pub(super) fn object(&mut self, object: &Object, context: &mut Context<'_>) {
        match object {
            Object::Sphere(Sphere { kind, position, radius, _turn: _, _axis: _, material }) => {
                let shape = ir::Shape::Sphere(ir::Sphere {
                    center: position.value.0,
                    radius: radius.value.0,
                    texture_from_world: None,
                });
                let places = [(Field::SphereCenter, position.span), (Field::SphereRadius, radius.span)];
                self.surface(kind.span, shape, &places, material, context);
            }
            Object::Plane(plane) => {
                if let Some((shape, places)) = lower_plane(plane, context) {
                    self.surface(plane.kind.span, ir::Shape::Plane(shape), &places, &plane.material, context);
                }
            }
            Object::Triangle(Triangle { kind, corners, material }) => {
                let shape =
                    ir::Shape::Triangle(ir::Triangle { vertices: corners.map(|corner| corner.value.0), uvs: None });
                let fields = [Field::TriangleVertex0, Field::TriangleVertex1, Field::TriangleVertex2];
                let places: Vec<_> = fields.into_iter().zip(corners.map(|corner| corner.span)).collect();
                self.surface(kind.span, shape, &places, material, context);
            }
        }
    }

    fn surface(
        &mut self,
        whole: Option<Span>,
        shape: ir::Shape,
        places: &[(Field, Option<Span>)],
        material: &Spanned<Shared<Material>>,
        context: &mut Context<'_>,
    ) {
        let Some(id) = self.material(material, context) else { return };
        let index = self.scene.surfaces.len();
        self.scene.surfaces.push(ir::Surface { shape, material: id });
        self.origin(Noun::Surface, index, Field::Whole, whole);
        for (field, span) in places {
            self.origin(Noun::Surface, index, *field, *span);
        }
        self.origin(Noun::Surface, index, Field::Material, material.span);
    }
}

type Placed<T> = (T, [(Field, Option<Span>); 2]);

/// A plane by the one form it is given in; any other set of keys is reported.
fn lower_plane(plane: &Plane, context: &mut Context<'_>) -> Option<Placed<ir::Plane>> {
    let Plane { kind, corners, position, normal, distance, material: _ } = plane;
    let given = [!corners.is_absent(), !position.is_absent(), !normal.is_absent(), !distance.is_absent()];
    let (center, normal) = match (given, corners, position, normal, distance) {
        ([true, false, false, false], Found::Read(corners), ..) => through(corners),
        ([false, true, true, false], _, Found::Read(position), Found::Read(normal), _) => (
            Spanned { value: position.value.0, span: position.span },
            Spanned { value: normal.value.0, span: normal.span },
        ),
        ([false, false, true, true], _, _, Found::Read(normal), Found::Read(distance)) => at_distance(normal, distance),
        ([true, false, false, false] | [false, true, true, false] | [false, false, true, true], ..) => return None,
        _ => {
            wrong_form(given, kind.span?, context);
            return None;
        }
    };
    let places = [(Field::PlaneCenter, center.span), (Field::PlaneNormal, normal.span)];
    Some((ir::Plane { center: center.value, normal: normal.value }, places))
}

fn through(corners: &[Spanned<Point>; 3]) -> (Spanned<[f64; 3]>, Spanned<[f64; 3]>) {
    let [a, b, c] = corners.map(|corner| Vec3::from_array(corner.value.0));
    let span = corners[0].span.zip(corners[2].span).map(|(first, last)| first.to(last));
    let normal = (b - a).cross(c - a).to_array();
    (Spanned { value: corners[0].value.0, span: corners[0].span }, Spanned { value: normal, span })
}

fn at_distance(normal: &Spanned<Vector>, distance: &Spanned<Real>) -> (Spanned<[f64; 3]>, Spanned<[f64; 3]>) {
    // A normal of length 0 is left for the proof to refuse.
    let direction = Vec3::from_array(normal.value.0).normalize_or_zero();
    let center = (direction * distance.value.0).to_array();
    (Spanned { value: center, span: distance.span }, Spanned { value: normal.value.0, span: normal.span })
}

fn wrong_form(given: [bool; 4], span: Span, context: &mut Context<'_>) {
    let [corners, position, normal, distance] = given;
    let forms = "a plane takes `position` and `normal`, or `normal` and `distance`, or three points `v0`, `v1`, `v2`";
    let many = (corners && (position || normal || distance)) || (position && distance);
    match (many, normal) {
        (true, _) => {
            let message = || "the plane is given in more than one way".to_owned();
            context.report(&codes::CONFLICTING_KEYS, span, message, |d| d.at(span, "this plane").hint(forms));
        }
        (false, true) => missing_form("`position` or `distance`", forms, span, context),
        (false, false) if position || distance => missing_form("`normal`", forms, span, context),
        (false, false) => missing_form("`position` and `normal`", forms, span, context),
    }
}

fn missing_form(what: &str, forms: &str, span: Span, context: &mut Context<'_>) {
    let message = || format!("the plane has no {what}");
    context.report(&codes::MISSING_KEY, span, message, |d| d.at(span, "this plane").hint(forms));
}
