//! The printers on made-up diagnostics, as whole texts; no bytes make them fail, or send a command
//! to the terminal.

use super::*;
use crate::codes;
use insta::assert_snapshot;
use proptest::prelude::*;
use rtc_source::Span;

const PLAIN: PrintOptions = PrintOptions {
    color: false,
    width: 80,
    least: Severity::Warning,
    max: 100,
};
const SCENE: &str = "Camera:\n\teye: [0, 日本, .inf]\nShaddows: true\n";

fn print(
    format: Format,
    options: PrintOptions,
    text: &[u8],
    make: impl Fn(Span) -> Vec<Diagnostic>,
) -> String {
    let mut map = SourceMap::default();
    let file = map.add("a b.yaml", text.to_vec());
    let mut sink = DiagnosticSink::default();
    make(Span::new(file, 0, 0))
        .into_iter()
        .for_each(|diagnostic| sink.push(diagnostic));
    let mut printer = DiagnosticPrinter::new(format, options);
    let text = printer.file("a b.yaml", sink, &map);
    text + &printer.finish()
}

fn find(at: Span, text: &str, word: &str) -> Span {
    let start = u32::try_from(text.find(word).unwrap()).unwrap();
    Span {
        start,
        end: start + u32::try_from(word.len()).unwrap(),
        ..at
    }
}

fn two(at: Span) -> Vec<Diagnostic> {
    let span = |word| find(at, SCENE, word);
    vec![
        Diagnostic::new(&codes::UNKNOWN_KEY, "unknown key `Shaddows`")
            .at(span("Shaddows"), "no such key: 100 %, here")
            .also(span("Camera"), "`Shadows` goes beside this")
            .replace(
                "a key with a similar name exists",
                span("Shaddows"),
                "Shadows",
            ),
        Diagnostic::new(&codes::NOT_FINITE, "`.inf` is not finite")
            .at(span(".inf"), "not a number to compute with")
            .pointer("/camera/eye/2")
            .hint("give a finite number"),
    ]
}

fn hostile(at: Span) -> Vec<Diagnostic> {
    vec![
        Diagnostic::new(&codes::UNKNOWN_KEY, "unknown key `\x1b[2J\n::error::x`")
            .at(
                Span {
                    start: 1,
                    end: 4,
                    ..at
                },
                "\u{9b}31m\u{202e}",
            )
            .replace(
                "\x07",
                Span {
                    start: 1,
                    end: 2,
                    ..at
                },
                "\x1b]0;x\n\x07",
            ),
    ]
}

