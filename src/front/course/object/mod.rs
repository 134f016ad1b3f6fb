//! The objects of the course: one record per `type`, in the file that is named after it.
//!
//! [`KINDS`] lists all types with their names; the decoder and the schema come from this list. Each
//! record implements `LowerObject`, which adds surfaces to the scene: first
//! `Lowering::surface_props` lowers the properties that all surfaces of an object share (material,
//! shadow flag, span), then `Lowering::add_surface` adds each surface with the spans of its values.
//!
//! * `sphere`, `plane`, `triangle`, `quad`, `disc`, `cylinder` (with the one without ends), `cone`
//!   (with the paraboloid), `torus` and `ellipsoid` become the shape of the same name in the IR.
//!   `cone` has the keys of a base and an axis, which cylinders share.
//! * `csg` (union, intersection, difference) makes one solid of the surfaces of its operands.
//! * `solid` (box, tetrahedron, prism) and `cube` become triangles.
//! * `mesh` becomes an instance of a mesh that is loaded later; `sizing` scales it after that.
//! * `gltf` becomes a pending asset only.
//!
//! Objects of size 0 are omitted with one diagnostic each. An object with an invalid material, or
//! with keys of no variant, is omitted after these have been reported.

mod cone;
mod csg;
mod cube;
mod cylinder;
mod disc;
mod ellipsoid;
mod gltf;
mod mesh;
mod plane;
mod quad;
pub(super) mod sizing;
mod solid;
mod sphere;
pub(super) mod torus;
mod triangle;

use super::decode::{
    Decode, DecodeContext, MapEntry, OperandMaterial, SharedValue, Spanned, ValueKey,
};
use super::lower::Lowering;
use super::material::Material;
use super::number::NonNegative;
use super::reader::{MATERIAL, TEXTURE, look_up, missing_keys};
use super::record::{HasRecord, Record};
use super::schema::{self, SchemaDefinitions};
use super::spelling::quoted_list;
use super::value::{AnyScalar, Point};
use rtc_diag::clip;
use rtc_diag::{Severity, codes, nearest};
use rtc_ir::{self as ir, EntityField, EntityKind, MaterialId};
use rtc_math::shortest;
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::Value as Json;

/// A type of object: its names, the canonical one first, and its declaration.
pub(super) struct ObjectKind {
    pub(super) names: &'static [&'static str],
    pub(super) record: &'static Record,
    decode: fn(&'static Record, NodeId, &mut DecodeContext<'_>) -> Option<Object>,
}

impl ObjectKind {
    const fn of<T: HasRecord + LowerObject + 'static>(names: &'static [&'static str]) -> Self {
        Self {
            names,
            record: T::RECORD,
            decode: |record, node, context| {
                T::read(record, node, context).map(|object| Object(Box::new(object)))
            },
        }
    }
}

/// An object of any type.
pub(super) struct Object(Box<dyn LowerObject>);

/// Lowers an object to surfaces of the IR.
trait LowerObject {
    /// Lowers an object. An object without a valid material or variant is omitted, which is
    /// reported.
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>);

    /// Whether it is read from a file, after the scene.
    fn is_in_file(&self) -> bool {
        false
    }
}

/// All types of objects.
pub(super) const KINDS: &[ObjectKind] = &[
    ObjectKind::of::<sphere::Sphere>(&["sphere"]),
    ObjectKind::of::<plane::Plane>(&["plane"]),
    ObjectKind::of::<triangle::Triangle>(&["triangle"]),
    ObjectKind::of::<quad::Quad>(&["quad", "quadrilateral"]),
    ObjectKind::of::<disc::Disc>(&["circle", "disc", "disk"]),
    ObjectKind::of::<cylinder::Cylinder>(&["cylinder"]),
    ObjectKind::of::<cone::Cone>(&["cone"]),
    ObjectKind::of::<cone::Paraboloid>(&["paraboloid"]),
    ObjectKind::of::<torus::Torus>(&["torus"]),
    ObjectKind::of::<ellipsoid::Ellipsoid>(&["ellipsoid"]),
    ObjectKind::of::<cylinder::InfiniteCylinder>(&["infiniteCylinder"]),
    ObjectKind::of::<csg::SetUnion>(&["union"]),
    ObjectKind::of::<csg::SetIntersection>(&["intersection"]),
    ObjectKind::of::<csg::SetDifference>(&["difference"]),
    ObjectKind::of::<csg::Csg>(&["csg", "CSG"]),
    ObjectKind::of::<solid::Cuboid>(&["box"]),
    ObjectKind::of::<solid::Tetrahedron>(&["tetrahedron"]),
    ObjectKind::of::<cube::Cube>(&["cube"]),
    ObjectKind::of::<solid::Prism>(&["prism", "prisme"]),
    ObjectKind::of::<mesh::Mesh>(&[
        "mesh",
        "model",
        "OBJModel",
        "triangleMesh",
        "triangleAggregate",
    ]),
    ObjectKind::of::<plane::BoundedPlane>(&["bplane"]),
    ObjectKind::of::<gltf::Gltf>(&["gltf"]),
];

