//! What parameters of a `standard` material are written as: parts of a whole, pairs, the alpha mode.

use super::super::decode::{Context, Spanned, Value};
use super::super::number::{NonNegative, Real, json_number, number, ranged, whole};
use super::super::record::{keys, record};
use super::super::schema::Definitions;
use super::super::value::{Color, tuple};
use super::super::word::{word, word_schema};
use super::Alpha;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

ranged! {
    /// The number of a set of texture coordinates.
    SetIndex(u32), |node, context| whole(0, 1, node, context), { "type": "integer", "minimum": 0, "maximum": 1 }
}

ranged! {
    /// A part of a whole.
    Fraction(f64), |node, context| number(node, "a number", context),
    { "type": "number", "minimum": 0, "maximum": 1 }
}

ranged! {
    /// An index of refraction.
    Refraction(f64), |node, context| number(node, "a number", context), { "type": "number", "minimum": 1 }
}

ranged! {
    /// An index of refraction, or 0 for a surface that mirrors all light.
    RefractionOrNone(f64), |node, context| number(node, "a number", context),
    { "anyOf": [{ "const": 0 }, { "type": "number", "minimum": 1 }] }
}

/// Declares a few numbers in a range as a type of the format.
macro_rules! numbers {
    ($(#[doc = $doc:literal])+ $name:ident, $count:literal, $what:literal, $item:tt) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name(pub(super) [f64; $count]);

        impl Value for $name {
            const IS_LIST: bool = true;

            fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
                tuple(node, $what, context, |node, context| number(node, $what, context)).map(Self)
            }

            fn schema(_: &mut Definitions) -> Json {
                json!({ "type": "array", "items": $item, "minItems": $count, "maxItems": $count })
            }

            fn json(&self) -> Json {
                self.0.map(json_number).to_vec().into()
            }
        }

        impl From<[f64; $count]> for $name {
            fn from(numbers: [f64; $count]) -> Self {
                Self(numbers)
            }
        }
    };
}

numbers! {
    /// Red, green and blue, each from 0 to 1.
    Tint, 3, "a list of three numbers", { "type": "number", "minimum": 0, "maximum": 1 }
}

numbers! {
    /// Red, green, blue and another channel, each from 0 to 1.
    Rgba, 4, "a list of four numbers", { "type": "number", "minimum": 0, "maximum": 1 }
}

numbers! {
    /// The least and the greatest, each at least 0.
    Pair, 2, "a list of two numbers", { "type": "number", "minimum": 0 }
}

/// Lets defaults of the table be shown as they are written.
macro_rules! shown {
    ($($name:ident)+) => {
        $(impl From<f64> for $name {
            fn from(number: f64) -> Self {
                Self(number)
            }
        })+
    };
}

shown!(Fraction NonNegative Real Refraction RefractionOrNone);

impl From<[f64; 3]> for Color {
    fn from(channels: [f64; 3]) -> Self {
        Self(channels)
    }
}

/// How much of the background a surface covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaMode(pub(super) Alpha);

impl From<Alpha> for AlphaMode {
    fn from(alpha: Alpha) -> Self {
        Self(alpha)
    }
}

/// The words for alpha modes; `mask` has the cutoff of glTF.
const MODES: &[(&str, Alpha)] = &[
    ("opaque", Alpha::Opaque),
    ("mask", Alpha::Mask(0.5)),
    ("blend", Alpha::Blend),
];

record! {
    /// A surface that covers all where its alpha is at least the cutoff, and nothing elsewhere.
    struct Mask, "alpha mask" {
        /// The cutoff.
        mask: Spanned<NonNegative>, required, keys!["mask"];
    }
}

impl Value for AlphaMode {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            let mask = Mask::decode(node, context)?;
            return Some(Self(Alpha::Mask(mask.mask.value.0)));
        }
        word(node, MODES, context).map(Self)
    }

    fn schema(definitions: &mut Definitions) -> Json {
        let mut schema = word_schema(MODES);
        let forms = schema["anyOf"].as_array_mut();
        let mask = Mask::schema(definitions);
        forms.into_iter().for_each(|forms| forms.push(mask.clone()));
        schema
    }

    fn json(&self) -> Json {
        let word = MODES.iter().find(|(_, alpha)| *alpha == self.0);
        word.map_or(Json::Null, |(word, _)| json!(word))
    }
}
