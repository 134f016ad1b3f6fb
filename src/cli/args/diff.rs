//! The arguments of `rtc diff`.

use super::super::gate::{MeasureLimits, picture_limits};
use super::{ReadArgs, ReportFormatArgs, ReporterArgs, TableFormat, WantedArgs};
use clap::{Args, ValueHint};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = "\
Values of pixel files are compared as stored, up to 16 bits. Values of EXR and HDR files are
encoded as sRGB and clipped at 1; only `relmse` uses the linear values, so highlights beyond 1
show in it alone. Of an EXR the first red, green and blue channels are read, without opacity;
negative values count as 0. Colours are composited on black; opacity shows in `max` and `share`.

Examples:
  rtc diff new.png golden.png
  rtc diff new.png golden.png --gate 'rmse<=1,share<=0.1%' -o map.png
  rtc diff new.yaml old.yaml --html page.html
  rtc diff handed-in/ solutions/ --gate 'share<=1%' --table csv")]
pub(crate) struct DiffArgs {
    /// The new picture (PNG, JPEG, WebP, EXR or HDR) or scene, or a folder
    ///
    /// Of two folders, pictures of one name are compared, those in folders below, too; of folders
    /// without pictures, scenes.
    #[arg(value_name = "NEW", value_hint = ValueHint::FilePath)]
    pub(crate) new: PathBuf,
    /// The old picture, of the same size, or the old scene
    ///
    /// Scenes are rendered with the camera of the new one.
    #[arg(value_name = "OLD", value_hint = ValueHint::FilePath)]
    pub(crate) old: PathBuf,
    /// Count pixels as different if a channel differs by more than this
    ///
    /// In grey levels of 8 bits, from 0 to 255.
    #[arg(
        long,
        value_name = "LEVELS",
        default_value = "1",
        value_parser = levels,
        help_heading = "Comparison",
    )]
    pub(crate) levels: f64,
    /// Exit with 1 if a measure exceeds its limit, as `rmse<=1,share<=0.5%`
    ///
    /// Measures: rmse, max, relmse, flip, and share (as `0.5%` or 0.005).
    #[arg(long, value_name = "GATES", value_parser = picture_limits, help_heading = "Comparison")]
    pub(crate) gate: Option<MeasureLimits>,
    /// Write a PNG map of the perceived difference (FLIP) of each pixel
    #[arg(
        short,
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(crate) output: Option<PathBuf>,
    /// Write an HTML page with a slider between the two pictures
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Output")]
    pub(crate) html: Option<PathBuf>,
    /// Of two folders: print the table in this format
    #[arg(long, value_enum, value_name = "FORMAT", help_heading = "Output")]
    pub(crate) table: Option<TableFormat>,
    #[command(flatten)]
    pub(crate) format: ReportFormatArgs,
    #[command(flatten)]
    pub(crate) wanted: WantedArgs,
    #[command(flatten)]
    pub(crate) reading: ReadArgs,
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
