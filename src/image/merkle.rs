//! A Merkle tree over the tiles of a picture: with it a picture, or a part of one, commits to its
//! film values.
//!
//! The tree is that of RFC 6962, section 2.1, with SHA-256: a leaf is the hash of a byte 0 and the
//! values of a tile, a node that of a byte 1 and its two children. The root is the hash of a byte
//! 2, of the metadata (each text after its length in 64 bits, little-endian), and of the top node.

use super::{BLOCK_ROWS, Image, PictureMetadata};
use sha2::{Digest as _, Sha256};
use std::fmt;
use std::ops::Range;

/// The side of a tile in pixels.
pub const TILE: u32 = BLOCK_ROWS;

/// The most nodes that a picture keeps which is to stay small: 16 KiB.
const MAX_NODES: usize = 512;

/// The version of the bytes of a tree.
const VERSION: u8 = 1;

/// A SHA-256.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileHash([u8; 32]);

impl TileHash {
    /// The hash of the values of a tile, as bytes.
    #[must_use]
    pub fn of_tile(values: &[u8]) -> Self {
        Self::of([&[0], values])
    }

    fn of<'p>(pieces: impl IntoIterator<Item = &'p [u8]>) -> Self {
        let mut hash = Sha256::new();
        pieces.into_iter().for_each(|piece| hash.update(piece));
        Self(hash.finalize().into())
    }

    /// The hash of the 64 hexadecimal digits that it prints as.
    #[must_use]
    pub fn parse(digits: &str) -> Option<Self> {
        from_hex(digits)?.try_into().ok().map(Self)
    }
}

/// The bytes of small hexadecimal digits.
pub(super) fn from_hex(digits: &str) -> Option<Vec<u8>> {
    const DIGITS: &[u8] = b"0123456789abcdef";
    let digit = |byte: u8| memchr::memchr(byte, DIGITS).and_then(|digit| u8::try_from(digit).ok());
    let (pairs, rest) = digits.as_bytes().as_chunks::<2>();
    let bytes = pairs
        .iter()
        .map(|[high, low]| Some(digit(*high)? << 4 | digit(*low)?))
        .collect::<Option<_>>();
    bytes.filter(|_| rest.is_empty())
}

impl fmt::Display for TileHash {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// The hashes of the tiles of a film, row by row of tiles from its upper left corner: of each pixel
/// red, green, blue as 64-bit floats and the coverage as one of 32 bits, little-endian. Tiles at
/// the right and lower border are cut off.
#[must_use]
pub fn tile_hashes(image: &Image, coverage: &[f32]) -> Vec<TileHash> {
    let [width, height] = [image.width, image.height];
    let mut values = Vec::with_capacity((TILE * TILE) as usize * 28);
    let mut hash = |[left, top]: [u32; 2]| {
        values.clear();
        for y in top..height.min(top + TILE) {
            let row = y as usize * width as usize;
            let range = row + left as usize..row + width.min(left + TILE) as usize;
            for (pixel, coverage) in image.pixels[range.clone()].iter().zip(&coverage[range]) {
                let pixel = pixel.iter();
                values.extend(pixel.flat_map(|value| plain(*value).to_le_bytes()));
                values.extend(coverage.to_le_bytes());
            }
        }
        TileHash::of_tile(&values)
    };
    let side = TILE as usize;
    let corners = (0..height)
        .step_by(side)
        .flat_map(|y| (0..width).step_by(side).map(move |x| [x, y]));
    corners.map(&mut hash).collect()
}

/// The value, with the one NaN that all machines write.
fn plain(value: f64) -> f64 {
    if value.is_nan() { f64::NAN } else { value }
}

/// The number of tiles of a picture.
#[must_use]
pub fn tile_count([width, height]: [u32; 2]) -> usize {
    width.div_ceil(TILE) as usize * height.div_ceil(TILE) as usize
}

/// A Merkle tree of which one level is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MerkleTree {
    root: TileHash,
    /// The level of the nodes above the leaves.
    level: u8,
    nodes: Vec<TileHash>,
}

