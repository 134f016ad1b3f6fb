//! What `rtc render` is told.

use super::super::parse::{crop, interval, levels, rule, seconds, setting, share, size};
use super::{LookArgs, Reading, StageArgs, TalkArgs};
use crate::pipeline::SharedBy;
use crate::plan::{self, Rule};
use crate::render::Crop;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, Args)]
pub(in crate::cli) struct Render {
    /// The scene, as YAML, glTF, a mesh or IR; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) file: PathBuf,
    /// Where to write, .png or .exr; `-` is PNG to standard output [default: the scene's name with
    /// .png, here]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Width and height in pixels; the picture keeps its height in the scene
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(in crate::cli) size: Option<[u32; 2]>,
    /// Sub-samples along each side of a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) supersampling: Option<u32>,
    /// Points of the lens each sub-sample takes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) aperture_samples: Option<u32>,
    /// Points of each soft light
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) light_samples: Option<u32>,
    /// Rays of each glossy lobe; what is a mirror stays one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) glossy_samples: Option<u32>,
    /// Paths a pixel, of scenes whose paths are traced
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) spp: Option<u32>,
    /// Bounces after the first hit
    #[arg(long, value_name = "N")]
    pub(in crate::cli) depth: Option<u32>,
    /// Sample until the picture is this close, in grey levels of 8 bits (RMSE, kept by 90 of 100
    /// pictures), to what ever more samples at this depth would show
    #[arg(long, value_name = "LEVELS", value_parser = levels, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(in crate::cli) target_error: Option<f64>,
    /// Sample for this long, in seconds of the clock, where it helps most; the picture then
    /// depends on the machine
    #[arg(long, value_name = "SECONDS", value_parser = seconds, conflicts_with_all = ["supersampling", "aperture_samples", "spp"])]
    pub(in crate::cli) time_budget: Option<Duration>,
    /// Render so many views, all around the scene: the output's name holds `%04d`, or ends with
    /// `-%04d`
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999), conflicts_with = "verify_effects")]
    pub(in crate::cli) turntable: Option<u32>,
    /// Render one of N shares of the picture into a part, .rtp; `rtc merge` makes the picture of all
    #[arg(long, value_name = "I/N", value_parser = share, conflicts_with_all = ["turntable", "verify_effects"])]
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
    /// The picture that the part is of, .png or .exr [default: the scene's name with .png]
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
    /// Threads to work on [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(in crate::cli) threads: Option<u16>,
    /// Render only this part of the picture, in pixels from the upper left
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(in crate::cli) crop: Option<Crop>,
    /// How rays meet shapes
    #[arg(long, value_enum, default_value_t, value_name = "ARITHMETIC")]
    pub(in crate::cli) arithmetic: ArithmeticArg,
    /// Replace a setting of the IR by its name there, last of all, as multipleScattering=false;
    /// `rtc schema ir` lists them
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(in crate::cli) set: Vec<(String, String)>,
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum ArithmeticArg {
    /// With bounds on all errors, in f64
    #[default]
    Robust,
    /// By the formulas of textbooks, in f64
    Plain,
    /// By the formulas of textbooks, in f32
    F32,
}

impl From<ArithmeticArg> for plan::Arithmetic {
    fn from(arithmetic: ArithmeticArg) -> Self {
        match arithmetic {
            ArithmeticArg::Robust => Self::Robust,
            ArithmeticArg::Plain => Self::Plain,
            ArithmeticArg::F32 => Self::F32,
        }
    }
}
