//! `rtc compile`: a scene to the IR as text or binary, or back to its canonical spelling.

use super::Failure;
use super::args::{Compile, Emit, Explanation, MessageFormat};
use super::input::{self, Input};
use super::interrupt::Interrupt;
use super::output::{self, Output};
use super::report::PlanReport;
use super::talk::Talk;
use crate::codec::{self, Form};
use crate::emit;
use crate::ir::Scene;
use std::io::{self, Write};
use std::path::Path;

/// Compiles the scene and writes it.
pub(super) fn run(args: &Compile) -> Result<(), Failure> {
    let target = target(args).unwrap_or(Path::new("-"));
    let emit = args.emit.map_or_else(|| by_extension(target), Ok)?;
    if emit == Emit::IrBin {
        output::refuse_terminal(target)?;
    }
    let mut talk = Talk::beside_result(&args.talk);
    let outcome = carry_out(args, emit, &mut talk);
    talk.finish()?;
    outcome
}

fn carry_out(args: &Compile, emit: Emit, talk: &mut Talk) -> Result<(), Failure> {
    let mut input = Input::staged(&args.file, &args.reading, &args.stage)?;
    let proven = input::require(&mut input, talk, input::fill)?;
    if let Some(form) = args.explain {
        let form = if args.talk.message_format == MessageFormat::Json {
            Explanation::Json
        } else {
            form
        };
        output::to_stdout(PlanReport::new(&proven, &input)?.print(form).as_bytes())?;
    }
    let Some(target) = target(args) else {
        return Ok(());
    };
    let write = writer(emit, &proven.lowered.scene).map_err(|reason| {
        Failure::Input(format!("`{}` can't be written so: {reason}", input.name()))
    })?;
    let interrupt = Interrupt::listen()?;
    Output::open(target, &input)?.commit_by(&write, &interrupt)
}

/// Where the IR goes, if anywhere: an explanation takes its place on standard output.
fn target(args: &Compile) -> Option<&Path> {
    let default = args.explain.is_none().then_some(Path::new("-"));
    args.output.as_deref().or(default)
}

fn by_extension(output: &Path) -> Result<Emit, Failure> {
    if output.as_os_str() == "-" {
        return Ok(Emit::Ir);
    }
    match output.extension().and_then(|extension| extension.to_str()) {
        Some("json") => Ok(Emit::Ir),
        Some("rtir") => Ok(Emit::IrBin),
        Some("yaml" | "yml") => Ok(Emit::Yaml),
        _ => Err(Failure::Trouble(format!(
            "can't tell from `{}` what to write; name it .json, .rtir or .yaml, or give `--emit`",
            output.display()
        ))),
    }
}

/// What writes the scene in this form.
fn writer(emit: Emit, scene: &Scene) -> Result<impl Fn(&mut dyn Write) -> io::Result<()>, String> {
    let ir = |form| {
        codec::prepare(form, scene).map_err(|codec::NotFinite| "a number is not finite".to_owned())
    };
    let (encoded, text) = match emit {
        Emit::Ir => (Some(ir(Form::Text)?), String::new()),
        Emit::IrBin => (Some(ir(Form::Binary)?), String::new()),
        Emit::Yaml => (None, emit::course::emit(scene)?),
    };
    Ok(move |out: &mut dyn Write| match &encoded {
        Some(encoded) => encoded.write(out),
        None => out.write_all(text.as_bytes()),
    })
}