impl MerkleTree {
    /// The tree over tiles of a picture with this metadata, with all its leaves.
    #[must_use]
    pub fn new(tiles: Vec<TileHash>, metadata: &PictureMetadata) -> Self {
        let mut tree = Self {
            root: TileHash::default(),
            level: 0,
            nodes: tiles,
        };
        tree.root = tree.root_of(metadata);
        tree
    }

    /// The tree without its lowest levels, so that it has at most [`MAX_NODES`] nodes.
    #[must_use]
    pub fn pruned(mut self) -> Self {
        while self.nodes.len() > MAX_NODES {
            self.nodes = parents(&self.nodes);
            self.level += 1;
        }
        self
    }

    /// The root.
    #[must_use]
    pub fn root(&self) -> TileHash {
        self.root
    }

    /// The nodes, in the order of their tiles.
    #[must_use]
    pub fn nodes(&self) -> &[TileHash] {
        &self.nodes
    }

    /// The number of tiles that a node covers; fewer only at the end.
    #[must_use]
    pub fn tiles_of_node(&self) -> usize {
        1 << self.level
    }

    /// The tiles of a node, out of all.
    #[must_use]
    pub fn tiles(&self, node: usize, count: usize) -> Range<usize> {
        let first = node << self.level;
        first..(first + self.tiles_of_node()).min(count)
    }

    /// The node over the tiles of one node.
    #[must_use]
    pub fn node(tiles: Vec<TileHash>) -> TileHash {
        let mut nodes = tiles;
        while nodes.len() > 1 {
            nodes = parents(&nodes);
        }
        nodes.first().copied().unwrap_or_default()
    }

    /// The root of these nodes for a picture of this origin.
    #[must_use]
    pub fn root_of(&self, metadata: &PictureMetadata) -> TileHash {
        let texts = [&metadata.software, &metadata.scene, &metadata.settings];
        let lengths = texts.map(|text| (text.len() as u64).to_le_bytes());
        let top = Self::node(self.nodes.clone());
        let mut pieces: Vec<&[u8]> = vec![&[2]];
        for (length, text) in lengths.iter().zip(texts) {
            pieces.extend([&length[..], text.as_bytes()]);
        }
        pieces.push(&top.0);
        TileHash::of(pieces)
    }

    /// Whether it can be that of a picture of this size.
    #[must_use]
    pub fn fits(&self, size: [u32; 2]) -> bool {
        tile_count(size).div_ceil(self.tiles_of_node()) == self.nodes.len()
    }

    /// Version and level, a byte each, the root, and the nodes.
    #[must_use]
    pub(super) fn bytes(&self) -> Vec<u8> {
        let hashes = std::iter::once(&self.root).chain(&self.nodes);
        let hashes = hashes.flat_map(|hash| hash.0);
        [VERSION, self.level].into_iter().chain(hashes).collect()
    }

    /// The bytes of the tree of a picture with all its leaves.
    pub(super) fn length(size: [u32; 2]) -> usize {
        2 + 32 * (1 + tile_count(size))
    }

    /// The tree of such bytes.
    pub(super) fn read(bytes: &[u8]) -> Option<Self> {
        let (&[VERSION, level @ 0..32], hashes) = bytes.split_first_chunk()? else {
            return None;
        };
        let (hashes, rest) = hashes.as_chunks::<32>();
        let (root, nodes) = hashes.split_first().filter(|_| rest.is_empty())?;
        Some(Self {
            root: TileHash(*root),
            level,
            nodes: nodes.iter().map(|node| TileHash(*node)).collect(),
        })
    }
}

