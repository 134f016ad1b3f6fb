//! How things are turned: by quaternions, and by rotations that `--lenient` may leave out.

use super::decode::{Context, Value};
use super::number::{number, plain_number};
use super::schema::Definitions;
use super::value::tuple;
use rtc_diag::{Severity, clip, codes};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// How something is turned: a quaternion (x, y, z, w) of any length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quaternion(pub(super) [f64; 4]);

impl Value for Quaternion {
    const IS_LIST: bool = true;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        const WHAT: &str = "a list of four numbers";
        tuple(node, WHAT, context, |node, context| {
            number(node, WHAT, context)
        })
        .map(Self)
    }

    fn schema(_: &mut Definitions) -> Json {
        json!({ "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4 })
    }
}

/// Declares vectors that stand one after another in one list, as a type of the format.
macro_rules! matrix {
    ($(#[doc = $doc:literal])+ $name:ident, $count:literal, $columns:literal, $what:literal) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name(pub(super) [[f64; 3]; $columns]);

        impl Value for $name {
            const IS_LIST: bool = true;

            fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
                let numbers: [f64; $count] =
                    tuple(node, $what, context, |node, context| number(node, $what, context))?;
                let vectors = numbers.as_chunks::<3>().0;
                Some(Self(std::array::from_fn(|at| vectors[at])))
            }

            fn schema(_: &mut Definitions) -> Json {
                let item = json!({ "type": "number", "minimum": -1e60, "maximum": 1e60 });
                json!({ "type": "array", "items": item, "minItems": $count, "maxItems": $count })
            }
        }
    };
}

matrix! {
    /// The rows of a rotation.
    RotationRows, 9, 3, "a list of nine numbers"
}

matrix! {
    /// The columns of an affine map: the images of the three axes, and that of the origin.
    AffineColumns, 12, 4, "a list of twelve numbers"
}

matrix! {
    /// The rows of an affine map of the plane: (a, b, c) for a·u + b·v + c.
    PlaneRows, 6, 2, "a list of six numbers"
}

/// A rotation; none where `--lenient` leaves out one that is written in an unknown way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation<T>(pub(super) Option<T>);

impl<T: Value> Value for Rotation<T> {
    const IS_LIST: bool = T::IS_LIST;

    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        let tree = context.tree;
        let is_known = tree.is_list(node)
            && tree.items(node).take(4).count() == 3
            && tree
                .items(node)
                .all(|item| plain_number(item, context).is_some());
        if is_known || !context.options.lenient {
            return T::decode(node, context).map(|rotation| Self(Some(rotation)));
        }
        let (key, span) = (context.key, tree.span(node));
        let message = || format!("`{}` is written in an unknown way", clip(key.text));
        context.report(&codes::NO_EFFECT, span, message, |d| {
            d.at(span, "left out: nothing is turned")
                .severity(Severity::Warning)
                .hint("here it is a list of three numbers")
        });
        Some(Self(None))
    }

    fn schema(definitions: &mut Definitions) -> Json {
        T::schema(definitions)
    }

    fn json(&self) -> Json {
        self.0.as_ref().map_or(Json::Null, Value::json)
    }
}
