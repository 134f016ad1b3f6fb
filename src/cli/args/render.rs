//! The arguments of `rtc render`.

use super::super::parse::{bytes, frames, interval, levels, radiance, rule, seconds, share};
use super::{OutputTransformArgs, ReadArgs, ReporterArgs, StageArgs, ThreadArgs, WantedArgs};
use clap::{Args, ValueEnum, ValueHint};
use rtc_pipeline::ShardDivision;
use rtc_plan::Rule;
use rtc_study::RenderGoal;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The settings that fix the number of samples.
const SAMPLE_COUNTS: [&str; 3] = ["supersampling", "aperture-samples", "spp"];

/// The settings that do not go with work on the whole picture.
const WHOLE_PICTURE: [&str; 5] = [
    "time_budget",
    "part",
    "checkpoint",
    "strips",
    "verify_effects",
];

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// Scenes, folders of scenes, or patterns such as 'a/*.glb'; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Write the picture to this file [default: the scene's name with .png, here]
    ///
    /// The extension selects the format: .png, .jpg, .webp (lossless), .exr or .hdr; `-` is
    /// PNG on standard output. For many scenes: a folder, as `out/`, where pictures of one name
    /// lie in folders as their scenes do; or a name with `{stem}` for the name of the scene and
    /// `{dir}` for its folder, as `out/{dir}/{stem}.png`.
    #[arg(
        short,
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) output: Option<PathBuf>,
    /// Also write one PNG with small pictures of all scenes and their names
    #[arg(
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        conflicts_with = "turntable",
        help_heading = "Output",
    )]
    pub(crate) contact_sheet: Option<PathBuf>,
    /// Also print the picture in the terminal, in 24-bit colours
    ///
    /// The width is that of the environment variable `COLUMNS`.
    #[arg(long, conflicts_with_all = ["turntable", "part"], help_heading = "Output")]
    pub(crate) show: bool,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    /// Sample until the error is at most this many grey levels
    ///
    /// The error is the RMSE in 8-bit grey levels against the picture of infinitely many samples
    /// at this depth; it is kept in 90 of 100 pictures.
    #[arg(
        long,
        value_name = "LEVELS",
        value_parser = levels,
        conflicts_with_all = SAMPLE_COUNTS,
        help_heading = "Sampling",
    )]
    pub(crate) target_error: Option<f64>,
    /// Choose the target error by a word: `--target-error` of 5, 1.5 or 0.5 grey levels
    #[arg(
        long,
        value_enum,
        value_name = "QUALITY",
        conflicts_with_all = SAMPLE_COUNTS,
        conflicts_with = "target_error",
        help_heading = "Sampling",
    )]
    pub(crate) quality: Option<QualityArg>,
    /// Finish within this time, counted from the start of the program
    ///
    /// A coarse picture comes first, then samples where they reduce the error most. The result
    /// depends on the machine.
    #[arg(
        long,
        value_name = "SECONDS",
        value_parser = seconds,
        conflicts_with_all = SAMPLE_COUNTS,
        help_heading = "Sampling",
    )]
    pub(crate) time_budget: Option<Duration>,
    /// Denoise path-traced pictures
    ///
    /// The denoiser uses albedo, normal and depth of the first hits, from more camera rays where
    /// these differ. Some pixels are sampled again: they tell the error, and how much of the plain
    /// picture to keep; those in most doubt become better by these samples. With a target error the
    /// picture is rendered with more paths until that is met.
    #[arg(
        long,
        conflicts_with_all = WHOLE_PICTURE,
        help_heading = "Sampling",
    )]
    pub(crate) denoise: bool,
    /// Clamp indirect radiance per channel, to reduce fireflies
    ///
    /// The picture loses energy; the fraction is printed at the end.
    #[arg(
        long,
        value_name = "LIMIT",
        value_parser = radiance,
        conflicts_with_all = WHOLE_PICTURE,
        conflicts_with_all = ["target_error", "quality", "denoise"],
        help_heading = "Sampling",
    )]
    pub(crate) clamp: Option<f64>,
    /// Render N views around the scene
    ///
    /// The name of the output holds `%04d`, or ends with `-%04d`; a .apng or .gif holds all views
    /// in one file.
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=9999),
        conflicts_with = "verify_effects",
        help_heading = "View",
    )]
    pub(crate) turntable: Option<u32>,
    /// Render only this range of turntable frames, 1-based and inclusive
    #[arg(
        long,
        value_name = "A..B",
        value_parser = frames,
        requires = "turntable",
        help_heading = "View",
    )]
    pub(crate) frames: Option<[u32; 2]>,
    /// Set the frames per second of a .apng or .gif turntable [default: 12]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1000),
        requires = "turntable",
        help_heading = "View",
    )]
    pub(crate) fps: Option<u16>,
    /// Render part I of N into a .rtp file; `rtc merge` joins all parts
    #[arg(
        long,
        value_name = "I/N",
        value_parser = share,
        conflicts_with = "verify_effects",
        help_heading = "Checkpoints and parts",
    )]
    pub(crate) part: Option<[u32; 2]>,
    /// Divide the work by tiles or by samples of path tracing
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        requires = "part",
        help_heading = "Checkpoints and parts"
    )]
    pub(crate) parts_by: ShardByArg,
    /// Name the picture that `rtc merge` makes [default: the scene's name with .png]
    #[arg(
        long,
        value_name = "FILE",
        requires = "part",
        value_hint = ValueHint::FilePath,
        help_heading = "Checkpoints and parts",
    )]
    pub(crate) picture: Option<PathBuf>,
    /// Save progress into this .rtp file; the same command resumes from it
    #[arg(
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        conflicts_with_all = ["part", "time_budget", "verify_effects"],
        help_heading = "Checkpoints and parts",
    )]
    pub(crate) checkpoint: Option<PathBuf>,
    /// Set the time between checkpoints, in seconds
    #[arg(
        long,
        value_name = "SECONDS",
        default_value = "60s",
        value_parser = interval,
        requires = "checkpoint",
        help_heading = "Checkpoints and parts",
    )]
    pub(crate) every: Duration,
    /// Ignore an existing checkpoint and start over
    #[arg(long, requires = "checkpoint", help_heading = "Checkpoints and parts")]
    pub(crate) restart: bool,
    /// Render and write strips of rows, for pictures larger than memory
    ///
    /// The number of rows is a multiple of 16 [default: about a million pixels].
    #[arg(
        long,
        value_name = "ROWS",
        num_args = 0..=1,
        require_equals = true,
        value_parser = clap::value_parser!(u32).range(1..),
        conflicts_with_all = ["part", "checkpoint"],
        help_heading = "Checkpoints and parts",
    )]
    pub(crate) strips: Option<Option<u32>>,
    /// Keep finished pictures in this folder, and take those that would be the same from it
    ///
    /// `-v` says what was taken, or why not. Whoever may write the folder is trusted.
    #[arg(
        long,
        value_name = "DIR",
        value_hint = ValueHint::DirPath,
        help_heading = "Performance",
    )]
    pub(crate) cache: Option<PathBuf>,
    /// Remove what was not used for longest when the folder holds more bytes [default: 1GiB]
    #[arg(long, value_name = "SIZE", value_parser = bytes, help_heading = "Performance")]
    pub(crate) cache_limit: Option<u64>,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) look: OutputTransformArgs,
    #[command(flatten)]
    pub(crate) pruning: PruningArgs,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

