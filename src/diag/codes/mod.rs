//! The table of codes, one row each. A code never changes its meaning.
//!
//! The first two letters are the family, which is the stage that raises it: `IO` files, `SY` YAML
//! syntax, `SC` structure and keys, `RE` files that a scene names, `VA` values, `GL` glTF, `MI`
//! Mitsuba, `PB` pbrt, `US` USD, `IR` the intermediate representation, `RD` rendering, `EX` export
//! to other renderers.
//!
//! The page of a code, `pages/<CODE>.md`, states what it finds and why that matters, with an
//! example that raises it and the fixed example; `tests/pages.rs` runs both.

mod code;
mod container;
mod exports;
mod files;
mod gltf;
mod mitsuba;
mod pbrt;
mod picture;
mod references;
mod shape;
mod syntax;
mod usd;
mod values;

pub use code::{Code, Severity};
pub use container::*;
pub use exports::*;
pub use files::*;
pub use gltf::*;
pub use mitsuba::*;
pub use pbrt::*;
pub use picture::*;
pub use references::*;
pub use shape::*;
pub use syntax::*;
pub use usd::*;
pub use values::*;

use code::codes;

impl Code {
    /// The page of `rtc explain`, in Markdown: what the code finds, why it matters, an example that
    /// raises it and the same example without the mistake.
    #[must_use]
    pub fn page(&self) -> &'static str {
        // No field, so that a program that shows no pages has none.
        let families = [
            container::page,
            exports::page,
            files::page,
            gltf::page,
            mitsuba::page,
            pbrt::page,
            picture::page,
            references::page,
            shape::page,
            syntax::page,
            usd::page,
            values::page,
        ];
        let mut pages = families.iter().filter_map(|find| find(self.id));
        pages.next().unwrap_or_default()
    }

    /// The first paragraph of the page: what the code finds.
    #[must_use]
    pub fn explanation(&self) -> &'static str {
        self.page().split("\n\n").next().unwrap_or_default()
    }
}

/// Every code there is, family by family.
pub fn all() -> impl Iterator<Item = &'static Code> {
    [IO, SY, SC, RE, VA, GL, MI, PB, US, IR, RD, EX]
        .into_iter()
        .flatten()
        .copied()
}

/// The code with the id given, in any case.
#[must_use]
pub fn find(id: &str) -> Option<&'static Code> {
    all().find(|code| code.id.eq_ignore_ascii_case(id))
}
