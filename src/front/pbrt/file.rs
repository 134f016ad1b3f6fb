//! The files that a scene names: found, read and unpacked within the budget.

use super::Lowering;
use super::token::TokenReader;
use crate::exchange::SpannedText;
use flate2::read::MultiGzDecoder;
use rtc_diag::{Code, Diagnostic, Severity, clip_path, codes};
use rtc_source::{Budget, FileId, FileKind, LimitExceeded, Loader, Resource, Span};
use std::io::Read;

/// The deepest nesting of included files.
const MAX_DEPTH: usize = 32;
/// The largest number of included files.
const MAX_FILES: usize = 1 << 14;
/// The largest file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;
/// The maximum size of a decompressed file: a constant, plus a factor times its size.
const UNPACKED: (u64, u64) = (16 << 20, 8);
/// The step in which unpacked bytes are charged.
const STEP: usize = 1 << 16;
/// The bytes of a text that are passed with the work of a node.
const BYTES_PER_NODE: u64 = 4;
/// The number of bytes of a compressed file that are examined.
const HEAD: u64 = 1 << 16;

/// Parts of scenes.
const SCENES: FileKind = FileKind {
    extensions: &["pbrt", "gz"],
    begins: |_| true,
};

/// A file that is being read.
pub(super) struct OpenFile {
    pub(super) reader: TokenReader,
    /// Whether it keeps the graphics state before it.
    pub(super) is_import: bool,
}

/// Whether bytes are compressed by gzip (RFC 1952).
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b")
}

/// The first bytes of a decompressed file.
pub(super) fn inflated_head(bytes: &[u8]) -> Vec<u8> {
    let mut head = Vec::new();
    // The bytes before the damage are inspected.
    let _ = MultiGzDecoder::new(bytes).take(HEAD).read_to_end(&mut head);
    head
}

/// Why a compressed file is not read.
enum GzipError {
    Damaged,
    Limit(LimitExceeded),
}

/// Unpacks a compressed file. Memory is charged before it is taken.
fn inflate(bytes: &[u8], budget: &Budget) -> Result<Vec<u8>, GzipError> {
    let most = UNPACKED.0 + UNPACKED.1 * bytes.len() as u64;
    let (mut decoder, mut unpacked) = (MultiGzDecoder::new(bytes), Vec::new());
    loop {
        let charged = budget.charge(Resource::Memory, STEP as u64);
        charged.map_err(GzipError::Limit)?;
        let before = unpacked.len();
        let mut step = (&mut decoder).take(STEP as u64);
        step.read_to_end(&mut unpacked)
            .map_err(|_| GzipError::Damaged)?;
        if unpacked.len() as u64 > most {
            return Err(GzipError::Limit(LimitExceeded {
                resource: Resource::Memory,
                total: unpacked.len() as u64,
                limit: most,
            }));
        }
        if unpacked.len() - before < STEP {
            return Ok(unpacked);
        }
    }
}

