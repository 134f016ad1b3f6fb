//! The arguments, exactly as typed; [`super`] resolves them.

use super::parse::{crop, folder, levels, moment, rule, seconds, size};
use crate::plan::{self, Rule};
use crate::render::Crop;
use crate::{diag, ir, study};
use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use std::path::PathBuf;
use std::sync::LazyLock;
use std::time::Duration;

static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    format!("{version}\nwrites IR version {0}, reads IR versions up to {0}", ir::VERSION)
});

/// A compiler for 3-D scenes: checks them, lowers them to one IR, renders the IR, the same bytes every time.
#[derive(Debug, Parser)]
#[command(name = "rtc", version = LONG_VERSION.as_str(), max_term_width = 100, arg_required_else_help = true)]
#[command(after_help = "Exit codes: 0 fine, 1 the input has errors, 2 usage, files or internal, 130 interrupted.")]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Check scenes and say what is wrong with them
    Check(Check),
    /// Compile a scene to the intermediate representation
    Compile(Compile),
    /// Render a scene to a picture
    Render(Render),
    /// Show what accuracy costs in a scene, and which settings are worth it
    Cost(Cost),
    /// Explain a code of a diagnostic
    Explain(Explain),
    /// Print the JSON Schema of a format
    Schema(Schema),
    /// Print a completion script for a shell
    Completions(Completions),
    /// Print a manual page
    Man(Man),
}

#[derive(Debug, Args)]
pub(super) struct Check {
    /// Scenes, as YAML or IR; `-` is standard input
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) files: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) talk: Talk,
}

#[derive(Debug, Args)]
pub(super) struct Compile {
    /// The scene, as YAML or IR; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    /// Where to write; `-` is standard output [default: `-`, or nowhere with `--explain`]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) output: Option<PathBuf>,
    /// Say which effects the picture needs, and why it does without the others
    #[arg(long, value_enum, value_name = "FORM", num_args = 0..=1, require_equals = true, default_missing_value = "human")]
    pub(super) explain: Option<Explanation>,
    /// What to write [default: by the extension of the output (.json, .rtir, .yaml), or `ir`]
    #[arg(long, value_enum)]
    pub(super) emit: Option<Emit>,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) talk: Talk,
}

#[derive(Debug, Args)]
pub(super) struct Render {
    /// The scene, as YAML or IR; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    /// Where to write, .png or .exr; `-` is PNG to standard output [default: the scene's name with .png, here]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) output: Option<PathBuf>,
    /// Width and height in pixels; the picture keeps its height in the scene
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<[u32; 2]>,
    /// Sub-samples along each side of a pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) supersampling: Option<u32>,
    /// Points of the lens each sub-sample takes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) aperture_samples: Option<u32>,
    /// Points of each soft light
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) light_samples: Option<u32>,
    /// Rays of each glossy lobe; what is a mirror stays one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) glossy_samples: Option<u32>,
    /// Bounces after the first hit
    #[arg(long, value_name = "N")]
    pub(super) depth: Option<u32>,
    /// Sample until the picture is this close, in grey levels of 8 bits (RMSE, kept by 90 of 100 pictures), to what ever more samples at this
    /// depth would show
    #[arg(long, value_name = "LEVELS", value_parser = levels, conflicts_with_all = ["supersampling", "aperture_samples"])]
    pub(super) target_error: Option<f64>,
    /// Sample for this long, in seconds of the clock, where it helps most; the picture then depends on the machine
    #[arg(long, value_name = "SECONDS", value_parser = seconds, conflicts_with_all = ["supersampling", "aperture_samples"])]
    pub(super) time_budget: Option<Duration>,
    /// Threads to work on [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Render only this part of the picture, in pixels from the upper left
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(super) crop: Option<Crop>,
    /// How rays meet shapes
    #[arg(long, value_enum, default_value_t, value_name = "ARITHMETIC")]
    pub(super) arithmetic: Arithmetic,
    /// Bits a channel of a PNG [default: 8]
    #[arg(long)]
    pub(super) bits: Option<Bits>,
    #[command(flatten)]
    pub(super) pruning: Pruning,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) talk: Talk,
}

