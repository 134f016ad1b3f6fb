//! The view and the light, for every command that renders a scene.

use super::super::parse::{color, degrees, orbit, sun, vector};
use clap::{Args, ValueEnum, ValueHint};
use rtc_passes as passes;
use std::path::PathBuf;

/// The camera and the lights.
#[derive(Debug, Args)]
pub(crate) struct StageArgs {
    /// Set the position of the camera [default: as in the scene]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_parser = vector,
        allow_hyphen_values = true,
        help_heading = "View",
    )]
    pub(crate) eye: Option<[f64; 3]>,
    /// Set the centre of the picture [default: with `--eye` the centre of the scene]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_parser = vector,
        allow_hyphen_values = true,
        help_heading = "View",
    )]
    pub(crate) center: Option<[f64; 3]>,
    /// Set the upward direction [default: the axis closest to the scene's]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_parser = direction,
        allow_hyphen_values = true,
        help_heading = "View",
    )]
    pub(crate) up: Option<[f64; 3]>,
    /// Set the vertical field of view, in degrees
    #[arg(long, value_name = "DEGREES", value_parser = degrees, help_heading = "View")]
    pub(crate) yfov: Option<f64>,
    /// Frame the whole scene from azimuth, elevation and roll, in degrees
    ///
    /// The azimuth goes from the front to the right [default of an asset without a camera:
    /// 34,23].
    #[arg(long, value_name = "AZ,EL[,ROLL]", value_parser = orbit, allow_hyphen_values = true,
        conflicts_with_all = ["eye", "center", "up"], help_heading = "View")]
    pub(crate) orbit: Option<passes::OrbitAngles>,
    /// Light the scene by an environment map: .hdr, .exr or a picture
    ///
    /// The map is equirectangular; its centre is towards -z.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Light")]
    pub(crate) env: Option<PathBuf>,
    /// Light the scene by a constant environment; 0 is black
    #[arg(
        long,
        value_name = "R,G,B",
        value_parser = color,
        conflicts_with = "env",
        help_heading = "Light",
    )]
    pub(crate) env_color: Option<[f64; 3]>,
    /// Add a sun: the direction to it, and its irradiance as one number or three
    #[arg(
        long,
        value_name = "DX,DY,DZ,E",
        value_parser = sun,
        allow_hyphen_values = true,
        help_heading = "Light",
    )]
    pub(crate) sun: Vec<passes::SunLight>,
    /// Leave out the lights of the scene
    #[arg(long, help_heading = "Light")]
    pub(crate) no_scene_lights: bool,
    /// Light the scene by the built-in studio [default: auto]
    #[arg(long, value_enum, value_name = "WHEN", help_heading = "Light")]
    pub(crate) studio: Option<StudioArg>,
    /// Place the scene on a shadow-catching ground
    ///
    /// [default: on for a glTF asset without a camera in the studio, unless the background is
    /// transparent]
    #[arg(long, value_enum, value_name = "WHEN", help_heading = "Light")]
    pub(crate) ground: Option<GroundArg>,
    /// Select the integrator
    ///
    /// [default: path for scenes with glTF, a sun or an environment, else whitted]
    #[arg(long, value_enum, help_heading = "Sampling")]
    pub(crate) integrator: Option<IntegratorArg>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudioArg {
    /// If the scene has no light; in `render` also dimmed, if a glTF asset is mostly dark
    Auto,
    /// Always: a dim room, as by default
    #[value(alias = "on")]
    Dark,
    /// Always: a near-white backdrop under a dark ceiling, for dark subjects
    Light,
    /// Always: a near-white room with a weak key light
    Soft,
    /// Never: a scene without light is black
    Off,
    /// Dimmed, with the lights of the scene
    Fill,
}

impl From<StudioArg> for passes::StudioChoice {
    fn from(studio: StudioArg) -> Self {
        match studio {
            StudioArg::Auto => Self::Auto,
            StudioArg::Light => Self::On(passes::StudioSet::Light),
            StudioArg::Dark => Self::On(passes::StudioSet::Dark),
            StudioArg::Soft => Self::On(passes::StudioSet::Soft),
            StudioArg::Off => Self::Off,
            StudioArg::Fill => Self::Fill,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum GroundArg {
    /// With any light and camera, unless the scene has a ground of its own
    On,
    /// Never
    Off,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorArg {
    /// Direct light, reflection and refraction
    Whitted,
    /// Path tracing: global illumination
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
            Err("the direction is zero".to_owned())
        } else {
            Ok(up)
        }
    })
}
