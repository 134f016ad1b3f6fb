//! What `rtc render` is told.

use super::super::parse::{frames, interval, levels, radiance, rule, seconds, share};
use super::{LookArgs, Reading, StageArgs, TalkArgs, WantedArgs};
use crate::pipeline::SharedBy;
use crate::plan::Rule;
use clap::{Args, ValueEnum, ValueHint};
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Debug, Args)]
pub(in crate::cli) struct Render {
    /// Scenes, as YAML, glTF, a mesh or IR; folders, all scenes below them; or patterns, as
    /// 'a/*.glb'. `-` is standard input
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) files: Vec<PathBuf>,
    /// Where to write: .png, .jpg, .webp (lossless) or .exr; `-` is PNG to standard output. Of many scenes a folder, as
    /// `out/`, or a name in which `{stem}` is that of the scene, as `out/{stem}.png` [default: the
    /// scene's name with .png, here]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Also write one PNG that shows the pictures of all scenes, small, with their names
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "turntable")]
    pub(in crate::cli) contact_sheet: Option<PathBuf>,
    /// Also print the picture in a terminal of 24-bit colours, as wide as `COLUMNS` says
    #[arg(long, conflicts_with_all = ["turntable", "part"])]
    pub(in crate::cli) show: bool,
    #[command(flatten)]
    pub(in crate::cli) wanted: WantedArgs,
    /// Sample until the picture is this close, in grey levels of 8 bits (RMSE, kept by 90 of 100
    /// pictures), to what ever more samples at this depth would show
    #[arg(long, value_name = "LEVELS", value_parser = levels, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(in crate::cli) target_error: Option<f64>,
    /// Have the picture ready in this time, in seconds of the clock from the start of the program:
    /// crude first, then samples where they help most; it depends on the machine
    #[arg(long, value_name = "SECONDS", value_parser = seconds, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(in crate::cli) time_budget: Option<Duration>,
    /// Denoise traced paths, guided by albedo, normal and distance of first hits, of four times as many
    /// camera rays; some pixels are sampled anew, which tells the error
    #[arg(long, conflicts_with_all = ["target_error", "time_budget", "part", "checkpoint", "strips", "verify_effects"])]
    pub(in crate::cli) denoise: bool,
    /// Let a traced path bring no more radiance than this after its first bounce, in any channel: fewer
    /// bright dots, but less light; the end of the run tells how much less
    #[arg(long, value_name = "LIMIT", value_parser = radiance, conflicts_with_all = ["target_error", "time_budget", "denoise", "part", "checkpoint", "strips", "verify_effects"])]
    pub(in crate::cli) clamp: Option<f64>,
    /// Render so many views, all around the scene: the output's name holds `%04d`, or ends with
    /// `-%04d`; or is .apng or .gif, one file that shows them all
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999), conflicts_with = "verify_effects")]
    pub(in crate::cli) turntable: Option<u32>,
    /// Only these views of the turntable, from 1 on, the first and the last of them
    #[arg(long, value_name = "A..B", value_parser = frames, requires = "turntable")]
    pub(in crate::cli) frames: Option<[u32; 2]>,
    /// Pictures a second of a turntable in one file, .apng or .gif [default: 12]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000), requires = "turntable")]
    pub(in crate::cli) fps: Option<u16>,
    /// Render one of N shares of the picture into a part, .rtp; `rtc merge` makes the picture of all
    #[arg(long, value_name = "I/N", value_parser = share, conflicts_with = "verify_effects")]
    pub(in crate::cli) part: Option<[u32; 2]>,
    /// What is shared out: tiles, or the samples of traced paths
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        requires = "part"
    )]
    pub(in crate::cli) parts_by: SharedByArg,
    /// The picture that the part is of, .png, .jpg, .webp or .exr [default: the scene's name with .png]
    #[arg(long, value_name = "FILE", requires = "part", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) picture: Option<PathBuf>,
    /// Save what is done into this file, .rtp, now and then and when told to end; the same command goes
    /// on from there
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["part", "time_budget", "verify_effects"])]
    pub(in crate::cli) checkpoint: Option<PathBuf>,
    /// How often to save, in seconds
    #[arg(long, value_name = "SECONDS", default_value = "60s", value_parser = interval, requires = "checkpoint")]
    pub(in crate::cli) every: Duration,
    /// Begin anew, whatever was saved
    #[arg(long, requires = "checkpoint")]
    pub(in crate::cli) restart: bool,
    /// Render and write some rows at a time, so that a picture may be larger than memory; so many,
    /// in sixteens [default: about a million pixels]
    #[arg(long, value_name = "ROWS", num_args = 0..=1, require_equals = true, value_parser = clap::value_parser!(u32).range(1..), conflicts_with_all = ["part", "checkpoint"])]
    pub(in crate::cli) strips: Option<Option<u32>>,
    /// Threads to work on [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(in crate::cli) threads: Option<u16>,
    #[command(flatten)]
    pub(in crate::cli) look: LookArgs,
    #[command(flatten)]
    pub(in crate::cli) pruning: Pruning,
    #[command(flatten)]
    pub(in crate::cli) stage: StageArgs,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
    #[command(flatten)]
    pub(in crate::cli) talk: TalkArgs,
}

impl Render {
    /// The scene of a command of one.
    pub(in crate::cli) fn file(&self) -> &Path {
        self.files.first().map_or(Path::new("-"), PathBuf::as_path)
    }
}

/// What is left out of the work for a picture.
#[derive(Debug, Args)]
pub(in crate::cli) struct Pruning {
    /// Simulate what a rule would leave out: all rules, or those named, as E-SPEC
    #[arg(long, value_name = "RULE", num_args = 0.., require_equals = true, value_delimiter = ',', value_parser = rule)]
    pub(in crate::cli) no_prune: Option<Vec<Rule>>,
    /// Leave out also what changes the picture by less than half a level of 8 bits
    #[arg(long)]
    pub(in crate::cli) approx: bool,
    /// Simulate also what is left out, and stop at a pixel where it would show
    #[arg(long, conflicts_with = "no_prune")]
    pub(in crate::cli) verify_effects: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum SharedByArg {
    /// Each part has some tiles, with all their samples
    #[default]
    Tiles,
    /// Each part has some blocks of 16 samples of all pixels
    Samples,
}

impl From<SharedByArg> for SharedBy {
    fn from(by: SharedByArg) -> Self {
        match by {
            SharedByArg::Tiles => Self::Tiles,
            SharedByArg::Samples => Self::Samples,
        }
    }
}
