//! The README and the book show what the program prints: each command in them is run in a folder
//! with copies of the files it names, and the lines shown are those of its output, `…` standing for
//! any others. Times and counts of renders may differ.
//!
//! `rtc cost` takes too long here: its arguments are parsed, and its lines are about what those of
//! a study with less work are about. `benches/readme.sh` runs everything in release and writes the
//! lines anew.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, makes the files it needs, and writes the README if asked"
)]

use crate::repo::files;
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::pipeline::{self, Options};
use rtc::internals::render::RenderStep;
use rtc::internals::source::{Loader, SourceMap};
use rtc::internals::study::{self, Effort, StudyProvenance, StudyRuntime, WorkClock};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;
use tempfile::TempDir;

/// Stands for any lines.
const CUT: &str = "…";

/// The pages whose commands are run: the README, and what is written by hand of these chapters. The
/// guide has a test of its own.
fn pages() -> Vec<PathBuf> {
    let chapters = ["how", "reference", "contributing"]
        .map(|chapter| files(&root().join("docs/book/src").join(chapter), &["md"]))
        .concat();
    let is_written = |path: &PathBuf| !fs::read_to_string(path).unwrap().contains(GENERATED);
    let chapters = chapters.into_iter().filter(is_written);
    [root().join("README.md")]
        .into_iter()
        .chain(chapters)
        .collect()
}

/// In pages that `tests/book.rs` writes.
const GENERATED: &str = "<!-- Generated";

/// Rays of a study that takes a second.
const EFFORT: Effort = Effort(1_000_000);

/// A command of the README and the lines shown below it, by their numbers.
pub(crate) struct Shown {
    pub(crate) args: Vec<String>,
    pub(crate) lines: std::ops::Range<usize>,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn lines(page: &Path) -> Vec<String> {
    fs::read_to_string(page)
        .unwrap()
        .lines()
        .map(str::to_owned)
        .collect()
}

/// The commands in the blocks of kind `console`.
pub(crate) fn commands(page: &[String]) -> Vec<Shown> {
    let mut found: Vec<Shown> = Vec::new();
    let mut inside = false;
    for (number, line) in page.iter().enumerate() {
        if let Some(command) = line.strip_prefix("$ rtc ").filter(|_| inside) {
            let args = command.split_whitespace().map(str::to_owned).collect();
            found.push(Shown {
                args,
                lines: number + 1..number + 1,
            });
        } else if line.starts_with("```") {
            inside = line == "```console";
        } else if let Some(last) = found.last_mut().filter(|_| inside) {
            last.lines.end = number + 1;
        }
    }
    found
}

/// A folder with a copy of each folder of the repo in which a file stands that is named.
fn folder(args: &[String]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for path in args
        .iter()
        .map(Path::new)
        .filter(|path| root().join(path).is_file())
    {
        let beside = path.parent().unwrap();
        fs::create_dir_all(folder.path().join(beside)).unwrap();
        for entry in fs::read_dir(root().join(beside))
            .unwrap()
            .map(Result::unwrap)
        {
            if entry.path().is_file() {
                fs::copy(
                    entry.path(),
                    folder.path().join(beside).join(entry.file_name()),
                )
                .unwrap();
            }
        }
    }
    folder
}

/// What a command says on both streams, and its exit code.
fn run(args: &[String]) -> (Vec<String>, i32) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    let folder = folder(args);
    let output = command
        .current_dir(folder.path())
        .args(args)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr]
        .map(|bytes| String::from_utf8(bytes).unwrap())
        .concat();
    (
        text.lines().map(str::to_owned).collect(),
        output.status.code().unwrap(),
    )
}

/// A line without its numbers, the units that depend on their size, and the mark of the front.
fn form(line: &str) -> String {
    let mut form = String::new();
    for c in line.chars() {
        let is_of_number = c.is_ascii_digit() || (form.ends_with('#') && matches!(c, '.' | ','));
        if !is_of_number {
            form.push(c);
        } else if !form.ends_with('#') {
            form.push('#');
        }
    }
    let is_unit = |word: &&str| {
        matches!(
            word.trim_end_matches([',', '.', ';']),
            "ms" | "s" | "min" | "k" | "M" | "G" | "*"
        )
    };
    let words = form
        .split_whitespace()
        .filter(|word| !is_unit(word))
        .collect::<Vec<_>>();
    words.join(" ").replace("#e-#", "#")
}