impl Lowering {
    /// Lowers an object. An object without a valid material or variant is omitted, which is
    /// reported.
    pub(super) fn object(&mut self, object: &Object, context: &mut DecodeContext<'_>) {
        object.0.lower(self, context);
    }
}

impl Decode for Object {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if !context.tree.is_map(node) {
            return context.expected(node, "a map");
        }
        // The key `type` selects the record.
        let Some(kind) = look_up("type", node, context) else {
            let tree = context.tree;
            let is_typo = |key: &NodeId| {
                let name = tree.text(*key);
                name.is_some_and(|name| nearest(name, ["type"].into_iter()).is_some())
            };
            if report_type_as_key(node, context) {
                return None;
            }
            let typo = tree.pairs(node).map(|(key, _)| key).find(is_typo);
            let typo = typo.map(|key| tree.span(key));
            missing_keys("object", context.head(node), &["type"], typo, context);
            return None;
        };
        let span = context.tree.span(kind);
        context.key = ValueKey {
            text: "type",
            span: Some(span),
        };
        let Some(name) = context.tree.text(kind) else {
            return context.expected(kind, "a word");
        };
        let known = KINDS.iter().find_map(|kind| {
            kind.names
                .iter()
                .find(|known| **known == name)
                .map(|name| (kind, *name))
        });
        let Some((kind, name)) = known else {
            report_unknown_type(name, kind, context);
            return None;
        };
        context.record_spelling(name, kind.names[0], span);
        // Operands without a material have that of the object around them.
        let outer = context.operand_material;
        if kind.record.fields.iter().any(|field| field.name == "of") {
            context.operand_material = operand_material(node, context);
        }
        let outer_texture = context.object_texture.take();
        let object = (kind.decode)(kind.record, node, context);
        context.operand_material = outer;
        context.object_texture = outer_texture;
        object
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        schema::object(definitions)
    }
}

/// The material of a solid's operands: its own, or that of the solid around it, either with the
/// texture of the solid if it has one.
fn operand_material<'a>(node: NodeId, context: &DecodeContext<'a>) -> Option<OperandMaterial<'a>> {
    let tree = context.tree;
    let own = |key| {
        let mut pairs = tree.pairs(node);
        let (key_node, value) = pairs.find(|(name, _)| tree.text(*name) == Some(key))?;
        Some(MapEntry {
            key,
            key_node,
            value,
            claimed: false,
        })
    };
    let outer = match own(MATERIAL) {
        Some(material) => Some(OperandMaterial {
            material,
            texture: None,
        }),
        None => context.operand_material,
    };
    outer.map(|outer| OperandMaterial {
        texture: own(TEXTURE).or(outer.texture),
        ..outer
    })
}