/// The nodes one level up; the last is its own parent if it has no sibling.
fn parents(nodes: &[TileHash]) -> Vec<TileHash> {
    let parent = |pair: &[TileHash]| match pair {
        [left, right] => TileHash::of([&[1], &left.0[..], &right.0]),
        _ => pair[0],
    };
    nodes.chunks(2).map(parent).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(count: usize) -> Vec<TileHash> {
        (0..count)
            .map(|index| TileHash::of_tile(&index.to_le_bytes()))
            .collect()
    }

    /// The tree hash as RFC 6962 defines it, by recursion.
    fn reference(leaves: &[TileHash]) -> TileHash {
        match leaves {
            [one] => *one,
            _ => {
                let left = leaves.len().next_power_of_two() / 2;
                let (left, right) = leaves.split_at(left);
                TileHash::of([&[1], &reference(left).0[..], &reference(right).0])
            }
        }
    }

    #[test]
    fn the_tree_is_that_of_the_rfc() {
        for count in 1..70 {
            assert_eq!(MerkleTree::node(leaves(count)), reference(&leaves(count)));
        }
        // SHA-256 of a byte 0, by `printf '\0' | sha256sum`.
        let empty = "6e340b9cffb37a989ca544e6bb780a2c78901d3fb33738768511a30617afa01d";
        assert_eq!(TileHash::of_tile(&[]).to_string(), empty);
        assert_eq!(TileHash::parse(empty), Some(TileHash::of_tile(&[])));
        assert_eq!(TileHash::parse(&"6e".repeat(31)), None);
        assert_eq!(TileHash::parse(&empty.replace('6', "g")), None);
    }

    #[test]
    fn pruning_keeps_the_root_and_says_which_tiles_a_node_has() {
        let metadata = PictureMetadata::default();
        for count in [1, 511, 512, 513, 1025, 3000] {
            let whole = MerkleTree::new(leaves(count), &metadata);
            let pruned = whole.clone().pruned();
            assert!(pruned.nodes.len() <= MAX_NODES);
            assert_eq!(pruned.root_of(&metadata), whole.root());
            for (index, node) in pruned.nodes().iter().enumerate() {
                let tiles = leaves(count)[pruned.tiles(index, count)].to_vec();
                assert_eq!(MerkleTree::node(tiles), *node);
            }
            assert_eq!(MerkleTree::read(&pruned.bytes()), Some(pruned));
        }
    }

    #[test]
    fn each_text_changes_the_root() {
        let tree = MerkleTree::new(leaves(5), &PictureMetadata::default());
        let with = |change: fn(&mut PictureMetadata)| {
            let mut metadata = PictureMetadata::default();
            change(&mut metadata);
            tree.root_of(&metadata)
        };
        let roots = [
            tree.root(),
            with(|metadata| metadata.software = "a".into()),
            with(|metadata| metadata.scene = "a".into()),
            with(|metadata| metadata.settings = "a".into()),
        ];
        for (index, root) in roots.iter().enumerate() {
            assert!(!roots[..index].contains(root), "{index}");
        }
    }

    #[test]
    fn each_bit_of_a_film_changes_the_hash_of_its_tile_alone() {
        let image = Image {
            width: 35,
            height: 20,
            pixels: vec![[0.25, 0.5, 1.0]; 700],
        };
        let coverage = vec![1.0; 700];
        let before = tile_hashes(&image, &coverage);
        assert_eq!(before.len(), tile_count([35, 20]));
        for (pixel, tile) in [(0, 0), (15, 0), (16, 1), (34, 2), (16 * 35, 3), (699, 5)] {
            let differ = |after: Vec<TileHash>| {
                let pairs = before.iter().zip(&after).enumerate();
                let differ = pairs.filter(|(_, (a, b))| a != b);
                differ.map(|(index, _)| index).collect::<Vec<_>>()
            };
            let mut changed = image.clone();
            let value = &mut changed.pixels[pixel][1];
            *value = f64::from_bits(value.to_bits() ^ 1);
            assert_eq!(differ(tile_hashes(&changed, &coverage)), [tile]);
            let mut covered = coverage.clone();
            covered[pixel] = 0.5;
            assert_eq!(differ(tile_hashes(&image, &covered)), [tile]);
        }
    }
}
