//! The arguments of `rtc fmt`.

use super::ReporterArgs;
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
Keys, values, their order, comments and line ends stay as they are. A text that would change its
meaning is left as it is. YAML and JSON are formatted; assets, meshes and IR are not.

Examples:
  rtc fmt scene.yaml
  rtc fmt --check scenes
  rtc fmt --diff 'scenes/*.yaml'")]
pub(crate) struct Fmt {
    /// Scene files, folders, or patterns such as 'a/*.yaml'; `-` is standard input
    ///
    /// Files are YAML or JSON; in folders, all YAML files are formatted. Standard input is
    /// formatted to standard output.
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) files: Vec<PathBuf>,
    /// Write nothing; list unformatted files, and exit with 1 if there are any
    #[arg(long)]
    pub(crate) check: bool,
    /// Write nothing; print the changes
    #[arg(long)]
    pub(crate) diff: bool,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
