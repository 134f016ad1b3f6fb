//! The output transform: exposure, tone map, background and layers.

use super::super::parse::{background, exposure};
use clap::{Args, ValueEnum};
use rtc_color::{Tone, srgb_decoded};
use rtc_image::{BackgroundFill, FileFormat};
use rtc_pipeline::Exposure;
use rtc_render::Aov;

#[derive(Debug, Args)]
pub(crate) struct OutputTransformArgs {
    /// Select the tone map of a PNG
    ///
    /// An EXR holds linear values [default: pbr-neutral for a glTF asset, srgb for other path-
    /// traced scenes, else none].
    #[arg(long, value_enum, value_name = "MAP", help_heading = "Output")]
    pub(crate) tonemap: Option<TonemapArg>,
    /// Set the exposure in stops, or `auto`
    ///
    /// Each stop doubles the values, in an EXR too [default: auto for the PNG of a glTF asset
    /// with lights of its own, else 0].
    #[arg(
        long,
        value_name = "STOPS",
        value_parser = exposure,
        allow_negative_numbers = true,
        help_heading = "Output",
    )]
    pub(crate) exposure: Option<Exposure>,
    /// Set the background: env, transparent, white, black, #rrggbb or R,G,B
    ///
    /// `env` shows the environment. R,G,B are linear values. The light of the scene stays.
    #[arg(
        long,
        value_name = "WHAT",
        default_value = "env",
        value_parser = background,
        help_heading = "Output",
    )]
    pub(crate) background: BackgroundArg,
    /// Write layers beside the colours: albedo, normal, depth, …
    ///
    /// Each value is a mean over the first hits of a pixel, or a statistic of its samples. An EXR
    /// holds the numbers; beside a PNG each layer is a picture, as `picture.depth.png`.
    #[arg(
        long,
        value_enum,
        value_name = "LAYERS",
        value_delimiter = ',',
        help_heading = "Output"
    )]
    pub(crate) aov: Vec<LayerArg>,
    /// Set the bits of a channel: 8 or 16 in a PNG, 16 or 32 in an EXR
    ///
    /// [default: 8, in an EXR 32]; layers of distances, positions and indices keep 32.
    #[arg(long, help_heading = "Output")]
    pub(crate) bits: Option<BitDepthArg>,
    /// Do not write metadata: the program, hashes of the scene and of tiles, the settings
    #[arg(long, help_heading = "Output")]
    pub(crate) no_metadata: bool,
}

/// A background as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BackgroundArg {
    /// A fill that does not depend on the file format.
    Fill(BackgroundFill),
    /// An sRGB colour, 8 bits per channel.
    Color([u8; 3]),
}

impl BackgroundArg {
    /// The fill for a file format: an EXR holds linear values, other formats sRGB values.
    pub(crate) fn fill(self, kind: FileFormat) -> BackgroundFill {
        match self {
            Self::Fill(fill) => fill,
            Self::Color(color) => {
                let shown = color.map(|channel| f64::from(channel) / 255.0);
                BackgroundFill::Color(if kind.is_linear() {
                    shown.map(srgb_decoded)
                } else {
                    shown
                })
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum BitDepthArg {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
    #[value(name = "32")]
    ThirtyTwo,
}

impl BitDepthArg {
    /// As a number.
    pub(crate) fn bits(self) -> u32 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
            Self::ThirtyTwo => 32,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LayerArg {
    /// Channels albedo.R, .G, .B: base colours, linear
    Albedo,
    /// Channels normal.X, .Y, .Z: shading normals in the world, towards the viewer
    Normal,
    /// Channel depth.Z: the distance along the view axis; 1e10 where nothing is hit
    Depth,
    /// Channels uv.U, .V: the first texture coordinates
    Uv,
    /// Channel instance.X: the number of the surface, from 1, that the first ray hits; 0 for none
    Instance,
    /// Channels position.X, .Y, .Z: world coordinates
    Position,
    /// Channels error.R, .G, .B: standard errors, of display values, of a picture of traced paths
    /// (17 or more), or with `--target-error` or `--time-budget`
    Error,
    /// Channel samples.X: the number of samples of such a picture
    Samples,
    /// Channel unmet.X: a bound on the light that no sample may have hit, in multiples of white; 1
    /// where there is no bound
    #[value(name = "unmet")]
    Undersampled,
}

impl From<LayerArg> for Aov {
    fn from(layer: LayerArg) -> Self {
        match layer {
            LayerArg::Albedo => Self::Albedo,
            LayerArg::Normal => Self::Normal,
            LayerArg::Depth => Self::Depth,
            LayerArg::Uv => Self::Uv,
            LayerArg::Instance => Self::Instance,
            LayerArg::Position => Self::Position,
            LayerArg::Error => Self::Error,
            LayerArg::Samples => Self::Samples,
            LayerArg::Undersampled => Self::Undersampled,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TonemapArg {
    /// Linear values
    None,
    /// Clipped at 1, sRGB encoding
    Srgb,
    /// AgX: highlights roll off over many stops and fade to white
    Agx,
    /// Khronos PBR Neutral: colours below the highlights keep their values
    PbrNeutral,
}

impl From<TonemapArg> for Tone {
    fn from(map: TonemapArg) -> Self {
        match map {
            TonemapArg::None => Self::None,
            TonemapArg::Srgb => Self::Srgb,
            TonemapArg::Agx => Self::Agx,
            TonemapArg::PbrNeutral => Self::PbrNeutral,
        }
    }
}
