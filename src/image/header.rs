//! What is known of a pixel file before its pixels, and the strips that they come in.

use super::file_format::FileFormat;
use super::merkle::{MerkleTree, TileHash};
use super::picture::{Image, Picture, PictureMetadata, PixelLayers};
use std::borrow::Cow;
use std::io;

/// The rows of a strip, except the last, are a multiple of this: the block height of an EXR.
pub const BLOCK_ROWS: u32 = 16;

/// The properties of a picture before any pixel is rendered.
#[derive(Clone, Debug)]
pub struct PictureHeader {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether it has opacities.
    pub has_alpha: bool,
    /// The names of the channels of its layers.
    pub layers: Vec<Cow<'static, str>>,
    /// The form of the file.
    pub form: FileFormat,
    /// Whether its values are colours as a display shows them, where its form can say so; else
    /// numbers.
    pub is_color: bool,
    /// Its provenance.
    pub metadata: PictureMetadata,
    /// Whether it keeps the hashes of its tiles, which come with its strips.
    pub has_tiles: bool,
}

/// The source of the strips of a picture, from the top. Each has the width and the channels of its
/// picture.
pub struct StripSource<'s> {
    next: &'s mut dyn FnMut() -> io::Result<Cow<'s, Picture>>,
    /// The hashes of the tiles of the strips so far.
    tiles: Vec<TileHash>,
    /// The tree over the tiles, of strips that have no hashes.
    tree: Option<MerkleTree>,
}

impl<'s> StripSource<'s> {
    /// The strips that a closure makes, one at each call.
    pub fn new(next: &'s mut dyn FnMut() -> io::Result<Cow<'s, Picture>>) -> Self {
        Self {
            next,
            tiles: Vec::new(),
            tree: None,
        }
    }

    /// The same strips with the tree over their tiles.
    pub(super) fn with_tree(self, tree: Option<MerkleTree>) -> Self {
        Self { tree, ..self }
    }

    /// The next strip; call it while there are rows left.
    pub(super) fn next_strip(&mut self) -> io::Result<Cow<'s, Picture>> {
        let strip = (self.next)()?;
        if strip.image.height == 0 {
            return Err(io::Error::other("a strip has no rows"));
        }
        self.tiles.extend(&strip.tiles);
        Ok(strip)
    }
}

impl StripSource<'_> {
    /// The tree over the tiles of all strips, once there are no more; none if the file keeps none.
    pub(super) fn tree(&mut self, head: &PictureHeader) -> Option<MerkleTree> {
        let tiles = std::mem::take(&mut self.tiles);
        let tree = self.tree.take();
        head.has_tiles
            .then(|| tree.unwrap_or_else(|| MerkleTree::new(tiles, &head.metadata)))
    }
}

impl PictureHeader {
    /// The header of a picture, in a format.
    #[must_use]
    pub fn of(picture: &Picture, form: FileFormat) -> Self {
        let Picture {
            image: Image { width, height, .. },
            alpha,
            layers: PixelLayers { names, .. },
            tiles,
        } = picture;
        Self {
            size: [*width, *height],
            has_alpha: alpha.is_some(),
            layers: names.iter().copied().map(Cow::Borrowed).collect(),
            form,
            is_color: true,
            metadata: PictureMetadata::default(),
            has_tiles: !tiles.is_empty(),
        }
    }
}
