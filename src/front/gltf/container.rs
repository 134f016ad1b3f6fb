//! The container: which bytes are the JSON of an asset and which its binary chunk, for `.glb` and
//! `.gltf` alike.

use super::advice::advice;
use super::header::CONVERT;
use rtc_diag::{Code, Diagnostic, DiagnosticSink, codes};
use rtc_source::{FileId, Span};
use std::ops::Range;

/// The first bytes of a `.glb` file.
const MAGIC: &[u8] = b"glTF";
/// The types of the chunks, as stored in the file.
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";
/// Bytes of the header of the file and of a chunk.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// The parts of an asset, as ranges of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AssetParts {
    /// The text.
    pub(super) json: Range<usize>,
    /// The binary chunk, if there is one.
    pub(super) bin: Option<Range<usize>>,
    /// It is a `.glb`.
    pub(super) is_glb: bool,
    /// The file does not end within a chunk.
    pub(super) is_whole: bool,
}

/// True if the bytes are a `.glb`, be it with a damaged beginning; `name` decides where they don't.
pub(super) fn is_glb(name: &str, bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC) || bytes.get(16..20) == Some(JSON) || name.ends_with(".glb")
}

/// The end of the text of a `.glb`, with the header of the chunk after it.
pub(super) fn text_end(bytes: &[u8]) -> usize {
    let length = bytes.get(HEADER..).and_then(<[u8]>::first_chunk);
    let length = length.map_or(0, |length| u32::from_le_bytes(*length));
    (HEADER + CHUNK_HEADER + CHUNK_HEADER).saturating_add(length as usize)
}

/// Finds the parts of a `.glb`. `None`, with an error, if there is no text.
pub(super) fn open(
    file: FileId,
    bytes: &[u8],
    is_lenient: bool,
    sink: &mut DiagnosticSink,
) -> Option<AssetParts> {
    let mut scan = ContainerScan {
        file,
        bytes,
        is_lenient,
        sink,
        json: None,
        bin: None,
        chunks: 0,
    };
    scan.header()?;
    let is_whole = scan.chunks();
    let ContainerScan { json, bin, .. } = scan;
    json.filter(|json| !json.is_empty()).map(|json| AssetParts {
        json,
        bin,
        is_glb: true,
        is_whole,
    })
}

struct ContainerScan<'a> {
    file: FileId,
    bytes: &'a [u8],
    /// Chunks of odd lengths are repaired.
    is_lenient: bool,
    sink: &'a mut DiagnosticSink,
    json: Option<Range<usize>>,
    bin: Option<Range<usize>>,
    /// The number of chunks before.
    chunks: usize,
}

