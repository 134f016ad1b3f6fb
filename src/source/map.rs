//! The source map: owns the bytes of every file and converts offsets to lines and columns.

use super::memory::resolved;
use super::record::SharedRecord;
use super::span::{FileId, LineColumn, Span};
use super::tree::{DetachedTree, SyntaxTree};
use super::{Budget, EditedFiles, Folder, FoundFile, Limits, MemoryFiles, ReadRecord};
use rtc_math::to_u32;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The number of bytes that are searched for NUL to detect binary files.
const SNIFF: usize = 8192;

struct SourceFile {
    name: String,
    /// The folder that it was read from; `None` for a stream.
    folder: Option<Folder>,
    /// All bytes, or the first ones of a file that was released.
    bytes: Arc<Vec<u8>>,
    is_released: bool,
    /// Computed when a line is first needed: most files never need it, and some are large and
    /// binary.
    line_starts: OnceLock<Vec<u32>>,
    /// Computed when needed, like `line_starts`; a line may be as long as the file.
    characters: OnceLock<Vec<ColumnMark>>,
    /// Whether all of it is UTF-8.
    is_utf8: OnceLock<bool>,
}

/// The number of characters before a character boundary.
#[derive(Clone, Copy)]
struct ColumnMark {
    offset: u32,
    characters: u32,
}

/// The minimum distance between two marks, in bytes.
const MARK_INTERVAL: usize = 1 << 10;

/// All files of one run with the names that the user gave them, and the budget of the run.
#[derive(Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
    budget: Budget,
    /// The canonical paths of all files read, including those that are not in the map.
    read: Mutex<BTreeSet<PathBuf>>,
    /// The paths of the files whose bytes count as read.
    counted: Mutex<BTreeSet<PathBuf>>,
    /// Texts that replace files.
    edited: EditedFiles,
    /// A record of the lookups and files, if it is kept.
    record: Option<SharedRecord>,
    /// The tree of a file that was parsed before it was added.
    parsed: Option<(FileId, Arc<DetachedTree>)>,
}

impl SourceMap {
    /// An empty map for a run with these limits.
    #[must_use]
    pub fn with_limits(limits: Limits) -> Self {
        Self {
            budget: Budget::new(limits),
            ..Self::default()
        }
    }

    /// Replaces files by these texts when a scene refers to them.
    #[must_use]
    pub fn with_edited(self, edited: EditedFiles) -> Self {
        Self { edited, ..self }
    }

    /// The same map, which keeps a record of all lookups and of the hashes of all files read.
    #[must_use]
    pub fn recording(self) -> Self {
        let record = Some(SharedRecord::default());
        Self { record, ..self }
    }

    /// The record so far, if it is kept.
    #[must_use]
    pub fn record(&self) -> Option<ReadRecord> {
        self.record.as_ref().map(SharedRecord::so_far)
    }

    /// Adds the content of a file that was read to the record.
    pub(super) fn note_content(&self, path: &Path, bytes: &[u8]) {
        if let Some(record) = &self.record {
            record.note_file(path, bytes);
        }
    }

    /// The text that replaces the file at a canonical path.
    pub(super) fn edited(&self, path: &Path) -> Option<&[u8]> {
        self.edited.get(path)
    }

    /// The budget of the run. The limits grow with the bytes of the files that [`super::Loader`]
    /// reads, of each file once, and with those given to [`Self::add`]; not with what files are
    /// unpacked to.
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Records that a file was read.
    pub(super) fn note(&self, path: &Path) {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        self.read
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(path);
    }

    /// Counts the bytes of the file at a path as read, unless they are counted already: however
    /// often a scene names a file, the limits grow by it once.
    pub(super) fn count(&self, path: &Path, bytes: usize) {
        let mut counted = self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        if counted.insert(path.to_owned()) {
            self.budget.read(bytes);
        }
    }

