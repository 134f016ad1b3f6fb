//! The arguments of `rtc merge`.

use super::{ReadArgs, ReporterArgs, StageArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// The parts that `rtc render --part` wrote
    ///
    /// In any order; a part may be given twice.
    #[arg(required = true, value_name = "PART", value_hint = ValueHint::FilePath)]
    pub(crate) parts: Vec<PathBuf>,
    /// Write the picture, or a larger part (.rtp), to this file
    #[arg(
        short,
        long,
        required = true,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) output: PathBuf,
    /// Render N tiles of each part again, and reject parts that differ; see `rtc audit`
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..),
        requires = "scene",
        help_heading = "Audit",
    )]
    pub(crate) audit: Option<u64>,
    /// Name the scene of the parts, for `--audit`
    #[arg(
        long,
        value_name = "FILE",
        requires = "audit",
        value_hint = ValueHint::FilePath,
        help_heading = "Audit",
    )]
    pub(crate) scene: Option<PathBuf>,
    /// Set the seed of the choice of tiles [default: random, printed]
    #[arg(long, value_name = "N", requires = "audit", help_heading = "Audit")]
    pub(crate) seed: Option<u64>,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
