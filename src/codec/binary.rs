//! The binary encoding, `.rtir`: 8 bytes of magic, container version and header length (u32 each),
//! a CRC-32 of these and of the header, the header as JSON, then sections.
//!
//! The header holds the entities of the scene, the tables of its lists, and the indices of the
//! sections with mesh columns and image pixels. Any changed bit is detected, and decoding allocates
//! memory in proportion to the length of the file only. Files are read, not memory-mapped: reading
//! takes 40 ms for a million triangles, and a mapped file could be truncated by another process.

use super::columns::{self, EntityTable, SectionReader};
use super::container::{CHECKSUMS_COUNT, Container};
use super::decoded::{Decoded, span, wrong_shape};
use super::section::{self, ALIGNMENT, SectionEntry, SectionWriter};
use super::tree::{NonFiniteNumber, tree};
use super::version::{VersionField, newer, typed};
use super::{image, mesh, stored};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{Display, Mesh, Scene, StoredTree, Surface, VERSION};
use rtc_source::{FileId, Span};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io::{self, Write};

/// A byte with its high bit set, a name, CR LF, the DOS end-of-file character, LF: any conversion
/// as text changes one of them.
const MAGIC: [u8; 8] = *b"\x89RTI\r\n\x1a\n";

/// The first bytes of a magic that was decoded as Latin-1 or as broken UTF-8 and encoded again.
const RECODED: [&[u8]; 2] = [b"\xc2\x89RTI", b"\xef\xbf\xbdRTI"];

/// The version of the container; the IR version is in the header.
const CONTAINER_VERSION: u32 = 1;

/// The offset of the header. The bytes before it have the same meaning in every version.
const PREAMBLE: usize = 20;

/// The only list that can be long and has small items; its items are decoded one by one.
const SURFACES: &str = "surfaces";

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Header {
    ir_version: u32,
    #[serde(default)]
    scene: Map<String, Value>,
    #[serde(default)]
    tables: Vec<EntityTable>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    images: Vec<image::StoredImage>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<mesh::StoredMesh>,
    /// Readers that do not know them leave them out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    trees: Vec<stored::StoredTreeSections>,
    #[serde(default)]
    sections: Vec<SectionEntry>,
}

/// Whether the bytes begin with the magic or a damaged magic.
pub(super) fn has_magic(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(MAGIC.len())];
    let same = start
        .iter()
        .zip(&MAGIC)
        .filter(|(byte, magic)| byte == magic)
        .count();
    let begun = !start.is_empty() && same == start.len();
    begun || same >= MAGIC.len() / 2 || RECODED.iter().any(|recoded| bytes.starts_with(recoded))
}

/// A container that borrows the columns of its scene.
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

/// Encodes a scene with these display settings and hierarchies.
pub(super) fn encode<'s>(
    scene: &'s Scene,
    display: &Display,
    trees: &'s [StoredTree],
) -> Result<ContainerDraft<'s>, NonFiniteNumber> {
    // Reject numbers that have no encoding.
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
        medium,
        display: _,
        trees: _,
    } = scene;
    if !meshes.iter().all(Mesh::is_finite) {
        return Err(NonFiniteNumber);
    }
    // Move lists of entities, pixels and mesh columns into sections.
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
    let trees = trees
        .iter()
        .map(|tree| stored::store(tree, &mut body))
        .collect();
    // The small parts of the scene stay in the header.
    let mut scene = Map::new();
    scene.insert("camera".to_owned(), tree(camera)?);
    scene.insert("settings".to_owned(), tree(settings)?);
    if !names.is_empty() {
        scene.insert("names".to_owned(), tree(names)?);
    }
    if let Some(environment) = environment {
        scene.insert("environment".to_owned(), tree(environment)?);
    }
    if let Some(medium) = medium {
        scene.insert("medium".to_owned(), tree(medium)?);
    }
    if !display.is_plain() {
        scene.insert("display".to_owned(), tree(display)?);
    }
    // The header refers to the sections by index.
    let header = Header {
        ir_version: VERSION,
        scene,
        tables,
        images,
        meshes,
        trees,
        sections: std::mem::take(&mut body.entries),
    };
    Ok(ContainerDraft {
        head: head(&header),
        body,
    })
}