    /// Whether the file at a path was read, under any name.
    #[must_use]
    pub fn has_read(&self, path: &Path) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        fs::canonicalize(path).is_ok_and(|path| read.contains(&path))
    }

    /// The canonical paths of the files that were read.
    #[must_use]
    pub fn paths_read(&self) -> Vec<PathBuf> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.iter().cloned().collect()
    }

    /// Adds a file that the user gave as these bytes, and returns its index.
    ///
    /// # Panics
    /// If the file has 4 GiB or more; [`super::Loader`] rejects such files.
    pub fn add(&mut self, name: impl Into<String>, bytes: Vec<u8>) -> FileId {
        self.budget.read(bytes.len());
        self.push(name.into(), None, bytes)
    }

    /// Adds what a file of the map was unpacked to, or a part of one. The limits do not grow with
    /// it.
    ///
    /// # Panics
    /// As [`Self::add`].
    pub fn add_unpacked(&mut self, name: impl Into<String>, bytes: Vec<u8>) -> FileId {
        self.push(name.into(), None, bytes)
    }

    /// Adds a file that was read from `path`, which is also its name.
    ///
    /// # Panics
    /// As [`Self::add`].
    pub fn add_from(&mut self, path: &Path, bytes: Vec<u8>) -> FileId {
        self.count(path, bytes.len());
        let folder = Folder::new(path.parent().unwrap_or(Path::new("")));
        self.push(path.display().to_string(), folder, bytes)
    }

    /// Keeps the tree of a file, so that it is not parsed again.
    pub fn keep_tree(&mut self, file: FileId, tree: Arc<DetachedTree>) {
        self.parsed = Some((file, tree));
    }

    /// The tree of a file, if it is kept.
    #[must_use]
    pub fn tree(&self, file: FileId) -> Option<SyntaxTree<'_>> {
        let (own, tree) = self.parsed.as_ref()?;
        let text = self.text(file).filter(|_| *own == file)?;
        Some(tree.attach(file, text))
    }

    /// Adds a file in memory.
    ///
    /// # Panics
    /// As [`Self::add`].
    pub fn add_memory(&mut self, path: &str, files: &Arc<MemoryFiles>, bytes: Vec<u8>) -> FileId {
        self.count(Path::new(path), bytes.len());
        let parent = Path::new(path).parent().unwrap_or(Path::new(""));
        let shown = Some(parent.to_owned());
        let folder = Folder::in_memory(files, &resolved(parent), shown);
        self.push(path.to_owned(), Some(folder), bytes)
    }

    /// Adds a file that was found and read; its name is the path as the user would write it. Its
    /// bytes may have been unpacked.
    ///
    /// # Panics
    /// As [`Self::add`].
    pub fn add_found(&mut self, found: &FoundFile, bytes: Vec<u8>) -> FileId {
        self.push(found.shown.display().to_string(), found.folder(), bytes)
    }

    fn push(&mut self, name: String, folder: Option<Folder>, bytes: Vec<u8>) -> FileId {
        assert!(
            u32::try_from(bytes.len()).is_ok(),
            "the loader refuses files of 4 GiB and more"
        );
        let folder = folder.map(|folder| folder.recorded(self.record.clone()));
        let id = FileId(to_u32(self.files.len()));
        self.files.push(SourceFile {
            name,
            folder,
            bytes: Arc::new(bytes),
            is_released: false,
            line_starts: OnceLock::new(),
            characters: OnceLock::new(),
            is_utf8: OnceLock::new(),
        });
        id
    }

    /// The folder of the file; `None` for a stream.
    #[must_use]
    pub fn folder(&self, file: FileId) -> Option<&Folder> {
        self.file(file).folder.as_ref()
    }

    /// The name of the file.
    #[must_use]
    pub fn name(&self, file: FileId) -> &str {
        &self.file(file).name
    }

    /// The bytes of the file.
    #[must_use]
    pub fn bytes(&self, file: FileId) -> &[u8] {
        &self.file(file).bytes
    }

    /// The same, for a reader that outlives a borrow of the map.
    #[must_use]
    pub fn shared_bytes(&self, file: FileId) -> Arc<Vec<u8>> {
        Arc::clone(&self.file(file).bytes)
    }

    /// Whether the file is text with readable lines. Latin-1 counts: only some of its characters
    /// are lost.
    #[must_use]
    pub fn is_text(&self, file: FileId) -> bool {
        let source = self.file(file);
        let head = &source.bytes[..source.bytes.len().min(SNIFF)];
        !head.contains(&0) || (source.is_utf8() && !source.is_released)
    }

    /// Frees the memory of a binary file that is no longer needed, except its first `kept` bytes. A
    /// text is kept, because diagnostics quote it.
    pub fn release(&mut self, file: FileId, kept: usize) {
        let kept = kept.max(SNIFF);
        if kept < self.bytes(file).len() && !self.is_text(file) {
            let source = &mut self.files[file.0 as usize];
            source.bytes = Arc::new(source.bytes[..kept].to_vec());
            (source.line_starts, source.characters) = (OnceLock::new(), OnceLock::new());
            source.is_released = true;
        }
    }

    /// The text of the file, if it is UTF-8 and was not released.
    #[must_use]
    pub fn text(&self, file: FileId) -> Option<&str> {
        let source = self.file(file);
        let text = std::str::from_utf8(&source.bytes);
        text.ok().filter(|_| !source.is_released)
    }

    /// The text of a span; invalid UTF-8 is replaced.
    #[must_use]
    pub fn slice(&self, span: Span) -> std::borrow::Cow<'_, str> {
        let bytes = self.bytes(span.file);
        let end = (span.end as usize).min(bytes.len());
        String::from_utf8_lossy(&bytes[(span.start as usize).min(end)..end])
    }

    /// The line and column of a byte offset.
    #[must_use]
    pub fn line_column(&self, file: FileId, offset: u32) -> LineColumn {
        let source = self.file(file);
        let starts = source.line_starts();
        let line = starts.partition_point(|&start| start <= offset).max(1);
        let start = starts.get(line - 1).copied().unwrap_or(0);
        LineColumn {
            line: to_u32(line),
            column: source.characters_before(offset) - source.characters_before(start) + 1,
        }
    }

    /// The byte range of the lines `first..=last` (from 1), with their newlines, clipped to the
    /// file.
    #[must_use]
    pub fn lines(&self, file: FileId, first: u32, last: u32) -> Span {
        let source = self.file(file);
        let end = to_u32(source.bytes.len());
        let at = |line: u32| {
            source
                .line_starts()
                .get(line as usize)
                .copied()
                .unwrap_or(end)
        };
        Span::new(file, at(first.saturating_sub(1)), at(last))
    }

    fn file(&self, file: FileId) -> &SourceFile {
        &self.files[file.0 as usize]
    }
}

