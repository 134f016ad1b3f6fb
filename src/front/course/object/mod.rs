//! The objects, told apart by their `type`: the table of types, and what all of them share.

mod axis_keys;
mod cone;
pub(super) mod cube;
mod cylinder;
mod disc;
mod gltf;
mod mesh;
mod paraboloid;
mod plane;
mod quad;
pub(super) mod sizing;
pub(super) mod solid;
mod sphere;
pub(super) mod torus;
mod triangle;

use super::decode::{Context, SharedValue, Spanned, Value, ValueKey};
use super::lower::Lowering;
use super::material::Material;
use super::number::NonNegative;
use super::reader::{look_up, missing_keys};
use super::record::Record;
use super::schema::{self, Definitions};
use super::spelling::quoted_list;
use super::value::AnyScalar;
use rtc_diag::clip;
use rtc_diag::{Severity, codes, nearest};
use rtc_ir::{self as ir, EntityKind, Field, MaterialId};
use rtc_math::shortest;
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::Value as Json;

/// A type of object: the words for it, the canonical one first, and its declaration.
pub(super) struct ObjectKind {
    pub(super) names: &'static [&'static str],
    pub(super) record: &'static Record,
    decode: fn(NodeId, &mut Context<'_>) -> Option<Object>,
    schema: fn(&mut Definitions) -> Json,
}

/// What an object becomes in the IR.
trait Lower {
    /// Lowers an object; one without a sound material or form is left out, and the sink has an
    /// error.
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>);
}

/// Declares the types of objects: the file and the record, and the words for it.
macro_rules! kinds {
    ($($file:ident $record:ident $($name:literal)+;)+) => {
        /// An object of any type.
        pub(super) enum Object {
            $($record($file::$record)),+
        }

        /// The types there are.
        pub(super) const KINDS: &[ObjectKind] = &[$(ObjectKind {
            names: &[$($name),+],
            record: &$file::$record::RECORD,
            decode: |node, context| $file::$record::decode(node, context).map(Object::$record),
            schema: $file::$record::schema,
        }),+];

        impl Lowering {
            /// Lowers an object; one without a sound material or form is left out, and the sink has
            /// an error.
            pub(super) fn object(&mut self, object: &Object, context: &mut Context<'_>) {
                match object {
                    $(Object::$record(record) => record.lower(self, context),)+
                }
            }
        }
    };
}

kinds! {
    sphere Sphere "sphere";
    plane Plane "plane";
    triangle Triangle "triangle";
    quad Quad "quad" "quadrilateral";
    disc Disc "circle" "disc" "disk";
    cylinder Cylinder "cylinder";
    cone Cone "cone";
    paraboloid Paraboloid "paraboloid";
    torus Torus "torus";
    solid Cuboid "box";
    solid Tetrahedron "tetrahedron";
    cube Cube "cube";
    solid Prism "prism" "prisme";
    mesh Mesh "mesh" "model" "OBJModel" "triangleMesh" "triangleAggregate";
    plane BoundedPlane "bplane";
    gltf Gltf "gltf";
}

impl Value for Object {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if !context.tree.is_map(node) {
            return context.expected(node, "a map");
        }
        let Some(kind) = look_up("type", node, context) else {
            let tree = context.tree;
            let is_typo = |key: &NodeId| {
                let name = tree.text(*key);
                name.is_some_and(|name| nearest(name, ["type"].into_iter()).is_some())
            };
            if is_named_by_key(node, context) {
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
        (kind.decode)(node, context)
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let mut kinds = Vec::new();
        for ObjectKind { names, schema, .. } in KINDS {
            let schema = schema(definitions);
            kinds.extend(names.iter().map(|name| (*name, schema.clone())));
        }
        schema::tagged("type", "What kind of object this is.", &kinds)
    }
}

/// Reports an object whose type stands as a key, `- sphere:`, if it is one.
fn is_named_by_key(node: NodeId, context: &mut Context<'_>) -> bool {
    let tree = context.tree;
    let is_kind = |name: &str| KINDS.iter().any(|kind| kind.names.contains(&name));
    let named = tree
        .pairs(node)
        .find_map(|(key, value)| Some((key, value, tree.text(key).filter(|name| is_kind(name))?)));
    let Some((key, value, name)) = named else {
        return false;
    };
    let span = tree.span(key);
    let message = || format!("an object says what it is by `type: {name}`");
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
                "write `type: {name}`, and its other keys beside that"
            )),
        }
    });
    true
}

