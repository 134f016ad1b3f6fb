//! `--allow`, `--warn` and `--deny`: what is made of findings, in each form and in the exit code.

use super::*;

/// A scene with a misspelt key, which is a warning, a material that a note is made of, and no fault.
const WARNED: &str = "Eye: [0, 0, 50]\nShadws: true\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjects:\n\
- {type: sphere, position: [0, 0, 0], radius: 3, material: {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1}}\n";

fn shelf() -> (TempDir, String) {
    let shelf = tempfile::tempdir().unwrap();
    fs::write(shelf.path().join("a.yaml"), WARNED).unwrap();
    let reported = rtc(&shelf, &["check", "a.yaml", "--message-format", "short"]);
    assert_eq!(code(&reported), 0);
    let said = stderr(&reported);
    assert!(said.contains("warning[SC"), "{said}");
    let (_, rest) = said.split_once("warning[").unwrap();
    let id = rest.split(']').next().unwrap().to_owned();
    (shelf, id)
}

#[test]
fn a_denied_warning_is_an_error_in_every_form() {
    let (shelf, id) = shelf();
    for deny in [id.as_str(), &id.to_lowercase(), "warnings"] {
        let refused = rtc(&shelf, &["check", "a.yaml", "--deny", deny]);
        let said = stderr(&refused);
        assert_eq!(code(&refused), 1, "{deny}: {said}");
        assert!(said.contains(&format!("error[{id}]")), "{said}");
        assert!(
            said.contains("1 error") && !said.contains("1 warning"),
            "{said}"
        );
    }
    let format = |form| {
        let output = rtc(
            &shelf,
            &["check", "a.yaml", "--deny", &id, "--message-format", form],
        );
        assert_eq!(code(&output), 1, "{form}");
        String::from_utf8(output.stdout).unwrap()
    };
    let json: serde_json::Value =
        serde_json::from_str(format("json").lines().next().unwrap()).unwrap();
    assert_eq!(
        (&json["code"], &json["severity"]),
        (&id.as_str().into(), &"error".into())
    );
    let sarif: serde_json::Value = serde_json::from_str(&format("sarif")).unwrap();
    assert_eq!(sarif["runs"][0]["results"][0]["level"], "error");
    for verb in ["compile", "info", "render"] {
        assert_eq!(
            code(&rtc(&shelf, &[verb, "a.yaml", "--deny", "warnings"])),
            1,
            "{verb}"
        );
    }
    assert_eq!(names(shelf.path()), ["a.yaml"], "no picture was made");
}

#[test]
fn what_is_allowed_is_not_told_in_any_form() {
    let (shelf, id) = shelf();
    for args in [
        &["--allow", id.as_str()][..],
        &["--allow", "warnings"],
        &["--deny", "warnings", "--allow", &id],
        &["--allow", "VA004,warnings"],
    ] {
        for form in ["human", "short", "json", "github"] {
            let all = [&["check", "a.yaml", "--message-format", form], args].concat();
            let fine = rtc(&shelf, &all);
            assert_eq!(code(&fine), 0, "{args:?}");
            let reported = stderr(&fine) + &String::from_utf8(fine.stdout).unwrap();
            assert!(!reported.contains(&id), "{args:?}, {form}: {reported}");
        }
    }
    let kept = rtc(
        &shelf,
        &["check", "a.yaml", "--deny", "warnings", "--warn", &id],
    );
    assert_eq!(code(&kept), 0);
    assert!(stderr(&kept).contains(&format!("warning[{id}]")));
}

#[test]
fn errors_can_not_be_allowed_and_unknown_codes_lead_on() {
    let (shelf, id) = shelf();
    let refused = |args: &[&str], words: &str| {
        let output = rtc(&shelf, &[&["check", "a.yaml"], args].concat());
        let said = stderr(&output);
        assert_eq!(code(&output), 2, "{args:?}: {said}");
        assert!(said.contains(words), "{args:?}: {said}");
    };
    refused(&["--allow", "VA001"], "`VA001` is an error");
    refused(&["--warn", "va001"], "`VA001` is an error");
    refused(&["--deny", "VA0011"], "did you mean `VA001`?");
    refused(&["--deny", "warning"], "did you mean `warnings`?");
    refused(&["--allow", "nonsense"], "`rtc explain --all` lists them");
    refused(
        &["--allow", &id, "--deny", &id],
        "cannot be both `allow` and `deny`",
    );
}
