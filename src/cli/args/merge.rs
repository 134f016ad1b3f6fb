//! What `rtc merge` is told.

use super::TalkArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct Merge {
    /// The parts, as `rtc render --part` writes them; in any order, some of them twice
    #[arg(required = true, value_name = "PART", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) parts: Vec<PathBuf>,
    /// Where to write: the picture, of the kind that they are parts of; or a larger part, .rtp
    #[arg(short, long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) output: PathBuf,
    /// Take pictures of any size
    #[arg(long)]
    pub(in crate::cli) allow_huge: bool,
    #[command(flatten)]
    pub(in crate::cli) talk: TalkArgs,
}
