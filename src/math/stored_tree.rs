//! Hierarchies that were built before, as plain numbers.

use crate::SharedList;

/// The topology of a bounding volume hierarchy over triangles of a scene. It has no boxes: who
/// reads it computes them from the triangles, so a wrong one may be slow but hides nothing.
///
/// It is no part of what the scene means: a reader that does not know its version, or finds it
/// unfit for the scene, builds one anew. Nothing is guaranteed about the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredTree {
    /// The version of the layout, which the renderer defines.
    pub version: u32,
    /// What the triangles belong to: the index of each surface, and how many it has. They are
    /// numbered surface by surface.
    pub surfaces: SharedList<[u32; 2]>,
    /// The numbers of the triangles, those of a leaf together.
    pub items: SharedList<u32>,
    /// The links of each node to its children.
    pub links: SharedList<[u32; StoredTree::WIDTH]>,
}

impl StoredTree {
    /// The children of a node at most.
    pub const WIDTH: usize = 8;
}