/// Reports an object of unknown type.
fn report_unknown_type(name: &str, node: NodeId, context: &mut Context<'_>) {
    let (lenient, span) = (context.options.lenient, context.tree.span(node));
    let known = KINDS.iter().flat_map(|kind| kind.names).copied();
    let meant = nearest(name, known).map(|meant| (meant, context.with_quotes_of(node, meant)));
    context.report(
        &codes::UNKNOWN_TYPE,
        span,
        || format!("there is no type `{}`", clip(name)),
        |d| {
            let d = match lenient {
                true => d
                    .at(span, "this object is left out")
                    .severity(Severity::Warning),
                false => d.at(span, "this object would be missing"),
            };
            match meant {
                Some((meant, better)) => d.guess(format!("did you mean `{meant}`?"), span, better),
                None if lenient => d,
                None => {
                    let kinds = quoted_list(KINDS.iter().map(|kind| kind.names[0]));
                    d.hint(format!(
                        "the types are {kinds}; `--lenient` leaves the object out"
                    ))
                }
            }
        },
    );
}

/// What the surfaces of an object have in common.
pub(super) struct SurfaceProps {
    object_span: Option<Span>,
    material: MaterialId,
    span: Option<Span>,
    casts_shadow: bool,
}

impl Lowering {
    /// Lowers the material of an object. `None` if it has no sound one, which is reported.
    pub(super) fn surface_props(
        &mut self,
        kind: &Spanned<AnyScalar>,
        material: &Spanned<SharedValue<Material>>,
        shadow: &Spanned<bool>,
        context: &mut Context<'_>,
    ) -> Option<SurfaceProps> {
        let id = self.material(material, context)?;
        Some(SurfaceProps {
            object_span: kind.span,
            material: id,
            span: material.span,
            casts_shadow: shadow.value,
        })
    }

    /// Clothes an object for which no material was written.
    pub(super) fn grey_surface_props(
        &mut self,
        kind: &Spanned<AnyScalar>,
        shadow: &Spanned<bool>,
    ) -> SurfaceProps {
        SurfaceProps {
            object_span: kind.span,
            material: self.grey(),
            span: kind.span,
            casts_shadow: shadow.value,
        }
    }

    /// Adds a surface of an object; `value_spans` are the ways to its values in the IR, and where those
    /// were written.
    pub(super) fn add_surface(
        &mut self,
        props: &SurfaceProps,
        shape: ir::Shape,
        value_spans: &[(&str, Option<Span>)],
    ) {
        if let Some(path) = zero_size_field(&shape) {
            let value_span = value_spans.iter().find(|(own, _)| *own == path);
            self.invisible(value_span.and_then(|(_, span)| *span).or(props.object_span));
            return;
        }
        let SurfaceProps {
            object_span,
            material,
            span,
            casts_shadow,
        } = *props;
        let (index, kind) = (self.scene.surfaces.len(), shape.kind());
        self.scene.surfaces.push(ir::Surface {
            shape,
            material,
            casts_no_shadow: !casts_shadow,
        });
        self.origin(EntityKind::Surface, index, Field::Whole, object_span);
        for (path, span) in value_spans {
            let field = Field::of_shape(kind, path);
            self.origin(EntityKind::Surface, index, field, *span);
        }
        self.origin(EntityKind::Surface, index, Field::Material, span);
    }

    /// Remembers what has no size, where that is written: it is left out.
    fn invisible(&mut self, span: Option<Span>) {
        self.invisible.extend(span);
    }

    /// Tells of what has no size.
    pub(super) fn report_invisible(&mut self, context: &mut Context<'_>) {
        for span in std::mem::take(&mut self.invisible) {
            let message = || "an object of size 0 is invisible".to_owned();
            context.report(&codes::INVISIBLE, span, message, |d| {
                d.at(span, "left out")
                    .hint("give it a size, or remove the object")
            });
        }
    }

    /// Calls the last surface by a name.
    fn set_name(&mut self, name: &str) {
        let names = &mut self.scene.names;
        names.resize(self.scene.surfaces.len(), String::new());
        names
            .last_mut()
            .into_iter()
            .for_each(|last| name.clone_into(last));
    }
}

/// The way to the value of a shape that is 0 and leaves nothing to see of it.
fn zero_size_field(shape: &ir::Shape) -> Option<&'static str> {
    let (path, size) = match shape {
        ir::Shape::Sphere(ir::Sphere { radius, .. })
        | ir::Shape::Disc(ir::Disc { radius, .. })
        | ir::Shape::Cylinder(ir::Cylinder { radius, .. })
        | ir::Shape::Cone(ir::Cone { radius, .. })
        | ir::Shape::Paraboloid(ir::Paraboloid { radius, .. }) => ("radius", *radius),
        ir::Shape::Torus(ir::Torus { minor, .. }) => ("minor", *minor),
        ir::Shape::Plane(_)
        | ir::Shape::Triangle(_)
        | ir::Shape::Quad(_)
        | ir::Shape::Instance(_) => return None,
    };
    (size == 0.0).then_some(path)
}

/// Reports a negative length of what becomes flat faces; of others the proof says so.
fn report_negative(length: &Spanned<NonNegative>, name: &str, context: &mut Context<'_>) {
    if let Some(span) = length.span {
        let shown = shortest(length.value.0);
        let message = || format!("the {name} `{shown}` is not above 0");
        context.report(&codes::RADIUS, span, message, |d| {
            d.at(span, "must be above 0")
        });
    }
}
