//! STL (3D Systems, "StereoLithography interface specification", 1989), as text or binary:
//! triangles that share no corners and are shaded flat.
//!
//! The normals of the file are not read: the order of the corners determines them.

use super::tint::decoded;
use super::{MAX_FAULTS, MeshOptions, ParsedMesh, TextParseError, first_lines};
use crate::words::{Word, WordError, WordLines, numbers};
use rtc_ir::Mesh;
use rtc_math::{Vec3, to_u32};
use rtc_source::{Budget, Resource};

/// The bytes before the triangles of a binary file: a header of 80 bytes, and their count.
const HEAD: usize = 84;

/// A binary triangle: its normal, its corners, and two bytes of any kind.
const TRIANGLE: usize = 50;

/// The maximum number of bytes read to find one with a given name.
const LOOKED_AT: usize = 1 << 16;

/// True if a file that begins so is an STL.
pub(super) fn is_head(head: &[u8]) -> bool {
    is_binary(head) || is_text(head)
}

fn is_text(head: &[u8]) -> bool {
    let (mut lines, mut words) = (first_lines(head), Vec::new());
    if !lines.next(&mut words) || !words[0].bytes.eq_ignore_ascii_case(b"solid") {
        return false;
    }
    let is_facet = |word: &Word<'_>| word.bytes.eq_ignore_ascii_case(b"facet");
    while !words.iter().any(is_facet) {
        if !lines.next(&mut words) {
            return false;
        }
    }
    true
}

/// Whether it has the length of its count, or begins with valid triangles; for a truncated prefix,
/// whether it may. Where the count is wrong, a triangle has an area.
fn is_binary(head: &[u8]) -> bool {
    let Some(count) = count(head) else {
        return false;
    };
    let length = head.len() as u64;
    // More than an address of 32 bits may hold.
    let size = HEAD as u64 + TRIANGLE as u64 * u64::from(count);
    let is_cut = head.len() == LOOKED_AT && size > length;
    let are_triangles = || triangles(head, count).iter().all(is_triangle);
    (count > 0 && length == size)
        || (count > 0 && (is_cut || length > size) && are_triangles())
        || are_solid(&head[HEAD..])
}

/// Whether some bytes are valid triangles, of which one has an area.
fn are_solid(bytes: &[u8]) -> bool {
    let triangles = bytes.as_chunks::<TRIANGLE>().0;
    let has_area = |triangle: &[u8; TRIANGLE]| {
        let [_, a, b, c] = vectors(triangle).map(Vec3::from_array);
        (b - a).cross(c - a) != Vec3::ZERO
    };
    triangles.iter().all(is_triangle) && triangles.iter().any(has_area)
}

/// The triangles of a binary file. Where the count is not that of the triangles that are there, it
/// is an error, or repaired; fewer than there are may be right, and the others are reported.
fn counted<'b>(
    bytes: &'b [u8],
    is_lenient: bool,
    parsed: &mut ParsedMesh,
) -> Result<&'b [[u8; TRIANGLE]], WordError> {
    let count = count(bytes).unwrap_or(0);
    let (all, declared) = (triangles(bytes, u32::MAX), triangles(bytes, count));
    let is_short = declared.len() < count as usize;
    if !is_short && !are_solid(&bytes[HEAD + TRIANGLE * declared.len()..]) {
        return Ok(declared);
    }
    let message = format!(
        "the file says that it has {count} triangles, and has {}",
        all.len()
    );
    let fault = WordError::new(HEAD - 4..HEAD, message, "the count").repaired("all are read");
    if is_lenient {
        parsed.note_repair(fault);
        return Ok(all);
    }
    if is_short || declared.is_empty() {
        return Err(fault);
    }
    parsed.skip(|| fault);
    Ok(declared)
}

/// The number of triangles that a binary file declares.
fn count(head: &[u8]) -> Option<u32> {
    let count = head.get(HEAD - 4..HEAD)?.try_into().ok()?;
    Some(u32::from_le_bytes(count))
}

/// The triangles of a binary file, up to its count; the bytes after them are ignored.
fn triangles(bytes: &[u8], count: u32) -> &[[u8; TRIANGLE]] {
    let there = bytes[HEAD..].as_chunks::<TRIANGLE>().0;
    &there[..there.len().min(count as usize)]
}

/// Whether some bytes are a triangle: numbers, and a normal of length 0 or 1.
fn is_triangle(triangle: &[u8; TRIANGLE]) -> bool {
    let [normal, a, b, c] = vectors(triangle);
    let square: f64 = normal.iter().map(|number| number * number).sum();
    let is_normal = square == 0.0 || (0.9..1.1).contains(&square);
    is_normal && [a, b, c].iter().flatten().all(|number| number.is_finite())
}

/// The normal and the corners of a binary triangle.
fn vectors(triangle: &[u8; TRIANGLE]) -> [[f64; 3]; 4] {
    let floats = triangle[..48].as_chunks::<4>().0;
    let number = |at: usize| f64::from(f32::from_le_bytes(floats[at]));
    [0, 3, 6, 9].map(|at| [number(at), number(at + 1), number(at + 2)])
}

