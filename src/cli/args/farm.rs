//! What `rtc farm` is told.

use super::super::parse::{frames, rate};
use super::{LookArgs, Reading, SharedByArg, StageArgs, TalkArgs, WantedArgs};
use crate::pipeline::MOST_SHARES;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(in crate::cli) struct Farm {
    /// The scene, as YAML, glTF, a mesh or IR; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(in crate::cli) file: PathBuf,
    /// The engine that is to run the job
    #[arg(long, value_enum, value_name = "ENGINE")]
    pub(in crate::cli) to: Engine,
    /// The folder to make, with the scene and the job; nothing is run
    #[arg(short, long, required = true, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(in crate::cli) output: PathBuf,
    /// The name of the picture in that folder, .png or .exr; of a turntable, `-` and four digits are
    /// put before the extension
    #[arg(long, value_name = "NAME", default_value = "picture.png")]
    pub(in crate::cli) picture: String,
    /// How many parts a picture has
    #[arg(long, value_name = "N", default_value = "64", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SHARES)))]
    pub(in crate::cli) parts: u32,
    /// What is shared out: tiles, or the samples of traced paths
    #[arg(long, value_enum, default_value_t, value_name = "WHAT")]
    pub(in crate::cli) parts_by: SharedByArg,
    /// So many views, all around the scene, each in parts
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub(in crate::cli) turntable: Option<u32>,
    /// The first and the last picture, from 1 on: of the views of `--turntable`, or with `--fps` of the
    /// animation of a glTF asset
    #[arg(long, value_name = "A..B", value_parser = frames)]
    pub(in crate::cli) frames: Option<[u32; 2]>,
    /// Pictures a second of an animation; the first is at 0 seconds, and each is that of `rtc render
    /// --time`
    #[arg(long, value_name = "N", value_parser = rate, requires = "frames", conflicts_with_all = ["turntable", "time"])]
    pub(in crate::cli) fps: Option<f64>,
    /// Threads of each task, and cores that it asks the engine for
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(in crate::cli) threads: u16,
    /// Memory that each task asks the engine for, in GiB
    #[arg(long, value_name = "GIB", default_value = "4", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    pub(in crate::cli) memory: u32,
    /// How often a task that failed is tried again
    #[arg(long, value_name = "N", default_value = "3", value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub(in crate::cli) retries: u32,
    #[command(flatten)]
    pub(in crate::cli) wanted: WantedArgs,
    #[command(flatten)]
    pub(in crate::cli) look: LookArgs,
    #[command(flatten)]
    pub(in crate::cli) stage: StageArgs,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
    #[command(flatten)]
    pub(in crate::cli) talk: TalkArgs,
}

/// What runs jobs on many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Engine {
    /// Open Job Description, as AWS Deadline Cloud takes it
    #[value(name = "openjd")]
    OpenJd,
    /// Slurm: arrays of tasks
    Slurm,
    /// Dask: a driver in Python
    Dask,
}
