//! Why a value can't be decoded, in the words of `serde_json`.

use super::Fields;
use rtc_source::tree::NodeId;
use serde::de::{self, Expected, Unexpected};
use std::fmt::{self, Display, Formatter};

/// Why a value can't be decoded.
#[derive(Debug)]
pub(super) struct Error {
    /// What is wrong.
    pub(super) what: String,
    /// Where, once that is known.
    pub(super) at: Option<NodeId>,
    /// The field that is missing, and those of its struct, once these are known.
    pub(super) missing: Option<(Fields, &'static str)>,
}

impl Error {
    /// The error, which came of a node unless it is known to have come of another.
    pub(super) fn at(self, node: Option<NodeId>) -> Self {
        Self {
            at: self.at.or(node),
            // What has no fields of its own is no struct, and is refused as a whole.
            missing: self.missing.filter(|(fields, _)| !fields.is_empty()),
            ..self
        }
    }

    /// The error, which came of a struct with these fields unless it came of another.
    pub(super) fn of(mut self, fields: Fields) -> Self {
        if let Some((own, _)) = self.missing.as_mut().filter(|(own, _)| own.is_empty()) {
            *own = fields;
        }
        self
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)
    }
}

impl std::error::Error for Error {}

impl de::Error for Error {
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
            Json(found)
        ))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!(
            "invalid value: {}, expected {expected}",
            Json(found)
        ))
    }

    fn missing_field(name: &'static str) -> Self {
        Self {
            missing: Some((&[], name)),
            ..Self::custom(format_args!("missing field `{name}`"))
        }
    }
}

/// What was found, as `serde_json` calls it.
struct Json<'a>(Unexpected<'a>);

impl Display for Json<'_> {
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
