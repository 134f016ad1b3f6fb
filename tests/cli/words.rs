//! The words of messages and of the help.

use super::*;

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
        let (options, view) = help.split_once("\nView and light:\n").unwrap();
        for option in [
            "--strict",
            "--lenient",
            "--color",
            "--quiet",
            "--message-format",
            "--max-errors",
        ] {
            assert!(
                options.contains(option) && !view.contains(&format!("{option} ")),
                "{verb} {option}"
            );
        }
        assert!(
            view.contains("--eye") && view.contains("--integrator"),
            "{verb}"
        );
    }
}

/// The exit codes of the help are those of the docs, with the same words.
#[test]
fn exit_codes_are_told_alike() {
    let help = String::from_utf8(rtc(&folder(), &["--help"]).stdout).unwrap();
    let (_, codes) = help.split_once("Exit codes:\n").unwrap();
    let told: Vec<_> = codes
        .lines()
        .filter_map(|line| line.trim().split_once("  "))
        .collect();
    let docs = include_str!("../../docs/ARCHITECTURE.md");
    let (_, rows) = docs
        .split_once("| exit code | means |\n| --: | --- |\n")
        .unwrap();
    let rows = rows
        .lines()
        .map_while(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let rows: Vec<_> = rows.filter_map(|row| row.split_once(" | ")).collect();
    assert_eq!(told, rows);
    let numbers: Vec<_> = told.iter().map(|(code, _)| *code).collect();
    assert_eq!(numbers, ["0", "1", "2", "130", "143"]);
}
