//! The objects, told apart by their `type`: the table of types, and what all of them share.

mod cone;
pub(super) mod cube;
mod cylinder;
mod disc;
mod gltf;
mod mesh;
mod paraboloid;
mod plane;
mod quad;
mod round;
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
use super::spelling::list;
use super::value::Text;
use rtc_diag::clip;
use rtc_diag::{Severity, codes, nearest};
use rtc_ir::{self as ir, EntityKind, Field, MaterialId};
use rtc_math::shortest;
use rtc_source::Span;
use rtc_source::tree::NodeId;
use serde_json::Value as Json;

/// A type of object: the words for it, the canonical one first, and its declaration.
pub(super) struct ObjectKind {
    pub(super) words: &'static [&'static str],
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
    ($($file:ident $record:ident $($word:literal)+;)+) => {
        /// An object of any type.
        pub(super) enum Object {
            $($record($file::$record)),+
        }

        /// The types there are.
        pub(super) const KINDS: &[ObjectKind] = &[$(ObjectKind {
            words: &[$($word),+],
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
            let is_slip = |key: &NodeId| {
                let word = tree.text(*key);
                word.is_some_and(|word| nearest(word, ["type"].into_iter()).is_some())
            };
            if is_named_by_key(node, context) {
                return None;
            }
            let slip = tree.pairs(node).map(|(key, _)| key).find(is_slip);
            let slip = slip.map(|key| tree.span(key));
            missing_keys("object", context.head(node), &["type"], slip, context);
            return None;
        };
        let span = context.tree.span(kind);
        context.key = ValueKey {
            text: "type",
            span: Some(span),
        };
        let Some(word) = context.tree.text(kind) else {
            return context.expected(kind, "a word");
        };
        let known = KINDS.iter().find_map(|kind| {
            kind.words
                .iter()
                .find(|known| **known == word)
                .map(|word| (kind, *word))
        });
        let Some((kind, word)) = known else {
            left_out(word, kind, context);
            return None;
        };
        context.note_spelling(word, kind.words[0], span);
        (kind.decode)(node, context)
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let mut kinds = Vec::new();
        for ObjectKind { words, schema, .. } in KINDS {
            let schema = schema(definitions);
            kinds.extend(words.iter().map(|word| (*word, schema.clone())));
        }
        schema::tagged("type", "What kind of object this is.", &kinds)
    }
}

/// Reports an object whose type stands as a key, `- sphere:`, if it is one.
fn is_named_by_key(node: NodeId, context: &mut Context<'_>) -> bool {
    let tree = context.tree;
    let is_kind = |word: &str| KINDS.iter().any(|kind| kind.words.contains(&word));
    let named = tree
        .pairs(node)
        .find_map(|(key, value)| Some((key, value, tree.text(key).filter(|word| is_kind(word))?)));
    let Some((key, value, word)) = named else {
        return false;
    };
    let span = tree.span(key);
    let message = || format!("an object says what it is by `type: {word}`");
    let is_alone = tree.text(value) == Some("") && tree.rest_of_line(span).starts_with(':');
    let colon = Span {
        end: span.end + 1,
        ..span
    };
    context.report(&codes::MISSING_KEY, span, message, |d| {
        let d = d.at(span, "a type, and not a key");
        match is_alone {
            true => d.guess("write", colon, format!("type: {word}")),
            false => d.hint(format!(
                "write `type: {word}`, and its other keys beside that"
            )),
        }
    });
    true
}

/// Reports an object of unknown type.
fn left_out(word: &str, node: NodeId, context: &mut Context<'_>) {
    let (lenient, span) = (context.options.lenient, context.tree.span(node));
    let known = KINDS.iter().flat_map(|kind| kind.words).copied();
    let meant = nearest(word, known).map(|meant| (meant, context.in_its_quotes(node, meant)));
    context.report(
        &codes::UNKNOWN_TYPE,
        span,
        || format!("there is no type `{}`", clip(word)),
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
                    let kinds = list(KINDS.iter().map(|kind| kind.words[0]));
                    d.hint(format!(
                        "the types are {kinds}; `--lenient` leaves the object out"
                    ))
                }
            }
        },
    );
}

