//! The arguments of `rtc farm`.

use super::super::parse::{frames, rate};
use super::{OutputTransformArgs, ReadArgs, ReporterArgs, ShardByArg, StageArgs, WantedArgs};
use clap::{Args, ValueEnum, ValueHint};
use rtc_pipeline::MAX_SHARDS;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct FarmArgs {
    /// The scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// Select the engine that will run the job
    #[arg(long, value_enum, value_name = "ENGINE", help_heading = "Job")]
    pub(crate) to: FarmEngine,
    /// Create this folder with the scene and the job; nothing is run
    #[arg(
        short,
        long,
        required = true,
        value_name = "FOLDER",
        value_hint = ValueHint::DirPath,
        help_heading = "Output",
    )]
    pub(crate) output: PathBuf,
    /// Name the picture in that folder, .png or .exr
    ///
    /// For several pictures, `-` and four digits are put before the extension.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "picture.png",
        help_heading = "Output"
    )]
    pub(crate) picture: String,
    /// Divide each picture into N parts
    #[arg(
        long,
        value_name = "N",
        default_value = "64",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SHARDS)),
        help_heading = "Job",
    )]
    pub(crate) parts: u32,
    /// Divide the work by tiles or by samples of path tracing
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        help_heading = "Job"
    )]
    pub(crate) parts_by: ShardByArg,
    /// Render N views around the scene
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=9999),
        help_heading = "View",
    )]
    pub(crate) turntable: Option<u32>,
    /// Render only this range of frames, 1-based and inclusive
    ///
    /// Frames are views of `--turntable`, or with `--fps` of the animation of a glTF asset.
    #[arg(long, value_name = "A..B", value_parser = frames, help_heading = "View")]
    pub(crate) frames: Option<[u32; 2]>,
    /// Set the frames per second of an animation
    ///
    /// The first frame is at 0 seconds. Each frame is the picture of `rtc render --time`.
    #[arg(
        long,
        value_name = "N",
        value_parser = rate,
        requires = "frames",
        conflicts_with_all = ["turntable", "time"],
        help_heading = "View",
    )]
    pub(crate) fps: Option<f64>,
    /// Request N cores for each task, and run N threads in it
    #[arg(
        long,
        value_name = "N",
        default_value = "1",
        value_parser = clap::value_parser!(u16).range(1..=1024),
        help_heading = "Job",
    )]
    pub(crate) threads: u16,
    /// Request this memory for each task, in GiB
    #[arg(
        long,
        value_name = "GIB",
        default_value = "4",
        value_parser = clap::value_parser!(u32).range(1..=65_536),
        help_heading = "Job",
    )]
    pub(crate) memory: u32,
    /// Retry a failed task N times
    #[arg(
        long,
        value_name = "N",
        default_value = "3",
        value_parser = clap::value_parser!(u32).range(0..=1000),
        help_heading = "Job",
    )]
    pub(crate) retries: u32,
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

/// An engine that runs jobs on many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FarmEngine {
    /// Open Job Description, for AWS Deadline Cloud
    #[value(name = "openjd")]
    OpenJd,
    /// Slurm: arrays of tasks
    Slurm,
    /// Dask: a driver in Python
    Dask,
    /// Kubernetes: an indexed Job
    Kubernetes,
}
