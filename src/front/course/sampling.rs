//! Supersampling: the number and the positions of the rays of a pixel.

use super::decode::{Decode, DecodeContext, Spanned};
use super::keyword::{Keyword, KeywordTable};
use super::number::{Count, is_number, plain_number};
use super::record::record;
use super::schema::SchemaDefinitions;
use rtc_diag::codes;
use rtc_ir as ir;
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};

record! {
    /// The number and the positions of the rays of a pixel.
    struct SamplingMap, "`SuperSampling` map" {
        /// The number of rays along each side of a pixel; 1 by default.
        factor: Spanned<Count>, optional, &[&["factor"]];
        /// The position of each ray: `grid` in the middle of its cell of the pixel, `jitter`
        /// anywhere in its cell, `random` anywhere in the pixel.
        pattern: Spanned<ir::Pattern>, default(ir::Pattern::Grid), &[&["pattern"]], own true;
    }
}

impl Keyword for ir::Pattern {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "grid",
            ir::Pattern::Grid,
            "In the middle of its cell of the pixel.",
        ),
        (
            "jitter",
            ir::Pattern::Jitter,
            "Anywhere in its cell of the pixel.",
        ),
        ("random", ir::Pattern::Random, "Anywhere in the pixel."),
    ];
}

/// The number of rays along the side of a pixel for `AntiAlias: true`.
const DEFAULT_FACTOR: u32 = 2;

/// The number of rays along the side of a pixel: a number, a map or a boolean.
#[derive(Clone, Copy, Debug)]
pub(super) struct SuperSampling {
    pub(super) factor: Count,
    /// The span of the factor.
    pub(super) factor_span: Option<Span>,
    pub(super) pattern: ir::Pattern,
}

impl SuperSampling {
    /// One ray in the middle of the pixel.
    pub(super) const ONE: Self = Self {
        factor: Count(1),
        factor_span: None,
        pattern: ir::Pattern::Grid,
    };
}

impl Decode for SuperSampling {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        match context.tree.shape(node) {
            NodeContent::Map => {
                let key = context.key.span;
                let SamplingMap { factor, pattern } = SamplingMap::decode(node, context)?;
                if factor.is_absent() {
                    report_no_factor(key.unwrap_or_else(|| context.head(node)), context);
                }
                let factor = factor.ok().unwrap_or(Spanned::without_span(Count(1)));
                Some(Self {
                    factor: factor.value,
                    factor_span: factor.span,
                    pattern: pattern.value,
                })
            }
            NodeContent::Word(scalar)
                if is_boolean_word(scalar) && plain_number(node, context).is_none() =>
            {
                bool::decode(node, context).map(|boolean| factor_of_switch(boolean, node, context))
            }
            NodeContent::Word(scalar) if !is_number(scalar) => {
                context.expected(node, "a whole number, or a map of `factor` and `pattern`")
            }
            NodeContent::Word(_) | NodeContent::Text(_) | NodeContent::List => {
                let factor_span = Some(context.tree.span(node));
                Count::decode(node, context).map(|factor| Self {
                    factor,
                    factor_span,
                    ..Self::ONE
                })
            }
        }
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let boolean = json!({ "type": "boolean", "deprecated": true });
        json!({ "anyOf": [Count::schema(definitions), SamplingMap::schema(definitions), boolean] })
    }

    fn json(&self) -> Json {
        self.factor.json()
    }
}

/// Reports a map without the number of rays.
fn report_no_factor(span: Span, context: &mut DecodeContext<'_>) {
    let message = || "`SuperSampling` has no `factor`: a pixel has one ray".to_owned();
    context.report(&codes::ASSUMED, span, message, |d| {
        d.at(span, "1 × 1 rays per pixel")
            .hint("`factor: 2` is two along each side of a pixel")
    });
}

/// Whether a scalar is a boolean of YAML 1.2 or 1.1.
fn is_boolean_word(scalar: &str) -> bool {
    ["true", "false", "on", "off", "yes", "no"]
        .iter()
        .any(|boolean| boolean.eq_ignore_ascii_case(scalar))
}

/// The number of rays in a file that only switches supersampling on or off.
fn factor_of_switch(boolean: bool, node: NodeId, context: &mut DecodeContext<'_>) -> SuperSampling {
    if !boolean {
        return SuperSampling::ONE;
    }
    let span = context.tree.span(node);
    let message = || format!("`true` is not a number of rays: read as {DEFAULT_FACTOR}");
    context.report(&codes::ASSUMED, span, message, |d| {
        d.at(
            span,
            format!("{DEFAULT_FACTOR} × {DEFAULT_FACTOR} rays per pixel"),
        )
        .replace(
            "write how many along each side",
            span,
            DEFAULT_FACTOR.to_string(),
        )
    });
    SuperSampling {
        factor: Count(DEFAULT_FACTOR),
        ..SuperSampling::ONE
    }
}