impl SourceFile {
    fn line_starts(&self) -> &[u32] {
        let newlines = || memchr::memchr_iter(b'\n', &self.bytes).map(|index| to_u32(index + 1));
        self.line_starts
            .get_or_init(|| std::iter::once(0).chain(newlines()).collect())
    }

    fn is_utf8(&self) -> bool {
        let find = || std::str::from_utf8(&self.bytes).is_ok();
        *self.is_utf8.get_or_init(find)
    }

    /// The number of characters that start before an offset; invalid UTF-8 counts as it is
    /// displayed.
    fn characters_before(&self, offset: u32) -> u32 {
        let marks = self.characters.get_or_init(|| marks(&self.bytes));
        let next = marks.partition_point(|mark| mark.offset <= offset);
        let mark = marks[next.saturating_sub(1)];
        let end = (offset as usize).min(self.bytes.len());
        let rest = self.bytes.get(mark.offset as usize..end);
        let rest = String::from_utf8_lossy(rest.unwrap_or_default());
        mark.characters + to_u32(rest.chars().count())
    }
}

/// The marks of a whole file.
fn marks(bytes: &[u8]) -> Vec<ColumnMark> {
    let (mut marks, mut offset, mut characters) = (Vec::new(), 0, 0);
    let mut advance = |bytes: usize| {
        let last = marks.last().map(|mark: &ColumnMark| mark.offset as usize);
        if last.is_none_or(|last| offset - last >= MARK_INTERVAL) {
            marks.push(ColumnMark {
                offset: to_u32(offset),
                characters,
            });
        }
        offset += bytes;
        characters += 1;
    };
    for chunk in bytes.utf8_chunks() {
        chunk.valid().chars().for_each(|c| advance(c.len_utf8()));
        if !chunk.invalid().is_empty() {
            advance(chunk.invalid().len());
        }
    }
    advance(0);
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Resource;

    #[test]
    fn limits_grow_by_what_is_given_and_by_each_file_once() {
        let mut map = SourceMap::default();
        let limit = |map: &SourceMap| map.budget().limit(Resource::Surfaces);
        let before = limit(&map);
        map.add("given", vec![0; 1024]);
        let grown = limit(&map) - before;
        assert!(grown > 0);
        map.add_from(Path::new("a"), vec![0; 1024]);
        for name in ["a", "a", "b", "b"] {
            map.count(Path::new(name), 1024);
        }
        map.add_unpacked("made", vec![0; 1 << 20]);
        assert_eq!(limit(&map), before + 3 * grown);
    }

    #[test]
    fn columns_count_characters_and_lines_start_after_the_newline() {
        let mut map = SourceMap::default();
        let file = map.add("x", "a\nü-b\n".as_bytes().to_vec());
        assert_eq!(map.line_column(file, 0), LineColumn { line: 1, column: 1 });
        assert_eq!(map.line_column(file, 5), LineColumn { line: 2, column: 3 });
        assert_eq!(map.slice(map.lines(file, 2, 2)), "ü-b\n");
        assert_eq!(map.line_column(file, 6), LineColumn { line: 2, column: 4 });
    }

    #[test]
    fn columns_of_a_long_line_are_as_if_it_were_read_from_its_start() {
        let mut map = SourceMap::default();
        let long = "aü😀\u{301}".repeat(2000) + "\nü" + &"x".repeat(5000);
        let latin = [long.as_bytes(), b"\xe9\x80\xff", long.as_bytes()].concat();
        for bytes in [long.as_bytes(), &latin] {
            let file = map.add("x", bytes.to_vec());
            for offset in (0..bytes.len() + 2).step_by(97) {
                let before = &bytes[..offset.min(bytes.len())];
                let start = before.iter().rposition(|byte| *byte == b'\n');
                let start = start.map_or(0, |at| at + 1);
                let before = String::from_utf8_lossy(&before[start..]);
                let at = map.line_column(file, to_u32(offset));
                assert_eq!(at.column as usize, before.chars().count() + 1, "{offset}");
            }
        }
    }

    /// Finding a column reads no more bytes than lie between two marks, however long the line.
    #[test]
    fn the_work_for_a_column_does_not_grow_with_its_line() {
        for characters in [4_000, 8_000, 16_000] {
            let line = "ü😀a".repeat(characters);
            let marks = marks(line.as_bytes());
            let gaps = marks.windows(2).map(|pair| pair[1].offset - pair[0].offset);
            assert!(gaps.max() <= Some(to_u32(MARK_INTERVAL + 4)));
            assert!(marks.len() <= line.len() / MARK_INTERVAL + 1);
        }
    }

    #[test]
    fn a_released_file_stays_binary_and_a_text_stays_whole() {
        let mut map = SourceMap::default();
        let text = [b"\0 but UTF-8".to_vec(), vec![b'a'; 3 * SNIFF]].concat();
        let binary = [text.clone(), vec![0xff]].concat();
        for (bytes, kept, is_text) in [(&text, text.len(), true), (&binary, 2 * SNIFF, false)] {
            let file = map.add("x", bytes.clone());
            map.release(file, 2 * SNIFF);
            let all = (
                map.bytes(file).len(),
                map.is_text(file),
                map.text(file).is_some(),
            );
            assert_eq!(all, (kept, is_text, is_text));
        }
    }
}
