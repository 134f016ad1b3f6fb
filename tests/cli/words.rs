//! The words of messages and of the help.

use super::*;

/// Numbers far from 1 have no hundreds of digits in what is said of them.
#[test]
fn numbers_are_short_in_messages() {
    let folder = folder();
    let object = |keys: &str, material: &str| {
        format!(
            "Eye: [200, 200, 1000]\nLights: [{{position: [0, 0, 900], color: [1, 1, 1]}}]\nObjects:\n- {{{keys}, material: {{color: [1, 1, 1], {material}}}}}\n"
        )
    };
    let clay = "ka: 0.2, kd: 0.7, ks: 0.1, n: 8";
    let mut texts = Vec::new();
    for number in ["5e-324", "-5e-324", "-1e60", "1e60", "1e300", "-1e300"] {
        texts.extend([
            object(&format!("type: sphere, position: [0, 0, 0], radius: {number}"), clay),
            object(&format!("type: plane, a: 1, b: 0, c: 0, d: {number}"), clay),
            object(&format!("type: bplane, typ: quad, center: [0, 0, 0], normal: [0, 0, 1], radius: {number}"), clay),
            object(&format!("type: torus, position: [0, 0, 0], innerRadius: 3, outerRadius: {number}"), clay),
            object("type: sphere, position: [200, 200, 0], radius: 9", &format!("ka: 1, kd: {number}, ks: 0, n: 1")),
            object("type: sphere, position: [200, 200, 0], radius: 9", &format!("ka: 1, kd: 1, ks: 0, n: {number}")),
            object("type: sphere, position: [200, 200, 0], radius: 9", &format!("ka: 1, kd: 1, ks: 0, n: 1, eta: {number}, kt: 1")),
            object("type: sphere, position: [200, 200, 0], radius: 9", clay).replace("[1, 1, 1]}]", &format!("[1, {number}, 1]}}]")),
            object("type: sphere, position: [200, 200, 0], radius: 9", &format!("{clay}, type: standard, metallic: {number}")),
            format!("Camera: {{eye: [0, 0, 9], center: [0, 0, 0], up: [0, {number}, 0], viewSize: [4, 4], apertureRadius: {number}}}\nObjects: []\n"),
        ]);
    }
    let mut said_of = 0;
    for (at, text) in texts.iter().enumerate() {
        let name = format!("{at}.yaml");
        fs::write(folder.path().join(&name), text).unwrap();
        let found = rtc(
            &folder,
            &["check", "--message-format", "short", "-v", &name],
        );
        let said = stderr(&found) + &String::from_utf8(found.stdout).unwrap();
        said_of += usize::from(!said.is_empty());
        let mut runs = said.split(|c: char| !c.is_ascii_digit());
        assert!(runs.all(|run| run.len() < 20), "{text}{said}");
    }
    assert!(said_of > 30, "{said_of}");
}

