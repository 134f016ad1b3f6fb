//! Messages and their streams: diagnostics for people on standard error, those for programs on
//! standard output.

use super::render::FinishedPicture;
use super::{Failure, args, output};
use anstream::{AutoStream, ColorChoice};
use rtc_diag::{
    DiagnosticPrinter, DiagnosticSink, Format, PrintOptions, Severity, clean_json, clean_lines,
};
use rtc_source::SourceMap;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::{self, IsTerminal, Write};

/// The default width of a terminal.
const WIDTH: usize = 100;

/// A message as it was reported.
#[derive(Deserialize, Serialize)]
pub(super) enum ReportedMessage {
    /// The printed diagnostics of a file.
    Diagnostics(String),
    /// A warning about the arguments or the machine.
    Warning(String),
}

impl ReportedMessage {
    /// Whether it commands a terminal to nothing but colours, as what was printed does.
    pub(super) fn is_harmless(&self) -> bool {
        let (Self::Diagnostics(text) | Self::Warning(text)) = self;
        let mut pieces = text.split("\x1b[");
        let is_clean = |text: &str| clean_lines(text) == text;
        // A colour is numbers and semicolons, and ends with an `m`.
        let after_color = |piece: &str| {
            let rest = piece.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';');
            rest.strip_prefix('m').is_some_and(is_clean)
        };
        pieces.next().is_none_or(is_clean) && pieces.all(after_color)
    }
}

/// Reports the diagnostics of one file after another.
pub(super) struct Reporter {
    printer: DiagnosticPrinter,
    /// Format and options of the printer, as text.
    style: String,
    /// The messages since [`Reporter::record`], if they can be reported again one by one.
    record: Option<Vec<ReportedMessage>>,
    to_stdout: bool,
    quiet: bool,
    verbose: bool,
    /// Findings are JSON objects.
    tells_objects: bool,
    /// A diagnostic of a file was printed.
    has_reported: bool,
    /// The number of warnings and errors so far, whether printed or not.
    warnings: usize,
    /// The errors, warnings and notes of the last file.
    last: [usize; 3],
    /// The warnings that are printed once.
    repeated: BTreeSet<String>,
}

impl Reporter {
    /// For a command whose result is its diagnostics: those for programs go to standard output.
    pub(super) fn as_result(args: &args::ReporterArgs) -> Self {
        let format = Format::from(args.message_format);
        Self {
            to_stdout: !matches!(format, Format::Human | Format::Short),
            ..Self::beside_result(args)
        }
    }

    /// For a command with another result: all diagnostics go to standard error.
    pub(super) fn beside_result(args: &args::ReporterArgs) -> Self {
        let args::ReporterArgs {
            message_format,
            color,
            max_errors,
            quiet,
            verbose,
        } = *args;
        let least = match (quiet, verbose) {
            (true, _) => Severity::Error,
            (false, true) => Severity::Note,
            (false, false) => Severity::Warning,
        };
        let width = std::env::var("COLUMNS")
            .ok()
            .and_then(|columns| columns.parse().ok())
            .unwrap_or(WIDTH);
        let options = PrintOptions {
            color: is_colored(color),
            width,
            least,
            max: max_errors as usize,
        };
        let format = Format::from(message_format);
        Self {
            printer: DiagnosticPrinter::new(format, options),
            style: format!("{format:?} {options:?}"),
            record: None,
            to_stdout: false,
            quiet,
            verbose,
            tells_objects: message_format == args::MessageFormat::Json,
            has_reported: false,
            warnings: 0,
            last: [0; 3],
            repeated: BTreeSet::new(),
        }
    }

    /// Reports the diagnostics of the file `name`.
    pub(super) fn file(
        &mut self,
        name: &str,
        sink: DiagnosticSink,
        map: &SourceMap,
    ) -> Result<(), Failure> {
        let [mut errors, mut warnings, mut notes] = [0; 3];
        for found in sink.kept() {
            match found.severity {
                Severity::Error => errors += 1,
                Severity::Warning => warnings += 1,
                Severity::Note => notes += 1,
            }
        }
        self.last = [errors, warnings, notes];
        self.warnings += errors + warnings + sink.dropped();
        let deferred = self.printer.deferred();
        let text = self.printer.file(name, sink, map);
        if self.printer.deferred() > deferred {
            self.record = None;
        }
        self.print_diagnostics(text)
    }