/// What is left out of the work for a picture.
#[derive(Debug, Args)]
pub(super) struct Pruning {
    /// Simulate what a rule would leave out: all rules, or those named, as E-SPEC
    #[arg(long, value_name = "RULE", num_args = 0.., require_equals = true, value_delimiter = ',', value_parser = rule)]
    pub(super) no_prune: Option<Vec<Rule>>,
    /// Leave out also what changes the picture by less than half a level of 8 bits
    #[arg(long)]
    pub(super) approx: bool,
    /// Simulate also what is left out, and stop at a pixel where it would show
    #[arg(long, conflicts_with_all = ["no_prune", "arithmetic"])]
    pub(super) verify_effects: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Explanation {
    /// A table to read
    Human,
    /// One JSON object
    Json,
}

#[derive(Debug, Args)]
pub(super) struct Cost {
    /// The scene, as YAML or IR; `-` is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    /// Where to write; `-` is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-", value_hint = ValueHint::FilePath)]
    pub(super) output: PathBuf,
    /// The form of the report
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub(super) format: Report,
    /// Also write a page for a browser, with plots and pictures
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) html: Option<PathBuf>,
    /// How much work the study may be
    #[arg(long, value_enum, default_value_t)]
    pub(super) effort: Effort,
    /// Which tiles of the picture are looked at, and in which order settings are timed
    #[arg(long, value_name = "N", default_value = "1")]
    pub(super) seed: u64,
    /// Threads for what is not timed [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    #[command(flatten)]
    pub(super) reading: Reading,
    #[command(flatten)]
    pub(super) talk: Talk,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Report {
    /// A table of 80 columns
    #[default]
    Table,
    /// The rows, as comma-separated values
    Csv,
    /// All there is, as JSON
    Json,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Effort {
    /// Seconds
    Quick,
    /// About a minute for a simple scene
    #[default]
    Default,
    /// Ten times that
    Thorough,
}

impl From<Effort> for study::Effort {
    fn from(effort: Effort) -> Self {
        match effort {
            Effort::Quick => Self::QUICK,
            Effort::Default => Self::DEFAULT,
            Effort::Thorough => Self::THOROUGH,
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct Explain {
    /// The code of a diagnostic, as VA001, or the name of a rule, as E-SPEC
    #[arg(required_unless_present = "all")]
    pub(super) code: Option<String>,
    /// Explain every code there is, as Markdown
    #[arg(long, conflicts_with = "code")]
    pub(super) all: bool,
}

#[derive(Debug, Args)]
pub(super) struct Schema {
    /// The format
    #[arg(value_enum, default_value_t)]
    pub(super) of: Format,
}

#[derive(Debug, Args)]
pub(super) struct Completions {
    /// The shell
    pub(super) shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct Man {
    /// The command the page is about [default: all of rtc]
    pub(super) command: Option<String>,
}

/// How the input is read.
#[derive(Debug, Args)]
pub(super) struct Reading {
    /// What to call standard input in messages
    #[arg(long, value_name = "NAME")]
    pub(super) stdin_name: Option<String>,
    /// Refuse unknown keys
    #[arg(long)]
    pub(super) strict: bool,
    /// Repair mistakes that have one sensible repair, with a warning
    #[arg(long)]
    pub(super) lenient: bool,
    /// A folder, beside that of the scene, whose files the scene may name: textures and meshes
    #[arg(long, value_name = "FOLDER", value_parser = folder, value_hint = ValueHint::DirPath)]
    pub(super) asset_root: Option<PathBuf>,
    /// Show a glTF asset at this moment of its animation [default: at rest]
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub(super) time: Option<f64>,
    /// The animation of a glTF asset, by its name [default: the first, if there is a `--time`]
    #[arg(long, value_name = "NAME")]
    pub(super) animation: Option<String>,
    /// The variant of the materials of a glTF asset, by its name
    #[arg(long, value_name = "NAME")]
    pub(super) variant: Option<String>,
    /// Lift the limits on the size of the picture and the number of rays
    #[arg(long)]
    pub(super) allow_huge: bool,
}

/// How findings are told.
#[derive(Debug, Args)]
pub(super) struct Talk {
    /// The form of diagnostics
    #[arg(long, value_enum, default_value_t, value_name = "FORMAT")]
    pub(super) message_format: MessageFormat,
    /// Colours in diagnostics
    #[arg(long, value_enum, default_value_t, value_name = "WHEN")]
    pub(super) color: Color,
    /// Show at most this many diagnostics of a file
    #[arg(long, value_name = "N", default_value = "100", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) max_errors: u32,
    /// Only errors: no warnings, no progress, no summary
    #[arg(short, long, action = ArgAction::SetTrue, conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Notes too
    #[arg(short, long, action = ArgAction::SetTrue)]
    pub(super) verbose: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Emit {
    /// The IR as text (JSON)
    Ir,
    /// The IR in its binary container
    IrBin,
    /// The scene, in canonical spelling
    Yaml,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Bits {
    #[value(name = "8")]
    Eight,
    #[value(name = "16")]
    Sixteen,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Arithmetic {
    /// With bounds on all errors, in f64
    #[default]
    Robust,
    /// By the formulas of textbooks, in f64
    Plain,
    /// By the formulas of textbooks, in f32
    F32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Scenes
    #[default]
    Scene,
    /// The text form of the IR
    Ir,
    /// Scenes, as a page to read in Markdown
    Page,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum MessageFormat {
    /// For people, with the source
    #[default]
    Human,
    /// One line each, for editors
    Short,
    /// One JSON object a line
    Json,
    /// SARIF 2.1.0
    Sarif,
    /// GitHub workflow commands
    Github,
}

impl From<Arithmetic> for plan::Arithmetic {
    fn from(arithmetic: Arithmetic) -> Self {
        match arithmetic {
            Arithmetic::Robust => Self::Robust,
            Arithmetic::Plain => Self::Plain,
            Arithmetic::F32 => Self::F32,
        }
    }
}

impl From<MessageFormat> for diag::Format {
    fn from(format: MessageFormat) -> Self {
        match format {
            MessageFormat::Human => Self::Human,
            MessageFormat::Short => Self::Short,
            MessageFormat::Json => Self::Json,
            MessageFormat::Sarif => Self::Sarif,
            MessageFormat::Github => Self::Github,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    Always,
    Never,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_agree_with_each_other() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_and_crops() {
        assert_eq!((size("640x480"), size("3×2")), (Ok([640, 480]), Ok([3, 2])));
        assert!(["640", "0x4", "4x", "-1x2", "1x2x3"].into_iter().all(|text| size(text).is_err()));
        assert!(["0", "-1", "nan", "inf", "256", "x"].into_iter().all(|text| levels(text).is_err()));
        assert!(["0", "-1", "nan", "inf", "1e300", "x"].into_iter().all(|text| seconds(text).is_err()));
        assert_eq!((levels("0.5"), seconds("2.5")), (Ok(0.5), Ok(Duration::from_millis(2500))));
        assert_eq!(crop("1, 2,3,4"), Ok(Crop { x: 1, y: 2, width: 3, height: 4 }));
        assert!(["1,2,3", "1,2,0,4", "a,b,c,d", "1,2,3,4,5"].into_iter().all(|text| crop(text).is_err()));
    }
}
