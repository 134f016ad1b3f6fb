//! `rtc fmt`: what is written, what is only shown, and what is left alone.

use super::*;

const UNTIDY: &str = "Eye:   [0,0,50]  # far\r\nLights:\r\n  -   position: [9,9,90]\r\n      color: [1,1,1]\r\n\r\n\r\nObjects: []";
const TIDY: &str =
    "Eye: [0, 0, 50]  # far\nLights:\n- position: [9, 9, 90]\n  color: [1, 1, 1]\n\nObjects: []\n";

fn shelf() -> TempDir {
    let shelf = tempfile::tempdir().unwrap();
    fs::create_dir(shelf.path().join("set")).unwrap();
    for (name, text) in [
        ("set/a.yaml", UNTIDY),
        ("set/b.yml", TIDY),
        ("set/c.json", "{\"Eye\":[0,0,50]}"),
        ("set/d.yaml", "Eye: [0, 0\n"),
        ("ball.json", SCENE),
    ] {
        fs::write(shelf.path().join(name), text).unwrap();
    }
    shelf
}

fn text(shelf: &TempDir, name: &str) -> String {
    fs::read_to_string(shelf.path().join(name)).unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn texts_are_laid_out_and_what_is_no_yaml_is_told() {
    let shelf = shelf();
    let done = rtc(&shelf, &["fmt", "set"]);
    let said = stderr(&done);
    assert_eq!(code(&done), 1, "{said}");
    assert!(said.contains("set/a.yaml: formatted\n"), "{said}");
    assert!(
        !said.contains("b.yml") && !said.contains("c.json"),
        "{said}"
    );
    assert!(
        said.contains("error[SY") && said.contains("set/d.yaml"),
        "{said}"
    );
    assert_eq!(text(&shelf, "set/a.yaml"), TIDY);
    assert_eq!(text(&shelf, "set/d.yaml"), "Eye: [0, 0\n");
    let named = rtc(&shelf, &["fmt", "set/a.yaml", "set/c.json"]);
    assert_eq!(code(&named), 0, "{}", stderr(&named));
    assert_eq!(stderr(&named), "set/c.json: formatted\n");
    assert_eq!(text(&shelf, "set/c.json"), "{\"Eye\": [0, 0, 50]}\n");
}

#[test]
fn a_check_and_a_diff_write_nothing() {
    let shelf = shelf();
    let checked = rtc(&shelf, &["fmt", "--check", "set/*.y*ml"]);
    assert_eq!(
        (code(&checked), stdout(&checked)),
        (1, "set/a.yaml\n".to_owned())
    );
    let sound = rtc(&shelf, &["fmt", "--check", "set/b.yml"]);
    assert_eq!((code(&sound), stdout(&sound)), (0, String::new()));
    let shown = rtc(&shelf, &["fmt", "--diff", "set/a.yaml", "set/b.yml"]);
    let diff = stdout(&shown);
    assert_eq!(code(&shown), 0);
    assert!(
        diff.starts_with("--- set/a.yaml\n+++ set/a.yaml\n"),
        "{diff}"
    );
    assert!(diff.contains("\n+- position: [9, 9, 90]\n"), "{diff}");
    let both = rtc(&shelf, &["fmt", "--diff", "--check", "set/a.yaml"]);
    assert_eq!((code(&both), stdout(&both)), (1, diff));
    assert_eq!(text(&shelf, "set/a.yaml"), UNTIDY);
}

#[test]
fn standard_input_goes_to_standard_output() {
    let shelf = shelf();
    let mut child = command(shelf.path(), &["fmt", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(UNTIDY.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!((code(&output), stdout(&output)), (0, TIDY.to_owned()));
}

#[test]
fn what_people_do_not_write_is_refused() {
    let shelf = shelf();
    let refused = rtc(&shelf, &["fmt", "ball.json"]);
    assert_eq!(code(&refused), 1);
    assert!(
        stderr(&refused).contains("only scene texts, YAML and JSON"),
        "{}",
        stderr(&refused)
    );
    assert_eq!(text(&shelf, "ball.json"), SCENE);
    assert_eq!(code(&rtc(&shelf, &["fmt", "none.yaml"])), 2);
    assert_eq!(code(&rtc(&shelf, &["fmt"])), 2);
}
