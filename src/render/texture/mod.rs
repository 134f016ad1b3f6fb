//! Textures: lookup at texture coordinates.
//!
//! [`Texture`] has a variant for each kind of the IR: `bilinear` by the rules of the course,
//! `sampled` by those of glTF (wrap modes and filters), patterns, and the coordinates as a colour.
//! A [`TextureLookupPoint`] is the point of a lookup: texture coordinates and world coordinates. An
//! [`Image`] decodes its texels on lookup and is shared by its textures. `footprint` selects the
//! texels of a bilinear lookup.

pub(crate) mod bilinear;
mod footprint;
pub(crate) mod sampled;

use rtc_image::{Texel, Texels};
use rtc_math::{SolidTexture, Vec3};
use std::sync::Arc;

/// A texture with its image.
#[derive(Clone, Debug)]
pub(crate) enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image as the course looks it up, v = 1 at its top row.
    Image(Arc<Image>),
    /// An image as glTF samples it, v = 0 at its top row.
    Sampled {
        image: Arc<Image>,
        /// Wrap modes along u and v.
        wrap: [Wrap; 2],
        filter: Filter,
    },
    /// A pattern in closed form.
    Procedural(Box<SolidTexture>),
}

/// Where on a surface a texture is looked up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextureLookupPoint {
    /// The first texture coordinates, if there are any.
    pub(crate) uv: Option<[f64; 2]>,
    /// The point in world coordinates.
    pub(crate) point: Vec3,
}

/// An image of at least one texel.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) texels: Texels,
}

/// The wrap mode outside of the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wrap {
    /// Repeat the image.
    Repeat,
    /// Repeat the image, reflected at each edge.
    Mirror,
    /// Clamp to the texel at the edge.
    Clamp,
}

/// The filter of a lookup.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    /// Bilinear interpolation of four texels.
    Linear,
    /// The nearest texel.
    Nearest,
}

impl Image {
    #[inline]
    fn texel(&self, column: usize, row: usize) -> Texel {
        self.texels.at(row * self.width as usize + column)
    }
}