    fn print_diagnostics(&mut self, text: String) -> Result<(), Failure> {
        if text.is_empty() {
            return Ok(());
        }
        self.has_reported = true;
        write(self.to_stdout, &text)?;
        if let Some(record) = &mut self.record {
            record.push(ReportedMessage::Diagnostics(text));
        }
        Ok(())
    }

    /// Records the messages from now on.
    pub(super) fn record(&mut self) {
        self.record = Some(Vec::new());
    }

    /// The messages since [`Reporter::record`]; `None` if a part of them is printed at the end of
    /// the report, together with those of other files.
    pub(super) fn take_record(&mut self) -> Option<Vec<ReportedMessage>> {
        self.record.take()
    }

    /// Reports recorded messages again.
    pub(super) fn report_again(&mut self, messages: &[ReportedMessage]) -> Result<(), Failure> {
        messages.iter().try_for_each(|message| match message {
            ReportedMessage::Diagnostics(text) => self.print_diagnostics(text.clone()),
            ReportedMessage::Warning(text) => {
                self.warn(text);
                Ok(())
            }
        })
    }

    /// What the text of recorded messages depends on besides the diagnostics.
    pub(super) fn style(&self) -> &str {
        &self.style
    }

    /// Reports a finished picture: as text, or as an object where diagnostics are objects.
    pub(super) fn made(&self, picture: &FinishedPicture) {
        if self.quiet {
            return;
        }
        match self.tells_objects {
            true => print_object(&picture.object()),
            false => print_message(&picture.text(self.verbose)),
        }
    }

    /// Prints a warning about the arguments or the machine, once.
    pub(super) fn warn(&mut self, message: &str) {
        self.warnings += 1;
        if let Some(record) = &mut self.record {
            record.push(ReportedMessage::Warning(message.to_owned()));
        }
        if !self.quiet && self.repeated.insert(message.to_owned()) {
            print_message(message);
        }
    }

    /// The number of warnings and errors so far, whether they were printed or not.
    pub(super) fn warnings(&self) -> usize {
        self.warnings
    }

    /// The numbers of errors, warnings and notes of the last file, those that are kept.
    pub(super) fn last_counts(&self) -> [usize; 3] {
        self.last
    }

    /// Prints a message that only `--verbose` asks for.
    pub(super) fn note(&self, message: &str) {
        if self.verbose {
            print_message(message);
        }
    }

    /// Whether messages about pictures are JSON objects.
    pub(super) fn tells_objects(&self) -> bool {
        self.tells_objects
    }

    /// Prints the end of the report.
    pub(super) fn finish(self) -> Result<(), Failure> {
        write(self.to_stdout, &self.printer.finish())
    }

    /// True if the terminal of a user has received no message, and quiet mode is off.
    pub(super) fn left_in_doubt(&self) -> bool {
        !self.has_reported && !self.to_stdout && !self.quiet && io::stderr().is_terminal()
    }

    /// True in quiet mode.
    pub(super) fn is_quiet(&self) -> bool {
        self.quiet
    }
}

/// Prints to standard error, without characters that command a terminal. A closed stream is
/// ignored.
pub(super) fn print_message(message: &str) {
    let _ = writeln!(io::stderr(), "{}", clean_lines(message));
}

/// The same for an object of JSON.
pub(super) fn print_object(json: &str) {
    let _ = writeln!(io::stderr(), "{}", clean_json(json));
}

fn write(to_stdout: bool, text: &str) -> Result<(), Failure> {
    if to_stdout {
        return output::to_stdout(text.as_bytes());
    }
    let _ = io::stderr().write_all(text.as_bytes());
    Ok(())
}

fn is_colored(color: args::ColorArg) -> bool {
    match color {
        args::ColorArg::Always => true,
        args::ColorArg::Never => false,
        args::ColorArg::Auto => AutoStream::choice(&io::stderr()) != ColorChoice::Never,
    }
}
