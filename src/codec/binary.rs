//! The binary form, `.rtir`: 8 bytes magic, container version and header length (u32 each), a CRC-32 of all that and
//! of the header, the header in JSON, then sections.
//!
//! The header holds the scene's small parts and the tables its lists are made of. A change of any bit is found, and
//! nothing is allocated that the length of the file does not warrant.

use super::columns::{self, Stock, Table};
use super::section::{self, ALIGNMENT, Body, Entry};
use super::{CHECKSUMS_COUNT, Decoded, newer, span, typed};
use crate::diag::{Code, Diagnostic, codes};
use crate::ir::{Scene, VERSION};
use crate::source::FileId;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A byte with the eighth bit set, a name, CR LF, the old end-of-file character, LF: whatever takes the file for text
/// changes one of them.
const MAGIC: [u8; 8] = *b"\x89RTI\r\n\x1a\n";

/// The beginnings of a magic that was taken for Latin-1 or for broken UTF-8 and written again.
const RECODED: [&[u8]; 2] = [b"\xc2\x89RTI", b"\xef\xbf\xbdRTI"];

/// The version of the container; that of the IR within is in the header.
const CONTAINER_VERSION: u32 = 1;

/// Where the header starts. The bytes before it mean the same in every version.
const PREAMBLE: usize = 20;

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Header {
    ir_version: u32,
    #[serde(default)]
    scene: Map<String, Value>,
    #[serde(default)]
    tables: Vec<Table>,
    #[serde(default)]
    sections: Vec<Entry>,
}

/// The part of the header that every version has.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    ir_version: u32,
}

/// True if the bytes begin with the magic, or with what a mishap leaves of it.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(MAGIC.len())];
    let same = start.iter().zip(&MAGIC).filter(|(byte, magic)| byte == magic).count();
    let begun = !start.is_empty() && same == start.len();
    begun || same >= MAGIC.len() / 2 || RECODED.iter().any(|recoded| bytes.starts_with(recoded))
}

/// Encodes the tree of a scene.
pub(super) fn encode(tree: Map<String, Value>) -> Vec<u8> {
    let mut body = Body::default();
    let mut header = Header { ir_version: VERSION, scene: Map::new(), tables: Vec::new(), sections: Vec::new() };
    for (key, member) in tree {
        if let Value::Array(entities) = member {
            header.tables.push(columns::pack(key, entities, &mut body));
        } else {
            header.scene.insert(key, member);
        }
    }
    header.sections = body.entries;
    let header = serde_json::to_vec(&header).expect("the header is made of maps with string keys, lists and numbers");
    let length = u32::try_from(header.len()).expect("the header holds kinds of entities, not the entities");
    let mut file = Vec::with_capacity(PREAMBLE + header.len() + ALIGNMENT + body.bytes.len());
    file.extend(MAGIC);
    file.extend(CONTAINER_VERSION.to_le_bytes());
    file.extend(length.to_le_bytes());
    file.extend(checksum(&file, &header).to_le_bytes());
    file.extend(header);
    file.resize(file.len().next_multiple_of(ALIGNMENT), 0);
    file.extend(body.bytes);
    file
}

/// The CRC-32 of what stands before the checksum and of the header behind it.
fn checksum(before: &[u8], header: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(before);
    crc.update(header);
    crc.finalize()
}

/// Decodes the container.
pub(super) fn decode(file: FileId, bytes: &[u8]) -> Decoded<Scene> {
    let container = Container { file, bytes };
    let end = container.check_preamble()?;
    let header = container.header(end)?;
    let sections = section::open(&container, end, &header.sections)?;
    let mut scene = header.scene;
    let mut stock = Stock::new(&sections, &container);
    for table in &header.tables {
        let entities = columns::unpack(table, &mut stock, &container)?;
        if scene.insert(table.key.clone(), Value::Array(entities)).is_some() {
            let message = format!("the scene has two `{}`", table.key.escape_debug());
            return Err(container.fault(&codes::MALFORMED, message, PREAMBLE, end));
        }
    }
    typed(header.ir_version, Value::Object(scene), span(file, PREAMBLE, end))
}

