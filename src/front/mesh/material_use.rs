//! The materials of an OBJ: its MTL files (`mtllib`), and the material of each triangle (`usemtl`).

use super::WordSpan;
use crate::words::Word;
use rtc_math::to_u32;
use std::collections::BTreeMap;
use std::ops::Range;

/// A name, and where it stands in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SpannedName {
    /// The name.
    pub text: String,
    /// The span of its first use.
    pub at: WordSpan,
}

/// The materials of the faces of a file.
#[derive(Debug, Default)]
pub struct MaterialUse {
    /// The MTL files, each once: every `mtllib` as one name, and, if it has spaces, also its words.
    pub libraries: Vec<SpannedName>,
    /// The materials in the order of first use. Faces without a material share one without a name.
    pub materials: Vec<SpannedName>,
    known: BTreeMap<String, u32>,
    /// From which triangle on which material counts.
    runs: Vec<(u32, u32)>,
    /// The material of the next face.
    current: SpannedName,
}

/// The maximum number of bytes held for a `usemtl` line: two copies of a short name with their
/// spans, a run, and the nodes of a map.
const LINE: usize = 192;

/// The maximum length of names, in bytes.
const LONGEST: usize = 256;

/// More files of materials than this are not looked for.
const MOST_LIBRARIES: usize = 16;

impl MaterialUse {
    /// The memory for the given number of lines, without longer names.
    pub(super) fn at_most(lines: usize) -> u64 {
        (LINE * lines) as u64
    }

    /// The following faces have another material; `rest` is the text after `usemtl`.
    pub(super) fn switch(&mut self, rest: &[Word<'_>], file: &[u8]) {
        self.current = name(rest, file).unwrap_or_default();
    }

    /// The material of the next face.
    pub(super) fn current(&self) -> &SpannedName {
        &self.current
    }

    /// The following faces have a known material.
    pub(super) fn resume(&mut self, named: SpannedName) {
        self.current = named;
    }

    /// Materials are in another file; `rest` is the text after `mtllib`.
    pub(super) fn library(&mut self, rest: &[Word<'_>], file: &[u8]) {
        let whole = name(rest, file);
        let words = rest
            .iter()
            .filter(|_| rest.len() > 1)
            .filter_map(|word| name(&[*word], file));
        for named in whole.into_iter().chain(words) {
            let is_new = self.libraries.iter().all(|known| known.text != named.text);
            if is_new && self.libraries.len() < MOST_LIBRARIES {
                self.libraries.push(named);
            }
        }
    }

    /// A face begins at triangle `first`.
    pub(super) fn face(&mut self, first: usize) {
        let last = self.runs.last().map(|(_, at)| *at as usize);
        if last.is_some_and(|at| self.materials[at].text == self.current.text) {
            return;
        }
        let at = match self.known.get(&self.current.text) {
            Some(at) => *at,
            None => {
                let at = to_u32(self.materials.len());
                self.materials.push(self.current.clone());
                self.known.insert(self.current.text.clone(), at);
                at
            }
        };
        self.runs.push((to_u32(first), at));
    }

    /// The triangles of each material, of a file that has `count`.
    #[must_use]
    pub fn parts(&self, count: usize) -> Vec<Vec<Range<usize>>> {
        let ends = self.runs.iter().skip(1).map(|(first, _)| *first as usize);
        let mut parts = vec![Vec::new(); self.materials.len()];
        for ((first, at), end) in self.runs.iter().zip(ends.chain([count])) {
            parts[*at as usize].push(*first as usize..end);
        }
        parts
    }

    /// The index in `materials` of one of this name.
    #[must_use]
    pub fn index_of(&self, name: &str) -> Option<usize> {
        self.known.get(name).map(|at| *at as usize)
    }

    /// Whether any face has a material with a name.
    #[must_use]
    pub fn names_any(&self) -> bool {
        self.materials.iter().any(|named| !named.text.is_empty())
    }
}

/// The name made of some words, with the spaces between them.
pub(super) fn name(words: &[Word<'_>], file: &[u8]) -> Option<SpannedName> {
    let whole = words.first()?.through(words.last()?, file);
    let bytes = &whole.bytes[..whole.bytes.len().min(LONGEST)];
    Some(SpannedName {
        text: String::from_utf8_lossy(bytes).into_owned(),
        at: whole.place(),
    })
}
