//! What each pixel may show.

/// What the rays through a pixel may meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// Nothing.
    Nothing,
    /// All of them the same flat surface, which shows the same value everywhere.
    Uniform,
    /// Whatever there is.
    Anything,
}

/// What each pixel of the picture may show.
#[derive(Clone, Debug, Default)]
pub struct Region {}

impl Region {
    /// What the rays through a pixel may meet.
    #[must_use]
    pub fn sight(&self, _pixel: [u32; 2]) -> Sight {
        Sight::Anything
    }
}
