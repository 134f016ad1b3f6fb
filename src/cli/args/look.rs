//! What `rtc render` is told of the look of a picture: how bright, by which tone map, before what,
//! with which layers.

use super::super::parse::{background, exposure};
use clap::{Args, ValueEnum};
use rtc_color::{Tone, srgb_decoded};
use rtc_image::{BackgroundFill, FileFormat};
use rtc_pipeline::Exposure;
use rtc_render::Aov;

#[derive(Debug, Args)]
pub(crate) struct OutputTransformArgs {
    /// How a PNG shows linear values; an EXR holds them as they are [default: pbr-neutral for a
    /// glTF asset, srgb where else paths are traced, else none]
    #[arg(long, value_enum, value_name = "MAP")]
    pub(crate) tonemap: Option<Tonemap>,
    /// Exposure in stops, of EXR too: each doubles the values; or `auto`, by what is seen
    /// [default: auto for the PNG of a glTF asset with lights of its own, else 0]
    #[arg(long, value_name = "STOPS", value_parser = exposure, allow_negative_numbers = true)]
    pub(crate) exposure: Option<Exposure>,
    /// What is behind all surfaces of any scene: `env`, the surroundings of the scene;
    /// `transparent`; `white`, `black` or #rrggbb, as a screen shows it; or a colour R,G,B in the
    /// values that the file is to hold. Light stays as it is
    #[arg(long, value_name = "WHAT", default_value = "env", value_parser = background)]
    pub(crate) background: BackgroundArg,
    /// Layers beside the colours: means over what the camera rays of a pixel meet first. An EXR holds
    /// their numbers; beside a PNG each is a picture of its own, as `picture.depth.png`
    #[arg(long, value_enum, value_name = "LAYERS", value_delimiter = ',')]
    pub(crate) aov: Vec<Layer>,
    /// Bits a channel: 8 or 16 of a PNG, 16 or 32 of an EXR, whose layers of distances, places and
    /// numbers keep 32 [default: 8, of an EXR 32]
    #[arg(long)]
    pub(crate) bits: Option<BitDepth>,
    /// Leave out of a PNG or an EXR what made it: the program, the hash of the scene and the settings
    /// that decide the pixels
    #[arg(long)]
    pub(crate) no_metadata: bool,
}

/// A background as typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BackgroundArg {
    /// That of the picture.
    Fill(BackgroundFill),
    /// A colour as a screen shows it: sRGB in 8 bits a channel.
    Color([u8; 3]),
}

impl BackgroundArg {
    /// That of a picture in a kind of file: an EXR holds linear values, other kinds those of sRGB.
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
pub(crate) enum BitDepth {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
    #[value(name = "32")]
    ThirtyTwo,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Layer {
    /// Channels albedo.R, .G, .B: base colours, linear
    Albedo,
    /// Channels normal.X, .Y, .Z: shading normals in the world, towards the viewer
    Normal,
    /// Channel depth.Z: the distance along the axis of view; 1e10 where there is nothing
    Depth,
    /// Channels uv.U, .V: the first texture coordinates
    Uv,
    /// Channel instance.X: the number of the surface, from 1, that the first ray meets; 0 of none
    Instance,
    /// Channels position.X, .Y, .Z: places in the world
    Position,
}

impl From<Layer> for Aov {
    fn from(layer: Layer) -> Self {
        match layer {
            Layer::Albedo => Self::Albedo,
            Layer::Normal => Self::Normal,
            Layer::Depth => Self::Depth,
            Layer::Uv => Self::Uv,
            Layer::Instance => Self::Instance,
            Layer::Position => Self::Position,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tonemap {
    /// As they are
    None,
    /// Cut off at 1, coded by sRGB
    Srgb,
    /// AgX: highlights roll off over many stops and fade to white
    Agx,
    /// Khronos PBR Neutral: colours below the highlights stay what they are
    PbrNeutral,
}

impl From<Tonemap> for Tone {
    fn from(map: Tonemap) -> Self {
        match map {
            Tonemap::None => Self::None,
            Tonemap::Srgb => Self::Srgb,
            Tonemap::Agx => Self::Agx,
            Tonemap::PbrNeutral => Self::PbrNeutral,
        }
    }
}