/// A word of 100 KB is repeated in no message.
#[test]
fn values_are_clipped_in_messages() {
    let folder = folder();
    let long = "long".repeat(25_000);
    let texture = format!("{{texture: {long}.png, ka: 1, kd: 1, ks: 0, n: 1}}");
    let wrong = [
        format!("{long}: 1"),
        format!("Shadows: {long}"),
        format!("Shadows: [{long}]"),
        format!("RenderMode: {long}"),
        format!("MaxRecursionDepth: \"{long}\""),
        format!("Objects: [{{type: {long}}}]"),
        format!("Objects: [{{type: sphere, position: [0, 0, 0], radius: 1, material: {texture}}}]"),
        format!(
            "Objects: [{{type: mesh, file: ../{long}/{long}/x, position: [0, 0, 0], scale: 1}}]"
        ),
        format!("{{\"irVersion\": 4, \"{long}\": 1}}"),
        scene_with(
            "\"phong\", \"shadows\"",
            &format!("\"{long}\", \"shadows\""),
        ),
        scene_with("\"shadows\": true", &format!("\"shadows\": \"{long}\"")),
        scene_with("[0, 0, 50]", "[0, 0, 1e308]"),
    ];
    let is_short = |what: &str, output: &Output| {
        let said = stderr(output) + &String::from_utf8(output.stdout.clone()).unwrap();
        assert!(
            !said.is_empty() && said.lines().all(|line| line.len() < 1500),
            "{what}: {said}"
        );
    };
    for (number, text) in wrong.iter().enumerate() {
        let name = format!("wrong-{number}");
        fs::write(folder.path().join(&name), text).unwrap();
        for form in ["short", "human"] {
            let output = rtc(&folder, &["check", &name, "--message-format", form]);
            assert_eq!(code(&output), 1, "{name}");
            is_short(&name, &output);
        }
    }
    for args in [
        &["render", "ball.json", "--size", &long][..],
        &["render", "ball.json", "--camera", &long],
        &["render", "ball.json", "--set", &format!("{long}=1")],
        &["render", "ball.json", "--set", &format!("shadows={long}")],
        &["explain", &long],
        &[&long],
    ] {
        let output = rtc(&folder, args);
        assert!(code(&output) > 0);
        is_short(args[0], &output);
    }
}

#[test]
fn a_view_from_beyond_all_numbers_is_refused_for_that() {
    let folder = folder();
    for option in ["--eye", "--center"] {
        let refused = rtc(&folder, &["render", "ball.json", option, "1e300,0,0"]);
        assert_eq!(code(&refused), 2);
        assert!(
            stderr(&refused).contains("numbers of a scene are at most 1e60 in absolute value"),
            "{}",
            stderr(&refused)
        );
    }
}

/// Of a page to read: each heading, with the options under it.
#[test]
fn options_stand_under_the_heading_that_is_theirs() {
    let folder = folder();
    for verb in ["render", "compile", "cost"] {
        let help = String::from_utf8(rtc(&folder, &[verb, "--help"]).stdout).unwrap();
        let heading = |option: &str| {
            let is_option = |line: &&str| {
                let line = line.trim_start();
                let names = line.split_once("  ").map_or(line, |(names, _)| names);
                names.split([' ', ',']).any(|name| name == option)
            };
            let end = help.find(help.lines().find(is_option).unwrap()).unwrap();
            let headings = help[..end].lines().rev();
            let mut headings =
                headings.filter(|line| line.ends_with(':') && !line.starts_with(' '));
            headings.next().unwrap()
        };
        for (option, expected) in [
            ("--strict", "Input:"),
            ("--lenient", "Input:"),
            ("--color", "Diagnostics:"),
            ("--quiet", "Diagnostics:"),
            ("--message-format", "Diagnostics:"),
            ("--max-errors", "Diagnostics:"),
            ("--eye", "View:"),
            ("--integrator", "Sampling:"),
        ] {
            assert_eq!(heading(option), expected, "{verb} {option}");
        }
    }
}

/// The exit codes of the help are those of the docs, with the same words.
#[test]
fn exit_codes_are_told_alike() {
    let help = String::from_utf8(rtc(&folder(), &["--help"]).stdout).unwrap();
    let (_, codes) = help.split_once("Exit codes:\n").unwrap();
    let reported: Vec<_> = codes
        .lines()
        .filter_map(|line| line.trim().split_once("  "))
        .collect();
    let docs = include_str!("../../docs/book/src/reference/command-line.md");
    let (_, rows) = docs
        .split_once("| exit code | means |\n| --: | --- |\n")
        .unwrap();
    let rows = rows
        .lines()
        .map_while(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let rows: Vec<_> = rows.filter_map(|row| row.split_once(" | ")).collect();
    assert_eq!(reported, rows);
    let numbers: Vec<_> = reported.iter().map(|(code, _)| *code).collect();
    assert_eq!(numbers, ["0", "1", "2", "130", "143"]);
}
