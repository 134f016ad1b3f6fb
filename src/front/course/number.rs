//! The number types of the format.
//!
//! Each type names a range for the schema. The decoder rejects only what the IR cannot represent;
//! the validator checks ranges, because a scene need not come from text.

use super::core_schema::{ScalarNumber, is_foreign_non_finite, parse_number};
use super::decode::{Decode, DecodeContext, describe};
use super::schema::SchemaDefinitions;
use rtc_diag::clip;
use rtc_diag::codes;
use rtc_ir::Display;
use rtc_source::Span;
use rtc_source::tree::{NodeContent, NodeId};
use serde_json::{Value as Json, json};
use std::f64::consts::FRAC_PI_2;

/// The number that an unquoted scalar spells, if any; reports nothing.
pub(super) fn plain_number(node: NodeId, context: &DecodeContext<'_>) -> Option<f64> {
    match context.tree.shape(node) {
        NodeContent::Word(scalar) => match parse_number(scalar) {
            ScalarNumber::Number(value) => Some(value),
            ScalarNumber::NotFinite | ScalarNumber::NoNumber => None,
        },
        NodeContent::Text(_) | NodeContent::List | NodeContent::Map => None,
    }
}

/// Whether an unquoted scalar is a number, finite or not.
pub(super) fn is_number(scalar: &str) -> bool {
    !matches!(parse_number(scalar), ScalarNumber::NoNumber)
}

/// Reads a finite number; reports anything else.
pub(super) fn number(node: NodeId, what: &str, context: &mut DecodeContext<'_>) -> Option<f64> {
    let tree = context.tree;
    // A number is an unquoted scalar.
    let (scalar, quoted) = match tree.shape(node) {
        NodeContent::Word(scalar) => (scalar, false),
        NodeContent::Text(text) => (text, true),
        NodeContent::List | NodeContent::Map => return context.expected(node, what),
    };
    let (key, span) = (context.key, tree.span(node));
    match parse_number(scalar) {
        ScalarNumber::NoNumber if !quoted && is_foreign_non_finite(scalar) => {
            not_finite(scalar, span, context);
            None
        }
        ScalarNumber::Number(_) | ScalarNumber::NotFinite if quoted => {
            let message = || {
                format!(
                    "`{}` must be {what}, not {}",
                    clip(key.text),
                    describe(tree.shape(node))
                )
            };
            context.report(&codes::WRONG_TYPE, span, message, |d| {
                d.at(span, "a string, because of the quotes").replace(
                    "remove the quotes",
                    span,
                    scalar,
                )
            });
            None
        }
        ScalarNumber::Number(value) => Some(value),
        ScalarNumber::NotFinite => {
            not_finite(scalar, span, context);
            None
        }
        ScalarNumber::NoNumber if what.starts_with("a number") => context.expected(node, what),
        ScalarNumber::NoNumber => context.expected_as(node, what, "a number"),
    }
}

fn not_finite(scalar: &str, span: Span, context: &mut DecodeContext<'_>) {
    let key = context.key;
    let message = || format!("`{}` is not finite: `{}`", clip(key.text), clip(scalar));
    context.report(&codes::NOT_FINITE, span, message, |d| {
        d.at(span, "not a finite number")
    });
}

/// Reads an integer of at most `max`. An integer that is larger or negative is reported and
/// replaced by `min`.
///
/// An integer from 0 to `min` is lowered as it is; the validator rejects it.
pub(super) fn integer(
    min: u32,
    max: u32,
    node: NodeId,
    context: &mut DecodeContext<'_>,
) -> Option<u32> {
    let value = number(node, "a whole number", context)?;
    #[expect(
        clippy::float_cmp,
        reason = "a whole number equals its truncation exactly"
    )]
    if value != value.trunc() {
        return context.expected(node, "a whole number");
    }
    if value < 0.0 {
        return out_of_range(&format!("at least {min}"), min, node, context);
    } else if value > f64::from(max) {
        return out_of_range(&format!("at most {max}"), min, node, context);
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it was brought into the range of u32"
    )]
    Some(value as u32)
}

/// Reports a number out of its range; returns what to read instead, if that is an error.
fn out_of_range<T>(
    range: &str,
    instead: T,
    node: NodeId,
    context: &mut DecodeContext<'_>,
) -> Option<T> {
    let (tree, key) = (context.tree, context.key);
    let (span, scalar) = (tree.span(node), tree.text(node).unwrap_or_default());
    let message = || {
        format!(
            "`{}` must be {range}, not `{}`",
            clip(key.text),
            clip(scalar)
        )
    };
    context.report(&codes::OUT_OF_RANGE, span, message, |d| {
        d.at(span, "out of range")
    });
    (!context.is_tolerant()).then_some(instead)
}

/// Warns of an angle in degrees that is probably in radians.
fn report_likely_radians(angle: f64, node: NodeId, context: &mut DecodeContext<'_>) {
    let degrees = (angle.to_degrees() * 100.0).round() / 100.0;
    let message = |key: &str| format!("`{}` is in degrees, and looks like radians", clip(key));
    report_other_unit(message, format!("{degrees}"), node, context);
}