impl ContainerScan<'_> {
    fn add(&mut self, code: &'static Code, alias: &'static str, at: Range<usize>, message: String) {
        let span = self.span(at);
        self.sink.push(fault(code, alias, message).at(span, ""));
    }

    fn span(&self, at: Range<usize>) -> Span {
        let offset = |at: usize| u32::try_from(at.min(self.bytes.len())).unwrap_or(u32::MAX);
        Span::new(self.file, offset(at.start), offset(at.end))
    }

    /// Reports a chunk whose length is not a multiple of 4.
    fn unaligned(&mut self, header: Range<usize>, name: &str) {
        let message = format!("the length of the {name} chunk is not a multiple of 4");
        let repair = "the next chunk is searched after it";
        let diagnostic = fault(&codes::GLB_CHUNK, "GLB_CHUNK_LENGTH_UNALIGNED", message);
        let diagnostic = super::repair(diagnostic, self.is_lenient, repair);
        let at = self.span(header);
        self.sink.push(diagnostic.at(at, ""));
    }

    /// Where the chunk after one that ends at `end` begins. After a length that is not a multiple
    /// of 4 some programs write padding, and some don't.
    fn next_chunk(&self, end: usize) -> usize {
        let padded = end.next_multiple_of(4);
        let is_chunk = |at: usize| {
            let kind = self.bytes.get(at + 4..at + CHUNK_HEADER);
            kind.is_some_and(|kind| kind == JSON || kind == BIN)
        };
        let is_padded = is_chunk(padded) || self.bytes.len() == padded;
        if self.is_lenient && !is_chunk(end) && is_padded {
            padded
        } else {
            end
        }
    }

    fn word(&self, at: usize) -> Option<usize> {
        let word = self.bytes.get(at..at + 4)?;
        usize::try_from(u32::from_le_bytes([word[0], word[1], word[2], word[3]])).ok()
    }

    /// The header; `None` if the rest can't be trusted.
    fn header(&mut self) -> Option<()> {
        let code = &codes::GLB_HEADER;
        let size = self.bytes.len();
        // The first four bytes must be the magic number.
        if size >= MAGIC.len() && !self.bytes.starts_with(MAGIC) {
            let found = String::from_utf8_lossy(&self.bytes[..4])
                .escape_debug()
                .to_string();
            self.add(
                code,
                "GLB_INVALID_MAGIC",
                0..4,
                format!("the file starts with `{found}`; a `.glb` file starts with `glTF`"),
            );
            return None;
        }
        // The header holds the version and the length of the file.
        let (Some(version), Some(length)) = (self.word(4), self.word(8)) else {
            let message =
                format!("the file ends within its header, after {size} of {HEADER} bytes");
            self.add(code, "GLB_UNEXPECTED_END_OF_HEADER", size..size, message);
            return None;
        };
        // Only version 2 of the container is read.
        if version == 1 {
            let diagnostic = Diagnostic::new(code, "the file is a `.glb` of glTF 1.0");
            let diagnostic = diagnostic.at(self.span(4..8), "the version").hint(CONVERT);
            self.sink.push(diagnostic.alias("GLB_INVALID_VERSION"));
            return None;
        }
        if version != 2 {
            self.add(
                code,
                "GLB_INVALID_VERSION",
                4..8,
                format!("the container has version {version}; rtc reads version 2"),
            );
            return None;
        }
        // The length must leave room for the JSON chunk.
        if length <= HEADER {
            let message = format!(
                "the length in the header is {length} bytes, so there is no room for a JSON chunk"
            );
            self.add(code, "GLB_LENGTH_TOO_SMALL", 8..12, message);
        }
        Some(())
    }

    /// The chunks, up to the length in the header, or else to the end of the file; false if it
    /// ends within one.
    fn chunks(&mut self) -> bool {
        let (declared, size) = (self.word(8).unwrap_or(0), self.bytes.len());
        let mut at = HEADER;
        while at != size {
            // Bytes after the declared length are no chunk.
            if at == declared {
                let message = format!("{} bytes after the last chunk are ignored", size - declared);
                self.add(&codes::GLB_EXTRA, "GLB_EXTRA_DATA", declared..size, message);
                return true;
            }
            // A chunk starts with its length and its type.
            let (Some(length), Some(kind)) =
                (self.word(at), self.bytes.get(at + 4..at + CHUNK_HEADER))
            else {
                let message = "the file ends within the header of a chunk".to_owned();
                self.add(
                    &codes::GLB_CHUNK,
                    "GLB_UNEXPECTED_END_OF_CHUNK_HEADER",
                    at..size,
                    message,
                );
                return false;
            };
            let kind = [kind[0], kind[1], kind[2], kind[3]];
            let start = at + CHUNK_HEADER;
            // Its data may end after the file, which is then truncated.
            let end = start.saturating_add(length);
            self.chunk(kind, at, start..end.min(size), end, declared);
            if end > size {
                self.json = self.json.take().filter(|json| json.start != start);
                let message = format!(
                    "the file is truncated: the chunk needs {} bytes more",
                    end - size
                );
                self.add(
                    &codes::GLB_CHUNK,
                    "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
                    size..size,
                    message,
                );
                return false;
            }
            at = self.next_chunk(end);
        }
        // The chunks must end at the declared length.
        if at != declared {
            let message =
                format!("the length in the header is {declared} bytes, but the file has {at}");
            self.add(&codes::GLB_HEADER, "GLB_LENGTH_MISMATCH", 8..12, message);
        }
        true
    }

    /// One chunk, whose header is at `at` and whose content should end at `end`.
    fn chunk(
        &mut self,
        kind: [u8; 4],
        at: usize,
        content: Range<usize>,
        end: usize,
        declared: usize,
    ) {
        let (header, code) = (at..at + CHUNK_HEADER, &codes::GLB_CHUNK);
        let name = shown(kind);
        self.chunks += 1;
        // Check the length of the chunk.
        if !(end - content.start).is_multiple_of(4) {
            self.unaligned(header.clone(), &name);
        }
        if end > declared {
            let message = format!(
                "the {name} chunk ends at byte {end}, but the header says that the file has \
                 {declared} bytes"
            );
            self.add(code, "GLB_CHUNK_TOO_BIG", header.clone(), message);
        }
        // Check the order of the chunks, and for empty ones.
        if self.chunks == 1 && kind != JSON {
            let message = format!("the first chunk has the type {name}; it must be JSON");
            self.add(code, "GLB_UNEXPECTED_FIRST_CHUNK", header.clone(), message);
        }
        if kind == BIN && content.is_empty() {
            let message = "the binary chunk is empty and can be omitted".to_owned();
            self.add(
                &codes::GLTF_REMARK,
                "GLB_EMPTY_BIN_CHUNK",
                header.clone(),
                message,
            );
        }
        if kind == BIN && self.chunks > 2 && self.bin.is_none() {
            let message = "the binary chunk must be the second chunk".to_owned();
            self.add(code, "GLB_UNEXPECTED_BIN_CHUNK", header.clone(), message);
        }
        if kind == JSON && content.is_empty() {
            self.add(
                code,
                "GLB_EMPTY_CHUNK",
                header.clone(),
                "the JSON chunk is empty".to_owned(),
            );
        }
        // Keep the first JSON chunk and the first binary chunk.
        let slot = match &kind[..] {
            JSON => &mut self.json,
            BIN => &mut self.bin,
            _ => {
                let message = format!("a chunk of the unknown type {name} is ignored");
                return self.add(&codes::GLB_EXTRA, "GLB_UNKNOWN_CHUNK_TYPE", header, message);
            }
        };
        if slot.is_some() {
            let message = format!("there is a second {name} chunk; only one is allowed");
            self.add(code, "GLB_DUPLICATE_CHUNK", header, message);
        } else {
            *slot = Some(content);
        }
    }
}

