//! The descriptions of rtc itself: `rtc schema`, `rtc completions`, `rtc man`.

use super::args::{Cli, CompletionsArgs, ManArgs, ReaderArg, SchemaArgs, SchemaFormat};
use super::audit::AuditReport;
use super::certify::CertificateReport;
use super::diff::DiffReport;
use super::info::InfoReport;
use super::versus::VersusReport;
use super::{Failure, output};
use clap::CommandFactory;
use rtc_codec as codec;
use rtc_diag::json_schema;
use rtc_front::{ForeignFormat, course, gltf, support_page};
use rtc_source::budget;
use rtc_study::Study;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;

/// Prints the JSON Schema of a format, or its page.
pub(super) fn schema(args: &SchemaArgs) -> Result<(), Failure> {
    if args.reader.is_some() && args.of != SchemaFormat::Support {
        let message = "the name of a program belongs to `rtc schema support`";
        return Err(Failure::Failed(message.to_owned()));
    }
    let text = match args.of {
        SchemaFormat::Scene => format!("{:#}\n", course::schema()),
        SchemaFormat::Ir => format!("{:#}\n", codec::schema()),
        SchemaFormat::Info => of_report::<InfoReport<'_>>(),
        SchemaFormat::Cost => of_report::<CostReport<'_>>(),
        SchemaFormat::Diff => of_report::<DiffReport<'_>>(),
        SchemaFormat::Audit => of_report::<AuditReport>(),
        SchemaFormat::Certify => of_report::<CertificateReport>(),
        SchemaFormat::Check => format!("{:#}\n", json_schema(settings()).to_value()),
        SchemaFormat::Page => course::page(),
        SchemaFormat::Limits => budget::page(),
        SchemaFormat::Extensions => gltf::extensions(),
        SchemaFormat::Support => support(args.reader),
    };
    output::to_stdout(text.as_bytes())
}

/// The page about one format of another program, or about all.
fn support(reader: Option<ReaderArg>) -> String {
    match reader {
        Some(ReaderArg::Mitsuba) => support_page(&[ForeignFormat::Mitsuba]),
        Some(ReaderArg::Pbrt) => support_page(&[ForeignFormat::Pbrt]),
        Some(ReaderArg::Usd) => support_page(&[ForeignFormat::Usd]),
        None => support_page(&ForeignFormat::ALL),
    }
}

/// The report of `rtc cost`: the study of one scene, or the comparison of two.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(
    dead_code,
    clippy::large_enum_variant,
    reason = "only its schema is used"
)]
enum CostReport<'a> {
    Study(Study),
    Versus(VersusReport<'a>),
}

/// The schema describes the written form: a key that may be null is always present.
fn settings() -> SchemaSettings {
    SchemaSettings::draft2020_12().for_serialize()
}

fn of_report<T: JsonSchema>() -> String {
    let schema = settings().into_generator().into_root_schema_for::<T>();
    format!("{:#}\n", schema.to_value())
}

/// Prints a completion script.
pub(super) fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "rtc", &mut script);
    output::to_stdout(&script)
}

/// Prints the manual page of rtc or of one of its commands.
pub(super) fn man(args: &ManArgs) -> Result<(), Failure> {
    let mut rtc = Cli::command();
    rtc.build();
    let command = match &args.command {
        Some(name) => rtc.find_subcommand(name).cloned(),
        None => Some(rtc),
    };
    let command = command.ok_or_else(|| {
        Failure::Failed("there is no such command; `rtc help` lists them".to_owned())
    })?;
    // The head of a page is one line.
    let command = command.version(env!("CARGO_PKG_VERSION"));
    let mut page = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(|error| Failure::Failed(error.to_string()))?;
    output::to_stdout(&page)
}
