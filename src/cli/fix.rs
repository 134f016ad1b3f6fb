//! `rtc check --fix` and `--diff`: what hints propose, put into files or shown.

use super::args::CheckArgs;
use super::talk::{self, Talk};
use super::{Failure, input, output};
use crate::pipeline::{self, FixedText, Input, NewFile};
use crate::source::{Loader, SourceMap};
use similar::TextDiff;
use std::io;
use std::path::Path;

/// Lines shown around each change.
const AROUND: usize = 3;

/// Fixes the scene that was read from `path`, or shows how that would be: the scene as it is then.
pub(super) fn run(
    path: &Path,
    read: Input,
    args: &CheckArgs,
    talk: &Talk,
) -> Result<Input, Failure> {
    let Some(text) = read.text().filter(|_| args.fix || args.diff) else {
        return Ok(read);
    };
    let is_file = path.as_os_str() != "-";
    if !is_file && !args.diff {
        return Err(Failure::Trouble(
            "standard input can't be fixed; give a file, or `--diff`".to_owned(),
        ));
    }
    let options = input::options(&args.reading);
    let fixed = pipeline::fix(path, text, &options, args.guesses);
    if !talk.is_quiet() {
        tell(read.name(), &fixed, args.diff);
    }
    if fixed.changes == 0 {
        return Ok(read);
    }
    if args.diff {
        output::to_stdout(diff(read.name(), text, &fixed.text).as_bytes())?;
        return Ok(read);
    }
    write(path, text, &fixed.text)
        .map_err(|error| Failure::Trouble(format!("can't write `{}`: {error}", read.name())))?;
    Ok(Input::edited(path, fixed.text.into_bytes(), options))
}

/// Says what was done, and what was not and why.
fn tell(name: &str, fixed: &FixedText, is_shown: bool) {
    let changes = |count| match count {
        1 => "1 change".to_owned(),
        _ => format!("{count} changes"),
    };
    let FixedText {
        text: _,
        changes: made,
        refused,
        guesses,
    } = *fixed;
    if made > 0 {
        let what = if is_shown { "proposed" } else { "made" };
        talk::say(&format!("{name}: {} {what}", changes(made)));
    }
    if refused > 0 {
        talk::say(&format!(
            "{name}: {} left out, which would not make the check better",
            changes(refused)
        ));
    }
    if guesses > 0 {
        talk::say(&format!(
            "{name}: {} left out, which only guess what was meant; `--unsafe` takes them",
            changes(guesses)
        ));
    }
}

/// The changes as a unified diff.
fn diff(name: &str, before: &str, after: &str) -> String {
    let name: String = name
        .chars()
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    TextDiff::from_lines(before, after)
        .unified_diff()
        .context_radius(AROUND)
        .header(&name, &name)
        .to_string()
}

/// Puts the text into the file, unless someone else has changed it since it was read.
fn write(path: &Path, before: &str, after: &str) -> io::Result<()> {
    let limit = before.len() as u64;
    let now = Loader.bytes(path, limit, &SourceMap::default());
    if !now.is_ok_and(|now| now == before.as_bytes()) {
        return Err(io::Error::other("it has changed since it was read"));
    }
    NewFile::save(path, after.as_bytes())
}