#[test]
fn human_marks_the_source() {
    assert_snapshot!(print(Format::Human, PLAIN, SCENE.as_bytes(), two), @r#"
    error[VA001]: `.inf` is not finite
     --> a b.yaml:2:15
      |
    2 |     eye: [0, 日本, .inf]
      |                    ^^^^ not a number to compute with
      |
      = help: give a finite number

    warning[SC001]: unknown key `Shaddows`
     --> a b.yaml:3:1
      |
    1 | Camera:
      | ------ `Shadows` goes beside this
    2 |     eye: [0, 日本, .inf]
    3 | Shaddows: true
      | ^^^^^^^^ no such key: 100 %, here
      |
    help: a key with a similar name exists
      |
    3 - Shaddows: true
    3 + Shadows: true
      |

    a b.yaml: 1 error, 1 warning; see `rtc explain VA001`
    "#);
}

#[test]
fn human_shows_far_places_apart() {
    let text = format!("Eye: 1\n{}Eye: 2\n", "# filler\n".repeat(500));
    let twice = |at: Span| {
        let second = u32::try_from(text.rfind("Eye").unwrap()).unwrap();
        let again = Diagnostic::new(&codes::NOT_FINITE, "`Eye` is given twice");
        vec![
            again
                .at(
                    Span {
                        start: second,
                        end: second + 3,
                        ..at
                    },
                    "again",
                )
                .also(Span { end: 3, ..at }, "first"),
        ]
    };
    assert_snapshot!(print(Format::Human, PLAIN, text.as_bytes(), twice), @r#"
    error[VA001]: `Eye` is given twice
       --> a b.yaml:502:1
        |
    502 | Eye: 2
        | ^^^ again
        |
       ::: a b.yaml:1:1
        |
      1 | Eye: 1
        | --- first

    a b.yaml: 1 error; see `rtc explain VA001`
    "#);
}

#[test]
fn human_names_the_byte_or_column_where_lines_mean_nothing() {
    let late = |at: Span| {
        let diagnostic = Diagnostic::new(&codes::NOT_UTF8, "the file is not UTF-8");
        vec![diagnostic.at(
            Span {
                start: 5000,
                end: 5001,
                ..at
            },
            "`0xff` here",
        )]
    };
    assert_snapshot!(print(Format::Human, PLAIN, &[&[0; 5000][..], &[0xff; 9]].concat(), late), @r#"
    error[SY001]: the file is not UTF-8
    --> a b.yaml: byte 5000
     = note: `0xff` here

    a b.yaml: 1 error; see `rtc explain SY001`
    "#);
    assert_snapshot!(print(Format::Human, PLAIN, &[b'x'; 9_000], late), @r#"
    error[SY001]: the file is not UTF-8
    --> a b.yaml:1:5001
     = note: `0xff` here

    a b.yaml: 1 error; see `rtc explain SY001`
    "#);
    assert_snapshot!(print(Format::Human, PLAIN, b"", |_| vec![
        Diagnostic::new(&codes::NOT_FINITE, "too large").pointer("/lights/0")
    ]), @r#"
    error[VA001]: too large
     |
     = note: at `/lights/0`

    a b.yaml: 1 error; see `rtc explain VA001`
    "#);
}

#[test]
fn human_pictures_commands() {
    assert_snapshot!(print(Format::Human, PLAIN, b"a\x1b[2J: 1", hostile), @r#"
    warning[SC001]: unknown key `\u{1b}[2J\u{a}::error::x`
     --> a b.yaml:1:2
      |
    1 | a␛[2J: 1
      |  ^^^ \u{9b}31m\u{202e}
      |
    help: \u{7}
      |
    1 ~ a\u{1b}]0;x
    2 ~ \u{7}[2J: 1
      |

    a b.yaml: 1 warning; see `rtc explain SC001`
    "#);
}

#[test]
fn short_is_one_line_each() {
    assert_snapshot!(print(Format::Short, PLAIN, SCENE.as_bytes(), two), @r#"
    a b.yaml:2:15: error[VA001]: `.inf` is not finite
    a b.yaml:3:1: warning[SC001]: unknown key `Shaddows`
    "#);
    assert_snapshot!(print(Format::Short, PLAIN, b"a\x1b[2J: 1", hostile), @r#"a b.yaml:1:2: warning[SC001]: unknown key `\u{1b}[2J\u{a}::error::x`"#);
}

#[test]
fn github_is_commands_of_its_own_only() {
    assert_snapshot!(print(Format::Github, PLAIN, SCENE.as_bytes(), two), @r#"
    ::error file=a b.yaml,line=2,endLine=2,col=15,endColumn=19,title=VA001::`.inf` is not finite%0Anot a number to compute with%0Aat `/camera/eye/2`%0Ahelp: give a finite number
    ::warning file=a b.yaml,line=3,endLine=3,col=1,endColumn=9,title=SC001::unknown key `Shaddows`%0Ano such key: 100 %25, here%0Ahelp: a key with a similar name exists: `Shadows`
    "#);
    assert_snapshot!(print(Format::Github, PLAIN, b"a\x1b[2J: 1", hostile), @r#"::warning file=a b.yaml,line=1,endLine=1,col=2,endColumn=5,title=SC001::unknown key `\u{1b}[2J%0A::error::x`%0A\u{9b}31m\u{202e}%0Ahelp: \u{7}: `\u{1b}]0;x%0A\u{7}`"#);
}

#[test]
fn json_has_every_field() {
    assert_snapshot!(print(Format::Json, PLAIN, SCENE.as_bytes(), two), @r#"
    {"code":"VA001","severity":"error","message":"`.inf` is not finite","file":"a b.yaml","primary":{"file":"a b.yaml","byteStart":26,"byteEnd":30,"start":{"line":2,"column":15},"end":{"line":2,"column":19},"text":"not a number to compute with"},"labels":[],"hints":[{"text":"give a finite number","replacement":null}],"pointer":"/camera/eye/2"}
    {"code":"SC001","severity":"warning","message":"unknown key `Shaddows`","file":"a b.yaml","primary":{"file":"a b.yaml","byteStart":32,"byteEnd":40,"start":{"line":3,"column":1},"end":{"line":3,"column":9},"text":"no such key: 100 %, here"},"labels":[{"file":"a b.yaml","byteStart":0,"byteEnd":6,"start":{"line":1,"column":1},"end":{"line":1,"column":7},"text":"`Shadows` goes beside this"}],"hints":[{"text":"a key with a similar name exists","replacement":{"file":"a b.yaml","byteStart":32,"byteEnd":40,"start":{"line":3,"column":1},"end":{"line":3,"column":9},"text":"Shadows","guess":false}}],"pointer":null}
    "#);
}

#[test]
fn sarif_is_one_run_with_all_rules() {
    let mut log: serde_json::Value =
        serde_json::from_str(&print(Format::Sarif, PLAIN, SCENE.as_bytes(), two)).unwrap();
    let run = &log["runs"][0];
    assert_eq!(
        run["tool"]["driver"]["rules"].as_array().unwrap().len(),
        codes::all().count()
    );
    for result in run["results"].as_array().unwrap() {
        let rule = usize::try_from(result["ruleIndex"].as_u64().unwrap()).unwrap();
        let rule = &run["tool"]["driver"]["rules"][rule];
        assert_eq!(rule["id"], result["ruleId"]);
        let help = ["text", "markdown"].map(|form| rule["help"][form].as_str().unwrap());
        assert!(help.iter().all(|text| text.len() > 40));
    }
    log["runs"][0]["results"][1]
        .as_object_mut()
        .unwrap()
        .shift_remove("ruleIndex");
    assert_snapshot!(log["runs"][0]["results"][1].to_string(), @r#"{"ruleId":"SC001","level":"warning","message":{"text":"unknown key `Shaddows`\nhelp: a key with a similar name exists"},"locations":[{"physicalLocation":{"artifactLocation":{"uri":"a%20b.yaml"},"region":{"byteOffset":32,"byteLength":8,"startLine":3,"startColumn":1,"endLine":3,"endColumn":9}},"message":{"text":"no such key: 100 %, here"}}],"relatedLocations":[{"physicalLocation":{"artifactLocation":{"uri":"a%20b.yaml"},"region":{"byteOffset":0,"byteLength":6,"startLine":1,"startColumn":1,"endLine":1,"endColumn":7}},"message":{"text":"`Shadows` goes beside this"}}],"fixes":[{"description":{"text":"a key with a similar name exists"},"artifactChanges":[{"artifactLocation":{"uri":"a%20b.yaml"},"replacements":[{"deletedRegion":{"byteOffset":32,"byteLength":8,"startLine":3,"startColumn":1,"endLine":3,"endColumn":9},"insertedContent":{"text":"Shadows"}}]}]}]}"#);
}

#[test]
fn errors_come_before_warnings_when_not_all_fit() {
    let flood = |at: Span| {
        let place = |i| Span {
            start: i,
            end: i + 1,
            ..at
        };
        let warning =
            |i| Diagnostic::new(&codes::UNKNOWN_KEY, format!("warning {i}")).at(place(i), "");
        let error = Diagnostic::new(&codes::NOT_FINITE, "error").at(place(2), "");
        (0..5).map(warning).chain([error]).collect()
    };
    let options = PrintOptions { max: 2, ..PLAIN };
    assert_snapshot!(print(Format::Short, options, b"0123456789", flood), @r#"
    a b.yaml:1:1: warning[SC001]: warning 0
    a b.yaml:1:3: error[VA001]: error
    a b.yaml: and 4 more
    "#);
    assert!(
        print(Format::Human, options, b"0123456789", flood)
            .contains("and 4 more\na b.yaml: 1 error, 5 warnings;")
    );
    assert!(print(Format::Json, options, b"0123456789", flood).ends_with("\n{\"omitted\":4}\n"));
}

/// Nine lines, one diagnostic in each: all equal except that of the second line.
#[test]
fn equal_findings_are_folded_for_people_alone() {
    let lines = "a\n".repeat(9);
    let flood = |at: Span| {
        let place = |line: u32| Span {
            start: 2 * line,
            end: 2 * line + 1,
            ..at
        };
        let message = |line: u32| {
            if line == 1 {
                "another"
            } else {
                "the same word"
            }
        };
        let diagnostic =
            |line| Diagnostic::new(&codes::NOT_FINITE, message(line)).at(place(line), "");
        (0..9).map(diagnostic).collect()
    };
    let text = print(Format::Human, PLAIN, lines.as_bytes(), flood);
    assert_eq!(text.matches("the same word").count(), 1);
    assert!(
        text.contains("= note: the same 7 times more, at lines 3, 4, 5, 6, 7, 8, …")
            && text.contains("another")
            && text.ends_with("a b.yaml: 9 errors; see `rtc explain VA001`\n"),
        "{text}"
    );
    let short = print(Format::Short, PLAIN, lines.as_bytes(), flood);
    assert_eq!(short.lines().count(), 9);
    // Three diagnostics are not folded.
    let some = |at: Span| flood(at).into_iter().take(4).collect();
    let text = print(Format::Human, PLAIN, lines.as_bytes(), some);
    assert_eq!(text.matches("the same word").count(), 3);
}

#[test]
fn notes_are_for_those_who_ask_and_for_programs() {
    let note = |at: Span| vec![two(at).remove(0).severity(Severity::Note)];
    let shown = |format, least| {
        !print(
            format,
            PrintOptions { least, ..PLAIN },
            SCENE.as_bytes(),
            note,
        )
        .is_empty()
    };
    assert_eq!(
        [Severity::Warning, Severity::Note].map(|least| shown(Format::Human, least)),
        [false, true]
    );
    assert_eq!(
        [Severity::Error, Severity::Note].map(|least| shown(Format::Json, least)),
        [true, true]
    );
}

fn nasty() -> impl Strategy<Value = Vec<u8>> {
    let pieces = [
        "a", ": ", "\n", "\r\n", "\r", "\t", "日", "e\u{301}", "\u{200d}", "\x1b[", "\0", "\u{9b}",
        "\u{202e}",
    ];
    let piece = prop_oneof![
        proptest::sample::select(pieces.to_vec()).prop_map(|piece| piece.as_bytes().to_vec()),
        Just(vec![0xff]),
        Just(vec![b'x'; 700]),
    ];
    proptest::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat())
}

proptest! {
    #[test]
    fn no_bytes_make_a_printer_fail_or_command_a_terminal(bytes in nasty(), at in any::<[u16; 6]>()) {
        let length = u32::try_from(bytes.len()).unwrap() + 1;
        let words = String::from_utf8_lossy(&bytes).into_owned();
        let make = |whole: Span| {
            let span = |i: usize| {
                let (a, b) = (u32::from(at[i]) % length, u32::from(at[i + 1]) % length);
                Span { start: a.min(b), end: a.max(b), ..whole }
            };
            let diagnostic = Diagnostic::new(&codes::NOT_FINITE, words.clone()).at(span(0), words.clone());
            vec![diagnostic.also(span(2), words.clone()).replace(words.clone(), span(4), words.clone()).pointer(words.clone())]
        };
        for format in [Format::Human, Format::Short, Format::Json, Format::Sarif, Format::Github] {
            let text = print(format, PLAIN, &bytes, make);
            prop_assert!(!text.contains(|c| c != '\n' && text::is_unsafe(c)), "{format:?}: {text:?}");
        }
    }
}
