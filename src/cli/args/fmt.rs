//! What `rtc fmt` is told.

use super::ReporterArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Words, their order, comments and where lines end stay as they are; a text that \
    would say something else is left alone. \
JSON is laid out likewise; assets, meshes and IR are not.\n\n\
Examples:\n  rtc fmt scene.yaml\n  rtc fmt --check scenes\n  rtc fmt --diff 'scenes/*.yaml'"
)]
pub(crate) struct Fmt {
    /// Scene texts, as YAML or JSON; folders, all YAML below them; or patterns, as 'a/*.yaml'. `-`
    /// is
    /// standard input, laid out on standard output
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Write nothing; name the files that are not laid out, and end with 1 if there are any
    #[arg(long)]
    pub(crate) check: bool,
    /// Write nothing; show what would change
    #[arg(long)]
    pub(crate) diff: bool,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
