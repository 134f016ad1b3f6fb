//! Tables of the files of a folder, a row each, with a total: as text, CSV or one JSON object.

use super::args::TableFormat;
use rtc_diag::clean;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// A value of a table.
#[derive(Clone, Debug)]
pub(super) enum TableCell {
    /// A name or a word.
    Text(String),
    /// A number of things.
    Count(usize),
    /// A measured value, and the decimals that text shows.
    Measure(f64, usize),
    /// There is none.
    Absent,
}

impl TableCell {
    /// The cell as text; a program wants all digits of a measure.
    fn text(&self, is_exact: bool) -> String {
        match self {
            Self::Text(text) => clean(text).into_owned(),
            Self::Count(count) => count.to_string(),
            Self::Measure(value, _) if is_exact => value.to_string(),
            Self::Measure(value, decimals) => format!("{value:.decimals$}"),
            Self::Absent => String::new(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Self::Text(text) => json!(text),
            Self::Count(count) => json!(count),
            Self::Measure(value, _) => json!(value),
            Self::Absent => Value::Null,
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Self::Text(_))
    }
}

/// A table of files.
pub(super) struct FileTable {
    /// The schema of the JSON object.
    pub(super) schema: &'static str,
    /// The names of the columns; the first is that of the files.
    pub(super) columns: &'static [&'static str],
    pub(super) rows: Vec<Vec<TableCell>>,
    /// The last row; its first cell is the number of files.
    pub(super) total: Vec<TableCell>,
}

impl FileTable {
    /// The table in a format.
    pub(super) fn print(&self, format: TableFormat) -> String {
        match format {
            TableFormat::Text => self.text(),
            TableFormat::Csv => self.csv(),
            TableFormat::Json => format!("{:#}\n", self.json()),
        }
    }

    fn lines(&self) -> impl Iterator<Item = &Vec<TableCell>> {
        self.rows.iter().chain([&self.total])
    }

    /// Text in columns: words to the left, numbers to the right.
    fn text(&self) -> String {
        let title = |name: &&str| (*name).to_owned();
        let titles: Vec<_> = self.columns.iter().map(title).collect();
        let cells = |row: &Vec<TableCell>| row.iter().map(|cell| cell.text(false)).collect();
        let lines: Vec<Vec<String>> = [titles]
            .into_iter()
            .chain(self.lines().map(cells))
            .collect();
        let width = |column: usize| {
            let cells = lines.iter().filter_map(|line| line.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<_> = (0..self.columns.len()).map(width).collect();
        let is_left = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            column == 0 || cells.clone().any(TableCell::is_text)
        };
        let mut text = String::new();
        for line in &lines {
            let mut padded = String::new();
            for (column, (cell, width)) in line.iter().zip(&widths).enumerate() {
                let gap = if column == 0 { "" } else { "  " };
                match is_left(column) {
                    true => write!(padded, "{gap}{cell:<width$}"),
                    false => write!(padded, "{gap}{cell:>width$}"),
                }
                .expect("a string takes all text");
            }
            text += padded.trim_end();
            text.push('\n');
        }
        text
    }

    /// Comma-separated values as of RFC 4180, with a line of titles.
    fn csv(&self) -> String {
        let titles = self.columns.join(",") + "\n";
        let line = |row: &Vec<TableCell>| {
            let cells: Vec<_> = row.iter().map(|cell| quoted(&cell.text(true))).collect();
            cells.join(",") + "\n"
        };
        titles + &self.lines().map(line).collect::<String>()
    }

    fn json(&self) -> Value {
        let object = |row: &Vec<TableCell>| {
            let values = row.iter().map(TableCell::json);
            let names = self.columns.iter().map(|name| (*name).to_owned());
            Value::Object(names.zip(values).collect::<Map<_, _>>())
        };
        let mut total = object(&self.total);
        total["files"] = json!(self.rows.len());
        if let Some(total) = total.as_object_mut() {
            total.remove(self.columns[0]);
        }
        let files: Vec<_> = self.rows.iter().map(object).collect();
        json!({ "schema": self.schema, "files": files, "total": total })
    }
}

/// A value of a CSV file: in quotes if it has a separator, or if a spreadsheet would compute it.
fn quoted(text: &str) -> String {
    let is_formula = text.starts_with(['=', '+', '@']);
    let text = if is_formula {
        format!("'{text}")
    } else {
        text.to_owned()
    };
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> FileTable {
        let row = |name: &str, value: f64| {
            let count = TableCell::Count(name.len());
            vec![
                TableCell::Text(name.to_owned()),
                TableCell::Measure(value, 2),
                count,
            ]
        };
        FileTable {
            schema: "x/1",
            columns: &["file", "rmse", "count"],
            rows: vec![row("a,\u{202e}\"b\".png", 0.5), row("=c", 12.25)],
            total: vec![
                TableCell::Text("2 files".to_owned()),
                TableCell::Absent,
                TableCell::Count(12),
            ],
        }
    }

    #[test]
    fn text_is_aligned() {
        let expected = "file                rmse  count\na,\\u{202e}\"b\".png   0.50     12\n\
                        =c                 12.25      2\n2 files                      12\n";
        assert_eq!(table().print(TableFormat::Text), expected);
    }

    #[test]
    fn csv_is_quoted() {
        let expected = "file,rmse,count\n\"a,\\u{202e}\"\"b\"\".png\",0.5,12\n'=c,12.25,2\n\
                        2 files,,12\n";
        assert_eq!(table().print(TableFormat::Csv), expected);
    }

    #[test]
    fn json_has_the_names_of_the_columns() {
        let value: Value = serde_json::from_str(&table().print(TableFormat::Json)).unwrap();
        assert_eq!(
            value["files"][1],
            json!({ "file": "=c", "rmse": 12.25, "count": 2 })
        );
        assert_eq!(
            value["total"],
            json!({ "files": 2, "rmse": null, "count": 12 })
        );
    }
}
