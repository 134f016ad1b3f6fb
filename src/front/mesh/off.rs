//! OFF, the object file format of Geomview: a head, three counts, a line a vertex, a line a face.
//!
//! Nothing is allocated by a count: the lines that are there are read.

use super::{MAX_FAULTS, Parsed, Unread, charge};
use crate::words::{Lines, Word, WordFault, numbers};
use rtc_source::{Budget, Resource};

/// True if the word opens an OFF file of any kind.
pub(super) fn is_head(word: &Word<'_>) -> bool {
    word.bytes.ends_with(b"OFF") && word.bytes.len() <= 6
}

/// Reads an OFF. Normals of vertices are kept, colours are not.
pub(super) fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    // A corner of two bytes becomes a triangle of twelve, in a list that grows by doubling.
    budget.has(Resource::Memory, 12 * bytes.len() as u64)?;
    let mut reader = Reader {
        lines: Lines::new(bytes),
        words: Vec::new(),
    };
    let mut faults = Vec::new();
    let mut parsed = Parsed::default();
    match head(&mut reader) {
        Ok(head) => body(&mut reader, &head, &mut parsed, &mut faults),
        Err(fault) => faults.push(fault),
    }
    if !faults.is_empty() {
        return Err(Unread::Faults(faults));
    }
    charge(&mut parsed.mesh, budget)?;
    Ok(parsed)
}

struct Reader<'a> {
    lines: Lines<'a>,
    words: Vec<Word<'a>>,
}

impl<'a> Reader<'a> {
    /// The words of the next line; `count` says who promised one.
    fn line(&mut self, count: &Count<'a>) -> Result<&[Word<'a>], WordFault> {
        if self.lines.next(&mut self.words) {
            return Ok(&self.words);
        }
        let Count { word, value, noun } = count;
        Err(word.fault(
            format!("the file ends before the last of {value} {noun}"),
            "promised here",
        ))
    }
}

/// A count of the head.
struct Count<'a> {
    word: Word<'a>,
    value: usize,
    noun: &'static str,
}

struct Head<'a> {
    has_normals: bool,
    vertices: Count<'a>,
    faces: Count<'a>,
}

fn head<'a>(reader: &mut Reader<'a>) -> Result<Head<'a>, WordFault> {
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
    // The counts stand on the line of the head or on the next.
    let mut counts = reader.words[1..].to_vec();
    if counts.is_empty() {
        reader.lines.next(&mut counts);
    }
    let count = |at: usize, noun| {
        let word = *counts
            .get(at)
            .ok_or_else(|| head.fault(format!("the number of {noun} is missing"), "after this"))?;
        let value = usize::try_from(word.integer()?);
        let value = value.map_err(|_| {
            word.fault(format!("there can't be {} {noun}", word.text()), "negative")
        })?;
        Ok(Count { word, value, noun })
    };
    Ok(Head {
        has_normals,
        vertices: count(0, "vertices")?,
        faces: count(1, "faces")?,
    })
}

fn body<'a>(
    reader: &mut Reader<'a>,
    head: &Head<'a>,
    parsed: &mut Parsed,
    faults: &mut Vec<WordFault>,
) {
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for _ in 0..head.vertices.value {
        let words = match reader.line(&head.vertices) {
            Ok(words) => words,
            Err(end) => return faults.push(end),
        };
        match vertex(words, head.has_normals) {
            Ok((position, normal)) => {
                positions.push(position);
                normals.extend(normal);
            }
            Err(fault) => faults.push(fault),
        }
        if faults.len() >= MAX_FAULTS {
            return;
        }
    }
    (parsed.mesh.positions, parsed.mesh.normals) = (positions.into(), normals.into());
    for _ in 0..head.faces.value {
        match reader.line(&head.faces) {
            Ok(words) => faults.extend(face(words, &head.vertices, parsed).err()),
            Err(end) => return faults.push(end),
        }
        if faults.len() >= MAX_FAULTS {
            return;
        }
    }
}

/// The position of a vertex, and its normal if there are any.
fn vertex(
    words: &[Word<'_>],
    has_normals: bool,
) -> Result<([f64; 3], Option<[f64; 3]>), WordFault> {
    let position = numbers(&words[0], words)?;
    let normal = || numbers(&words[0], words.get(3..).unwrap_or_default());
    Ok((position, has_normals.then(normal).transpose()?))
}

/// A polygon, as the fan of its triangles; what follows its corners is its colour.
fn face(words: &[Word<'_>], vertices: &Count<'_>, parsed: &mut Parsed) -> Result<(), WordFault> {
    let (head, rest) = (&words[0], &words[1..]);
    let arity = head.integer()?;
    let corners = usize::try_from(arity)
        .ok()
        .and_then(|arity| rest.get(..arity));
    let Some(corners) = corners else {
        let message = format!("a face of {arity} corners names {}", rest.len());
        return Err(head.fault(message, "on this line"));
    };
    if corners.len() < 3 {
        let fault = head.fault("faces need three corners", "the first one");
        parsed.not_drawn.get_or_insert((fault, 0)).1 += 1;
        return Ok(());
    }
    let indices = corners
        .iter()
        .map(|corner| index(corner, vertices))
        .collect::<Result<Vec<u32>, WordFault>>()?;
    parsed.mesh.triangles.extend(
        indices[1..]
            .windows(2)
            .map(|pair| [indices[0], pair[0], pair[1]]),
    );
    Ok(())
}

fn index(corner: &Word<'_>, vertices: &Count<'_>) -> Result<u32, WordFault> {
    let number = corner.integer()?;
    let index = u32::try_from(number)
        .ok()
        .filter(|index| (*index as usize) < vertices.value);
    index.ok_or_else(|| {
        let message = format!(
            "a face refers to vertex {number}, and there are {}, from 0",
            vertices.value
        );
        corner.fault(message, "there is no such vertex")
    })
}
