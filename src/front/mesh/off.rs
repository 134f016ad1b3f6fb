//! OFF, the object file format of Geomview: a head, three counts, a line a vertex, a line a face.
//!
//! Nothing is allocated by a count: the lines that are there are read.

use super::polygons::{CORNER, Polygons};
use super::stroke::Segments;
use super::tint::VertexColors;
use super::{MAX_FAULTS, MeshOptions, ParsedMesh, TextParseError};
use crate::words::{Word, WordError, WordLines, numbers};
use rtc_source::{Budget, LimitExceeded, Resource};

/// True if the word begins an OFF file of any variant.
pub(super) fn is_head(word: &Word<'_>) -> bool {
    word.bytes.ends_with(b"OFF") && word.bytes.len() <= 6
}

/// Reads an OFF. Normals and colours of vertices are kept, of faces colours.
pub(super) fn parse(
    bytes: &[u8],
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    // A corner takes two bytes.
    budget.has(Resource::Memory, (CORNER / 2 * bytes.len()) as u64)?;
    let mut reader = OffReader {
        lines: WordLines::new(bytes),
        words: Vec::new(),
    };
    let (mut faults, mut content) = (Vec::new(), OffContent::default());
    match head(&mut reader) {
        Ok(head) => body(&mut reader, &head, &mut content, &mut faults),
        Err(fault) => faults.push(fault),
    }
    if !faults.is_empty() {
        return Err(TextParseError::Faults(faults));
    }
    Ok(content.finish(options, budget)?)
}

struct OffReader<'a> {
    lines: WordLines<'a>,
    words: Vec<Word<'a>>,
}

impl<'a> OffReader<'a> {
    /// The words of the next line; `count` names the count that announced it.
    fn line(&mut self, count: &OffCount<'a>) -> Result<&[Word<'a>], WordError> {
        if self.lines.next(&mut self.words) {
            return Ok(&self.words);
        }
        let OffCount {
            word,
            value,
            entity,
        } = count;
        Err(word.fault(
            format!("the file ends before the last of {value} {entity}"),
            "promised here",
        ))
    }
}

/// A count of the head.
struct OffCount<'a> {
    word: Word<'a>,
    value: usize,
    entity: &'static str,
}

struct OffHeader<'a> {
    has_normals: bool,
    vertices: OffCount<'a>,
    faces: OffCount<'a>,
}

fn head<'a>(reader: &mut OffReader<'a>) -> Result<OffHeader<'a>, WordError> {
    reader.lines.next(&mut reader.words);
    let head = reader.words[0];
    let has_normals = match head.bytes {
        b"OFF" | b"COFF" => false,
        b"NOFF" | b"CNOFF" => true,
        _ => {
            let message = format!("`{}` is a kind of OFF that is not supported", head.text());
            return Err(head.fault(message, "OFF, COFF, NOFF and CNOFF are read"));
        }
    };
    if let Some(binary) = reader.words.get(1).filter(|word| word.bytes == b"BINARY") {
        return Err(binary.fault("binary OFF is not supported", "only the text form is read"));
    }
    // The counts are on the header line or on the next.
    let mut counts = reader.words[1..].to_vec();
    if counts.is_empty() {
        reader.lines.next(&mut counts);
    }
    let count = |at: usize, entity| {
        let word = *counts.get(at).ok_or_else(|| {
            head.fault(format!("the number of {entity} is missing"), "after this")
        })?;
        let value = usize::try_from(word.integer()?);
        let value = value.map_err(|_| {
            word.fault(
                format!("there can't be {} {entity}", word.text()),
                "negative",
            )
        })?;
        Ok(OffCount {
            word,
            value,
            entity,
        })
    };
    Ok(OffHeader {
        has_normals,
        vertices: count(0, "vertices")?,
        faces: count(1, "faces")?,
    })
}

/// The contents of an OFF file.
#[derive(Default)]
struct OffContent {
    parsed: ParsedMesh,
    polygons: Polygons,
    /// The colour of each polygon.
    tints: VertexColors,
    strokes: Segments,
}

