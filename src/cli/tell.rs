//! What rtc tells about itself: `rtc schema`, `rtc completions`, `rtc man`.

use super::args::{Cli, Completions, Man, Schema, SchemaFormat};
use super::{Failure, output};
use clap::CommandFactory;
use rtc_codec as codec;
use rtc_front::{course, gltf};
use rtc_source::budget;

/// Prints the JSON Schema of a format, or its page.
pub(super) fn schema(args: &Schema) -> Result<(), Failure> {
    let text = match args.of {
        SchemaFormat::Scene => format!("{:#}\n", course::schema()),
        SchemaFormat::Ir => format!("{:#}\n", codec::schema()),
        SchemaFormat::Page => course::page(),
        SchemaFormat::Limits => budget::page(),
        SchemaFormat::Extensions => gltf::extensions(),
    };
    output::to_stdout(text.as_bytes())
}

/// Prints a completion script.
pub(super) fn completions(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "rtc", &mut script);
    output::to_stdout(&script)
}

/// Prints the manual page of rtc or of one of its commands.
pub(super) fn man(args: &Man) -> Result<(), Failure> {
    let mut rtc = Cli::command();
    rtc.build();
    let command = match &args.command {
        Some(name) => rtc.find_subcommand(name).cloned(),
        None => Some(rtc),
    };
    let command = command.ok_or_else(|| {
        Failure::Trouble("there is no such command; `rtc help` lists them".to_owned())
    })?;
    // The head of a page is one line.
    let command = command.version(env!("CARGO_PKG_VERSION"));
    let mut page = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(|error| Failure::Trouble(error.to_string()))?;
    output::to_stdout(&page)
}
