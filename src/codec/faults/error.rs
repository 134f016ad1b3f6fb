//! Decoding errors, with the wording of `serde_json`.

use super::FieldNames;
use rtc_source::tree::NodeId;
use serde::de::{self, Expected, Unexpected};
use std::fmt::{self, Display, Formatter};

/// A decoding error.
#[derive(Debug)]
pub(super) struct NodeError {
    /// The message.
    pub(super) what: String,
    /// The node, if known.
    pub(super) at: Option<NodeId>,
    /// The missing field and the fields of its struct, if known.
    pub(super) missing: Option<(FieldNames, &'static str)>,
}

impl NodeError {
    /// Sets the node, unless it is already set.
    pub(super) fn at(self, node: Option<NodeId>) -> Self {
        Self {
            at: self.at.or(node),
            // A type without fields is not a struct; it is rejected as a whole.
            missing: self.missing.filter(|(fields, _)| !fields.is_empty()),
            ..self
        }
    }

    /// Sets the fields of the struct, unless they are already set.
    pub(super) fn of(mut self, fields: FieldNames) -> Self {
        if let Some((known, _)) = self.missing.as_mut().filter(|(known, _)| known.is_empty()) {
            *known = fields;
        }
        self
    }
}

impl Display for NodeError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl std::error::Error for NodeError {}

impl de::Error for NodeError {
    fn custom<T: Display>(what: T) -> Self {
        Self {
            what: what.to_string(),
            at: None,
            missing: None,
        }
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!(
            "invalid type: {}, expected {expected}",
            FoundJsonValue(found)
        ))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!(
            "invalid value: {}, expected {expected}",
            FoundJsonValue(found)
        ))
    }

    fn missing_field(name: &'static str) -> Self {
        Self {
            missing: Some((&[], name)),
            ..Self::custom(format_args!("missing field `{name}`"))
        }
    }
}

/// The value that was found, as `serde_json` names it.
struct FoundJsonValue<'a>(Unexpected<'a>);

impl Display for FoundJsonValue<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Unexpected::Unit = self.0 {
            f.write_str("null")
        } else if let Unexpected::Float(value) = self.0
            && let Some(number) = serde_json::Number::from_f64(value)
        {
            write!(f, "floating point `{number}`")
        } else {
            Display::fmt(&self.0, f)
        }
    }
}
