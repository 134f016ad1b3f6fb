//! What `rtc cost` is told.

use super::super::gate::{Gates, of_scenes};
use super::super::parse::interval;
use super::{Reading, ReporterArgs, StageArgs};
use clap::{Args, ValueEnum, ValueHint};
use rtc_study as study;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
#[command(
    after_help = "Errors are against the picture of the scene's own depth; what more bounces \
    would add is told apart. Of a large \
picture some random tiles are looked at: `tiles%` is how much less or more the error of the whole \
may be, and a row is on the \
front only if these tiles show that it has less error than cheaper ones. Where paths are traced \
and the whole picture is looked \
at, a quarter and a sixteenth of the scene's paths are tried denoised, too (`dn`), with the time \
that telling their errors takes.\n\n \
A scene and its reference are looked at in their own settings: what one takes against the other, \
and whether their pictures \
differ by more than noise. Traced paths are coded after they are averaged, which darkens what is \
noisy: scenes with other numbers of paths \
differ by that, too.\n\n\
Examples:\n  rtc cost scene.yaml --html cost.html\n  rtc cost scene.yaml --maps maps\n  rtc cost \
model.glb --effort quick\n \
rtc cost new.yaml old.yaml --effort quick --gate 'error<=1.0,time<=1.2x'"
)]
pub(crate) struct Cost {
    /// The scene, as YAML, glTF, a mesh or IR; `-` is standard input. With a second one as
    /// reference: what
    /// the scene costs and shows against that
    #[arg(value_name = "FILE", required = true, num_args = 1..=2, value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// With a reference: what must hold, or the exit code is 1: `MEASURE<=VALUE`, several with
    /// commas between;
    /// measures are error (in grey levels, beyond noise), and as ratios time, rays and noise
    #[arg(long, value_name = "GATES", value_parser = of_scenes)]
    pub(crate) gate: Option<Gates>,
    /// Where to write; `-` is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// The form of the report
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub(crate) format: StudyFormat,
    /// Also write a page for a browser, with plots and pictures
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    /// Also write maps into this folder, which is made if there is none: PNGs of the size of the
    /// picture with the rays
    /// and the error of each pixel, in the scene's own setting and in the recommended one, and
    /// `maps.html` with their scales
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) maps: Option<PathBuf>,
    /// How much work the study may be
    #[arg(long, value_enum, default_value_t)]
    pub(crate) effort: EffortArg,
    /// Which tiles of the picture are looked at, in which order settings are timed, and with which
    /// random
    /// numbers two scenes are compared
    #[arg(long, value_name = "N", default_value = "1")]
    pub(crate) seed: u64,
    /// Keep what is rendered in this file, now and then and when told to end; the same command goes
    /// on from
    /// there, with the seconds measured before
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) checkpoint: Option<PathBuf>,
    /// How often to save, in seconds
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "60s",
        value_parser = interval,
        requires = "checkpoint",
    )]
    pub(crate) every: Duration,
    /// Begin anew, whatever was saved
    #[arg(long, requires = "checkpoint")]
    pub(crate) restart: bool,
    /// Threads for what is not timed [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyFormat {
    /// A table of 80 columns
    #[default]
    Table,
    /// The rows, as comma-separated values
    Csv,
    /// All there is, as JSON
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