impl Lowering<'_> {
    /// The text of the scene itself; `None` if it cannot be unpacked.
    pub(super) fn open_scene(&mut self, file: FileId) -> Option<OpenFile> {
        let mut text = file;
        if is_gzip(self.map.bytes(file)) {
            let name = self.map.name(file).to_owned();
            let unpacked = self.unpack(self.map.bytes(file), &name);
            let unpacked = unpacked.map_err(|diagnostic| {
                self.sink.push(diagnostic.severity(Severity::Error));
            });
            text = self.map.add_unpacked(name, unpacked.ok()?);
        }
        let bytes = self.map.bytes(text);
        self.is_version_3 = memchr::memmem::find(bytes, b"WorldEnd").is_some();
        Some(OpenFile {
            reader: TokenReader::new(text, self.map.shared_bytes(text)),
            is_import: false,
        })
    }

    /// A file that the scene includes; its parts are missing if there is none.
    pub(super) fn open_included(&mut self, path: &SpannedText, is_import: bool) {
        self.included += 1;
        if self.files.len() >= MAX_DEPTH || self.included > MAX_FILES {
            let message = format!(
                "more than {MAX_FILES} files are included, or they are nested more than \
                 {MAX_DEPTH} deep"
            );
            self.is_exhausted |= self.included > MAX_FILES;
            return self.mistake(path.span, message);
        }
        let found = match self.parts.get(&path.text).cloned() {
            Some(known) => {
                // To pass a text once more is work even where it has nothing but comments.
                let bytes = known.as_ref().map_or(0, TokenReader::len) as u64;
                self.charge(Resource::Nodes, bytes / BYTES_PER_NODE, path.span);
                known
            }
            None => {
                let found = self.find_included(path);
                self.parts.insert(path.text.clone(), found.clone());
                found
            }
        };
        let Some(reader) = found else { return };
        if self.is_open(&reader) {
            return self.mistake(path.span, "the file includes itself");
        }
        if is_import {
            self.open(super::state::StateOpener::Import, path.span);
        }
        self.files.push(OpenFile { reader, is_import });
    }

    /// The text of a file from its start; one file is read once, whatever its names are.
    fn find_included(&mut self, path: &SpannedText) -> Option<TokenReader> {
        const INSTEAD: &str = "its contents are left out";
        let found = self.find(path, &SCENES, INSTEAD)?;
        let reader = match self.texts.get(&found.path) {
            Some(known) => known.clone(),
            None => {
                let bytes = self.bytes_of(path, INSTEAD, &found)?;
                // The scene itself is open already.
                let scene = self.files.first().map(|open| open.reader.restarted());
                let reader = match scene.filter(|scene| scene.has_text(&bytes)) {
                    Some(scene) => scene,
                    None => {
                        let file = self.map.add_found(&found, bytes);
                        TokenReader::new(file, self.map.shared_bytes(file))
                    }
                };
                self.texts.insert(found.path.clone(), reader.clone());
                reader
            }
        };
        // A file that is absent may have the name of an open one in another folder.
        if found.elsewhere && self.is_open(&reader) {
            self.absent(path, INSTEAD);
            return None;
        }
        Some(reader)
    }

    fn is_open(&self, reader: &TokenReader) -> bool {
        let mut open = self.files.iter();
        open.any(|open| open.reader.file() == reader.file())
    }

    /// Finds a file of a format; if it is missing, a warning names the replacement `instead`.
    fn find(
        &mut self,
        path: &SpannedText,
        kind: &FileKind,
        instead: &str,
    ) -> Option<rtc_source::FoundFile> {
        self.lookups += 1;
        if self.lookups > MAX_FILES {
            let message = format!("more than {MAX_FILES} files are named");
            self.is_exhausted = true;
            self.mistake(path.span, message);
            return None;
        }
        let found = self.search.find(&path.text, kind);
        if found.is_err() {
            self.absent(path, instead);
        }
        found.ok()
    }

    /// Reports a file that is not there.
    fn absent(&mut self, path: &SpannedText, instead: &str) {
        let message = format!("there is no file `{}`", clip_path(&path.text));
        let diagnostic = Diagnostic::new(&codes::FILE_NOT_FOUND, message);
        self.without(diagnostic, path.span, instead);
    }

    /// The bytes of a file of a format, decompressed; if it is missing, a warning names the
    /// replacement `instead`.
    pub(super) fn file(
        &mut self,
        path: &SpannedText,
        kind: &FileKind,
        instead: &str,
    ) -> Option<Vec<u8>> {
        let found = self.find(path, kind, instead)?;
        let bytes = self.bytes_of(path, instead, &found)?;
        Some(bytes)
    }

    fn bytes_of(
        &mut self,
        path: &SpannedText,
        instead: &str,
        found: &rtc_source::FoundFile,
    ) -> Option<Vec<u8>> {
        let name = found.shown.display().to_string();
        let read = Loader.found(found, MAX_BYTES, self.map);
        let read = read.map_err(|error| {
            let message = format!("can't read `{name}`: {error}");
            Box::new(Diagnostic::new(&codes::CANNOT_READ, message))
        });
        let unpacked = read.and_then(|bytes| match is_gzip(&bytes) {
            true => self.unpack(&bytes, &name),
            false => Ok(bytes),
        });
        let report = |diagnostic: Box<Diagnostic>| self.without(*diagnostic, path.span, instead);
        unpacked.map_err(report).ok()
    }

    fn unpack(&self, bytes: &[u8], name: &str) -> Result<Vec<u8>, Box<Diagnostic>> {
        let name = clip_path(name);
        inflate(bytes, self.map.budget()).map_err(|fault| match fault {
            GzipError::Damaged => {
                let message = format!("`{name}` is compressed, and damaged");
                Box::new(Diagnostic::new(&codes::CANNOT_READ, message))
            }
            GzipError::Limit(fault) => Box::new(crate::over_limit(&format!("`{name}`"), &fault)),
        })
    }

    /// Reports a file without which the picture is made: a warning that says how.
    pub(super) fn without(&mut self, mut diagnostic: Diagnostic, span: Span, instead: &str) {
        diagnostic.message = format!("{}: {instead}", diagnostic.message);
        let diagnostic = diagnostic.severity(Severity::Warning);
        self.sink.push(diagnostic.at(span, "named here"));
    }

    /// Reports an invalid file; the picture is rendered without it.
    pub(super) fn damaged(
        &mut self,
        code: &'static Code,
        path: &SpannedText,
        why: &str,
        instead: &str,
    ) {
        let message = format!("`{}` cannot be read: {why}", clip_path(&path.text));
        self.without(Diagnostic::new(code, message), path.span, instead);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::{Compression, write::GzEncoder};
    use std::io::Write as _;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn what_was_packed_is_unpacked_and_a_bomb_is_not() {
        let text = b"Film \"rgb\"\n".repeat(9000);
        let packed = gzip(&text);
        assert!(inflate(&packed, &Budget::default()).is_ok_and(|unpacked| unpacked == text));
        let bomb = gzip(&vec![b' '; 64 << 20]);
        let fault = inflate(&bomb, &Budget::default());
        assert!(matches!(fault, Err(GzipError::Limit(fault)) if fault.total < 20 << 20));
    }

    #[test]
    fn no_damaged_file_panics() {
        let packed = gzip(&b"Camera \"perspective\"\n".repeat(40));
        for length in 0..packed.len() {
            assert!(
                inflate(&packed[..length], &Budget::default()).is_err(),
                "{length}"
            );
            let _ = inflated_head(&packed[..length]);
        }
    }
}
