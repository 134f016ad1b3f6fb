//! The binary form, `.rtir`: 8 bytes magic, container version and header length (u32 each), a
//! CRC-32 of all that and of the header, the header in JSON, then sections.
//!
//! The header holds the scene's small parts, the tables its lists are made of, and which sections
//! are the columns of a mesh or the pixels of an image. A change of any bit is found, and nothing
//! is allocated that the length of the file does not warrant. Files are read whole, not mapped:
//! that takes 40 ms for a million triangles, and a mapped file may shrink under its reader.

use super::columns::{self, Stock, Table};
use super::section::{self, ALIGNMENT, SectionEntry, SectionWriter};
use super::{
    CHECKSUMS_COUNT, Decoded, NotFinite, image, mesh, newer, span, tree, typed, wrong_shape,
};
use rtc_diag::{Code, Diagnostic, codes};
use rtc_ir::{Display, Mesh, Scene, Surface, VERSION};
use rtc_source::{FileId, Span};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io::{self, Write};

/// A byte with the eighth bit set, a name, CR LF, the old end-of-file character, LF: whatever takes
/// the file for text changes one of them.
const MAGIC: [u8; 8] = *b"\x89RTI\r\n\x1a\n";

/// The beginnings of a magic that was taken for Latin-1 or for broken UTF-8 and written again.
const RECODED: [&[u8]; 2] = [b"\xc2\x89RTI", b"\xef\xbf\xbdRTI"];

/// The version of the container; that of the IR within is in the header.
const CONTAINER_VERSION: u32 = 1;

/// Where the header starts. The bytes before it mean the same in every version.
const PREAMBLE: usize = 20;

/// The one list that may be long and is made of small parts: it is typed part by part.
const SURFACES: &str = "surfaces";

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Header {
    ir_version: u32,
    #[serde(default)]
    scene: Map<String, Value>,
    #[serde(default)]
    tables: Vec<Table>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    images: Vec<image::StoredImage>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<mesh::StoredMesh>,
    #[serde(default)]
    sections: Vec<SectionEntry>,
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
    let same = start
        .iter()
        .zip(&MAGIC)
        .filter(|(byte, magic)| byte == magic)
        .count();
    let begun = !start.is_empty() && same == start.len();
    begun || same >= MAGIC.len() / 2 || RECODED.iter().any(|recoded| bytes.starts_with(recoded))
}

/// A scene as a container, its columns still where the scene has them.
pub(super) struct ContainerDraft<'s> {
    /// Preamble, header and padding.
    head: Vec<u8>,
    body: SectionWriter<'s>,
}

impl ContainerDraft<'_> {
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.head)?;
        self.body.write(out)
    }
}

/// Encodes a scene, to be shown so.
pub(super) fn encode<'s>(
    scene: &'s Scene,
    display: &Display,
) -> Result<ContainerDraft<'s>, NotFinite> {
    let Scene {
        camera,
        settings,
        lights,
        images,
        textures,
        meshes,
        materials,
        surfaces,
        names,
        environment,
        display: _,
    } = scene;
    if !meshes.iter().all(Mesh::is_finite) {
        return Err(NotFinite);
    }
    let mut body = SectionWriter::default();
    let tables = vec![
        columns::pack("lights", lights, &mut body)?,
        columns::pack("textures", textures, &mut body)?,
        columns::pack("materials", materials, &mut body)?,
        columns::pack(SURFACES, surfaces, &mut body)?,
    ];
    let images = images
        .iter()
        .map(|image| image::store(image, &mut body))
        .collect();
    let meshes = meshes
        .iter()
        .map(|mesh| mesh::store(mesh, &mut body))
        .collect();
    let mut scene = Map::new();
    scene.insert("camera".to_owned(), tree(camera)?);
    scene.insert("settings".to_owned(), tree(settings)?);
    if !names.is_empty() {
        scene.insert("names".to_owned(), tree(names)?);
    }
    if let Some(environment) = environment {
        scene.insert("environment".to_owned(), tree(environment)?);
    }
    if !display.is_plain() {
        scene.insert("display".to_owned(), tree(display)?);
    }
    let header = Header {
        ir_version: VERSION,
        scene,
        tables,
        images,
        meshes,
        sections: std::mem::take(&mut body.entries),
    };
    Ok(ContainerDraft {
        head: head(&header),
        body,
    })
}