/// Reports an object whose type is written as a key, as in `- sphere:`.
fn report_type_as_key(node: NodeId, context: &mut DecodeContext<'_>) -> bool {
    let tree = context.tree;
    let is_kind = |name: &str| KINDS.iter().any(|kind| kind.names.contains(&name));
    let named = tree
        .pairs(node)
        .find_map(|(key, value)| Some((key, value, tree.text(key).filter(|name| is_kind(name))?)));
    let Some((key, value, name)) = named else {
        return false;
    };
    let span = tree.span(key);
    let message = || format!("the type of an object is written `type: {name}`");
    let is_alone = tree.text(value) == Some("") && tree.rest_of_line(span).starts_with(':');
    let colon = Span {
        end: span.end + 1,
        ..span
    };
    context.report(&codes::MISSING_KEY, span, message, |d| {
        let d = d.at(span, "a type, and not a key");
        match is_alone {
            true => d.guess("write", colon, format!("type: {name}")),
            false => d.hint(format!(
                "write `type: {name}`, and its other keys next to it"
            )),
        }
    });
    true
}

/// Other words for the types of objects.
const OTHER_NAMES: &[(&str, &[&str])] = &[
    ("sphere", &["ball", "orb", "globe"]),
    (
        "plane",
        &["floor", "ground", "wall", "ceiling", "halfspace"],
    ),
    ("triangle", &["tri", "face"]),
    (
        "quad",
        &["rect", "rectangle", "square", "polygon", "parallelogram"],
    ),
    ("cylinder", &["tube", "pipe", "rod", "can"]),
    ("torus", &["donut", "doughnut", "ring"]),
    ("ellipsoid", &["ellipse", "egg", "spheroid"]),
    (
        "box",
        &["cuboid", "block", "brick", "aabb", "parallelepiped"],
    ),
    ("tetrahedron", &["pyramid", "simplex"]),
    (
        "mesh",
        &["obj", "off", "object", "geometry", "trimesh", "polymesh"],
    ),
    ("gltf", &["glb", "asset"]),
    ("difference", &["subtraction", "subtract", "minus"]),
    ("intersection", &["intersect"]),
    ("union", &["merge", "group", "combine"]),
];

/// The type that was probably meant by another name.
fn meant_type(name: &str) -> Option<&'static str> {
    let is_it = |other: &&str| other.eq_ignore_ascii_case(name);
    let mut others = OTHER_NAMES.iter();
    let other = others.find(|(_, names)| names.iter().any(is_it));
    let known = || KINDS.iter().flat_map(|kind| kind.names).copied();
    match other {
        Some((kind, _)) => Some(kind),
        None => nearest(name, known()),
    }
}

/// Reports an object of unknown type.
fn report_unknown_type(name: &str, node: NodeId, context: &mut DecodeContext<'_>) {
    let (lenient, span) = (context.options.lenient, context.tree.span(node));
    let suggestion =
        meant_type(name).map(|suggestion| (suggestion, context.with_quotes_of(node, suggestion)));
    context.report(
        &codes::UNKNOWN_TYPE,
        span,
        || format!("unknown object type `{}`", clip(name)),
        |d| {
            let d = match lenient {
                true => d
                    .at(span, "the object is skipped")
                    .severity(Severity::Warning),
                false => d.at(span, "not an object type"),
            };
            match suggestion {
                Some((suggestion, replacement)) => {
                    d.guess(format!("did you mean `{suggestion}`?"), span, replacement)
                }
                None if lenient => d,
                None => {
                    let kinds = quoted_list(KINDS.iter().map(|kind| kind.names[0]));
                    d.hint(format!(
                        "the types are {kinds}; `--lenient` skips the object"
                    ))
                }
            }
        },
    );
}

/// The properties that all surfaces of an object share.
pub(super) struct SurfaceProperties {
    object_span: Option<Span>,
    material: MaterialId,
    span: Option<Span>,
    casts_shadow: bool,
    velocity: Spanned<Point>,
}

impl Lowering {
    /// Lowers the properties of an object. `None` if its material is invalid, which is reported.
    pub(super) fn surface_props(
        &mut self,
        kind: &Spanned<AnyScalar>,
        material: &Spanned<SharedValue<Material>>,
        (shadow, velocity): (&Spanned<bool>, &Spanned<Point>),
        context: &mut DecodeContext<'_>,
    ) -> Option<SurfaceProperties> {
        let id = self.material(material, context)?;
        self.dependent.record_shadow(shadow);
        Some(SurfaceProperties {
            object_span: kind.span,
            material: id,
            span: material.span,
            casts_shadow: shadow.value,
            velocity: *velocity,
        })
    }

