//! The settings of a picture, for every command that renders: size, samples, and the region.

use super::super::parse::{crop, setting, size};
use clap::{Args, ValueEnum};
use rtc_passes::Overrides;
use rtc_plan as plan;
use rtc_render::Crop;

#[derive(Debug, Args)]
pub(crate) struct WantedArgs {
    /// Set width and height in pixels; one number is both
    ///
    /// The picture keeps its height in the scene.
    #[arg(long, value_name = "WxH|N", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<[u32; 2]>,
    /// Take N × N samples in each pixel
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Sampling",
    )]
    pub(crate) supersampling: Option<u32>,
    /// Sample N points of the lens for each sample of a pixel
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Sampling",
    )]
    pub(crate) aperture_samples: Option<u32>,
    /// Sample N points of each soft light
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Sampling",
    )]
    pub(crate) light_samples: Option<u32>,
    /// Trace N rays for each glossy reflection
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Sampling",
    )]
    pub(crate) glossy_samples: Option<u32>,
    /// Trace N paths in each pixel, in path-traced scenes
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..),
        help_heading = "Sampling",
    )]
    pub(crate) spp: Option<u32>,
    /// Follow N bounces after the first hit
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub(crate) depth: Option<u32>,
    /// Render only this rectangle, in pixels from the upper left corner
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop, help_heading = "Picture")]
    pub(crate) crop: Option<Crop>,
    /// Select the arithmetic of intersections
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "ARITHMETIC",
        help_heading = "Debugging"
    )]
    pub(crate) arithmetic: ArithmeticArg,
    /// Set a setting of the IR by its name, as `multipleScattering=false`
    ///
    /// It is applied last. `rtc schema ir` lists the names.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "Picture")]
    pub(crate) set: Vec<(String, String)>,
}

impl WantedArgs {
    /// The overrides of the settings of the scene.
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
    /// f64 with bounds on all errors
    #[default]
    Robust,
    /// f64, textbook formulas
    Plain,
    /// f32, textbook formulas
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
