//! XYZ: one point per line, its position, then its colour, its normal or both, as scanners write
//! them.

use super::tint::VertexColors;
use super::{MAX_FAULTS, MeshOptions, ParsedMesh, TextParseError, first_lines};
use crate::words::{Word, WordError, WordLines, numbers};
use rtc_source::{Budget, Resource};

/// The maximum number of lines inspected to detect the format and the meaning of its numbers.
const LOOKED_AT: usize = 64;

/// The fewest and the most numbers of a line.
const COUNTS: std::ops::RangeInclusive<usize> = 3..=10;

/// The lines of a file as numbers between white space, commas or semicolons.
struct XyzLines<'a> {
    lines: WordLines<'a>,
    words: Vec<Word<'a>>,
    cells: Vec<Word<'a>>,
    /// What is not as it should be: a heading, or other separators than white space.
    fault: Option<WordError>,
}

impl<'a> XyzLines<'a> {
    /// The lines after a heading.
    fn new(lines: WordLines<'a>) -> Self {
        let mut begun = Self {
            lines,
            words: Vec::new(),
            cells: Vec::new(),
            fault: None,
        };
        let mut ahead = Self {
            lines: begun.lines.clone(),
            words: Vec::new(),
            cells: Vec::new(),
            fault: None,
        };
        if ahead.next() && is_heading(&ahead.cells) {
            let fault = ahead.cells[0].fault("the first line is no point", "a heading");
            begun = ahead;
            begun.fault = Some(fault.repaired("it is skipped"));
        }
        begun
    }

    /// Reads the next line into `cells`; false at the end of the file.
    fn next(&mut self) -> bool {
        self.cells.clear();
        // A line of separators alone is empty.
        while self.cells.is_empty() {
            if !self.lines.next(&mut self.words) {
                return false;
            }
            for word in &self.words {
                let parts = word.split(b',').flat_map(|part| part.split(b';'));
                self.cells
                    .extend(parts.filter(|part| !part.bytes.is_empty()));
                if self.fault.is_none() && word.bytes.iter().any(|byte| b",;".contains(byte)) {
                    let fault = word.fault("commas separate the numbers", "the first one");
                    self.fault = Some(fault.repaired("they are read as spaces"));
                }
            }
        }
        true
    }
}

/// Whether a first line names the columns, or counts the points.
fn is_heading(cells: &[Word<'_>]) -> bool {
    match cells {
        [count] => count.integer().is_ok_and(|count| count >= 0),
        [first, ..] => {
            let is_x = first.bytes.eq_ignore_ascii_case(b"x") || first.bytes == b"//X";
            is_x && cells.iter().all(|cell| cell.number().is_err())
        }
        [] => false,
    }
}

/// True if the first lines are numbers, as many on each, after a heading at most.
pub(super) fn is_head(head: &[u8]) -> bool {
    let mut rows = XyzLines::new(first_lines(head));
    let mut count = None;
    for _ in 0..LOOKED_AT {
        if !rows.next() {
            break;
        }
        let cells = &rows.cells;
        let columns = *count.get_or_insert(cells.len());
        // The last line may be cut off.
        let is_cut = rows.lines.is_at_end() && cells.len() < columns;
        let are_numbers = || cells.iter().all(|cell| cell.number().is_ok());
        if !is_cut && (columns != cells.len() || !COUNTS.contains(&columns) || !are_numbers()) {
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
    let mut lines = XyzLines::new(first_lines(bytes));
    let mut rows: Vec<Vec<f64>> = Vec::new();
    while rows.len() < LOOKED_AT && lines.next() {
        let row = lines.cells.iter().map_while(|cell| cell.number().ok());
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

/// Reads an XYZ. Other separators than white space, and a heading, are errors or repaired.
pub(super) fn parse(
    bytes: &[u8],
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    // A line of six bytes becomes a position, a normal and a colour, in lists that grow by
    // doubling.
    budget.has(Resource::Memory, 24 * bytes.len() as u64)?;
    let columns = columns(bytes);
    let mut lines = XyzLines::new(WordLines::new(bytes));
    let (mut positions, mut normals, mut tints) = (Vec::new(), Vec::new(), VertexColors::default());
    let mut faults = Vec::new();
    while lines.next() && faults.len() < MAX_FAULTS {
        if !options.is_lenient
            && let Some(fault) = lines.fault.take()
        {
            return Err(TextParseError::Faults(vec![fault]));
        }
        let outcome = point(&lines.cells, &columns, &mut normals, &mut tints);
        match outcome {
            Ok(position) => positions.push(position),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(TextParseError::Faults(faults));
    }
    let mut parsed = ParsedMesh::default();
    lines
        .fault
        .into_iter()
        .for_each(|fault| parsed.note_repair(fault));
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
