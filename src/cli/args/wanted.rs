//! The settings of a picture, for every command that renders: size, samples, and the region.

use super::super::parse::{crop, setting, size};
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches, ValueEnum};
use rtc_passes::{CountSetting, Overrides};
use rtc_plan as plan;
use rtc_render::Crop;

#[derive(Debug, Args)]
pub(crate) struct WantedArgs {
    /// Set width and height in pixels; one number is both
    ///
    /// The picture shows at least what it shows in its own size.
    #[arg(long, value_name = "WxH|N", value_parser = size, help_heading = "Picture")]
    pub(crate) size: Option<[u32; 2]>,
    #[command(flatten)]
    pub(crate) counts: CountArgs,
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
            ..self.counts.0
        }
    }
}

/// The flags of [`CountSetting::ALL`].
#[derive(Debug)]
pub(crate) struct CountArgs(Overrides);

impl Args for CountArgs {
    fn augment_args(command: Command) -> Command {
        command.args(CountSetting::ALL.map(
            |CountSetting {
                 name, help, least, ..
             }| {
                let number = clap::value_parser!(u32).range(i64::from(least)..);
                let flag = Arg::new(name).long(name).value_name("N").help(help);
                flag.value_parser(number).help_heading("Sampling")
            },
        ))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for CountArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let mut counts = Self(Overrides::default());
        counts.update_from_arg_matches(matches).map(|()| counts)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        for CountSetting { name, of, .. } in &CountSetting::ALL {
            *of(&mut self.0) = matches.get_one(name).copied();
        }
        Ok(())
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
