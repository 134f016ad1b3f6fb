//! Stored hierarchies in a container: each list is a section of numbers, of which nothing else is
//! checked here.

use super::columns::SectionReader;
use super::section::{ElementType, SectionContent, SectionWriter};
use rtc_ir::StoredTree;
use serde::{Deserialize, Serialize};

/// A stored hierarchy with the section index of each list.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StoredTreeSections {
    version: u32,
    surfaces: usize,
    items: usize,
    links: usize,
}

/// Puts the lists of a hierarchy into sections.
pub(super) fn store<'s>(tree: &'s StoredTree, body: &mut SectionWriter<'s>) -> StoredTreeSections {
    let StoredTree {
        version,
        surfaces,
        items,
        links,
    } = tree;
    let mut put = |stride: usize, numbers: &'s [u32]| {
        body.push(ElementType::U32, stride, SectionContent::U32(numbers))
    };
    StoredTreeSections {
        version: *version,
        surfaces: put(2, surfaces.as_flattened()),
        items: put(1, items),
        links: put(StoredTree::WIDTH, links.as_flattened()),
    }
}

impl StoredTreeSections {
    /// The hierarchy; `None` if a section is missing, of another type, or was taken before.
    pub(super) fn load(&self, reader: &mut SectionReader<'_>) -> Option<StoredTree> {
        let items: Vec<[u32; 1]> = vectors(self.items, reader)?;
        Some(StoredTree {
            version: self.version,
            surfaces: vectors(self.surfaces, reader)?.into(),
            items: items.into_flattened().into(),
            links: vectors(self.links, reader)?.into(),
        })
    }
}

fn vectors<const N: usize>(
    section: usize,
    reader: &mut SectionReader<'_>,
) -> Option<Vec<[u32; N]>> {
    let section = reader.take(section)?;
    section.vectors(ElementType::U32, u32::from_le_bytes)
}