    /// The properties of an object without a material: grey.
    pub(super) fn grey_surface_props(
        &mut self,
        kind: &Spanned<AnyScalar>,
        (shadow, velocity): (&Spanned<bool>, &Spanned<Point>),
    ) -> SurfaceProperties {
        SurfaceProperties {
            object_span: kind.span,
            material: self.grey(),
            span: kind.span,
            casts_shadow: shadow.value,
            velocity: *velocity,
        }
    }

    /// Adds a surface of an object. `value_spans` are the paths of its values in the IR, with their
    /// spans.
    pub(super) fn add_surface(
        &mut self,
        props: &SurfaceProperties,
        shape: ir::Shape,
        value_spans: &[(&str, Option<Span>)],
    ) {
        if let Some(path) = zero_size_field(&shape) {
            let value_span = value_spans.iter().find(|(own, _)| *own == path);
            self.invisible(value_span.and_then(|(_, span)| *span).or(props.object_span));
            return;
        }
        let SurfaceProperties {
            object_span,
            material,
            span,
            casts_shadow,
            velocity,
        } = *props;
        let (index, kind) = (self.scene.surfaces.len(), shape.kind());
        self.scene.surfaces.push(ir::Surface {
            shape,
            material,
            casts_no_shadow: !casts_shadow,
            velocity: velocity.value.0.into(),
        });
        self.record_span(EntityKind::Surface, index, EntityField::Whole, object_span);
        for (path, span) in value_spans {
            let field = EntityField::of_shape(kind, path);
            self.record_span(EntityKind::Surface, index, field, *span);
        }
        self.record_span(EntityKind::Surface, index, EntityField::Material, span);
        self.record_span(
            EntityKind::Surface,
            index,
            EntityField::Velocity,
            velocity.span,
        );
    }

    /// Omits an object of size 0 and records its span.
    fn invisible(&mut self, span: Option<Span>) {
        self.invisible.extend(span);
    }

    /// Reports the objects of size 0.
    pub(super) fn report_invisible(&mut self, context: &mut DecodeContext<'_>) {
        for span in std::mem::take(&mut self.invisible) {
            let message = || "an object of size 0 is invisible".to_owned();
            context.report(&codes::INVISIBLE, span, message, |d| {
                d.at(span, "left out")
                    .hint("give it a size, or remove the object")
            });
        }
    }

    /// Names the last surface.
    fn set_name(&mut self, name: &str) {
        let names = &mut self.scene.names;
        names.resize(self.scene.surfaces.len(), String::new());
        names
            .last_mut()
            .into_iter()
            .for_each(|last| name.clone_into(last));
    }
}

/// The path of the value that makes a shape invisible because it is 0.
fn zero_size_field(shape: &ir::Shape) -> Option<&'static str> {
    let (path, size) = match shape {
        ir::Shape::Sphere(ir::Sphere { radius, .. })
        | ir::Shape::Disc(ir::Disc { radius, .. })
        | ir::Shape::Cylinder(ir::Cylinder { radius, .. })
        | ir::Shape::Cone(ir::Cone { radius, .. })
        | ir::Shape::InfiniteCylinder(ir::InfiniteCylinder { radius, .. })
        | ir::Shape::Paraboloid(ir::Paraboloid { radius, .. }) => ("radius", *radius),
        ir::Shape::Torus(ir::Torus { minor, .. }) => ("minor", *minor),
        ir::Shape::Plane(_)
        | ir::Shape::Triangle(_)
        | ir::Shape::Quad(_)
        | ir::Shape::Ellipsoid(_)
        | ir::Shape::Csg(_)
        | ir::Shape::Instance(_) => return None,
    };
    (size == 0.0).then_some(path)
}

/// Reports a negative length of an object that becomes triangles or a quad; the validator reports
/// those of other shapes.
fn report_negative(length: &Spanned<NonNegative>, name: &str, context: &mut DecodeContext<'_>) {
    if let Some(span) = length.span {
        let shown = shortest(length.value.0);
        let message = || format!("the {name} `{shown}` is negative");
        context.report(&codes::RADIUS, span, message, |d| {
            d.at(span, "must be above 0")
        });
    }
}
