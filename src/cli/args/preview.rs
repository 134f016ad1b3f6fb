//! What `rtc preview` is told.

use super::{OutputTransformArgs, Reading, ReporterArgs, StageArgs, WantedArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "The page is for this machine alone, and for who has its address. The finished \
    picture has the bytes of `rtc render` with the \
same options. Ctrl-C ends it.\n\n\
Examples:\n  rtc preview scene.yaml --open\n  rtc preview scene.yaml --size 320x240 --port 8080\n  rtc preview scene.yaml --against golden.png\n  rtc preview scene.yaml --against HEAD~1"
)]
pub(crate) struct Preview {
    /// The scene, as YAML, glTF, a mesh or IR
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// The port to listen on; 0 is any that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// What the page lays over the picture of the scene, behind a slider: a picture file (PNG,
    /// JPEG, WebP, EXR, HDR), another
    /// scene, or a commit of git, whose text of the scene is taken; scenes are looked at as the
    /// first one
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) against: Option<PathBuf>,
    /// Threads to work on [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    #[command(flatten)]
    pub(crate) look: OutputTransformArgs,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