/// What a line is about: what stands before a colon.
fn heading(form: &str) -> &str {
    form.split(':').next().unwrap()
}

/// Where in an output the lines shown are; cuts are nowhere.
fn places(
    shown: &[String],
    output: &[String],
    same: impl Fn(&str, &str) -> bool,
) -> Option<Vec<Option<usize>>> {
    let (mut places, mut from) = (Vec::new(), 0);
    let parts = shown.split(|line| line == CUT).collect::<Vec<_>>();
    for (index, part) in parts.iter().enumerate() {
        let fits = |at: &usize| part.iter().zip(&output[*at..]).all(|(a, b)| same(a, b));
        let last = output
            .len()
            .checked_sub(part.len())
            .filter(|last| *last >= from)?;
        let (first, last) = (
            if index == parts.len() - 1 { last } else { from },
            if index == 0 { from } else { last },
        );
        let at = if part.is_empty() {
            from
        } else {
            (first..=last).find(fits)?
        };
        from = at + part.len();
        places.extend((at..from).map(Some));
        places.push(None);
    }
    places.pop();
    Some(places)
}

/// Whether two lines say the same, but for what differs from machine to machine.
fn is_same(args: &[String], a: &str, b: &str) -> bool {
    let is_measured = matches!(args[0].as_str(), "render" | "cost");
    if is_measured {
        form(a) == form(b)
    } else {
        a == b
    }
}

/// What `rtc cost` says of a scene for little work.
fn cheap_study(path: &str) -> String {
    let (mut map, mut sink, options) = (
        SourceMap::default(),
        DiagnosticSink::default(),
        Options::default(),
    );
    let file = Loader.file(&root().join(path), &mut map).unwrap();
    let scene = pipeline::load(file, &mut map, &options, &mut sink)
        .unwrap()
        .scene;
    let traced = AtomicU64::new(0);
    let clock = || Duration::from_micros(traced.load(Relaxed));
    let on_pixel = |step: RenderStep| {
        traced.fetch_add(step.rays, Relaxed);
        true
    };
    let bench = StudyRuntime::new(
        0,
        WorkClock {
            cpu: &clock,
            wall: &clock,
        },
        &on_pixel,
    )
    .unwrap();
    study::table(&study::study(&scene, StudyProvenance::default(), EFFORT, 0, &bench).unwrap())
}

/// What is wrong with the lines shown of a command.
pub(crate) fn fault(shown: &[String], args: &[String]) -> Option<String> {
    if args[0] == "cost" {
        let (_, code) = run(&[args, &["--help".to_owned()]].concat());
        let output = cheap_study(&args[1]);
        let forms = output.lines().map(form).collect::<Vec<_>>().join(" ");
        let missing = shown
            .iter()
            .find(|line| *line != CUT && !forms.contains(heading(&form(line))));
        return (code != 0 || missing.is_some())
            .then(|| format!("exit code {code}, {missing:?} is not in\n{output}"));
    }
    let (output, code) = run(args);
    let is_error = |line: &String| line.starts_with("error[") || line.starts_with("::error ");
    let wanted = i32::from(shown.iter().any(is_error));
    let places = places(shown, &output, |a, b| is_same(args, a, b));
    (code != wanted || places.is_none())
        .then(|| format!("exit code {code}, says\n{}", output.join("\n")))
}

/// The lines of an output that stand for those shown; all of them if they don't.
fn anew(shown: &[String], args: &[String]) -> Vec<String> {
    let (output, _) = run(args);
    match places(shown, &output, |a, b| is_same(args, a, b)) {
        Some(places) => places
            .iter()
            .map(|at| at.map_or(CUT.to_owned(), |at| output[at].clone()))
            .collect(),
        None => {
            println!("rtc {}: cut what it says by hand", args.join(" "));
            output
        }
    }
}

