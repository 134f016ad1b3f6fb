//! Arguments shared by all commands that read a scene: how to read it, and how to report
//! diagnostics.

use super::super::parse::{folder, length, limit, moment};
use clap::{ArgAction, Args, ValueEnum, ValueHint};
use rtc_diag::{self as diag, DiagnosticLevel, DiagnosticLevels, LevelSubject};
use rtc_front::UpAxis;
use rtc_source::{Limits, Resource};
use std::path::PathBuf;

/// The options for reading the input.
#[derive(Clone, Debug, Args)]
pub(crate) struct ReadArgs {
    /// Name standard input in messages
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    pub(crate) stdin_name: Option<String>,
    /// Treat unknown keys as errors
    #[arg(long, help_heading = "Input")]
    pub(crate) strict: bool,
    /// Repair mistakes that have one sensible repair, with a warning
    #[arg(long, help_heading = "Input")]
    pub(crate) lenient: bool,
    /// Also search this folder for textures and meshes
    #[arg(
        long,
        value_name = "FOLDER",
        value_parser = folder,
        value_hint = ValueHint::DirPath,
        help_heading = "Input",
    )]
    pub(crate) asset_root: Option<PathBuf>,
    /// Show the animation of a glTF asset or USD stage at this time [default: at rest]
    #[arg(long, value_name = "SECONDS", value_parser = moment, help_heading = "Input")]
    pub(crate) time: Option<f64>,
    /// Select an animation of a glTF asset by name [default: the first, with `--time`]
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    pub(crate) animation: Option<String>,
    /// Select a material variant of a glTF asset by name, or a variant of USD as SET=NAME
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    pub(crate) variant: Option<String>,
    /// Select a camera of a glTF asset or USD stage by name, node or index
    ///
    /// [default: the first that sees something]
    #[arg(long, value_name = "NAME|INDEX", help_heading = "Input")]
    pub(crate) camera: Option<String>,
    /// Set the axis that points up in a mesh file, glTF asset or USD stage
    ///
    /// [default: y, or as the stage says]
    #[arg(long, value_enum, value_name = "AXIS", help_heading = "Input")]
    pub(crate) up_axis: Option<UpAxisArg>,
    /// Set the diameter of points, in pixels of a picture of 512 rows that shows all of them
    ///
    /// [default: by their density]
    #[arg(long, value_name = "PIXELS", value_parser = length, help_heading = "Input")]
    pub(crate) point_size: Option<f64>,
    /// Set a parameter of a Mitsuba scene, before its own `<default>`
    #[arg(
        short = 'D',
        long = "define",
        value_name = "NAME=VALUE",
        value_parser = definition,
        help_heading = "Input",
    )]
    pub(crate) define: Vec<(String, String)>,
    /// Do not report this code, as VA004, or any `warnings`; errors stay
    #[arg(
        long,
        value_name = "CODE",
        value_delimiter = ',',
        value_parser = LevelSubject::parse,
        help_heading = "Diagnostics",
    )]
    pub(crate) allow: Vec<LevelSubject>,
    /// Report this code as a warning
    #[arg(
        long,
        value_name = "CODE",
        value_delimiter = ',',
        value_parser = LevelSubject::parse,
        help_heading = "Diagnostics",
    )]
    pub(crate) warn: Vec<LevelSubject>,
    /// Report this code, or all `warnings`, as errors
    #[arg(
        long,
        value_name = "CODE",
        value_delimiter = ',',
        value_parser = LevelSubject::parse,
        help_heading = "Diagnostics",
    )]
    pub(crate) deny: Vec<LevelSubject>,
    /// Set a limit of the run, as memory=2GiB; `rtc schema limits` lists them
    #[arg(long, value_name = "NAME=NUMBER", value_parser = limit, help_heading = "Limits")]
    pub(crate) limit: Vec<(Resource, u64)>,
    /// Lift all limits of the run
    #[arg(long, help_heading = "Limits")]
    pub(crate) allow_huge: bool,
    /// Let the `rtc.toml` of the scene raise limits, widen `asset-root` and name a `cache`
    #[arg(long, help_heading = "Limits")]
    pub(crate) trust_project: bool,
}

