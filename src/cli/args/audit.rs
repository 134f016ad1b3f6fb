//! The arguments of `rtc audit`.

use super::{ReadArgs, ReportFormatArgs, ReporterArgs, StageArgs, ThreadArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
The metadata are checked first. Then random tiles are rendered again from the scene and compared bit
by bit: the film values, and the pixels of the file. If none differs, the report bounds the number
of wrong tiles at a confidence of 98 %.

Size, samples, exposure and other settings are taken from the metadata; differences from the scene
are listed. Exit code 1: the picture does not match its metadata. Exit code 2: the picture can't be
audited, for example because it was denoised.

Examples:
  rtc audit glass.png scenes/glass.yaml
  rtc audit frame.exr scene.rtir --tiles 400
  rtc audit part-3.rtp scene.yaml --seed 7")]
pub(crate) struct AuditArgs {
    /// The picture, as PNG, WebP or EXR, or a part that `rtc render --part` wrote
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    pub(crate) picture: PathBuf,
    /// Its scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) draw: TileDrawArgs,
    #[command(flatten)]
    pub(crate) format: ReportFormatArgs,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

/// The random choice of tiles.
#[derive(Debug, Args)]
pub(crate) struct TileDrawArgs {
    /// Render N tiles again, or all if there are fewer
    #[arg(
        long,
        value_name = "N",
        default_value = "32",
        value_parser = clap::value_parser!(u64).range(1..),
        help_heading = "Audit",
    )]
    pub(crate) tiles: u64,
    /// Set the seed of the choice of tiles [default: random, printed]
    ///
    /// A seed that is known before the render reveals which tiles will be checked.
    #[arg(long, value_name = "N", help_heading = "Audit")]
    pub(crate) seed: Option<u64>,
}
