//! `rtc compile`: a scene to the IR as text or binary, or back to its canonical spelling.

use super::Failure;
use super::args::{Compile, Emit};
use super::input::{self, Input};
use super::interrupt::Interrupt;
use super::output::{self, Output};
use super::talk::Talk;
use crate::codec::{self, Form};
use crate::front::course;
use crate::ir::Scene;
use std::path::Path;

/// Compiles the scene and writes it.
pub(super) fn run(args: &Compile) -> Result<(), Failure> {
    let emit = args.emit.map_or_else(|| by_extension(&args.output), Ok)?;
    if emit == Emit::IrBin {
        output::refuse_terminal(&args.output)?;
    }
    let mut talk = Talk::beside_result(&args.talk);
    let outcome = carry_out(args, emit, &mut talk);
    talk.finish()?;
    outcome
}

fn carry_out(args: &Compile, emit: Emit, talk: &mut Talk) -> Result<(), Failure> {
    let mut input = Input::read(&args.file, &args.reading);
    let proven = input::require(&mut input, talk, |_| ())?;
    let bytes = encode(emit, &proven.lowered.scene)
        .map_err(|reason| Failure::Input(format!("`{}` can't be written so: {reason}", input.name())))?;
    let interrupt = Interrupt::listen()?;
    Output::open(&args.output, &interrupt)?.commit(&bytes, &interrupt)
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

fn encode(emit: Emit, scene: &Scene) -> Result<Vec<u8>, String> {
    let ir = |form| codec::encode(form, scene).map_err(|codec::NotFinite| "a number is not finite".to_owned());
    match emit {
        Emit::Ir => ir(Form::Text),
        Emit::IrBin => ir(Form::Binary),
        Emit::Yaml => course::emit(scene).map(String::into_bytes),
    }
}