/// Everything before the first section.
fn head(header: &Header) -> Vec<u8> {
    let header = serde_json::to_vec(header)
        .expect("the header is made of maps with string keys, lists and numbers");
    let length = u32::try_from(header.len()).expect("no file that is read has 2³² parts");
    let mut head = Vec::with_capacity(PREAMBLE + header.len() + ALIGNMENT);
    head.extend(MAGIC);
    head.extend(CONTAINER_VERSION.to_le_bytes());
    head.extend(length.to_le_bytes());
    head.extend(checksum(&head, &header).to_le_bytes());
    head.extend(header);
    head.resize(head.len().next_multiple_of(ALIGNMENT), 0);
    head
}

/// The CRC-32 of the bytes before the checksum and of the header after it.
fn checksum(before: &[u8], header: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new();
    crc.update(before);
    crc.update(header);
    crc.finalize()
}

/// Decodes the container.
pub(super) fn decode(file: FileId, bytes: &[u8]) -> Decoded<Scene> {
    // Verify preamble, header and sections.
    let container = Container { file, bytes };
    let end = container.check_preamble()?;
    let header = container.header(end)?;
    let sections = section::open(&container, end, &header.sections)?;
    let mut reader = SectionReader::new(&sections, &container);
    // Read images and meshes from their sections.
    let images = header
        .images
        .iter()
        .map(|stored| stored.load(&mut reader))
        .collect::<Option<Vec<_>>>();
    let meshes = header
        .meshes
        .iter()
        .map(|stored| stored.load(&mut reader))
        .collect::<Option<Vec<_>>>();
    let trees = header
        .trees
        .iter()
        .map(|stored| stored.load(&mut reader))
        .collect::<Option<Vec<_>>>();
    let malformed = |message| container.error_at(&codes::MALFORMED, message, PREAMBLE, end);
    let (Some(images), Some(meshes), Some(trees)) = (images, meshes, trees) else {
        return Err(malformed(
            "an image, a mesh or a hierarchy has no sections of its declared kind".to_owned(),
        ));
    };
    // Unpack each table to a list of entities; surfaces are typed one by one.
    let span = span(file, PREAMBLE, end);
    let (mut tree, mut surfaces) = (header.scene, Vec::new());
    for table in &header.tables {
        let mut entities = Vec::new();
        if header.ir_version == VERSION && table.key == SURFACES {
            columns::unpack(table, &mut reader, &container, |entity| {
                surfaces.push(surface(entity, span)?);
                Ok(())
            })?;
        } else {
            columns::unpack(table, &mut reader, &container, |entity| {
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
    // Upgrade and type the tree, then add the sections.
    let mut scene = typed(header.ir_version, Value::Object(tree), span)?;
    scene.images.extend(images);
    scene.meshes.extend(meshes);
    scene.trees = trees;
    scene.surfaces.extend(surfaces);
    Ok(scene)
}

fn surface(tree: Value, span: Span) -> Decoded<Surface> {
    serde_json::from_value(tree).map_err(|error| wrong_shape(&error.to_string(), span))
}

impl Container<'_> {
    /// Checks magic, length, checksum and version, in this order. Returns the end of the header.
    fn check_preamble(&self) -> Decoded<usize> {
        // Magic.
        let differs = self
            .bytes
            .iter()
            .zip(&MAGIC)
            .position(|(byte, magic)| byte != magic);
        if let Some(at) = differs {
            return Err(self.wrong_magic(at));
        }
        // Length.
        let Some(preamble) = self.bytes.first_chunk::<PREAMBLE>() else {
            return Err(self.truncated(PREAMBLE, "the preamble"));
        };
        let read_u32 = |at: usize| {
            u32::from_le_bytes([
                preamble[at],
                preamble[at + 1],
                preamble[at + 2],
                preamble[at + 3],
            ])
        };
        let (version, length, expected) = (read_u32(8), read_u32(12), read_u32(16));
        let end = PREAMBLE.saturating_add(length as usize);
        let Some(header) = self.bytes.get(PREAMBLE..end) else {
            return Err(self.truncated(end, "the header"));
        };
        // Checksum.
        if CHECKSUMS_COUNT && checksum(&preamble[..16], header) != expected {
            let message = format!("the checksum of the header, bytes 0 to {end}, is wrong");
            return Err(self.error_at(&codes::DAMAGED, message, 0, end));
        }
        // Version.
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
            self.error_at(
                &codes::MALFORMED,
                format!("the header, bytes {PREAMBLE} to {end}: {error}"),
                PREAMBLE,
                end,
            )
        };
        let VersionField { ir_version } = serde_json::from_slice(text).map_err(malformed)?;
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
        let error = self.error_at(&codes::WRONG_MAGIC, message, at, at + 1);
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
        Box::new(error.hint(hint))
    }
}