/// All that stands before the first section.
fn head(header: &Header) -> Vec<u8> {
    let header = serde_json::to_vec(header)
        .expect("the header is made of maps with string keys, lists and numbers");
    let length = u32::try_from(header.len()).expect("no file that is read has so many parts");
    let mut head = Vec::with_capacity(PREAMBLE + header.len() + ALIGNMENT);
    head.extend(MAGIC);
    head.extend(CONTAINER_VERSION.to_le_bytes());
    head.extend(length.to_le_bytes());
    head.extend(checksum(&head, &header).to_le_bytes());
    head.extend(header);
    head.resize(head.len().next_multiple_of(ALIGNMENT), 0);
    head
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
    let mut stock = Stock::new(&sections, &container);
    let images = header
        .images
        .iter()
        .map(|stored| stored.load(&mut stock))
        .collect::<Option<Vec<_>>>();
    let meshes = header
        .meshes
        .iter()
        .map(|stored| stored.load(&mut stock))
        .collect::<Option<Vec<_>>>();
    let malformed = |message| container.fault(&codes::MALFORMED, message, PREAMBLE, end);
    let (Some(images), Some(meshes)) = (images, meshes) else {
        return Err(malformed(
            "an image or a mesh has no sections of the kind it says".to_owned(),
        ));
    };
    let place = span(file, PREAMBLE, end);
    let (mut tree, mut surfaces) = (header.scene, Vec::new());
    for table in &header.tables {
        let mut entities = Vec::new();
        if header.ir_version == VERSION && table.key == SURFACES {
            columns::unpack(table, &mut stock, &container, |entity| {
                surfaces.push(surface(entity, place)?);
                Ok(())
            })?;
        } else {
            columns::unpack(table, &mut stock, &container, |entity| {
                entities.push(entity);
                Ok(())
            })?;
        }
        if tree
            .insert(table.key.clone(), Value::Array(entities))
            .is_some()
        {
            return Err(malformed(format!(
                "the scene has two `{}`",
                table.key.escape_debug()
            )));
        }
    }
    let mut scene = typed(header.ir_version, Value::Object(tree), place)?;
    scene.images.extend(images);
    scene.meshes.extend(meshes);
    scene.surfaces.extend(surfaces);
    Ok(scene)
}

fn surface(tree: Value, place: Span) -> Decoded<Surface> {
    serde_json::from_value(tree).map_err(|error| wrong_shape(&error.to_string(), place))
}

/// A file of the binary form, of whose bytes nothing is known yet.
pub(super) struct Container<'a> {
    file: FileId,
    pub(super) bytes: &'a [u8],
}

impl Container<'_> {
    /// Checks magic, length, checksum and version, in this order, and returns where the header
    /// ends.
    fn check_preamble(&self) -> Decoded<usize> {
        let differs = self
            .bytes
            .iter()
            .zip(&MAGIC)
            .position(|(byte, magic)| byte != magic);
        if let Some(at) = differs {
            return Err(self.wrong_magic(at));
        }
        let Some(preamble) = self.bytes.first_chunk::<PREAMBLE>() else {
            return Err(self.truncated(PREAMBLE, "the preamble"));
        };
        let word = |at: usize| {
            u32::from_le_bytes([
                preamble[at],
                preamble[at + 1],
                preamble[at + 2],
                preamble[at + 3],
            ])
        };
        let (version, length, expected) = (word(8), word(12), word(16));
        let end = PREAMBLE.saturating_add(length as usize);
        let Some(header) = self.bytes.get(PREAMBLE..end) else {
            return Err(self.truncated(end, "the header"));
        };
        if CHECKSUMS_COUNT && checksum(&preamble[..16], header) != expected {
            let message = format!("the checksum of the header, bytes 0 to {end}, is wrong");
            return Err(self.fault(&codes::DAMAGED, message, 0, end));
        }
        if version > CONTAINER_VERSION {
            return Err(newer(
                version,
                "container",
                CONTAINER_VERSION,
                span(self.file, 8, 12),
            ));
        }
        Ok(end)
    }

    fn header(&self, end: usize) -> Decoded<Header> {
        let text = &self.bytes[PREAMBLE..end];
        let malformed = |error: serde_json::Error| {
            self.fault(
                &codes::MALFORMED,
                format!("the header, bytes {PREAMBLE} to {end}: {error}"),
                PREAMBLE,
                end,
            )
        };
        let Head { ir_version } = serde_json::from_slice(text).map_err(malformed)?;
        if ir_version > VERSION {
            return Err(newer(
                ir_version,
                "IR",
                VERSION,
                span(self.file, PREAMBLE, end),
            ));
        }
        serde_json::from_slice(text).map_err(malformed)
    }

    fn wrong_magic(&self, at: usize) -> Box<Diagnostic> {
        let message = format!("the byte at offset {at} is not that of a binary IR file");
        let fault = self.fault(&codes::WRONG_MAGIC, message, at, at + 1);
        let recoded = RECODED
            .iter()
            .any(|recoded| self.bytes.starts_with(recoded));
        let hint = match self.bytes {
            _ if recoded => {
                "the file was taken for text and written again as UTF-8; copy it as binary"
            }
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
    pub(super) fn fault(
        &self,
        code: &'static Code,
        message: String,
        start: usize,
        end: usize,
    ) -> Box<Diagnostic> {
        let length = self.bytes.len();
        let place = span(self.file, start.min(length), end.min(length));
        Box::new(Diagnostic::new(code, message).at(place, format!("at byte {start}")))
    }
}
