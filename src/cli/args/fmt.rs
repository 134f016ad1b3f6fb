//! The arguments of `rtc fmt`.

use super::ReporterArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
Only whitespace changes: keys, values, their order, comments and line endings stay. A file whose
meaning would change is not written. Assets, meshes and IR files are not formatted.

Examples:
  rtc fmt scene.yaml
  rtc fmt --check scenes
  rtc fmt --diff 'scenes/*.yaml'")]
pub(crate) struct FmtArgs {
    /// Scene files, folders, or patterns such as 'a/*.yaml'; `-` is standard input
    ///
    /// Files are YAML or JSON; in folders, all YAML files are formatted. Standard input is
    /// formatted to standard output.
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Write nothing; list unformatted files, and exit with 1 if there are any
    #[arg(long, help_heading = "Output")]
    pub(crate) check: bool,
    /// Write nothing; print the changes
    #[arg(long, help_heading = "Output")]
    pub(crate) diff: bool,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
