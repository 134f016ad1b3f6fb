//! Front ends: what people and tools write, lowered to the IR. One folder a language.

pub mod course;

/// What a front end lets pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Unknown keys are errors.
    pub strict: bool,
    /// Mistakes with one sensible repair are repaired, with a warning that says what was done.
    pub lenient: bool,
}
