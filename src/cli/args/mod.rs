//! The arguments, exactly as typed; [`super`] resolves them.

mod audit;
mod certify;
mod common;
mod cost;
mod diff;
mod farm;
mod fmt;
mod look;
mod merge;
mod preview;
mod render;
mod stage;
mod wanted;

pub(super) use audit::AuditArgs;
pub(super) use certify::CertifyArgs;
pub(super) use common::{
    ColorArg, MessageFormat, ReadArgs, ReportFormatArgs, ReporterArgs, TableFormat, ThreadArgs,
};
pub(super) use cost::{CostArgs, StudyFormat};
pub(super) use diff::DiffArgs;
pub(super) use farm::{FarmArgs, FarmEngine};
pub(super) use fmt::FmtArgs;
pub(super) use look::{BackgroundArg, BitDepthArg, OutputTransformArgs};
pub(super) use merge::MergeArgs;
pub(super) use preview::PreviewArgs;
pub(super) use render::{PruningArgs, RenderArgs, ShardByArg};
pub(super) use stage::{GroundArg, IntegratorArg, StageArgs};
pub(super) use wanted::{ArithmeticArg, WantedArgs};

use super::parse::length;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
use rtc_ir as ir;
use std::path::PathBuf;
use std::sync::LazyLock;

static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "{version}\nwrites IR version {0}, reads IR versions up to {0}",
        ir::VERSION
    )
});

/// As in the book (`reference/command-line.md`).
const EXIT_CODES: &str = "Exit codes:
    0  success; there may be warnings
    1  the input has errors, or a gate failed
    2  a usage or file error, or a bug in rtc
  130  ended by SIGINT, as by Ctrl-C
  143  ended by SIGTERM";

/// A compiler and renderer for 3-D scenes: checks them, lowers them to one IR, and renders it, with
/// the same bytes on every machine.
#[derive(Debug, Parser)]
#[command(name = "rtc", version = LONG_VERSION.as_str(), max_term_width = 100)]
#[command(after_help = EXIT_CODES)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Write a first scene, with comments
    New(NewArgs),
    /// Check scenes for errors, and fix them
    Check(CheckArgs),
    /// Format scene files; comments stay
    Fmt(FmtArgs),
    /// Convert a scene to the IR, YAML, glTF, Mitsuba, pbrt or POV-Ray; explain what it needs
    Compile(CompileArgs),
    /// Render scenes to pictures
    Render(Box<RenderArgs>),
    /// Show a scene on a local web page while you edit it
    Preview(Box<PreviewArgs>),
    /// Run the language server (diagnostics, quick fixes, hover, completion)
    Lsp(LspArgs),
    /// Merge the parts of `rtc render --part` into the picture
    Merge(Box<MergeArgs>),
    /// Write a job that renders a picture in parts on many machines
    Farm(Box<FarmArgs>),
    /// Show the error and the time of each setting, and recommend one
    Cost(CostArgs),
    /// Compare two pictures, scenes or folders, and apply gates
    Diff(DiffArgs),
    /// Verify a picture against its metadata: render some tiles again
    Audit(Box<AuditArgs>),
    /// Prove the pixels of a picture of the course by interval arithmetic
    Certify(Box<CertifyArgs>),
    /// Show contents, size and required features of a scene
    Info(Box<InfoArgs>),
    /// Explain a code of a diagnostic, or list all codes
    Explain(ExplainArgs),
    /// Print the JSON Schema of a format
    Schema(SchemaArgs),
    /// Print a completion script for a shell
    Completions(CompletionsArgs),
    /// Print a manual page
    Man(ManArgs),
}

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// Write the scene to this file; `-` is standard output
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    /// Select the template
    #[arg(long, value_enum, default_value_t)]
    pub(super) template: TemplateArg,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum TemplateArg {
    /// Spheres, a light and shadows, in the format of the course
    #[default]
    Course,
    /// A path-traced scene with a sun and physical materials
    Path,
    /// A scene with a glTF model, which is written beside it
    Gltf,
    /// A scene for a turntable
    Turntable,
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("change").args(["fix", "diff"]).multiple(true))]
pub(super) struct CheckArgs {
    /// Scenes, folders of scenes, or patterns such as 'a/*.glb'; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) files: Vec<PathBuf>,
    /// Apply the suggested fixes that keep the meaning
    #[arg(long, help_heading = "Fixes")]
    pub(super) fix: bool,
    /// Print what `--fix` would change; write nothing
    #[arg(long, help_heading = "Fixes")]
    pub(super) diff: bool,
    /// With `--fix` or `--diff`: also apply fixes that are guesses
    #[arg(long = "unsafe", requires = "change", help_heading = "Fixes")]
    pub(super) guesses: bool,
    /// Skip YAML, JSON and XML files that do not look like scenes, as in folders
    ///
    /// A file looks like a scene if it names its schema, or has a top-level key of the format,
    /// possibly misspelt.
    #[arg(long, help_heading = "Input")]
    pub(super) skip_others: bool,
    /// Print a table with a row for each file, and a total
    #[arg(
        long,
        value_enum,
        value_name = "FORMAT",
        help_heading = "Output",
        conflicts_with = "diff"
    )]
    pub(super) table: Option<TableFormat>,
    #[command(flatten)]
    pub(super) reading: ReadArgs,
    #[command(flatten)]
    pub(super) reporter: ReporterArgs,
}

