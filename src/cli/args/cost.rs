//! The arguments of `rtc cost`.

use super::super::gate::{MeasureLimits, scene_limits};
use super::super::parse::interval;
use super::{ReadArgs, ReporterArgs, StageArgs};
use clap::{Args, ValueEnum, ValueHint};
use rtc_study as study;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
#[command(after_help = "\
Errors are measured against a picture with the depth of the scene. The effect of more bounces is
reported separately. In a large picture random tiles are rendered: `tiles%` is the interval of the
error of the whole picture, and a row is on the front only if these tiles show that its error is
below that of cheaper rows. In a path-traced scene, if the whole picture is rendered, a quarter
and a sixteenth of its paths are also measured with denoising (`dn`).

A scene and its reference are compared with their own settings: the ratio of their costs, and
whether their pictures differ by more than noise. Pixels are averaged before they are encoded, so
noise makes pictures darker, and scenes with different numbers of paths differ by that, too.

Examples:
  rtc cost scene.yaml --html cost.html
  rtc cost scene.yaml --maps maps
  rtc cost model.glb --effort quick
  rtc cost new.yaml old.yaml --effort quick --gate 'error<=1.0,time<=1.2x'")]
pub(crate) struct CostArgs {
    /// The scene, and an optional reference scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, Mitsuba XML, pbrt, mesh files, and the IR. With a
    /// reference, the costs and pictures of the two are compared.
    #[arg(value_name = "FILE", required = true, num_args = 1..=2, value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Exit with 1 if a measure exceeds its limit, as `error<=1.0,time<=1.2x`
    ///
    /// It needs a reference. Measures: error (in grey levels, beyond noise), and the ratios time,
    /// rays and noise.
    #[arg(long, value_name = "GATES", value_parser = scene_limits, help_heading = "Study")]
    pub(crate) gate: Option<MeasureLimits>,
    /// Write the report to this file; `-` is standard output
    #[arg(
        short,
        long,
        value_name = "FILE",
        default_value = "-",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) output: PathBuf,
    /// Select the format of the report
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "FORMAT",
        help_heading = "Output"
    )]
    pub(crate) format: StudyFormat,
    /// Also write an HTML page with plots and pictures
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Output")]
    pub(crate) html: Option<PathBuf>,
    /// Also write maps of the rays and the error of each pixel into this folder
    ///
    /// The maps are PNGs, for the setting of the scene and for the recommended one; `maps.html`
    /// shows their scales. The folder is created if necessary.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath, help_heading = "Output")]
    pub(crate) maps: Option<PathBuf>,
    /// Select the ray budget of the study
    #[arg(long, value_enum, default_value_t, help_heading = "Study")]
    pub(crate) effort: EffortArg,
    /// Set the seed of the choice of tiles, the timing order and the comparison
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Study")]
    pub(crate) seed: u64,
    /// Save progress into this file; the same command resumes from it
    ///
    /// It is also saved when the program is interrupted. Times measured before count.
    #[arg(
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Checkpoints",
    )]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Set the time between checkpoints, in seconds
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "60s",
        value_parser = interval,
        requires = "checkpoint",
        help_heading = "Checkpoints",
    )]
    pub(crate) every: Duration,
    /// Ignore an existing checkpoint and start over
    #[arg(long, requires = "checkpoint", help_heading = "Checkpoints")]
    pub(crate) restart: bool,
    /// Use N threads for work that is not timed [default: one for each core]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024),
        help_heading = "Performance",
    )]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyFormat {
    /// A table of 80 columns, for people
    #[default]
    Table,
    /// The rows, as comma-separated values (not for two scenes)
    Csv,
    /// The whole report; `rtc schema cost` prints its JSON Schema
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum EffortArg {
    /// Seconds
    Quick,
    /// About a minute for a simple scene
    #[default]
    Default,
    /// Ten times that
    Thorough,
}

impl From<EffortArg> for study::Effort {
    fn from(effort: EffortArg) -> Self {
        match effort {
            EffortArg::Quick => Self::QUICK,
            EffortArg::Default => Self::DEFAULT,
            EffortArg::Thorough => Self::THOROUGH,
        }
    }
}