impl ReadArgs {
    /// The levels of diagnostics.
    pub(crate) fn levels(&self) -> Result<DiagnosticLevels, String> {
        let mut levels = DiagnosticLevels::default();
        for level in DiagnosticLevel::ALL {
            let subjects = match level {
                DiagnosticLevel::Allow => &self.allow,
                DiagnosticLevel::Warn => &self.warn,
                DiagnosticLevel::Deny => &self.deny,
            };
            for subject in subjects {
                let set = levels.set(*subject, level);
                set.map_err(|message| format!("`--{}`: {message}", level.name()))?;
            }
        }
        Ok(levels)
    }

    /// The limits of the run; `settle` changes the defaults before the flags do.
    pub(crate) fn limits(&self, settle: impl FnOnce(&mut Limits)) -> Limits {
        let mut limits = Limits::default();
        settle(&mut limits);
        if self.allow_huge {
            limits = Limits::NONE;
        }
        self.limit
            .iter()
            .for_each(|(resource, limit)| limits.set(*resource, *limit));
        limits
    }
}

/// How many threads work.
#[derive(Debug, Args)]
pub(crate) struct ThreadArgs {
    /// Use N threads [default: one for each core]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024),
        help_heading = "Performance",
    )]
    threads: Option<u16>,
}

impl ThreadArgs {
    /// The number of threads; 0 for one for each core.
    pub(crate) fn count(&self) -> usize {
        self.threads.map_or(0, usize::from)
    }
}

/// How diagnostics are printed.
#[derive(Debug, Args)]
pub(crate) struct ReporterArgs {
    /// Select the format of diagnostics
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "FORMAT",
        help_heading = "Diagnostics"
    )]
    pub(crate) message_format: MessageFormat,
    /// Colour diagnostics
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHEN",
        help_heading = "Diagnostics"
    )]
    pub(crate) color: ColorArg,
    /// Print at most N diagnostics for each file
    #[arg(
        long,
        value_name = "N",
        default_value = "100",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Diagnostics",
    )]
    pub(crate) max_errors: u32,
    /// Print only errors: no warnings, progress or summary
    #[arg(
        short,
        long,
        action = ArgAction::SetTrue,
        conflicts_with = "verbose",
        help_heading = "Diagnostics",
    )]
    pub(crate) quiet: bool,
    /// Also print notes, and how often each effect was simulated
    #[arg(short, long, action = ArgAction::SetTrue, help_heading = "Diagnostics")]
    pub(crate) verbose: bool,
}

/// The format of a result that is a report.
#[derive(Debug, Args)]
pub(crate) struct ReportFormatArgs {
    /// Select the format of the report
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "FORMAT",
        help_heading = "Output"
    )]
    format: ReportFormat,
    /// The former spelling of `--format json`
    #[arg(long, hide = true, conflicts_with = "format")]
    json: bool,
}

impl ReportFormatArgs {
    /// Whether the report is one JSON object.
    pub(crate) fn is_json(&self) -> bool {
        self.json || self.format == ReportFormat::Json
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ReportFormat {
    /// Text for people
    #[default]
    Table,
    /// One JSON object; `rtc schema` prints its JSON Schema
    Json,
}

/// The format of a table of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// Text for people
    Text,
    /// Comma-separated values
    Csv,
    /// One JSON object
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum MessageFormat {
    /// For people, with the source
    #[default]
    Human,
    /// One line each, for editors
    Short,
    /// One JSON object per line; the last of a picture is `{"rendered": …}`
    Json,
    /// SARIF 2.1.0
    Sarif,
    /// GitHub workflow commands
    Github,
}

impl From<MessageFormat> for diag::Format {
    fn from(format: MessageFormat) -> Self {
        match format {
            MessageFormat::Human => Self::Human,
            MessageFormat::Short => Self::Short,
            MessageFormat::Json => Self::Json,
            MessageFormat::Sarif => Self::Sarif,
            MessageFormat::Github => Self::Github,
        }
    }
}

/// The axis that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum UpAxisArg {
    /// As in glTF
    Y,
    /// As in most CAD programs
    Z,
}

impl From<UpAxisArg> for UpAxis {
    fn from(axis: UpAxisArg) -> Self {
        match axis {
            UpAxisArg::Y => Self::Y,
            UpAxisArg::Z => Self::Z,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorArg {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    Always,
    Never,
}

/// A parameter and its value.
fn definition(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("`NAME=VALUE` is needed")?;
    Ok((name.to_owned(), value.to_owned()))
}
