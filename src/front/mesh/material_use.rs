//! The materials that an OBJ asks for: the files of them (`mtllib`), and which triangles have which
//! (`usemtl`).

use super::WordSpan;
use crate::words::Word;
use rtc_math::to_u32;
use std::collections::BTreeMap;
use std::ops::Range;

/// A name in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Named {
    /// The name.
    pub text: String,
    /// Where it is first written.
    pub at: WordSpan,
}

/// Which materials the faces of a file ask for.
#[derive(Debug, Default)]
pub struct MaterialUse {
    /// The files of materials, each once: every `mtllib` as one name, and beside it, if it has
    /// spaces, the words of it.
    pub libraries: Vec<Named>,
    /// The materials in the order in which faces first ask for them. Faces that ask for none share
    /// one without a name.
    pub materials: Vec<Named>,
    known: BTreeMap<String, u32>,
    /// From which triangle on which material counts.
    runs: Vec<(u32, u32)>,
    /// What the next face asks for.
    current: Named,
}

/// Said most so many bytes are held for a line that asks for a material: two copies of a short name
/// with their places, a run, and the nodes of a map.
const LINE: usize = 192;

/// Names are cut after so many bytes.
const LONGEST: usize = 256;

/// More files of materials than this are not looked for.
const MOST_LIBRARIES: usize = 16;

impl MaterialUse {
    /// The memory that so many lines take, names longer than theirs aside.
    pub(super) fn at_most(lines: usize) -> u64 {
        (LINE * lines) as u64
    }

    /// The faces that follow ask for another material; `rest` is what follows `usemtl`.
    pub(super) fn switch(&mut self, rest: &[Word<'_>], file: &[u8]) {
        self.current = name(rest, file).unwrap_or_default();
    }

    /// What the next face asks for.
    pub(super) fn current(&self) -> &Named {
        &self.current
    }

    /// The faces that follow ask for a material that was asked for before.
    pub(super) fn resume(&mut self, named: Named) {
        self.current = named;
    }

    /// Materials are in another file; `rest` is what follows `mtllib`.
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

    /// Whether any face asks for a material by a name.
    #[must_use]
    pub fn names_any(&self) -> bool {
        self.materials.iter().any(|named| !named.text.is_empty())
    }
}

/// The name that some words make, with the spaces between them.
pub(super) fn name(words: &[Word<'_>], file: &[u8]) -> Option<Named> {
    let whole = words.first()?.through(words.last()?, file);
    let bytes = &whole.bytes[..whole.bytes.len().min(LONGEST)];
    Some(Named {
        text: String::from_utf8_lossy(bytes).into_owned(),
        at: whole.place(),
    })
}
