//! The corpus of the Khronos validator: the same errors as its reports say, model by model.

use super::{errors, files, findings, shared};
use std::collections::BTreeSet;
use std::path::Path;

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

#[test]
fn errors_are_those_of_the_official_reports() {
    let Some(folder) = shared("validator-corpus") else {
        return;
    };
    let (mut models, mut same) = (0, 0);
    for report in files(&folder) {
        let Some(model) = report
            .to_str()
            .unwrap()
            .strip_suffix(".report.json")
            .map(Path::new)
        else {
            continue;
        };
        let (expected, found) = (official(&report), errors(&findings(model)));
        models += 1;
        same += usize::from(expected == found);
        if expected != found {
            let name = model.strip_prefix(&folder).unwrap().display();
            let missing: Vec<_> = expected.difference(&found).collect();
            let extra: Vec<_> = found.difference(&expected).collect();
            println!("{name}: missing {missing:?}, beside {extra:?}");
        }
    }
    assert!(
        models > 0 && same == models,
        "{same} of {models} models have the same errors"
    );
}