/// A diagnostic with the advice of its kind. `alias` is the code of the validator, empty if it has
/// none.
pub(super) fn fault(
    code: &'static Code,
    alias: &'static str,
    message: impl Into<String>,
) -> Diagnostic {
    let diagnostic = Diagnostic::new(code, message);
    let diagnostic = diagnostic.alias((!alias.is_empty()).then_some(alias));
    let advice = advice(code, alias).into_iter();
    advice.fold(diagnostic, Diagnostic::hint)
}

/// The type of a chunk, for a message.
fn shown(kind: [u8; 4]) -> String {
    let letters: Vec<u8> = kind.into_iter().take_while(|byte| *byte != 0).collect();
    if letters.iter().all(u8::is_ascii_graphic) && !letters.is_empty() {
        String::from_utf8_lossy(&letters).into_owned()
    } else {
        format!("{:#010x}", u32::from_le_bytes(kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::SourceMap;

    fn open_bytes(bytes: &[u8]) -> (Option<AssetParts>, Vec<&'static str>) {
        let mut map = SourceMap::default();
        let file = map.add("x.glb", bytes.to_vec());
        let mut sink = DiagnosticSink::default();
        let parts = open(file, map.bytes(file), false, &mut sink);
        (
            parts,
            sink.kept()
                .iter()
                .filter_map(|diagnostic| diagnostic.alias)
                .collect(),
        )
    }

    fn glb(chunks: &[(&[u8], &[u8])]) -> Vec<u8> {
        let body: Vec<u8> = chunks
            .iter()
            .flat_map(|(kind, content)| {
                [
                    &u32::try_from(content.len()).unwrap().to_le_bytes()[..],
                    kind,
                    content,
                ]
                .concat()
            })
            .collect();
        let length = u32::try_from(body.len() + HEADER).unwrap();
        [
            MAGIC,
            &2u32.to_le_bytes()[..],
            &length.to_le_bytes()[..],
            &body,
        ]
        .concat()
    }

    #[test]
    fn parts_are_where_the_chunks_say() {
        let bytes = glb(&[(JSON, b"{}  "), (BIN, b"12345678")]);
        let (parts, faults) = open_bytes(&bytes);
        assert_eq!(
            parts,
            Some(AssetParts {
                json: 20..24,
                bin: Some(32..40),
                is_glb: true,
                is_whole: true
            })
        );
        assert!(faults.is_empty(), "{faults:?}");
    }

    #[test]
    fn a_file_that_ends_with_its_header_has_no_scene() {
        let (parts, faults) = open_bytes(&glb(&[]));
        assert_eq!((parts, faults), (None, vec!["GLB_LENGTH_TOO_SMALL"]));
    }

    #[test]
    fn every_cut_is_found() {
        let bytes = glb(&[(JSON, b"{}  "), (BIN, b"12345678")]);
        for length in 0..bytes.len() {
            let (_, faults) = open_bytes(&bytes[..length]);
            assert!(!faults.is_empty(), "cut to {length} bytes");
        }
    }
}
