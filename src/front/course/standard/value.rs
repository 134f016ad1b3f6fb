//! The value types of a `standard` material: fractions, ranges, alpha modes.

use super::super::decode::{Decode, DecodeContext, Spanned};
use super::super::keyword::{Keyword, KeywordTable, keyword, keyword_schema};
use super::super::number::{NonNegative, integer, json_number, number, ranged};
use super::super::record::record;
use super::super::schema::SchemaDefinitions;
use super::super::value::{Color, numbers, tuple};
use super::Alpha;
use rtc_ir::Conductor;
use rtc_math::{Microfacets, Plastic};
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};
use std::sync::LazyLock;

ranged! {
    /// The index of a set of texture coordinates.
    SetIndex(u32), |node, context| integer(0, 1, node, context),
    { "type": "integer", "minimum": 0, "maximum": 1 }
}

ranged! {
    /// A part of a integer.
    Fraction(f64), |node, context| number(node, "a number", context),
    { "type": "number", "minimum": 0, "maximum": 1 }
}

ranged! {
    /// An index of refraction.
    Refraction(f64), |node, context| number(node, "a number", context),
    { "type": "number", "minimum": 1 }
}

ranged! {
    /// An index of refraction, or 0 for a surface that reflects all light.
    RefractionOrNone(f64), |node, context| number(node, "a number", context),
    { "anyOf": [{ "const": 0 }, { "type": "number", "minimum": 1 }] }
}

numbers! {
    /// Red, green and blue, each from 0 to 1.
    FractionColor, 3, "a list of three numbers", { "type": "number", "minimum": 0, "maximum": 1 }
}

numbers! {
    /// Red, green, blue and a fourth channel, each from 0 to 1.
    Rgba, 4, "a list of four numbers", { "type": "number", "minimum": 0, "maximum": 1 }
}

numbers! {
    /// A minimum and a maximum, each at least 0.
    Range, 2, "a list of two numbers", { "type": "number", "minimum": 0 }
}

/// The alpha mode of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaMode(pub(super) Alpha);

impl From<Alpha> for AlphaMode {
    fn from(alpha: Alpha) -> Self {
        Self(alpha)
    }
}

/// The keywords of alpha modes; `mask` has the default cutoff of glTF.
const ALPHA_MODES: KeywordTable<Alpha> = &[
    ("opaque", Alpha::Opaque, "Alpha has no effect."),
    (
        "mask",
        Alpha::Mask(0.5),
        "Opaque where alpha is at least 0.5, invisible elsewhere.",
    ),
    ("blend", Alpha::Blend, "As opaque as alpha says."),
];

record! {
    /// An alpha mask: the surface is opaque if its alpha is at least the cutoff, and invisible
    /// otherwise.
    struct Mask, "alpha mask" {
        /// The cutoff.
        mask: Spanned<NonNegative>, required, &[&["mask"]];
    }
}

impl Decode for AlphaMode {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            let mask = Mask::decode(node, context)?;
            return Some(Self(Alpha::Mask(mask.mask.value.0)));
        }
        keyword(node, ALPHA_MODES, context).map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let mut schema = keyword_schema(ALPHA_MODES);
        let variants = schema["anyOf"].as_array_mut();
        let mask = Mask::schema(definitions);
        variants
            .into_iter()
            .for_each(|variants| variants.push(mask.clone()));
        schema
    }

    fn json(&self) -> Json {
        let keyword = ALPHA_MODES.iter().find(|(_, alpha, _)| *alpha == self.0);
        keyword.map_or(Json::Null, |(keyword, ..)| json!(keyword))
    }
}

impl Keyword for Microfacets {
    const KEYWORDS: KeywordTable<Self> = Self::KEYWORDS;
}

impl Keyword for Plastic {
    const KEYWORDS: KeywordTable<Self> = Self::KEYWORDS;
}

/// The complex index of a conductor: the name of a metal, or numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConductorIndex(pub(super) Conductor);

/// The metals that have a name.
static METALS: LazyLock<Vec<(&str, Conductor, &str)>> = LazyLock::new(|| {
    let named = rtc_tables::METALS.iter().filter_map(|metal| {
        let rtc_tables::Metal {
            symbol,
            name,
            eta,
            k,
        } = *metal;
        let meaning: &str = format!("The metal {symbol}.").leak();
        Some((name?, Conductor { eta, k }, meaning))
    });
    named.collect()
});

record! {
    /// The complex index of refraction η + i·k of a conductor.
    struct ComplexNumbers, "complex index" {
        /// η at red, green and blue.
        eta: Spanned<Color>, required, &[&["eta"]];
        /// k at red, green and blue.
        k: Spanned<Color>, required, &[&["k"]];
    }
}

impl Decode for ConductorIndex {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            let ComplexNumbers { eta, k } = ComplexNumbers::decode(node, context)?;
            let [eta, k] = [eta, k].map(|written| written.value.0);
            return Some(Self(Conductor { eta, k }));
        }
        keyword(node, &METALS, context).map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let mut schema = keyword_schema(&METALS);
        let variants = schema["anyOf"].as_array_mut();
        let numbers = ComplexNumbers::schema(definitions);
        variants
            .into_iter()
            .for_each(|variants| variants.push(numbers.clone()));
        schema
    }
}
