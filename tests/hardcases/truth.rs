//! Reading the truth: numbers are strings, exact values are pairs of f64, errors are counted in u.

use rtc::math::{U, Vec3};
use serde_json::Value;

/// The cases of a file, or `None` with a note if it is absent.
pub(crate) fn load(variable: &str, name: &str) -> Option<Vec<Value>> {
    let shared = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/numerics/");
    let path = std::env::var(variable).unwrap_or_else(|_| format!("{shared}{name}"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: {path} is not here (set {variable} to name another file)");
        return None;
    };
    let file: Value = serde_json::from_str(&text).unwrap();
    Some(file["cases"].as_array().unwrap().clone())
}

/// The cases of one kind from the file of single cases.
pub(crate) fn cases(kind: &str) -> Vec<Value> {
    let all = load("RTC_HARDCASES", "hardcases.json").unwrap_or_default();
    all.into_iter().filter(|case| case["kind"] == kind).collect()
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
        println!("{} of {} passed", self.count - self.failed.len(), self.count);
        assert!(self.failed.is_empty(), "{}", self.failed.join("\n"));
    }
}

pub(crate) fn id(case: &Value) -> &str {
    case["id"].as_str().unwrap()
}