#[derive(Debug, Args)]
#[command(
    after_help = "The editor starts it, and exchanges messages over standard input and output.\n\n\
Example, for Helix (languages.toml):\n  [language-server.rtc]\n  command = \"rtc\"\n  args = [\"lsp\"]"
)]
pub(super) struct LspArgs {
    #[command(flatten)]
    pub(super) reading: ReadArgs,
}

#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    /// The scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    #[command(flatten)]
    pub(super) format: ReportFormatArgs,
    #[command(flatten)]
    pub(super) stage: StageArgs,
    #[command(flatten)]
    pub(super) reading: ReadArgs,
    #[command(flatten)]
    pub(super) reporter: ReporterArgs,
}

#[derive(Debug, Args)]
pub(super) struct CompileArgs {
    /// The scene; `-` is standard input
    ///
    /// Formats: YAML or JSON of the course, glTF, USD, Mitsuba XML, pbrt, mesh files, and the IR.
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(super) file: PathBuf,
    /// Write to this file; `-` is standard output
    ///
    /// [default: `-`, or nothing with `--explain`]
    #[arg(
        short,
        long,
        value_name = "FILE",
        value_hint = ValueHint::FilePath,
        help_heading = "Output",
    )]
    pub(super) output: Option<PathBuf>,
    /// Explain which effects the picture needs, and why it does not need the others
    #[arg(
        long,
        value_enum,
        value_name = "FORMAT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "table",
        help_heading = "Output",
    )]
    pub(super) explain: Option<Explanation>,
    /// Select the format [default: by the extension of the output, or `ir`]
    ///
    /// Extensions: .json, .rtir, .yaml, .glb, .gltf, .xml (Mitsuba), .pbrt, .pov.
    #[arg(long, value_enum, help_heading = "Output")]
    pub(super) emit: Option<Emit>,
    /// Store the hierarchy of boxes over the meshes in an .rtir, so that renders start sooner
    ///
    /// Pictures are the same. The file grows by about 6 bytes for each triangle.
    #[arg(long, help_heading = "Output")]
    pub(super) with_bvh: bool,
    /// Set the tolerance of tessellation for glTF, in scene units
    ///
    /// [default: a thousandth of the radius of each shape]
    #[arg(long, value_name = "LENGTH", value_parser = length, help_heading = "Output")]
    pub(super) tolerance: Option<f64>,
    #[command(flatten)]
    pub(super) stage: StageArgs,
    #[command(flatten)]
    pub(super) reading: ReadArgs,
    #[command(flatten)]
    pub(super) reporter: ReporterArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Explanation {
    /// A table
    #[value(alias = "human")]
    Table,
    /// One JSON object
    Json,
}

#[derive(Debug, Args)]
pub(super) struct ExplainArgs {
    /// A code such as VA001, or a rule such as E-SPEC [default: list both]
    pub(super) code: Option<String>,
    /// Print the pages of all codes, as Markdown
    #[arg(long, conflicts_with = "code")]
    pub(super) all: bool,
}

#[derive(Debug, Args)]
pub(super) struct SchemaArgs {
    /// The format
    #[arg(value_enum, default_value_t)]
    pub(super) of: SchemaFormat,
    /// The program whose scenes `support` is about [default: all]
    #[arg(value_enum)]
    pub(super) reader: Option<ReaderArg>,
}

/// A program whose scenes are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ReaderArg {
    /// Scenes of Mitsuba
    Mitsuba,
    /// Scenes of pbrt
    Pbrt,
    /// Stages of USD
    Usd,
}

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    pub(super) shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// The command that the page describes [default: all]
    pub(super) command: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Emit {
    /// The IR as text (JSON)
    Ir,
    /// The IR in its binary container
    IrBin,
    /// The scene, in canonical spelling
    Yaml,
    /// A binary glTF 2.0 asset: shapes become meshes
    Glb,
    /// The same as text, with vertices and images in a folder beside it
    Gltf,
    /// A scene of Mitsuba 3 (XML), with meshes in a folder beside it; warnings name approximations
    Mitsuba,
    /// A scene of pbrt-v4, with meshes in a folder beside it; warnings name approximations
    Pbrt,
    /// A scene of POV-Ray 3.7; warnings name approximations
    Pov,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum SchemaFormat {
    /// Scenes
    #[default]
    Scene,
    /// The text form of the IR
    Ir,
    /// The report of `rtc info --format json`
    Info,
    /// The report of `rtc cost --format json`, of one scene or of two
    Cost,
    /// The report of `rtc diff --format json`
    Diff,
    /// The report of `rtc audit --format json`
    Audit,
    /// The report of `rtc certify --format json`
    Certify,
    /// A line of `rtc check --message-format json`
    Check,
    /// The scene format, as a Markdown page
    Page,
    /// The resource limits of a run, as a Markdown page
    Limits,
    /// The supported glTF extensions, as a Markdown page
    Extensions,
    /// What is read of the scenes of Mitsuba, pbrt and USD, as a Markdown page
    Support,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_agree_with_each_other() {
        Cli::command().debug_assert();
    }
}