/// Warns of an angle in radians that is probably in degrees: above one revolution and a multiple of
/// 5.
pub(super) fn radians(angle: f64, node: NodeId, context: &mut DecodeContext<'_>) -> f64 {
    if angle.abs() > std::f64::consts::TAU && angle % 5.0 == 0.0 {
        let radians = (angle.to_radians() * 10_000.0).round() / 10_000.0;
        let message = |key: &str| format!("`{}` is in radians, and looks like degrees", clip(key));
        report_other_unit(message, format!("{radians}"), node, context);
    }
    angle
}

fn report_other_unit(
    message: impl FnOnce(&str) -> String,
    replacement: String,
    node: NodeId,
    context: &mut DecodeContext<'_>,
) {
    let (key, span) = (context.key, context.tree.span(node));
    context.report(
        &codes::OTHER_UNIT,
        span,
        || message(key.text),
        |d| {
            d.at(span, "used unchanged")
                .guess("in the other unit", span, replacement)
        },
    );
}

/// The shortest JSON of a number; integers have no decimal point.
pub(super) fn json_number(value: f64) -> Json {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "only whole numbers below 2^53 pass"
    )]
    if value.fract() == 0.0 && value.abs() < 9e15 {
        json!(value as i64)
    } else {
        json!(value)
    }
}

/// Declares a type of the format: a number in a range.
macro_rules! ranged {
    ($(#[doc = $doc:literal])+ $name:ident($inner:ty), $decode:expr, $schema:tt) => {
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $name(pub(crate) $inner);

        impl Decode for $name {
            fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
                let decode: fn(NodeId, &mut DecodeContext<'_>) -> Option<$inner> = $decode;
                decode(node, context).map(Self)
            }

            fn schema(_: &mut SchemaDefinitions) -> Json {
                json!($schema)
            }

            fn json(&self) -> Json {
                json_number(f64::from(self.0))
            }
        }

        impl From<$inner> for $name {
            fn from(number: $inner) -> Self {
                Self(number)
            }
        }
    };
}

pub(super) use ranged;

ranged! {
    /// Any finite number.
    Real(f64), |node, context| number(node, "a number", context), { "type": "number" }
}

ranged! {
    /// A field of view in degrees.
    FieldOfView(f64), |node, context| {
        let degrees = number(node, "a number", context)?;
        if degrees <= 0.0 || degrees >= 180.0 {
            return out_of_range("above 0 and below 180", 90.0, node, context);
        }
        if degrees < std::f64::consts::PI {
            report_likely_radians(degrees, node, context);
        }
        Some(degrees)
    }, { "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180, "x-unit": "degrees" }
}

ranged! {
    /// An angle in degrees.
    Degrees(f64), |node, context| {
        let degrees = number(node, "a number", context)?;
        if degrees.fract() != 0.0 && degrees.abs() <= std::f64::consts::TAU {
            report_likely_radians(degrees, node, context);
        }
        Some(degrees)
    }, { "type": "number", "x-unit": "degrees" }
}

ranged! {
    /// A number of at least 0.
    NonNegative(f64), |node, context| number(node, "a number", context),
    { "type": "number", "minimum": 0 }
}

ranged! {
    /// A number above 0.
    Positive(f64), |node, context| number(node, "a number", context),
    { "type": "number", "exclusiveMinimum": 0 }
}

ranged! {
    /// An integer of at least 0.
    Natural(u32), |node, context| integer(0, u32::MAX, node, context),
    { "type": "integer", "minimum": 0, "maximum": 4_294_967_295_u32 }
}

ranged! {
    /// An integer of at least 1.
    Count(u32), |node, context| integer(1, u32::MAX, node, context),
    { "type": "integer", "minimum": 1, "maximum": 4_294_967_295_u32 }
}

ranged! {
    /// An angle in radians of at most π/2.
    HalfAngle(f64), |node, context| {
        number(node, "a number", context).map(|angle| radians(angle, node, context))
    }, { "type": "number", "exclusiveMinimum": 0, "maximum": FRAC_PI_2, "x-unit": "radians" }
}

ranged! {
    /// An exposure in stops.
    Stops(f64), |node, context| {
        const MOST: f64 = Display::MOST_STOPS;
        let stops = number(node, "a number", context)?;
        if !(-MOST..=MOST).contains(&stops) {
            return out_of_range("from -64 to 64", 0.0, node, context);
        }
        Some(stops)
    }, { "type": "number", "minimum": -64, "maximum": 64, "x-unit": "stops" }
}

/// The largest width or height of an image.
const MAX_SIDE: u32 = 65_535;

ranged! {
    /// The width or height of an image in pixels.
    PixelCount(u32), |node, context| integer(1, MAX_SIDE, node, context),
    { "type": "integer", "minimum": 1, "maximum": MAX_SIDE, "x-unit": "pixels" }
}
