//! Reading the truth: numbers are strings, exact values are pairs of f64, errors are counted in u.

use rtc::internals::math::{U, Vec3};
use serde_json::Value;

/// All single cases.
pub(crate) fn all() -> Vec<Value> {
    serde_json::from_str(include_str!("cases.json")).unwrap()
}

/// A family of the table: its name, the shape, and rows of a ray, a shape, and where they meet.
pub(crate) struct Table {
    pub(crate) id: &'static str,
    pub(crate) shape: &'static str,
    pub(crate) rows: Vec<Vec<f64>>,
}

/// The families of the table.
pub(crate) fn tables() -> Vec<Table> {
    let mut tables: Vec<Table> = Vec::new();
    let lines = include_str!("families.txt").lines();
    for line in lines.filter(|line| !line.starts_with('#')) {
        if let Some(head) = line.strip_prefix("family ") {
            let (id, shape) = head.split_once(' ').unwrap();
            let rows = Vec::new();
            tables.push(Table { id, shape, rows });
        } else {
            let row = line.split(' ').map(|number| number.parse().unwrap());
            tables.last_mut().unwrap().rows.push(row.collect());
        }
    }
    tables
}

/// The single cases of one kind.
pub(crate) fn cases(kind: &str) -> Vec<Value> {
    let mut cases = all();
    cases.retain(|case| case["kind"] == kind);
    assert!(!cases.is_empty(), "there is no case of kind {kind}");
    cases
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

pub(crate) fn vector(value: &Value) -> Vec3 {
    Vec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

/// The error of `x` against an exact value `{hi, lo}`.
pub(crate) fn error(x: f64, exact: &Value) -> f64 {
    ((x - number(&exact["hi"])) - number(&exact["lo"])).abs()
}

/// The error in units of the last place of the exact value.
pub(crate) fn relative_error(x: f64, exact: &Value) -> f64 {
    let size = U * number(&exact["hi"]).abs();
    let error = error(x, exact);
    if error == 0.0 { 0.0 } else { error / size }
}

/// The largest error of a component.
pub(crate) fn vector_error(v: Vec3, exact: &Value) -> f64 {
    (0..3).map(|k| error(v[k], &exact[k])).fold(0.0, f64::max)
}

/// Collects verdicts, prints a line each, and fails at the end with every id that failed.
#[derive(Default)]
pub(crate) struct Report {
    failed: Vec<String>,
    count: usize,
}

impl Report {
    pub(crate) fn line(&mut self, id: &str, passed: bool, detail: &str) {
        println!("{:4} {id}  {detail}", if passed { "ok" } else { "FAIL" });
        self.count += 1;
        if !passed {
            self.failed.push(format!("{id}: {detail}"));
        }
    }

    pub(crate) fn finish(self) {
        println!(
            "{} of {} passed",
            self.count - self.failed.len(),
            self.count
        );
        assert!(self.failed.is_empty(), "{}", self.failed.join("\n"));
    }
}

pub(crate) fn id(case: &Value) -> &str {
    case["id"].as_str().unwrap()
}
