//! Pixel files decoded within the budget of the run: what a file takes is charged before it is
//! decoded.

use crate::image::{Cost, DecodeError, Opacity, PixelFile, Pixels, Radiance, RadianceFile};
use crate::source::{Budget, Exceeded, Resource};

/// Why there is no picture.
#[derive(Debug)]
pub enum Refused {
    /// The file can't be read as one.
    File(DecodeError),
    /// It would take more than the budget has.
    Limit(Exceeded),
}

impl From<DecodeError> for Refused {
    fn from(error: DecodeError) -> Self {
        Self::File(error)
    }
}

/// Decodes a PNG, JPEG or WebP.
///
/// # Errors
/// If the bytes are no such file, damaged, or ask for too much.
pub fn decode(bytes: &[u8], opacity: Opacity, budget: &Budget) -> Result<Pixels, Refused> {
    let file = PixelFile::open(bytes, opacity, budget.limit(Resource::Pixels))?;
    charge(file.cost(), budget)?;
    Ok(file.decode()?)
}

/// Decodes a Radiance HDR or OpenEXR file.
///
/// # Errors
/// As [`decode`].
pub fn decode_radiance(bytes: &[u8], budget: &Budget) -> Result<Radiance, Refused> {
    let file = RadianceFile::open(bytes, budget.limit(Resource::Pixels))?;
    charge(file.cost(), budget)?;
    Ok(file.decode()?)
}

fn charge(cost: Cost, budget: &Budget) -> Result<(), Refused> {
    let Cost {
        pixels,
        memory,
        scratch,
    } = cost;
    budget
        .charge(Resource::Pixels, pixels)
        .map_err(Refused::Limit)?;
    // What is given back at once only has to be there.
    budget
        .has(Resource::Memory, memory.saturating_add(scratch))
        .map_err(Refused::Limit)?;
    budget
        .charge(Resource::Memory, memory)
        .map_err(Refused::Limit)
}
