//! The arguments of `rtc certify`.

use super::super::parse::size;
use super::{ReadArgs, ReportFormatArgs, ReporterArgs, StageArgs, ThreadArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
The picture is rendered, and each pixel is evaluated again by interval arithmetic, where 53 bits do
not decide with 106. A pixel is proven if the formulas, in real numbers, certainly give its 8-bit
values; others are flagged with the reason: a border within rounding, or a feature that is not
evaluated.

Exit code 1: a rendered value differs from one that 53 bits prove, which is an error of the
renderer. Exit code 2: the picture can't be certified, for example because it is path-traced.

Examples:
  rtc certify scenes/mirrors.yaml -o mirrors.png
  rtc certify scene.yaml -o scene.png --flags flags.png --format json")]
pub(crate) struct CertifyArgs {
    /// The scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, and the IR.
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub(crate) scene: PathBuf,
    /// Write the picture to this file: .png or .webp
    #[arg(
        short,
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) output: PathBuf,
    /// Write a map of the flagged pixels to this file
    ///
    /// Proven pixels are dark, and blue where that took 106 bits; red ones lie on a border within
    /// rounding, yellow ones show a feature that is not evaluated, and magenta ones differ.
    #[arg(
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) flags: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) format: ReportFormatArgs,
    /// Set width and height in pixels; one number is both
    ///
    /// The picture shows at least what it shows in its own size.
    #[arg(long, value_name = "WxH|N", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<[u32; 2]>,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    #[command(flatten)]
    pub(crate) stage: StageArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}
