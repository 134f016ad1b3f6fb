//! The arguments of `rtc audit`.

use super::{Reading, ReportFormatArgs, ReporterArgs, StageArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
Everything that the metadata say is checked. Then tiles are drawn at random, made anew from the
scene, and compared bit by bit: the values of which they were made, and the pixels of the file. If
none differs, the report says how many may: with 98 % confidence fewer than the number given.

Size, samples, exposure and the other settings of the picture are those in its metadata; those that
the scene has otherwise are listed. Exit code 1: the picture is not what it says. Exit code 2: it
can't be audited, as a denoised one.

Examples:
  rtc audit glass.png scenes/glass.yaml
  rtc audit frame.exr scene.rtir --tiles 400
  rtc audit part-3.rtp scene.yaml --seed 7")]
pub(crate) struct Audit {
    /// The picture, as PNG, WebP or EXR, or a part that `rtc render --part` wrote
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    pub(crate) picture: PathBuf,
    /// Its scene, as YAML, glTF, a mesh or IR; `-` is standard input
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) draw: DrawArgs,
    #[command(flatten)]
    pub(crate) format: ReportFormatArgs,
    /// Use N threads [default: one for each core]
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
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

/// Which tiles are drawn.
#[derive(Debug, Args)]
pub(crate) struct DrawArgs {
    /// Make N tiles anew, or all if there are fewer
    #[arg(
        long,
        value_name = "N",
        default_value = "32",
        value_parser = clap::value_parser!(u64).range(1..),
        help_heading = "Audit",
    )]
    pub(crate) tiles: u64,
    /// Draw the tiles by this seed [default: a random one, which is printed]
    ///
    /// Whoever knows the seed before the picture is made knows which tiles will be looked at.
    #[arg(long, value_name = "N", help_heading = "Audit")]
    pub(crate) seed: Option<u64>,
}