#[test]
fn the_readme_and_the_book_show_what_the_program_says() {
    let (mut count, mut faults) = (0, Vec::new());
    for page in pages() {
        let mut lines = lines(&page);
        let commands = commands(&lines);
        count += commands.len();
        if cfg!(not(debug_assertions)) && std::env::var_os("RTC_UPDATE").is_some() {
            for Shown { args, lines: shown } in commands.iter().rev() {
                let anew = anew(&lines[shown.clone()], args);
                lines.splice(shown.clone(), anew);
            }
            fs::write(page, lines.join("\n") + "\n").unwrap();
            continue;
        }
        let fault = |shown: &Shown| {
            let fault = fault(&lines[shown.lines.clone()], &shown.args)?;
            let args = shown.args.join(" ");
            Some(format!("{}: rtc {args}: {fault}", page.display()))
        };
        faults.extend(commands.iter().filter_map(fault));
    }
    assert!(count >= 9, "there are commands in the README and the book");
    assert!(
        faults.is_empty(),
        "run benches/readme.sh\n{}",
        faults.join("\n")
    );
}

/// The lines of a page outside of blocks of code, and the commands in such blocks as code.
fn prose(page: &Path) -> Vec<String> {
    let mut is_code = false;
    let line = |line: String| {
        let text = line.trim_start().trim_start_matches("$ ");
        if text.starts_with("```") {
            is_code = !is_code;
            return None;
        }
        if !is_code {
            return Some(line);
        }
        text.starts_with("rtc ").then(|| format!("`{text}`"))
    };
    lines(page).into_iter().filter_map(line).collect()
}

#[test]
fn every_command_and_option_that_the_readme_and_the_book_name_is_there() {
    let text = pages()
        .iter()
        .flat_map(|page| prose(page))
        .collect::<Vec<_>>()
        .join("\n");
    let spans = text
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|span| !span.contains("cargo "));
    let spans: Vec<Vec<&str>> = spans
        .map(|span| span.split_whitespace().collect())
        .collect();
    let words = spans.concat();
    let after_rtc = spans
        .iter()
        .flat_map(|span| span.windows(2))
        .filter(|pair| pair[0] == "rtc")
        .map(|pair| pair[1]);
    let mut commands = after_rtc
        .filter(|word| word.chars().all(|c| c.is_ascii_lowercase()))
        .collect::<Vec<_>>();
    commands.sort_unstable();
    commands.dedup();
    assert!(commands.len() >= 7, "{commands:?}");
    let mut help = String::new();
    for command in commands {
        let (lines, code) = run(&[command.to_owned(), "--help".to_owned()]);
        assert_eq!(code, 0, "rtc {command}");
        help += &lines.join("\n");
    }
    let is_option = |word: &str| {
        word.strip_prefix("--")
            .is_some_and(|name| name.starts_with(char::is_alphabetic))
    };
    let mut options = words.iter().filter(|word| is_option(word));
    assert!(options.clone().count() >= 10);
    let missing = options.find(|option| !help.contains(option.split('=').next().unwrap()));
    assert_eq!(missing, None, "no command has this option");
}

#[test]
fn lines_are_found_between_cuts() {
    let lines = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let found = |shown: &str| places(&lines(shown), &lines("a b c a d"), |a, b| a == b);
    assert_eq!(found("a b c a d"), Some((0..5).map(Some).collect()));
    assert_eq!(found("a … d"), Some(vec![Some(0), None, Some(4)]));
    assert_eq!(found("… a d"), Some(vec![None, Some(3), Some(4)]));
    assert_eq!(found("… c …"), Some(vec![None, Some(2), None]));
    for wrong in ["a b", "b …", "… a", "a … c", "… d … c …", "a b c a d e"] {
        assert_eq!(found(wrong), None, "{wrong}");
    }
    assert_eq!(
        form("* 2  543 k  94.1 ms, 1,234 rays/s 3e-5"),
        "# # # # rays/s #"
    );
}

#[test]
fn its_picture_is_what_its_first_command_makes() {
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("glass.png");
    let mut command = Command::new(env!("CARGO_BIN_EXE_rtc"));
    command
        .current_dir(root())
        .args(["render", "-q", "scenes/glass.yaml", "-o"]);
    assert!(command.arg(&made).status().unwrap().success());
    let shown = root().join("scenes/glass.png");
    assert!(
        fs::read(made).unwrap() == fs::read(&shown).unwrap(),
        "{}: render scenes/glass.yaml anew, and put its sha256 into the README",
        shown.display()
    );
}