/// What the surfaces of an object have in common.
pub(super) struct Clothes {
    whole: Option<Span>,
    material: MaterialId,
    span: Option<Span>,
    casts_shadow: bool,
}

impl Lowering {
    /// Lowers the material of an object. `None` if it has no sound one, which is reported.
    pub(super) fn clothe(
        &mut self,
        kind: &Spanned<Text>,
        material: &Spanned<SharedValue<Material>>,
        shadow: &Spanned<bool>,
        context: &mut Context<'_>,
    ) -> Option<Clothes> {
        let id = self.material(material, context)?;
        Some(Clothes {
            whole: kind.span,
            material: id,
            span: material.span,
            casts_shadow: shadow.value,
        })
    }

    /// Clothes an object for which no material was written.
    pub(super) fn clothe_in_grey(
        &mut self,
        kind: &Spanned<Text>,
        shadow: &Spanned<bool>,
    ) -> Clothes {
        Clothes {
            whole: kind.span,
            material: self.grey(),
            span: kind.span,
            casts_shadow: shadow.value,
        }
    }

    /// Adds a surface of an object; `places` are the ways to its values in the IR, and where those
    /// were written.
    pub(super) fn put(
        &mut self,
        clothes: &Clothes,
        shape: ir::Shape,
        places: &[(&str, Option<Span>)],
    ) {
        if let Some(way) = without_size(&shape) {
            let place = places.iter().find(|(own, _)| *own == way);
            self.invisible(place.and_then(|(_, span)| *span).or(clothes.whole));
            return;
        }
        let Clothes {
            whole,
            material,
            span,
            casts_shadow,
        } = *clothes;
        let (index, kind) = (self.scene.surfaces.len(), shape.kind());
        self.scene.surfaces.push(ir::Surface {
            shape,
            material,
            casts_no_shadow: !casts_shadow,
        });
        self.origin(EntityKind::Surface, index, Field::Whole, whole);
        for (way, span) in places {
            let field = Field::of_shape(kind, way);
            self.origin(EntityKind::Surface, index, field, *span);
        }
        self.origin(EntityKind::Surface, index, Field::Material, span);
    }

    /// Remembers what has no size, where that is written: it is left out.
    fn invisible(&mut self, span: Option<Span>) {
        self.invisible.extend(span);
    }

    /// Tells of what has no size.
    pub(super) fn note_invisible(&mut self, context: &mut Context<'_>) {
        for span in std::mem::take(&mut self.invisible) {
            let message = || "an object of size 0 is invisible".to_owned();
            context.report(&codes::INVISIBLE, span, message, |d| {
                d.at(span, "left out")
                    .hint("give it a size, or remove the object")
            });
        }
    }

    /// Calls the last surface by a name.
    fn call(&mut self, name: &str) {
        let names = &mut self.scene.names;
        names.resize(self.scene.surfaces.len(), String::new());
        names
            .last_mut()
            .into_iter()
            .for_each(|last| name.clone_into(last));
    }
}

/// The way to the value of a shape that is 0 and leaves nothing to see of it.
fn without_size(shape: &ir::Shape) -> Option<&'static str> {
    let (way, size) = match shape {
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
    (size == 0.0).then_some(way)
}

/// Reports a negative length of what becomes flat faces; of others the proof says so.
fn negative(length: &Spanned<NonNegative>, word: &str, context: &mut Context<'_>) {
    if let Some(span) = length.span {
        let shown = shortest(length.value.0);
        let message = || format!("the {word} `{shown}` is not above 0");
        context.report(&codes::RADIUS, span, message, |d| {
            d.at(span, "must be above 0")
        });
    }
}
