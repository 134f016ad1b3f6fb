//! A log–log plot of error against time for a terminal, in braille characters of 2 × 4 dots.

use super::super::advice::{digits, seconds};
use super::super::outcome::{Study, StudyRow};
use super::chart::front_steps;
use rtc_math::ln;

/// The size of the plot in characters.
const COLUMNS: usize = 64;
const LINES: usize = 12;

/// The width of the axis labels.
const MARGIN: usize = 8;

/// The bits of the dots of a character, row by row (Unicode block U+2800).
const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// Plots all rows with an error as dots and the front as steps; empty if there are too few.
pub(super) fn plot(study: &Study) -> String {
    let rows = study.rows.iter().filter(|row| row.errors.rmse > 0.0);
    let rows: Vec<&StudyRow> = rows.collect();
    let points = rows.iter().map(|row| (row.seconds.value, row.errors.rmse));
    let points: Vec<_> = points.collect();
    let end = points.iter().fold(0.0_f64, |end, (x, _)| end.max(*x));
    let title = "error in grey levels against time, both logarithmic; the line is the front";
    match drawn(&points, &front_steps(&rows, end)) {
        Some(lines) => format!("\n{title}\n{lines}"),
        None => String::new(),
    }
}

/// Plots points and a step line; `None` if an axis has no extent.
fn drawn(points: &[(f64, f64)], steps: &[(f64, f64)]) -> Option<String> {
    // Find the ranges of both axes.
    let axis = |of: fn(&(f64, f64)) -> f64| {
        let ends = points.iter().map(of).fold((f64::INFINITY, 0.0), ends);
        (0.0 < ends.0 && ends.0 < ends.1).then_some(ends)
    };
    let (xs, ys) = (axis(|point| point.0)?, axis(|point| point.1)?);
    // Draw the step line and the points.
    let mut canvas = BrailleCanvas([[0; COLUMNS]; LINES]);
    let place = |(x, y): (f64, f64)| {
        let at = |value: f64, (low, high): (f64, f64), most: usize| {
            let fraction = (ln(value) - ln(low)) / (ln(high) - ln(low));
            (fraction.clamp(0.0, 1.0) * most as f64).round() as usize
        };
        let (right, top) = (2 * COLUMNS - 2, 4 * LINES - 2);
        [at(x, xs, right), top - at(y, ys, top)]
    };
    for pair in steps.windows(2) {
        canvas.line([place(pair[0]), place(pair[1])]);
    }
    for point in points {
        let [x, y] = place(*point);
        for dot in [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]] {
            canvas.set(dot);
        }
    }
    // Format the lines with labels.
    let mut text = String::new();
    for (index, line) in canvas.lines().enumerate() {
        let label = match index {
            0 => digits(ys.1),
            _ if index + 1 == LINES => digits(ys.0),
            _ => String::new(),
        };
        text += format!("{label:>MARGIN$} {line}").trim_end();
        text += "\n";
    }
    let (from, to) = (seconds(xs.0), seconds(xs.1));
    let room = COLUMNS - from.chars().count();
    Some(format!("{text}{:MARGIN$} {from}{to:>room$}\n", ""))
}

fn ends((low, high): (f64, f64), value: f64) -> (f64, f64) {
    (low.min(value), high.max(value))
}

/// A bitmap of dots, from the upper left.
struct BrailleCanvas([[u8; COLUMNS]; LINES]);

impl BrailleCanvas {
    fn set(&mut self, [x, y]: [usize; 2]) {
        if let Some(letter) = self.0.get_mut(y / 4).and_then(|line| line.get_mut(x / 2)) {
            *letter |= BITS[y % 4][x % 2];
        }
    }

    /// Draws a line along an axis.
    fn line(&mut self, [[x0, y0], [x1, y1]]: [[usize; 2]; 2]) {
        for x in x0.min(x1)..=x0.max(x1) {
            (y0.min(y1)..=y0.max(y1)).for_each(|y| self.set([x, y]));
        }
    }

    fn lines(&self) -> impl Iterator<Item = String> {
        let letter = |bits: &u8| match bits {
            0 => ' ',
            _ => char::from_u32(0x2800 + u32::from(*bits)).unwrap_or(' '),
        };
        self.0
            .iter()
            .map(move |line| line.iter().map(letter).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_steps_lie_where_they_belong() {
        let points = [(0.1, 8.0), (1.0, 2.0), (10.0, 0.5)];
        let steps = [(0.1, 8.0), (10.0, 8.0), (10.0, 0.5)];
        let text = drawn(&points, &steps).unwrap();
        let lines: Vec<Vec<char>> = text.lines().map(|line| line.chars().collect()).collect();
        assert_eq!(lines.len(), LINES + 1, "{text}");
        assert!(lines.iter().all(|line| line.len() <= 80), "{text}");
        // Four dots, next to the step line.
        assert_eq!(lines[0][MARGIN + 1], '⠛', "{text}");
        assert_eq!(lines[LINES - 1][MARGIN + COLUMNS], '⣧', "{text}");
        let middle = &lines[LINES / 2][MARGIN + 1..];
        let marked = middle.iter().position(|letter| *letter != ' ').unwrap();
        assert!(marked.abs_diff(COLUMNS / 2) <= 1, "{text}");
        assert!(
            lines[0][MARGIN + 1..].iter().all(|letter| *letter != ' '),
            "{text}"
        );
        assert!(
            text.starts_with("    8.00 ") && text.contains("0.50 "),
            "{text}"
        );
        assert!(text.ends_with("10.0 s\n"), "{text}");
    }

    #[test]
    fn a_single_point_has_no_plot() {
        assert_eq!(drawn(&[(1.0, 2.0)], &[]), None);
        assert_eq!(drawn(&[], &[]), None);
    }
}