/// A file of the binary form, of whose bytes nothing is known yet.
pub(super) struct Container<'a> {
    file: FileId,
    pub(super) bytes: &'a [u8],
}

impl Container<'_> {
    /// Checks magic, length, checksum and version, in this order, and returns where the header ends.
    fn check_preamble(&self) -> Decoded<usize> {
        let differs = self.bytes.iter().zip(&MAGIC).position(|(byte, magic)| byte != magic);
        if let Some(at) = differs {
            return Err(self.wrong_magic(at));
        }
        let Some(preamble) = self.bytes.first_chunk::<PREAMBLE>() else {
            return Err(self.truncated(PREAMBLE, "the preamble"));
        };
        let word = |at: usize| u32::from_le_bytes([preamble[at], preamble[at + 1], preamble[at + 2], preamble[at + 3]]);
        let (version, length, expected) = (word(8), word(12), word(16));
        let end = PREAMBLE.saturating_add(length as usize);
        let Some(header) = self.bytes.get(PREAMBLE..end) else { return Err(self.truncated(end, "the header")) };
        if CHECKSUMS_COUNT && checksum(&preamble[..16], header) != expected {
            let message = format!("the checksum of the header, bytes 0 to {end}, is wrong");
            return Err(self.fault(&codes::DAMAGED, message, 0, end));
        }
        if version > CONTAINER_VERSION {
            return Err(newer(version, "container", CONTAINER_VERSION, span(self.file, 8, 12)));
        }
        Ok(end)
    }

    fn header(&self, end: usize) -> Decoded<Header> {
        let text = &self.bytes[PREAMBLE..end];
        let malformed = |error: serde_json::Error| {
            self.fault(&codes::MALFORMED, format!("the header, bytes {PREAMBLE} to {end}: {error}"), PREAMBLE, end)
        };
        let Head { ir_version } = serde_json::from_slice(text).map_err(malformed)?;
        if ir_version > VERSION {
            return Err(newer(ir_version, "IR", VERSION, span(self.file, PREAMBLE, end)));
        }
        serde_json::from_slice(text).map_err(malformed)
    }

    fn wrong_magic(&self, at: usize) -> Box<Diagnostic> {
        let message = format!("the byte at offset {at} is not that of a binary IR file");
        let fault = self.fault(&codes::WRONG_MAGIC, message, at, at + 1);
        let recoded = RECODED.iter().any(|recoded| self.bytes.starts_with(recoded));
        let hint = match self.bytes {
            _ if recoded => "the file was taken for text and written again as UTF-8; copy it as binary",
            [0x89, b'R', b'T', b'I', b'\n', ..] | [0x89, b'R', b'T', b'I', b'\r', b'\r', ..] => {
                "the line ends of the file were changed, as for a text; copy it as binary"
            }
            [0x09, ..] => "the eighth bit of every byte was cut off; copy the file as binary",
            _ => "copy the file again, or compile the scene again",
        };
        Box::new(fault.hint(hint))
    }

    /// The file ends before `end`, where `what` ends.
    pub(super) fn truncated(&self, end: usize, what: &str) -> Box<Diagnostic> {
        let length = self.bytes.len();
        let message = format!("the file ends at byte {length}, but {what} goes on to byte {end}");
        self.fault(&codes::TRUNCATED, message, length, length)
    }

    /// A fault at bytes `start..end`.
    pub(super) fn fault(&self, code: &'static Code, message: String, start: usize, end: usize) -> Box<Diagnostic> {
        let length = self.bytes.len();
        let place = span(self.file, start.min(length), end.min(length));
        Box::new(Diagnostic::new(code, message).at(place, format!("at byte {start}")))
    }
}
