//! `rtc schema`: the schemas of reports describe what the commands write, key by key, and the
//! committed files are current. `RTC_UPDATE=1` writes the files.

use super::*;
use serde_json::Value;

/// The schema of a report, as `rtc schema` prints it.
fn schema(name: &str) -> Value {
    let printed = rtc(&folder(), &["schema", name]);
    assert_eq!(code(&printed), 0, "{}", stderr(&printed));
    serde_json::from_slice(&printed.stdout).unwrap()
}

/// Rejects keys that the schema does not name: a report that gains a key must document it.
fn close(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(close),
        Value::Object(members) => {
            members.values_mut().for_each(close);
            if members.get("properties").is_some_and(Value::is_object) {
                let key = "additionalProperties".to_owned();
                members.entry(key).or_insert(Value::Bool(false));
            }
        }
        _ => {}
    }
}

/// Validates a report against its schema.
fn assert_valid(name: &str, report: &Value) {
    let mut schema = schema(name);
    close(&mut schema);
    let validator = jsonschema::validator_for(&schema).unwrap();
    let errors: Vec<_> = validator
        .iter_errors(report)
        .map(|error| format!("{}: {error}", error.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{name}: {errors:#?}\n{report:#}");
}

fn report(folder: &TempDir, args: &[&str]) -> Value {
    let written = rtc(folder, args);
    assert!(written.status.success(), "{args:?}: {}", stderr(&written));
    serde_json::from_slice(&written.stdout).unwrap()
}

fn scene(name: &str) -> String {
    format!("{}/scenes/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_committed_schemas_are_current() {
    for name in ["info", "cost", "diff", "audit", "certify", "check"] {
        let current = rtc(&folder(), &["schema", name]).stdout;
        let path = format!("{}/schema/{name}.schema.json", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("RTC_UPDATE").is_some() {
            fs::write(&path, &current).unwrap();
        }
        let committed = fs::read(&path).unwrap_or_default();
        assert!(
            committed == current,
            "{path} is out of date: RTC_UPDATE=1 cargo test --test suites schemas::"
        );
    }
}

#[test]
fn info_agrees_with_its_schema() {
    for name in ["five-spheres.yaml", "vase.glb", "vases.yaml"] {
        let info = report(&folder(), &["info", &scene(name), "--format", "json"]);
        assert_valid("info", &info);
        let former = report(&folder(), &["info", &scene(name), "--json"]);
        assert_eq!(info, former, "the former spelling");
    }
}

#[test]
fn diff_agrees_with_its_schema() {
    let folder = folder();
    let small = ["render", "ball.json", "--size", "8x6", "-q", "-o"];
    for (name, more) in [("one.png", &[][..]), ("two.png", &["--depth", "0"])] {
        let args = [&small[..], &[name], more].concat();
        assert_eq!(code(&rtc(&folder, &args)), 0);
    }
    let pictures = ["diff", "one.png", "two.png", "--format", "json"];
    assert_valid("diff", &report(&folder, &pictures));
    let gated = [&pictures[..], &["--gate", "rmse<=255,share<=100%"]].concat();
    assert_valid("diff", &report(&folder, &gated));
    let other = scene_with("\"radius\": 10", "\"radius\": 9");
    fs::write(folder.path().join("other.json"), other).unwrap();
    let scenes = [
        "diff",
        "ball.json",
        "other.json",
        "--size",
        "8x6",
        "--format",
        "json",
    ];
    assert_valid("diff", &report(&folder, &scenes));
}

#[test]
fn audit_agrees_with_its_schema() {
    let folder = folder();
    for (name, more) in [("one.png", &[][..]), ("two.png", &["--depth", "0"])] {
        let args = [&["render", "ball.json", "-q", "-o", name], more].concat();
        assert_eq!(code(&rtc(&folder, &args)), 0);
    }
    let json = ["--format", "json", "--tiles", "3"];
    for name in ["one.png", "two.png"] {
        let args = [&["audit", name, "ball.json"], &json[..]].concat();
        assert_valid("audit", &report(&folder, &args));
    }
    // Of another scene there are findings.
    let failed = rtc(
        &folder,
        &[&["audit", "one.png", "away.json"], &json[..]].concat(),
    );
    assert_eq!(code(&failed), 1);
    assert_valid("audit", &serde_json::from_slice(&failed.stdout).unwrap());
}

#[test]
fn certify_agrees_with_its_schema() {
    let folder = folder();
    for scene in ["ball.json", "away.json"] {
        let args = ["certify", scene, "-o", "one.png", "--format", "json"];
        assert_valid("certify", &report(&folder, &args));
    }
}

#[test]
fn cost_agrees_with_its_schema() {
    let folder = folder();
    let small = scene_with("[40, 30]", "[8, 6]");
    fs::write(folder.path().join("small.json"), small).unwrap();
    let quick = ["--effort", "quick", "--format", "json"];
    let alone = [&["cost", "small.json"], &quick[..]].concat();
    assert_valid("cost", &report(&folder, &alone));
    let gate = ["--gate", "error<=255"];
    let two = [&["cost", "small.json", "small.json"], &quick[..], &gate].concat();
    assert_valid("cost", &report(&folder, &two));
}

#[test]
fn check_agrees_with_its_schema() {
    let folder = folder();
    let args = ["check", "bad.json", "--message-format", "json"];
    for more in [&[][..], &["--max-errors", "1"]] {
        let checked = rtc(&folder, &[&args[..], more].concat());
        assert_eq!(code(&checked), 1);
        for line in String::from_utf8(checked.stdout).unwrap().lines() {
            assert_valid("check", &serde_json::from_str(line).unwrap());
        }
    }
}
