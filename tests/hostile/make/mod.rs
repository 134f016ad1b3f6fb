//! The generators of hostile files, shared by the tests and by the script that measures what they
//! cost.

pub(crate) mod gltf;
pub(crate) mod many;
pub(crate) mod media;
pub(crate) mod mitsuba;
pub(crate) mod pbrt;
pub(crate) mod usd;
mod webp;

/// Files that ask for much, and what is done with them.
pub(crate) struct Repro {
    /// What they are.
    pub(crate) name: &'static str,
    /// Name and bytes of each file.
    pub(crate) files: Vec<(String, Vec<u8>)>,
    /// What `rtc` is asked, in their folder.
    pub(crate) arguments: Vec<String>,
    /// The code of the finding that ends it; none if it is harmless.
    pub(crate) expected: Option<&'static str>,
}
