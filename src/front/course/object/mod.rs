//! The objects, told apart by their `type`: the table of types, and what all of them share.

mod cone;
mod cube;
mod cylinder;
mod disc;
mod gltf;
pub(super) mod mesh;
mod paraboloid;
mod plane;
mod quad;
pub(super) mod solid;
mod sphere;
mod torus;
mod triangle;

use super::decode::{Context, SharedValue, Spanned, Value, ValueKey};
use super::lower::Lowering;
use super::material::Material;
use super::reader::{look_up, missing_keys};
use super::record::Record;
use super::schema::{self, Definitions};
use super::spelling::list;
use super::value::Text;
use rtc_diag::clip;
use rtc_diag::{Severity, codes, nearest};
use rtc_ir::{self as ir, Field, MaterialId, Noun};
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
        self.origin(Noun::Surface, index, Field::Whole, whole);
        for (way, span) in places {
            let field = Field::of_shape(kind, way);
            self.origin(Noun::Surface, index, field, *span);
        }
        self.origin(Noun::Surface, index, Field::Material, span);
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
