//! The table of codes, one row each, in families that are the passes; a code is stable for ever.
//!
//! `IO` files, `SY` YAML syntax, `SC` shape and keys, `RE` files named by a scene, `VA` values,
//! `GL` glTF, `IR` the container, `RD` what a render found, `EX` what is written for other renderers.

use std::fmt;

mod container;
mod files;
mod gltf;
mod picture;
mod references;
mod shape;
mod syntax;
mod exports;
mod values;

pub use container::*;
pub use files::*;
pub use gltf::*;
pub use picture::*;
pub use references::*;
pub use shape::*;
pub use syntax::*;
pub use exports::*;
pub use values::*;

/// How bad it is. Only errors stop the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The input is refused.
    Error,
    /// Probably not what was meant.
    Warning,
    /// Worth knowing, shown with `-v`.
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
    /// One line: what the finding is.
    pub summary: &'static str,
    /// The page of `rtc explain`, in Markdown: what the code finds, why it matters, an example that
    /// raises it and the same example without the mistake.
    pub page: &'static str,
    /// The names that the glTF validator of Khronos has for it; none outside `GL`.
    pub aliases: &'static [&'static str],
}

impl Code {
    /// The first paragraph of the page: what the code finds.
    #[must_use]
    pub fn explanation(&self) -> &'static str {
        self.page.split("\n\n").next().unwrap_or_default()
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

/// Declares a family: a static for each row, and `FAMILY`, all of them in order.
macro_rules! codes {
    ($family:ident: $($name:ident = $id:literal, $severity:ident, $summary:literal
        $(, [$($alias:literal),*])?;)*) => {
        $(
            #[doc = $summary]
            pub static $name: $crate::Code = $crate::Code {
                id: $id,
                severity: $crate::Severity::$severity,
                summary: $summary,
                page: include_str!(concat!("pages/", $id, ".md")),
                aliases: &[$($($alias),*)?],
            };
        )*
        /// The rows of this family, in order.
        pub static $family: &[&$crate::Code] = &[$(&$name),*];
    };
}
use codes;

/// Every code there is, family by family.
pub fn all() -> impl Iterator<Item = &'static Code> {
    [IO, SY, SC, RE, VA, GL, IR, RD, EX]
        .into_iter()
        .flatten()
        .copied()
}

/// The code with the id given, in any case.
#[must_use]
pub fn find(id: &str) -> Option<&'static Code> {
    all().find(|code| code.id.eq_ignore_ascii_case(id))
}
