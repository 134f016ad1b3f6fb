//! What every command with a scene is told: how to read it, and how to tell findings.

use super::super::parse::{folder, limit, moment};
use clap::{ArgAction, Args, ValueEnum, ValueHint};
use rtc_diag::{self as diag, FindingLevel, FindingLevels, LevelSubject};
use rtc_source::{Limits, Resource};
use std::path::PathBuf;

/// How the input is read.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = None::<&str>)]
pub(crate) struct Reading {
    /// What to call standard input in messages
    #[arg(long, value_name = "NAME")]
    pub(crate) stdin_name: Option<String>,
    /// Refuse unknown keys
    #[arg(long)]
    pub(crate) strict: bool,
    /// Repair mistakes that have one sensible repair, with a warning
    #[arg(long)]
    pub(crate) lenient: bool,
    /// A folder, beside that of the scene, whose files the scene may name: textures and meshes
    #[arg(long, value_name = "FOLDER", value_parser = folder, value_hint = ValueHint::DirPath)]
    pub(crate) asset_root: Option<PathBuf>,
    /// Show a glTF asset at this moment of its animation [default: at rest]
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub(crate) time: Option<f64>,
    /// The animation of a glTF asset, by its name [default: the first, if there is a `--time`]
    #[arg(long, value_name = "NAME")]
    pub(crate) animation: Option<String>,
    /// The variant of the materials of a glTF asset, by its name
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
    /// The camera of a glTF asset: its name, that of its node, or its index [default: the first
    /// that shows anything]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) camera: Option<String>,
    /// Do not tell findings of this code, as VA004, or no `warnings`; errors are always told
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = LevelSubject::parse)]
    pub(crate) allow: Vec<LevelSubject>,
    /// Make findings of this code warnings; what has a code of its own here is no matter of `warnings`
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = LevelSubject::parse)]
    pub(crate) warn: Vec<LevelSubject>,
    /// Make findings of this code, or all `warnings`, errors
    #[arg(long, value_name = "CODE", value_delimiter = ',', value_parser = LevelSubject::parse)]
    pub(crate) deny: Vec<LevelSubject>,
    /// Set a limit on what the run may take, as memory=2GiB; `rtc schema limits` lists them
    #[arg(long, value_name = "NAME=NUMBER", value_parser = limit)]
    pub(crate) limit: Vec<(Resource, u64)>,
    /// Lift all limits on what the run may take
    #[arg(long)]
    pub(crate) allow_huge: bool,
    /// Let the `rtc.toml` of the scene raise limits and lend files outside of its folder, whoever
    /// wrote it
    #[arg(long)]
    pub(crate) trust_project: bool,
}

impl Reading {
    /// What is made of findings.
    pub(crate) fn levels(&self) -> Result<FindingLevels, String> {
        let mut levels = FindingLevels::default();
        for level in FindingLevel::ALL {
            let subjects = match level {
                FindingLevel::Allow => &self.allow,
                FindingLevel::Warn => &self.warn,
                FindingLevel::Deny => &self.deny,
            };
            for subject in subjects {
                let set = levels.set(*subject, level);
                set.map_err(|words| format!("`--{}`: {words}", level.name()))?;
            }
        }
        Ok(levels)
    }

    /// What the run may take, where by default it is what `settle` makes of the limits of the house.
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

/// How findings are told.
#[derive(Debug, Args)]
#[command(next_help_heading = None::<&str>)]
pub(crate) struct ReporterArgs {
    /// The form of diagnostics
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub(crate) message_format: MessageFormat,
    /// Colours in diagnostics
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub(crate) color: Color,
    /// Show at most this many diagnostics of a file
    #[arg(long, value_name = "N", default_value = "100", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) max_errors: u32,
    /// Only errors: no warnings, no progress, no summary
    #[arg(short, long, action = ArgAction::SetTrue, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Notes too, and of a render how often each effect was simulated
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub(crate) verbose: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum MessageFormat {
    /// For people, with the source
    #[default]
    Human,
    /// One line each, for editors
    Short,
    /// One JSON object a line; the last of a picture is `{"rendered": …}`
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    Always,
    Never,
}
