//! The command line of rtc: parses the arguments, runs a command, returns an exit code.
//!
//! # Overview
//!
//! [`run`] is the only entry point. `main` passes it the arguments and exits with its result.
//!
//! 1. `args` declares every command and option with clap, exactly as typed. `parse` has the parsers
//!    of values.
//! 2. Each command is a module with a function `run`: `check`, `compile`, `render`, `cost`, `diff`,
//!    `audit`, `certify`, `info`, `fmt`, `new`, `merge`, `batch` (for `rtc farm`), `preview`,
//!    `lsp`, `explain`, and `describe` for schemas, completions and manual pages.
//! 3. `input` reads the scene of a command with the defaults of its `rtc.toml` (`project`), and
//!    validates it. The work itself is done by `pipeline`, `study` and `render`.
//! 4. `reporter` prints diagnostics in the requested format; `output` writes results atomically.
//!
//! Shared parts: `files` expands folders and patterns, `table` prints a row for each file, `gate`
//! parses and checks limits, `interrupt` turns signals into a flag, `progress` draws the bar.
//! [`trial`] has the entry points of the fuzz targets.
//!
//! # Streams and exit codes
//!
//! - Standard output is for results, standard error for messages. A closed pipe is success.
//! - `Failure` lists the reasons why a command fails, with their exit codes: 1 for errors in the
//!   input and failed gates, 2 for usage and file errors, 128 plus the number of a signal.
//! - A panic is reported as an internal error with exit code 2.
//!
//! # Guarantees
//!
//! - No rule about scenes is decided here.
//! - Results are written as a whole or not at all, except to standard output.

mod args;
mod audit;
mod batch;
mod certify;
mod check;
mod compile;
mod cost;
mod describe;
mod diff;
mod edit;
mod explain;
mod failure;
mod files;
mod fix;
mod fmt;
mod gate;
mod ignored;
mod info;
mod input;
mod interrupt;
mod lsp;
mod merge;
mod new;
mod output;
mod parse;
mod preview;
mod progress;
mod project;
mod render;
mod report;
mod reporter;
mod shown;
mod simd;
mod system;
mod table;
pub mod trial;
mod turntable;
mod typed;
mod versus;

use args::{Cli, Command};
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Error, Parser};
use failure::Failure;
use rtc_diag::clip_words;
use rtc_front::is_scene_name;
use std::ffi::OsString;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::path::Path;

/// The maximum length of a line of the help; a line that repeats arguments may be longer.
const LONG_LINE: usize = 500;

/// What `rtc` alone prints.
const FIRST_COMMANDS: &str = "rtc, a compiler for 3-D scenes

Commands to begin with:
  rtc new scene.yaml              write a first scene
  rtc preview scene.yaml --open   show it on a page while you edit it
  rtc check scene.yaml            report mistakes in it
  rtc render scene.yaml           render it to scene.png
  rtc render model.glb            render a glTF model

`rtc --help` lists all commands, `rtc explain` all codes of diagnostics.";

/// Carries out the command given by the arguments, program name first, and returns the exit code.
#[must_use]
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    interrupt::outlive_full_files();
    panic::set_hook(Box::new(|info| {
        reporter::print_message(&internal_error(info))
    }));
    guarded(|| dispatch(arguments))
}

/// The exit code of a command, or of an internal error.
fn guarded(work: impl FnOnce() -> u8) -> u8 {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(2)
}

fn dispatch(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let typed: Vec<OsString> = arguments.into_iter().collect();
    if typed.len() < 2 {
        reporter::print_message(FIRST_COMMANDS);
        return 2;
    }
    let cli = match Cli::try_parse_from(&typed) {
        Ok(cli) => cli,
        Err(mut error) => {
            suggest_render(&mut error, &typed);
            // Help and version also arrive here. A closed pipe is no failure for them.
            let text = error.render().to_string();
            if text.lines().any(|line| line.len() > LONG_LINE) {
                let lines: Vec<_> = text.lines().map(clip_words).collect();
                reporter::print_message(&lines.join("\n"));
            } else {
                let _ = error.print();
            }
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let outcome = match cli.command {
        Command::New(args) => new::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Fmt(args) => fmt::run(&args),
        Command::Compile(args) => compile::run(&args),
        Command::Render(args) => render::run(*args, &typed),
        Command::Preview(args) => preview::run(&args, &typed),
        Command::Lsp(args) => lsp::run(args),
        Command::Merge(args) => merge::run(&args),
        Command::Farm(args) => batch::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Audit(args) => audit::run(&args),
        Command::Certify(args) => certify::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Schema(args) => describe::schema(&args),
        Command::Completions(args) => describe::completions(&args),
        Command::Man(args) => describe::man(&args),
    };
    match outcome {
        Ok(()) => 0,
        Err(failure) => {
            if let Failure::Input(message) | Failure::Failed(message) = &failure {
                reporter::print_message(&format!("error: {message}"));
            }
            failure.exit_code()
        }
    }
}

/// Completes the error of a command that has a scene where a subcommand belongs.
fn suggest_render(error: &mut Error, typed: &[OsString]) {
    let Some(scene) = typed.get(1).map(Path::new) else {
        return;
    };
    let name = scene.to_string_lossy();
    let is_scene = is_scene_name(&name) || scene.is_file();
    if error.kind() != ErrorKind::InvalidSubcommand || !is_scene {
        return;
    }
    error.remove(ContextKind::SuggestedSubcommand);
    let tip = format!("did you mean `rtc render {}`?", clip_words(&name));
    let tip = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
    error.insert(ContextKind::Suggested, tip);
}

fn internal_error(info: &PanicHookInfo) -> String {
    let message = info.payload_as_str().unwrap_or("no message");
    let place = info
        .location()
        .map(|at| format!(" at {}:{}", at.file(), at.line()))
        .unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "internal error: {message}{place}\n\
         This is a bug in rtc {version}: please report it with the scene."
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_neither_success_nor_the_fault_of_the_input() {
        assert_eq!(guarded(|| unreachable!("this test asks for it")), 2);
        assert_eq!(guarded(|| 1), 1);
    }
}