/// The colours of the triangles of a binary file, linear; none if it has none.
///
/// Two programs keep them in the last two bytes, five bits a channel. By VisCAM the highest bit
/// says that there is a colour, red is in the highest bits; by Magics the head has the colour of
/// the whole behind `COLOR=`, which a triangle has whose highest bit is set, and red is in the
/// lowest bits.
fn colors(bytes: &[u8], triangles: &[[u8; TRIANGLE]]) -> Vec<[f32; 4]> {
    const HAS: u16 = 1 << 15;
    let code = |triangle: &[u8; TRIANGLE]| u16::from_le_bytes([triangle[48], triangle[49]]);
    let channel = |code: u16, shift: u16| decoded(f64::from(code >> shift & 31) / 31.0);
    let whole = memchr::memmem::find(&bytes[..HEAD - 4], b"COLOR=");
    let whole = whole.and_then(|at| bytes.get(at + 6..at + 9));
    match whole {
        Some(whole) => {
            let whole = [0, 1, 2].map(|at| decoded(f64::from(whole[at]) / 255.0));
            let color = |triangle: &[u8; TRIANGLE]| match code(triangle) {
                code if code & HAS != 0 => whole,
                code => [0, 5, 10].map(|shift| channel(code, shift)),
            };
            triangles
                .iter()
                .map(|triangle| opaque(color(triangle)))
                .collect()
        }
        None if triangles.iter().any(|triangle| code(triangle) & HAS != 0) => {
            let color = |triangle: &[u8; TRIANGLE]| match code(triangle) {
                code if code & HAS != 0 => [10, 5, 0].map(|shift| channel(code, shift)),
                _ => GREY,
            };
            triangles
                .iter()
                .map(|triangle| opaque(color(triangle)))
                .collect()
        }
        None => Vec::new(),
    }
}

/// The default colour of triangles without one, linear.
const GREY: [f32; 3] = [0.7; 3];

fn opaque([r, g, b]: [f32; 3]) -> [f32; 4] {
    [r, g, b, 1.0]
}

/// Reads an STL.
pub(super) fn parse(
    bytes: &[u8],
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    // A binary triangle becomes three positions, three colours and three numbers; a line of text
    // one position, in a list that grows by doubling.
    budget.has(Resource::Memory, 5 * bytes.len() as u64)?;
    let mut parsed = ParsedMesh::default();
    let binary_triangles =
        is_binary(bytes).then(|| counted(bytes, options.is_lenient, &mut parsed));
    let binary_triangles = binary_triangles.transpose();
    let binary_triangles = binary_triangles.map_err(|fault| TextParseError::Faults(vec![fault]))?;
    let (positions, faults) = match binary_triangles {
        Some(triangles) => binary(triangles),
        None => text(bytes, &mut parsed),
    };
    if !faults.is_empty() {
        return Err(TextParseError::Faults(faults));
    }
    let count = to_u32(positions.len() / 3);
    let colors = binary_triangles.map_or_else(Vec::new, |triangles| colors(bytes, triangles));
    let corners = colors.into_iter().flat_map(|color| [color; 3]);
    parsed.mesh = Mesh {
        positions: positions.into(),
        colors: corners.collect::<Vec<_>>().into(),
        triangles: (0..count)
            .map(|at| [3 * at, 3 * at + 1, 3 * at + 2])
            .collect(),
        ..Mesh::default()
    };
    Ok(parsed)
}

fn binary(triangles: &[[u8; TRIANGLE]]) -> (Vec<[f64; 3]>, Vec<WordError>) {
    let mut positions = Vec::with_capacity(3 * triangles.len());
    let mut faults = Vec::new();
    for (at, triangle) in triangles.iter().enumerate() {
        let [_, corners @ ..] = vectors(triangle);
        if !corners.iter().flatten().all(|number| number.is_finite()) {
            let start = HEAD + TRIANGLE * at;
            let message = "a corner of a triangle is not finite";
            faults.push(WordError::new(
                start..start + TRIANGLE,
                message,
                "this triangle",
            ));
        }
        positions.extend(corners);
        if faults.len() >= MAX_FAULTS {
            break;
        }
    }
    (positions, faults)
}

fn text(bytes: &[u8], parsed: &mut ParsedMesh) -> (Vec<[f64; 3]>, Vec<WordError>) {
    let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
    let (mut positions, mut faults) = (Vec::new(), Vec::new());
    while lines.next(&mut words) && faults.len() < MAX_FAULTS {
        if words[0].bytes.eq_ignore_ascii_case(b"color") {
            parsed.skip(|| words[0].fault("colours of a text are not read", "the first one"));
        }
        faults.extend(statement(&words, &mut positions).err());
    }
    if !positions.len().is_multiple_of(3) && faults.is_empty() {
        let end = bytes.len();
        faults.push(WordError::new(
            end..end,
            "the file ends within a facet",
            "here",
        ));
    }
    (positions, faults)
}

fn statement(words: &[Word<'_>], positions: &mut Vec<[f64; 3]>) -> Result<(), WordError> {
    let head = &words[0];
    match &*head.bytes.to_ascii_lowercase() {
        b"vertex" => positions.push(numbers(head, &words[1..])?),
        b"endfacet" if !positions.len().is_multiple_of(3) => {
            return Err(head.fault("a facet has not three corners", "it ends here"));
        }
        b"facet" | b"endfacet" | b"outer" | b"endloop" | b"solid" | b"endsolid" | b"color" => {}
        _ => {
            let message = format!("`{}` is not a statement of STL", head.text());
            return Err(head.fault(message, "not known"));
        }
    }
    Ok(())
}
