//! The arguments of `rtc merge`.

use super::ReporterArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The parts that `rtc render --part` wrote
    ///
    /// In any order; a part may be given twice.
    #[arg(required = true, value_name = "PART", value_hint = ValueHint::FilePath)]
    pub(crate) parts: Vec<PathBuf>,
    /// Write the picture, or a larger part (.rtp), to this file
    #[arg(short, long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Accept pictures of any size
    #[arg(long)]
    pub(crate) allow_huge: bool,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
