//! The arguments of `rtc preview`.

use super::{OutputTransformArgs, ReadArgs, ReporterArgs, StageArgs, ThreadArgs, WantedArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
Only this machine can open the page, and only with the address that is printed. The finished
picture has the same bytes as that of `rtc render` with the same options. Ctrl-C ends the server.

Examples:
  rtc preview scene.yaml --open
  rtc preview scene.yaml --size 320x240 --port 8080
  rtc preview scene.yaml --against golden.png
  rtc preview scene.yaml --against HEAD~1")]
pub(crate) struct PreviewArgs {
    /// The scene
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// Listen on this port; 0 selects a free one
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = "Server")]
    pub(crate) port: u16,
    /// Open the page in the browser
    #[arg(long, help_heading = "Server")]
    pub(crate) open: bool,
    /// Compare with a picture, another scene, or a git commit of the scene
    ///
    /// The page shows both behind a slider. Pictures: PNG, JPEG, WebP, EXR or HDR. Scenes are
    /// rendered with the view of the first one.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Comparison")]
    pub(crate) against: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    #[command(flatten)]
    pub(crate) look: OutputTransformArgs,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
