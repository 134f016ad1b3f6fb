//! The objects, told apart by their `type`: the table of types, and what all of them share.

use super::cone::Cone;
use super::cylinder::Cylinder;
use super::decode::{Context, SharedValue, Spanned, Value, ValueKey};
use super::disc::Disc;
use super::gltf::Gltf;
use super::lower::Lowering;
use super::material::Material;
use super::mesh::Mesh;
use super::plane::{BoundedPlane, Plane};
use super::quad::Quad;
use super::reader::{look_up, missing_keys};
use super::record::Record;
use super::schema::{self, Definitions};
use super::solid::{Cuboid, Prism, Tetrahedron};
use super::spelling::{list, nearest};
use super::sphere::Sphere;
use super::torus::Torus;
use super::triangle::Triangle;
use super::value::Text;
use crate::diag::clip;
use crate::diag::{Severity, codes};
use crate::ir::{self, Field, MaterialId, Noun};
use crate::source::Span;
use crate::source::tree::NodeId;
use serde_json::Value as Json;

/// A type of object: the words for it, the canonical one first, and its declaration.
pub(super) struct ObjectKind {
    pub(super) words: &'static [&'static str],
    pub(super) record: &'static Record,
    decode: fn(NodeId, &mut Context<'_>) -> Option<Object>,
    schema: fn(&mut Definitions) -> Json,
}

/// Declares the types of objects: the record and the words for it.
macro_rules! kinds {
    ($($record:ident $($word:literal)+;)+) => {
        /// An object of any type.
        pub(super) enum Object {
            $($record($record)),+
        }

        /// The types there are.
        pub(super) const KINDS: &[ObjectKind] = &[$(ObjectKind {
            words: &[$($word),+],
            record: &$record::RECORD,
            decode: |node, context| $record::decode(node, context).map(Object::$record),
            schema: $record::schema,
        }),+];
    };
}

kinds! {
    Sphere "sphere";
    Plane "plane";
    Triangle "triangle";
    Quad "quad" "quadrilateral";
    Disc "circle" "disc" "disk";
    Cylinder "cylinder";
    Cone "cone";
    Torus "torus";
    Cuboid "box";
    Tetrahedron "tetrahedron";
    Prism "prism";
    Mesh "mesh" "model" "OBJModel" "triangleMesh" "triangleAggregate";
    BoundedPlane "bplane";
    Gltf "gltf";
}

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
            left_out(word, span, context);
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
fn left_out(word: &str, span: Span, context: &mut Context<'_>) {
    let lenient = context.options.lenient;
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
            let known = KINDS.iter().flat_map(|kind| kind.words).copied();
            match nearest(word, known) {
                Some(meant) => d.replace(format!("did you mean `{meant}`?"), span, meant),
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
}

impl Lowering {
    /// Lowers an object; one without a sound material or form is left out, and the sink has an
    /// error.
    pub(super) fn object(&mut self, object: &Object, context: &mut Context<'_>) {
        match object {
            Object::Sphere(sphere) => self.sphere(sphere, context),
            Object::Plane(plane) => self.plane(plane),
            Object::Triangle(triangle) => self.triangle(triangle),
            Object::Quad(quad) => self.quad(quad),
            Object::Disc(disc) => self.disc(disc),
            Object::Cylinder(cylinder) => self.cylinder(cylinder),
            Object::Cone(cone) => self.cone(cone),
            Object::Torus(torus) => self.torus(torus),
            Object::Cuboid(cuboid) => self.cuboid(cuboid, context),
            Object::Tetrahedron(tetrahedron) => self.tetrahedron(tetrahedron, context),
            Object::Prism(prism) => self.prism(prism, context),
            Object::Mesh(mesh) => self.mesh(mesh, context),
            Object::BoundedPlane(plane) => self.bounded_plane(plane, context),
            Object::Gltf(gltf) => self.gltf(gltf),
        }
    }

    /// Lowers the material of an object. `None` if it has no sound one, which is reported.
    pub(super) fn clothe(
        &mut self,
        kind: &Spanned<Text>,
        material: &Spanned<SharedValue<Material>>,
    ) -> Option<Clothes> {
        let id = self.material(material)?;
        Some(Clothes {
            whole: kind.span,
            material: id,
            span: material.span,
        })
    }

    /// Clothes an object for which no material was written.
    pub(super) fn clothe_in_grey(&mut self, kind: &Spanned<Text>) -> Clothes {
        Clothes {
            whole: kind.span,
            material: self.grey(),
            span: kind.span,
        }
    }

    /// Adds a surface of an object.
    pub(super) fn put(
        &mut self,
        clothes: &Clothes,
        shape: ir::Shape,
        places: &[(Field, Option<Span>)],
    ) {
        let Clothes {
            whole,
            material,
            span,
        } = *clothes;
        let index = self.scene.surfaces.len();
        self.scene.surfaces.push(ir::Surface { shape, material });
        self.origin(Noun::Surface, index, Field::Whole, whole);
        for (field, span) in places {
            self.origin(Noun::Surface, index, *field, *span);
        }
        self.origin(Noun::Surface, index, Field::Material, span);
    }
}
