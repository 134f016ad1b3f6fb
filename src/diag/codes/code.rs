//! One row of the table of codes, and how a family declares its rows.

use std::fmt;

/// The severity of a diagnostic. Only errors stop the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The input is rejected.
    Error,
    /// The picture is probably not the one that was meant.
    Warning,
    /// Information; printed with `-v`.
    Note,
}

impl Severity {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// One row of the table.
#[derive(Debug, PartialEq, Eq)]
pub struct Code {
    /// Family and number, as `VA003`.
    pub id: &'static str,
    /// The severity unless an option changes it.
    pub severity: Severity,
    /// One line: the error.
    pub summary: &'static str,
    /// The codes of Khronos' glTF validator for it; empty outside `GL`.
    pub aliases: &'static [&'static str],
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

/// Declares a family: a static for each row, `$family`, a list of all rows in order, and their
/// pages.
macro_rules! codes {
    ($family:ident: $($name:ident = $id:literal, $severity:ident, $summary:literal
        $(, [$($alias:literal),*])?;)*) => {
        $(
            #[doc = $summary]
            pub static $name: $crate::Code = $crate::Code {
                id: $id,
                severity: $crate::Severity::$severity,
                summary: $summary,
                aliases: &[$($($alias),*)?],
            };
        )*
        /// The rows of this family, in order.
        pub static $family: &[&$crate::Code] = &[$(&$name),*];

        /// The page of a code of this family.
        pub(super) fn page(id: &str) -> Option<&'static str> {
            match id {
                $($id => Some(include_str!(concat!("pages/", $id, ".md"))),)*
                _ => None,
            }
        }
    };
}
pub(super) use codes;
