//! The corpus of the Khronos validator: the same errors as its reports say, for every model.

use crate::suite::{absent, files, name, shared, trial};
use libtest_mimic::Trial;
use rtc::internals::diag::{DiagnosticSink, Severity};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const FOLDER: &str = "gltf/validator-corpus";

pub(crate) fn trials() -> Vec<Trial> {
    let Some(folder) = shared(FOLDER) else {
        return vec![absent("corpus", FOLDER)];
    };
    let reports = files(&folder, &["json"]).into_iter().filter_map(|report| {
        let model = report.to_str()?.strip_suffix(".report.json")?;
        let model = PathBuf::from(model);
        let is_gltf = model.extension().is_some_and(|own| own == "gltf");
        // Two models of a name differ in their extension.
        let name = name(&model, &folder) + if is_gltf { "" } else { ".glb" };
        Some((name, model, report))
    });
    let mut trials: Vec<_> = reports
        .map(|(name, model, report)| {
            trial(format!("corpus/{name}"), move || {
                errors_are_those_of_the_report(&model, &report);
            })
        })
        .collect();
    let models = trials.len();
    trials.push(trial("corpus: all models", move || {
        assert!(models >= 194, "only {models} models");
    }));
    trials
}

fn errors_are_those_of_the_report(model: &Path, report: &Path) {
    assert_eq!(
        errors(model),
        official(report),
        "ours, and those of the report"
    );
}

/// The errors of an official report.
fn official(report: &Path) -> BTreeSet<String> {
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(report).unwrap()).unwrap();
    let messages = report["issues"]["messages"].as_array().unwrap();
    let errors = messages.iter().filter(|message| message["severity"] == 0);
    errors
        .map(|message| message["code"].as_str().unwrap().to_owned())
        .collect()
}

/// The names of the errors found, ours where Khronos has none.
fn errors(model: &Path) -> BTreeSet<String> {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(model, &mut map).unwrap();
    if let Some(lowered) = pipeline::load(file, &mut map, &options, &mut sink) {
        pipeline::validate(&lowered, &options, &mut sink);
    }
    let errors = sink
        .kept()
        .iter()
        .filter(|finding| finding.severity == Severity::Error);
    errors
        .map(|finding| finding.alias.unwrap_or(finding.code.id).to_owned())
        .collect()
}
