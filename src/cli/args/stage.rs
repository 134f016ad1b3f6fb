//! What every command that shows a scene is told of view and light.

use super::super::parse::{color, degrees, orbit, sun, vector};
use clap::{Args, ValueEnum, ValueHint};
use rtc_passes as passes;
use std::path::PathBuf;

/// From where a scene is seen, and what lights it.
#[derive(Debug, Args)]
#[command(next_help_heading = "View and light")]
pub(crate) struct StageArgs {
    /// Where the camera stands [default: as in the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) eye: Option<[f64; 3]>,
    /// What is in the middle of the picture [default: with `--eye` the middle of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(crate) center: Option<[f64; 3]>,
    /// The upward direction [default: the axis nearest to that of the scene's camera]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub(crate) up: Option<[f64; 3]>,
    /// The angle the picture spans from bottom to top, in degrees
    #[arg(long, value_name = "DEGREES", value_parser = degrees)]
    pub(crate) yfov: Option<f64>,
    /// All of the scene from an angle, in degrees: around from the front to the right, above the
    /// horizon, and about the view [default of an asset without a camera: 34,23]
    #[arg(long, value_name = "AZIMUTH,ELEVATION[,ROLL]", value_parser = orbit, allow_hyphen_values = true,
        conflicts_with_all = ["eye", "center", "up"])]
    pub(crate) orbit: Option<passes::Orbit>,
    /// A picture of the surroundings, .hdr or .exr: longitude across, its middle towards -z
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) env: Option<PathBuf>,
    /// The same radiance from every direction, one number or three; 0 is darkness
    #[arg(long, value_name = "R,G,B", value_parser = color, conflicts_with = "env")]
    pub(crate) env_color: Option<[f64; 3]>,
    /// A sun: the direction to it, and the irradiance on a surface that faces it, one number or
    /// three
    #[arg(long, value_name = "DX,DY,DZ,E", value_parser = sun, allow_hyphen_values = true)]
    pub(crate) sun: Vec<passes::Sun>,
    /// Leave out the lights of the scene
    #[arg(long)]
    pub(crate) no_scene_lights: bool,
    /// Whether it stands in the studio [default: auto]
    #[arg(long, value_enum, value_name = "WHEN")]
    pub(crate) studio: Option<StudioArg>,
    /// Whether a ground that fades out is laid under it, to catch its shadow [default: on for a glTF
    /// asset without a camera in the studio, unless the background is transparent]
    #[arg(long, value_enum, value_name = "WHEN")]
    pub(crate) ground: Option<GroundArg>,
    /// How light is followed [default: all paths of what holds glTF, a sun or surroundings; else
    /// Whitted's way]
    #[arg(long, value_enum)]
    pub(crate) integrator: Option<IntegratorArg>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudioArg {
    /// If it has no light; dimmed in `render`, if the light of a glTF asset shows little of it
    Auto,
    /// Always
    On,
    /// Never: what has no light is black
    Off,
    /// Dimmed, beside its own light
    Fill,
}

impl From<StudioArg> for passes::StudioChoice {
    fn from(studio: StudioArg) -> Self {
        match studio {
            StudioArg::Auto => Self::Auto,
            StudioArg::On => Self::On,
            StudioArg::Off => Self::Off,
            StudioArg::Fill => Self::Fill,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum GroundArg {
    /// Also in other light and for its own camera; not where it has a ground of its own
    On,
    /// Never
    Off,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorArg {
    /// Direct light, mirrors and refraction
    Whitted,
    /// All the light along all paths
    Path,
}

impl From<IntegratorArg> for passes::IntegratorChoice {
    fn from(integrator: IntegratorArg) -> Self {
        match integrator {
            IntegratorArg::Whitted => Self::Whitted,
            IntegratorArg::Path => Self::Path,
        }
    }
}

fn direction(text: &str) -> Result<[f64; 3], String> {
    vector(text).and_then(|up| {
        if up == [0.0; 3] {
            Err("it has no direction".to_owned())
        } else {
            Ok(up)
        }
    })
}