impl OffContent {
    fn finish(
        mut self,
        options: MeshOptions,
        budget: &Budget,
    ) -> Result<ParsedMesh, LimitExceeded> {
        let mut parsed = self.parsed;
        if parsed.mesh.colors.is_empty() {
            self.polygons.colors = self.tints.linear();
        } else if !self.tints.is_empty() {
            parsed.skip(|| Word::START.fault("its vertices have colours", "faces have too"));
        }
        let missing = || Word::START.fault("a corner is not there", "in this file");
        self.polygons.cut(&mut parsed, missing, budget)?;
        parsed.draw(self.strokes, options, budget)?;
        Ok(parsed)
    }
}

fn body<'a>(
    reader: &mut OffReader<'a>,
    head: &OffHeader<'a>,
    content: &mut OffContent,
    faults: &mut Vec<WordError>,
) {
    let (mut positions, mut normals, mut tints) = (Vec::new(), Vec::new(), VertexColors::default());
    // Read a position per line, with a normal and a colour if declared.
    for _ in 0..head.vertices.value {
        let words = match reader.line(&head.vertices) {
            Ok(words) => words,
            Err(end) => return faults.push(end),
        };
        match vertex(words, head.has_normals) {
            Ok((position, normal)) => {
                positions.push(position);
                normals.extend(normal);
                let read = if head.has_normals { 6 } else { 3 };
                tint(words.get(read..).unwrap_or_default(), &mut tints);
            }
            Err(fault) => faults.push(fault),
        }
        if faults.len() >= MAX_FAULTS {
            return;
        }
    }
    // Store the attributes, and read a polygon per line.
    let mesh = &mut content.parsed.mesh;
    (mesh.positions, mesh.normals) = (positions.into(), normals.into());
    mesh.colors = tints.column();
    for _ in 0..head.faces.value {
        match reader.line(&head.faces) {
            Ok(words) => faults.extend(face(words, &head.vertices, content).err()),
            Err(end) => return faults.push(end),
        }
        if faults.len() >= MAX_FAULTS {
            return;
        }
    }
}

/// Adds the colour of some words, if they are one.
fn tint(words: &[Word<'_>], tints: &mut VertexColors) {
    let channels: Vec<f64> = words
        .iter()
        .take(4)
        .map_while(|word| word.number().ok())
        .collect();
    match channels.len() {
        3 | 4 => tints.push(&channels),
        _ => tints.skip(),
    }
}

/// The position of a vertex, and its normal if there are any.
fn vertex(
    words: &[Word<'_>],
    has_normals: bool,
) -> Result<([f64; 3], Option<[f64; 3]>), WordError> {
    let position = numbers(&words[0], words)?;
    let normal = || numbers(&words[0], words.get(3..).unwrap_or_default());
    Ok((position, has_normals.then(normal).transpose()?))
}

/// A polygon; after its corners follows its colour. With two corners it is a line, with one a
/// point.
fn face(
    words: &[Word<'_>],
    vertices: &OffCount<'_>,
    content: &mut OffContent,
) -> Result<(), WordError> {
    let (head, rest) = (&words[0], &words[1..]);
    let arity = head.integer()?;
    let corners = usize::try_from(arity)
        .ok()
        .and_then(|arity| rest.split_at_checked(arity));
    let Some((corners, color)) = corners else {
        let message = format!("a face of {arity} corners names {}", rest.len());
        return Err(head.fault(message, "on this line"));
    };
    for corner in corners {
        match index(corner, vertices)? {
            Ok(vertex) => content.polygons.corner(vertex),
            Err(fault) => {
                content.polygons.discard_polygon();
                content.parsed.skip(|| fault);
                return Ok(());
            }
        }
    }
    if corners.len() < 3 {
        let row = content.polygons.discard_polygon();
        content.strokes.row(&row);
        return Ok(());
    }
    content.polygons.end();
    tint(color, &mut content.tints);
    Ok(())
}

/// The vertex of a corner; an error inside if there is none.
fn index(corner: &Word<'_>, vertices: &OffCount<'_>) -> Result<Result<u32, WordError>, WordError> {
    let number = corner.integer()?;
    let index = u32::try_from(number)
        .ok()
        .filter(|index| (*index as usize) < vertices.value);
    Ok(index.ok_or_else(|| {
        let message = format!(
            "a face refers to vertex {number}, but there are only {}, from 0",
            vertices.value
        );
        corner.fault(message, "there is no such vertex")
    }))
}
