//! `rtc cost SCENE REFERENCE`: the cost and the picture of a scene against another, with gates.

use super::Failure;
use super::args::{self, StudyFormat};
use super::cost::{about, threads, with_progress};
use super::gate::{self, GateResult};
use super::input;
use super::interrupt::Interrupt;
use super::output::Output;
use super::reporter::Reporter;
use rtc_ir::Scene;
use rtc_pipeline::Input;
use rtc_study::{SceneComparison, Stopped, StudyProvenance, versus, versus_table};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

/// The JSON report of a comparison.
#[derive(Serialize, JsonSchema)]
pub(super) struct VersusReport<'a> {
    #[serde(flatten)]
    found: &'a SceneComparison,
    /// The gates of `--gate`, in their order.
    gates: &'a [GateResult],
}

/// Compares the scenes and writes the report.
pub(super) fn run(args: &args::CostArgs, files: [&Path; 2]) -> Result<(), Failure> {
    refuse_others(args, files)?;
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = carry_out(args, files, &mut reporter);
    reporter.finish()?;
    outcome
}

/// Rejects options for the study of one scene.
fn refuse_others(args: &args::CostArgs, files: [&Path; 2]) -> Result<(), Failure> {
    let refused = if args.html.is_some() {
        "`--html` is for the study of one scene"
    } else if args.maps.is_some() {
        "`--maps` is for the study of one scene"
    } else if args.checkpoint.is_some() {
        "`--checkpoint` is for the study of one scene"
    } else if args.format == StudyFormat::Csv {
        "`--format csv` is for the study of one scene; of two there is `json`"
    } else if files.iter().all(|file| file.as_os_str() == "-") {
        "standard input is one scene; give a file for the other"
    } else {
        return Ok(());
    };
    Err(Failure::Failed(refused.to_owned()))
}

fn carry_out(
    args: &args::CostArgs,
    files: [&Path; 2],
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    // Validate both scenes; their pictures have one size.
    let [first, second] = files.map(|file| input::staged(file, &args.reading, &args.stage));
    let mut inputs = [first?, second?];
    let [first, second] = &mut inputs;
    let (first, second) = (validated(first, reporter)?, validated(second, reporter)?);
    let interrupt = Interrupt::listen()?;
    let [a, b] = [&first.1, &second.1].map(|scene| scene.camera.size);
    if a != b {
        let message = "pictures of one size are compared";
        return Err(Failure::Input(format!(
            "{message}: `{}` has {} × {} pixels, `{}` {} × {}",
            first.0.scene, a[0], a[1], second.0.scene, b[0], b[1]
        )));
    }
    // The report may replace neither scene.
    let output = Output::open(&args.output, &inputs[0])?;
    if args.output.as_path() != Path::new("-") {
        Output::open(&args.output, &inputs[1])?;
    }
    // Measure the scenes.
    let (scenes, abouts) = ([&first.1, &second.1], [first.0.clone(), second.0.clone()]);
    let found = with_progress(threads(args), (&interrupt, reporter), |runtime| {
        versus(scenes, abouts, args.effort.into(), args.seed, &runtime)
    })?;
    let found = found.map_err(|Stopped| Failure::Interrupted)?;
    // Compare with the limits and write the report.
    let gates = args.gate.as_ref();
    let results = gates.map_or_else(Vec::new, |gates| {
        gates.results(|name| measure(&found, name))
    });
    let report = match args.format {
        StudyFormat::Json => json(&found, &results)?,
        StudyFormat::Table | StudyFormat::Csv => versus_table(&found),
    };
    output.commit(report.as_bytes(), &interrupt)?;
    gate::pass(&results, reporter.is_quiet())
}

/// A validated scene with its diagnostics.
fn validated(
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<(StudyProvenance, Scene), Failure> {
    input.lift_rays();
    let validated = input::require(input, reporter, input::fill)?;
    let scene = validated.lowered.scene.clone();
    Ok((about(input.name(), &scene), scene))
}

fn measure(found: &SceneComparison, name: &str) -> f64 {
    match name {
        "error" => found.error.value,
        "time" => found.time.value,
        "rays" => found.ratio_of_rays(),
        _ => found.ratio_of_noise(),
    }
}

fn json(found: &SceneComparison, gates: &[GateResult]) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(&VersusReport { found, gates });
    text.map(|text| text + "\n")
        .map_err(|error| Failure::Failed(error.to_string()))
}
