//! What `rtc render` is told.

use super::super::parse::{frames, interval, levels, radiance, rule, seconds, share};
use super::{OutputTransformArgs, Reading, ReporterArgs, StageArgs, WantedArgs};
use clap::{Args, ValueEnum, ValueHint};
use rtc_pipeline::ShardBy;
use rtc_plan::Rule;
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug, Args)]
pub(crate) struct Render {
    /// Scenes, as YAML, glTF, a mesh or IR; folders, all scenes below them; or patterns, as
    /// 'a/*.glb'. `-` is standard input
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Where to write: .png, .jpg, .webp (lossless) or .exr; `-` is PNG to standard output. Of many scenes a folder, as
    /// `out/`, or a name in which `{stem}` is that of the scene, as `out/{stem}.png` [default: the
    /// scene's name with .png, here]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Also write one PNG that shows the pictures of all scenes, small, with their names
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "turntable")]
    pub(crate) contact_sheet: Option<PathBuf>,
    /// Also print the picture in a terminal of 24-bit colours, as wide as `COLUMNS` says
    #[arg(long, conflicts_with_all = ["turntable", "part"])]
    pub(crate) show: bool,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    /// Sample until the picture is this close, in grey levels of 8 bits (RMSE, kept by 90 of 100
    /// pictures), to what ever more samples at this depth would show
    #[arg(long, value_name = "LEVELS", value_parser = levels, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(crate) target_error: Option<f64>,
    /// Have the picture ready in this time, in seconds of the clock from the start of the program:
    /// crude first, then samples where they help most; it depends on the machine
    #[arg(long, value_name = "SECONDS", value_parser = seconds, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(crate) time_budget: Option<Duration>,
    /// Denoise traced paths, guided by albedo, normal and distance of first hits, of four times as many
    /// camera rays; some pixels are sampled anew, which tells the error
    #[arg(long, conflicts_with_all = ["target_error", "time_budget", "part", "checkpoint", "strips", "verify_effects"])]
    pub(crate) denoise: bool,
    /// Let a traced path bring no more radiance than this after its first bounce, in any channel: fewer
    /// bright dots, but less light; the end of the run tells how much less
    #[arg(long, value_name = "LIMIT", value_parser = radiance, conflicts_with_all = ["target_error", "time_budget", "denoise", "part", "checkpoint", "strips", "verify_effects"])]
    pub(crate) clamp: Option<f64>,
    /// Render so many views, all around the scene: the output's name holds `%04d`, or ends with
    /// `-%04d`; or is .apng or .gif, one file that shows them all
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999), conflicts_with = "verify_effects")]
    pub(crate) turntable: Option<u32>,
    /// Only these views of the turntable, from 1 on, the first and the last of them
    #[arg(long, value_name = "A..B", value_parser = frames, requires = "turntable")]
    pub(crate) frames: Option<[u32; 2]>,
    /// Pictures a second of a turntable in one file, .apng or .gif [default: 12]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000), requires = "turntable")]
    pub(crate) fps: Option<u16>,
    /// Render one of N shares of the picture into a part, .rtp; `rtc merge` makes the picture of all
    #[arg(long, value_name = "I/N", value_parser = share, conflicts_with = "verify_effects")]
    pub(crate) part: Option<[u32; 2]>,
    /// What is shared out: tiles, or the samples of traced paths
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        requires = "part"
    )]
    pub(crate) parts_by: SharedByArg,
    /// The picture that the part is of, .png, .jpg, .webp or .exr [default: the scene's name with .png]
    #[arg(long, value_name = "FILE", requires = "part", value_hint = ValueHint::FilePath)]
    pub(crate) picture: Option<PathBuf>,
    /// Save what is done into this file, .rtp, now and then and when told to end; the same command goes
    /// on from there
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["part", "time_budget", "verify_effects"])]
    pub(crate) checkpoint: Option<PathBuf>,
    /// How often to save, in seconds
    #[arg(long, value_name = "SECONDS", default_value = "60s", value_parser = interval, requires = "checkpoint")]
    pub(crate) every: Duration,
    /// Begin anew, whatever was saved
    #[arg(long, requires = "checkpoint")]
    pub(crate) restart: bool,
    /// Render and write some rows at a time, so that a picture may be larger than memory; so many,
    /// in sixteens [default: about a million pixels]
    #[arg(long, value_name = "ROWS", num_args = 0..=1, require_equals = true, value_parser = clap::value_parser!(u32).range(1..), conflicts_with_all = ["part", "checkpoint"])]
    pub(crate) strips: Option<Option<u32>>,
    /// Threads to work on [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) look: OutputTransformArgs,
    #[command(flatten)]
    pub(crate) pruning: Pruning,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

impl Render {
    /// The scene of a command of one.
    pub(crate) fn file(&self) -> &Path {
        self.files.first().map_or(Path::new("-"), PathBuf::as_path)
    }
}

/// What is left out of the work for a picture.
#[derive(Debug, Args)]
pub(crate) struct Pruning {
    /// Simulate what a rule would leave out: all rules, or those named, as E-SPEC
    #[arg(long, value_name = "RULE", num_args = 0.., require_equals = true, value_delimiter = ',', value_parser = rule)]
    pub(crate) no_prune: Option<Vec<Rule>>,
    /// Leave out also what changes the picture by less than half a level of 8 bits
    #[arg(long)]
    pub(crate) approx: bool,
    /// Simulate also what is left out, and stop at a pixel where it would show
    #[arg(long, conflicts_with = "no_prune")]
    pub(crate) verify_effects: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SharedByArg {
    /// Each part has some tiles, with all their samples
    #[default]
    Tiles,
    /// Each part has some blocks of 16 samples of all pixels
    Samples,
}

impl From<SharedByArg> for ShardBy {
    fn from(by: SharedByArg) -> Self {
        match by {
            SharedByArg::Tiles => Self::Tiles,
            SharedByArg::Samples => Self::Samples,
        }
    }
}
