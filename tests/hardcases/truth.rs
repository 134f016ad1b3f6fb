//! Reading the truth: numbers are strings, exact values are pairs of f64, errors are counted in u.

use rtc::math::{U, Vec3};
use serde_json::Value;

/// The cases of the files present: of those the variables name, which must exist, or else of
/// `../shared`.
pub(crate) fn all() -> Vec<Value> {
    let named = ["RTC_HARDCASES", "RTC_HARDCASES_FAMILIES"].map(|name| std::env::var(name).ok());
    let mut paths: Vec<_> = named.into_iter().flatten().collect();
    if paths.is_empty() {
        let shared = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/numerics/");
        paths = ["hardcases.json", "hardcases-families.json"]
            .map(|name| format!("{shared}{name}"))
            .to_vec();
        paths.retain(|path| {
            std::path::Path::new(path).exists() || {
                println!("skipped: {path} is not here (set RTC_HARDCASES to name another file)");
                false
            }
        });
    }
    paths.iter().flat_map(|path| read(path)).collect()
}

fn read(path: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let file: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(file["schema"], "rtc-hardcases/1", "{path}");
    file["cases"].as_array().unwrap().clone()
}

/// The single cases of one kind.
pub(crate) fn cases(kind: &str) -> Vec<Value> {
    all()
        .into_iter()
        .filter(|case| case["kind"] == kind)
        .collect()
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
