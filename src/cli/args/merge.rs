//! What `rtc merge` is told.

use super::ReporterArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The parts, as `rtc render --part` writes them; in any order, some of them twice
    #[arg(required = true, value_name = "PART", value_hint = ValueHint::FilePath)]
    pub(crate) parts: Vec<PathBuf>,
    /// Where to write: the picture, of the kind that they are parts of; or a larger part, .rtp
    #[arg(short, long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,
    /// Take pictures of any size
    #[arg(long)]
    pub(crate) allow_huge: bool,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
