//! What every command that makes pictures of a scene is told of them: size, samples, which part, by
//! which arithmetic.

use super::super::parse::{crop, setting, size};
use clap::{Args, ValueEnum};
use rtc_passes::Overrides;
use rtc_plan as plan;
use rtc_render::Crop;

#[derive(Debug, Args)]
#[command(next_help_heading = None::<&str>)]
pub(crate) struct WantedArgs {
    /// Width and height in pixels, one number being both; the picture keeps its height in the scene
    #[arg(long, value_name = "WxH|N", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Sub-samples along each side of a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) supersampling: Option<u32>,
    /// Points of the lens each sub-sample takes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) aperture_samples: Option<u32>,
    /// Points of each soft light
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) light_samples: Option<u32>,
    /// Rays of each glossy lobe; what is a mirror stays one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) glossy_samples: Option<u32>,
    /// Paths a pixel, of scenes whose paths are traced
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) spp: Option<u32>,
    /// Bounces after the first hit
    #[arg(long, value_name = "N")]
    pub(crate) depth: Option<u32>,
    /// Render only this part of the picture, in pixels from the upper left
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(crate) crop: Option<Crop>,
    /// How rays meet shapes
    #[arg(long, value_enum, default_value_t, value_name = "ARITHMETIC")]
    pub(crate) arithmetic: ArithmeticArg,
    /// Replace a setting of the IR by its name there, last of all, as multipleScattering=false;
    /// `rtc schema ir` lists them
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, String)>,
}

impl WantedArgs {
    /// What replaces the settings of the scene.
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            size: self.size,
            supersampling: self.supersampling,
            aperture_samples: self.aperture_samples,
            light_samples: self.light_samples,
            glossy_samples: self.glossy_samples,
            depth: self.depth,
            spp: self.spp,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ArithmeticArg {
    /// With bounds on all errors, in f64
    #[default]
    Robust,
    /// By the formulas of textbooks, in f64
    Plain,
    /// By the formulas of textbooks, in f32
    F32,
}

impl From<ArithmeticArg> for plan::Arithmetic {
    fn from(arithmetic: ArithmeticArg) -> Self {
        match arithmetic {
            ArithmeticArg::Robust => Self::Robust,
            ArithmeticArg::Plain => Self::Plain,
            ArithmeticArg::F32 => Self::F32,
        }
    }
}
