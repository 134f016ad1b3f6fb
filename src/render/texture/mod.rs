//! Textures: values looked up at texture coordinates, by the rules of the course and of glTF.

pub(in crate::render) mod bilinear;
pub(in crate::render) mod sampled;

use crate::image::{Texel, Texels};
use std::sync::Arc;

/// A texture with its image at hand.
#[derive(Clone, Debug)]
pub(in crate::render) enum Texture {
    /// The colour (u, 0, v).
    Uv,
    /// An image as the course looks it up, v = 1 at its top row.
    Image(Arc<Image>),
    /// An image as glTF samples it, v = 0 at its top row.
    Sampled {
        image: Arc<Image>,
        /// What lies beyond the unit square, along u and v.
        wrap: [Wrap; 2],
        filter: Filter,
    },
}

/// A picture of at least one pixel.
#[derive(Clone, Debug)]
pub(in crate::render) struct Image {
    pub(in crate::render) width: u32,
    pub(in crate::render) height: u32,
    pub(in crate::render) texels: Texels,
}

/// What lies beyond the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) enum Wrap {
    /// The image again.
    Repeat,
    /// The image again, mirrored at each edge.
    Mirror,
    /// The texel at the edge.
    Clamp,
}

/// How texels blend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) enum Filter {
    /// The four nearest by their nearness.
    Linear,
    /// The nearest alone.
    Nearest,
}

impl Image {
    #[inline]
    fn texel(&self, column: usize, row: usize) -> Texel {
        self.texels.at(row * self.width as usize + column)
    }
}