impl RenderArgs {
    /// The scene of a command of one.
    pub(crate) fn file(&self) -> &Path {
        self.files.first().map_or(Path::new("-"), PathBuf::as_path)
    }
}

/// The plan rules that are applied.
#[derive(Debug, Args)]
pub(crate) struct PruningArgs {
    /// Simulate effects that plan rules remove: all, or those of the named rules
    ///
    /// For example `--no-prune=E-SPEC`.
    #[arg(
        long,
        value_name = "RULE",
        num_args = 0..,
        require_equals = true,
        value_delimiter = ',',
        value_parser = rule,
        help_heading = "Debugging",
    )]
    pub(crate) no_prune: Option<Vec<Rule>>,
    /// Also remove effects that change the picture by less than half a grey level
    #[arg(long, help_heading = "Performance")]
    pub(crate) approx: bool,
    /// Also render without the plan's rules, and fail at the first pixel that differs
    #[arg(long, conflicts_with = "no_prune", help_heading = "Debugging")]
    pub(crate) verify_effects: bool,
}

/// A target error as a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QualityArg {
    /// For a first look: at most 5 grey levels
    Draft,
    /// For a page: at most 1.5 grey levels
    Good,
    /// To compare with: at most 0.5 grey levels
    Reference,
}

impl QualityArg {
    /// The target error in 8-bit grey levels.
    fn levels(self) -> f64 {
        match self {
            Self::Draft => 5.0,
            Self::Good => 1.5,
            Self::Reference => 0.5,
        }
    }
}

impl RenderArgs {
    /// The target of the render.
    pub(crate) fn goal(&self) -> RenderGoal {
        RenderGoal {
            error: self.target_error.or(self.quality.map(QualityArg::levels)),
            time: self.time_budget,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShardByArg {
    /// Each part has some tiles, with all their samples
    #[default]
    Tiles,
    /// Each part has some blocks of 16 samples of all pixels
    Samples,
}

impl From<ShardByArg> for ShardDivision {
    fn from(by: ShardByArg) -> Self {
        match by {
            ShardByArg::Tiles => Self::Tiles,
            ShardByArg::Samples => Self::Samples,
        }
    }
}
