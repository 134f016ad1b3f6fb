//! What `rtc diff` is told.

use super::super::gate::{Gates, of_pictures};
use super::{Reading, ReportFormatArgs, ReporterArgs, WantedArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(
    after_help = "Values of pixel files are compared as they are stored, up to 16 bits; those of \
    EXR and HDR by the code of sRGB, cut off \
at 1, and `relmse` by what they hold: highlights beyond 1 show in it alone. Of an EXR the first \
red, green and blue are read, negative values as \
0, and no opacity. Colours count as on black; opacity of its own shows in `max` and `share`.\n\n\
Examples:\n  rtc diff new.png golden.png\n  rtc diff new.png golden.png --gate 'rmse<=1,share<=0.1%' -o map.png\n  rtc diff new.yaml old.yaml --html page.html"
)]
pub(crate) struct Diff {
    /// The picture (PNG, JPEG, WebP, EXR or HDR), or the scene
    #[arg(value_name = "NEW", value_hint = ValueHint::FilePath)]
    pub(crate) new: PathBuf,
    /// What it is compared with: a picture of the same size, or a scene, which is seen by the
    /// camera of the
    /// new one
    #[arg(value_name = "OLD", value_hint = ValueHint::FilePath)]
    pub(crate) old: PathBuf,
    /// Pixels count as different if a channel is off by more than so many grey levels of 8 bits
    #[arg(long, value_name = "LEVELS", default_value = "1", value_parser = levels)]
    pub(crate) levels: f64,
    /// What must hold, or the exit code is 1: `MEASURE<=VALUE`, several with commas between;
    /// measures are rmse, max, relmse, flip
    /// and share (as `0.5%` or 0.005)
    #[arg(long, value_name = "GATES", value_parser = of_pictures)]
    pub(crate) gate: Option<Gates>,
    /// Write where they differ, as perceived (FLIP), from black to white: a PNG
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,
    /// Write a page with a slider between the two
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) html: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) format: ReportFormatArgs,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) reporter: ReporterArgs,
}

fn levels(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    match (0.0..=255.0).contains(&value) {
        true => Ok(value),
        false => Err("grey levels are from 0 to 255".to_owned()),
    }
}
