//! XYZ: one point per line, its position, then its colour, its normal or both, as scanners write
//! them.

use super::tint::VertexColors;
use super::{MAX_FAULTS, ParsedMesh, TextParseError, first_lines};
use crate::words::{Word, WordError, WordLines, numbers};
use rtc_source::{Budget, Resource};

/// The maximum number of lines inspected to detect the format and the meaning of its numbers.
const LOOKED_AT: usize = 64;

/// The fewest and the most numbers of a line.
const COUNTS: std::ops::RangeInclusive<usize> = 3..=10;

/// True if the first lines are numbers, as many on each.
pub(super) fn is_head(head: &[u8]) -> bool {
    let (mut lines, mut words) = (first_lines(head), Vec::new());
    let mut count = None;
    for _ in 0..LOOKED_AT {
        if !lines.next(&mut words) {
            break;
        }
        let columns = *count.get_or_insert(words.len());
        // The last line may be cut off.
        let is_cut = lines.is_at_end() && words.len() < columns;
        let are_numbers = || words.iter().all(|word| word.number().is_ok());
        if !is_cut && (columns != words.len() || !COUNTS.contains(&columns) || !are_numbers()) {
            return false;
        }
    }
    count.is_some()
}

/// The meaning of the numbers after the position of a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum XyzColumns {
    Color,
    Normal,
}

/// The meaning of the numbers of a line, with their first index.
fn columns(bytes: &[u8]) -> Vec<(usize, XyzColumns)> {
    let (mut lines, mut words) = (first_lines(bytes), Vec::new());
    let mut rows: Vec<Vec<f64>> = Vec::new();
    while rows.len() < LOOKED_AT && lines.next(&mut words) {
        let row = words.iter().map_while(|word| word.number().ok());
        rows.push(row.collect());
    }
    let count = rows.first().map_or(0, Vec::len);
    let triples: &[usize] = match count {
        6 => &[3],
        // The intensity precedes the colour.
        7 | 10 => &[4, 7],
        9 => &[3, 6],
        _ => &[],
    };
    let meaning = |first: usize| {
        let row = rows.iter().filter_map(|row| row.get(first..first + 3));
        let is_unit = |row: &[f64]| {
            let square: f64 = row.iter().map(|number| number * number).sum();
            (square - 1.0).abs() < 0.02
        };
        if row.clone().all(is_unit) || row.flatten().any(|number| *number < 0.0) {
            XyzColumns::Normal
        } else {
            XyzColumns::Color
        }
    };
    let triples = triples.iter().filter(|first| **first + 3 <= count);
    triples.map(|first| (*first, meaning(*first))).collect()
}

/// Reads an XYZ.
pub(super) fn parse(bytes: &[u8], budget: &Budget) -> Result<ParsedMesh, TextParseError> {
    // A line of six bytes becomes a position, a normal and a colour, in lists that grow by
    // doubling.
    budget.has(Resource::Memory, 24 * bytes.len() as u64)?;
    let columns = columns(bytes);
    let (mut lines, mut words) = (WordLines::new(bytes), Vec::new());
    let (mut positions, mut normals, mut tints) = (Vec::new(), Vec::new(), VertexColors::default());
    let mut faults = Vec::new();
    while lines.next(&mut words) && faults.len() < MAX_FAULTS {
        let outcome = point(&words, &columns, &mut normals, &mut tints);
        match outcome {
            Ok(position) => positions.push(position),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(TextParseError::Faults(faults));
    }
    let mut parsed = ParsedMesh::default();
    parsed.mesh.positions = positions.into();
    parsed.mesh.normals = normals.into();
    parsed.mesh.colors = tints.column();
    Ok(parsed)
}

/// The position of a point; its colour and its normal are added.
fn point(
    words: &[Word<'_>],
    columns: &[(usize, XyzColumns)],
    normals: &mut Vec<[f64; 3]>,
    tints: &mut VertexColors,
) -> Result<[f64; 3], WordError> {
    let position = numbers(&words[0], words)?;
    let (mut normal, mut color) = (None, None);
    for (first, meaning) in columns {
        let row: [f64; 3] = numbers(&words[0], words.get(*first..).unwrap_or_default())?;
        match meaning {
            XyzColumns::Normal if normal.is_none() => normal = Some(row),
            XyzColumns::Color if color.is_none() => color = Some(row),
            XyzColumns::Normal | XyzColumns::Color => {}
        }
    }
    normals.extend(normal);
    if let Some(color) = color {
        tints.push(&color);
    }
    Ok(position)
}
