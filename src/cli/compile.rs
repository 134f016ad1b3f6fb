//! `rtc compile`: a scene to the IR as text or binary, back to its canonical spelling, to glTF, or
//! to the files of other renderers.

use super::Failure;
use super::args::{CompileArgs, Emit, Explanation, MessageFormat};
use super::input;
use super::interrupt::Interrupt;
use super::output::{self, Output, SidecarFiles};
use super::report::PlanReport;
use super::reporter::Reporter;
use super::simd;
use rtc_codec::{self as codec, Encoding};
use rtc_emit as emit;
use rtc_emit::course::WrittenScene;
use rtc_image::{BackgroundFill, FileFormat};
use rtc_pipeline::{
    ExportFormat, Exposure, Input, OutputTransform, PictureSetup, ValidatedScene, store_tree,
};
use std::path::Path;

/// Compiles the scene and writes it.
pub(super) fn run(args: &CompileArgs) -> Result<(), Failure> {
    let target = target(args).unwrap_or(Path::new("-"));
    let emit = args.emit.map_or_else(|| by_extension(target), Ok)?;
    if matches!(emit, Emit::IrBin | Emit::Glb) {
        output::refuse_terminal(target)?;
    }
    if !matches!(emit, Emit::Glb | Emit::Gltf) && args.tolerance.is_some() {
        let message = "`--tolerance` is about the meshes of glTF; name the output .glb or .gltf";
        return Err(Failure::Failed(message.to_owned()));
    }
    if emit != Emit::IrBin && args.with_bvh {
        let message = "`--with-bvh` is about the binary IR; name the output .rtir";
        return Err(Failure::Failed(message.to_owned()));
    }
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = carry_out(args, emit, &mut reporter);
    reporter.finish()?;
    outcome
}

fn carry_out(args: &CompileArgs, emit: Emit, reporter: &mut Reporter) -> Result<(), Failure> {
    let input = input::staged(&args.file, &args.reading, &args.stage)?;
    match emit {
        Emit::Ir => carry_out_ir(args, Encoding::Json, input, reporter),
        Emit::IrBin => carry_out_ir(args, Encoding::Binary, input, reporter),
        Emit::Yaml => carry_out_text(args, input, reporter),
        Emit::Glb | Emit::Gltf => carry_out_gltf(args, emit, input, reporter),
        Emit::Mitsuba => carry_out_exported(args, ExportFormat::Mitsuba, input, reporter),
        Emit::Pbrt => carry_out_exported(args, ExportFormat::Pbrt, input, reporter),
        Emit::Pov => carry_out_exported(args, ExportFormat::Pov, input, reporter),
    }
}

/// Writes the IR.
fn carry_out_ir(
    args: &CompileArgs,
    encoding: Encoding,
    mut input: Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let mut validated = displayed(&mut input, &interrupt, reporter)?;
    explain(args, &validated, &input)?;
    let Some(target) = target(args) else {
        return Ok(());
    };
    if args.with_bvh {
        store_tree(&mut validated)?;
    }
    let scene = &validated.lowered.scene;
    let encoded = match args.with_bvh {
        true => codec::prepare_with_trees(scene),
        false => codec::prepare(encoding, scene),
    };
    let encoded =
        encoded.map_err(|codec::NonFiniteNumber| cannot(&input, "a number is not finite"))?;
    Output::open(target, &input)?.commit_by(&|out| encoded.write(out), &interrupt)
}

/// Writes the scene as glTF, and beside a text the files that it names.
fn carry_out_gltf(
    args: &CompileArgs,
    emit: Emit,
    mut input: Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let validated = displayed(&mut input, &interrupt, reporter)?;
    explain(args, &validated, &input)?;
    let Some(target) = target(args) else {
        return Ok(());
    };
    let output = Output::open(target, &input)?;
    let folder = folder_of((emit == Emit::Gltf).then_some(target), &output, &input)?;
    let asset = input.gltf(&validated.lowered, args.tolerance, folder.as_deref());
    let asset = input::unless_refused(asset, &mut input, reporter)?;
    let companions = write_sidecar(target, asset.files(), &interrupt)?;
    output.commit_by(&|out| asset.write(out), &interrupt)?;
    companions.keep();
    Ok(())
}

/// Why a text with files beside it is not written to standard output.
const NO_FOLDER: &str = "its vertices and images are files beside the text: give `-o FILE`";

/// Writes the scene for another renderer in the light of its picture, which the studio may fill in,
/// with its files beside it.
fn carry_out_exported(
    args: &CompileArgs,
    format: ExportFormat,
    mut input: Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    // The exposure is not written, so it need not be measured.
    let exposure = Some(Exposure::Stops(0.0));
    let (_, validated) = lit(exposure, &mut input, &interrupt, reporter)?;
    explain(args, &validated, &input)?;
    let Some(target) = target(args) else {
        return Ok(());
    };
    let output = Output::open(target, &input)?;
    let folder = match format == ExportFormat::Pov {
        true => output.sidecar_folder(target),
        false => folder_of(Some(target), &output, &input)?,
    };
    let exported = input.export(&validated.lowered, format, folder.as_deref());
    let exported = input::unless_refused(exported, &mut input, reporter)?;
    let files = exported.files.iter();
    let files = files.map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
    let companions = write_sidecar(target, files, &interrupt)?;
    output.commit(exported.text.as_bytes(), &interrupt)?;
    companions.keep();
    Ok(())
}

/// The scene in the light of its picture, with the output transform that was found.
fn lit(
    exposure: Option<Exposure>,
    input: &mut Input,
    interrupt: &Interrupt,
    reporter: &mut Reporter,
) -> Result<(OutputTransform, ValidatedScene), Failure> {
    let look = OutputTransform::new(FileFormat::Png8, None, exposure, BackgroundFill::Film, &[]);
    let mut setup = PictureSetup {
        simd: simd::level()?,
        ..PictureSetup::new(look.map_err(|message| Failure::Failed(message.to_owned()))?)
    };
    let mut subject = input::subject(&mut setup, input, reporter)?;
    input::light(&mut setup, &mut subject, input, interrupt, reporter)?;
    Ok((setup.look, subject.validated))
}

/// The scene in the light of its picture and with its display settings: what is compiled is
/// rendered
/// to the same picture, which an asset does not determine alone.
fn displayed(
    input: &mut Input,
    interrupt: &Interrupt,
    reporter: &mut Reporter,
) -> Result<ValidatedScene, Failure> {
    let (look, mut validated) = lit(None, input, interrupt, reporter)?;
    validated.lowered.scene.display = look.as_display();
    Ok(validated)
}

/// The name of the folder of files beside a target, if it has one.
fn folder_of(
    target: Option<&Path>,
    output: &Output,
    input: &Input,
) -> Result<Option<String>, Failure> {
    let folder = |target| {
        let folder = output.sidecar_folder(target);
        folder.ok_or_else(|| cannot(input, NO_FOLDER))
    };
    target.map(folder).transpose()
}

/// Writes the files beside a target, by their paths from its folder.
fn write_sidecar<'f>(
    target: &Path,
    files: impl IntoIterator<Item = (&'f str, &'f [u8])>,
    interrupt: &Interrupt,
) -> Result<SidecarFiles, Failure> {
    let mut companions = SidecarFiles::beside(target);
    for (name, bytes) in files {
        companions.put(name, bytes, interrupt)?;
    }
    Ok(companions)
}

/// Writes the scene in its canonical spelling.
fn carry_out_text(
    args: &CompileArgs,
    mut input: Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let validated = displayed(&mut input, &interrupt, reporter)?;
    explain(args, &validated, &input)?;
    match target(args) {
        Some(target) => write_text(args, target, &validated, &input, &interrupt),
        None => Ok(()),
    }
}

/// Reports the plan, if requested.
fn explain(args: &CompileArgs, validated: &ValidatedScene, input: &Input) -> Result<(), Failure> {
    let Some(form) = args.explain else {
        return Ok(());
    };
    let form = if args.reporter.message_format == MessageFormat::Json {
        Explanation::Json
    } else {
        form
    };
    let text = PlanReport::new(validated, input)?.print(form);
    match form {
        Explanation::Json => output::print_json(&text),
        Explanation::Table => output::print(&text),
    }
}

/// Writes the scene in its canonical spelling, and beside it the files that it needs: a text in the
/// folder of a scene text finds those of that.
fn write_text(
    args: &CompileArgs,
    target: &Path,
    validated: &ValidatedScene,
    input: &Input,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let scene = &validated.lowered.scene;
    let output = Output::open(target, input)?;
    let refuse = |reason: String| cannot(input, &reason);
    let folder = output.sidecar_folder(target);
    let has_files = input.has_original_files(&validated.lowered);
    if has_files && (folder.is_none() || is_beside(target, &args.file)) {
        let text = emit::course::emit(scene).map_err(refuse)?;
        return output.commit(text.as_bytes(), interrupt);
    }
    let written = match &folder {
        Some(folder) => emit::course::emit_elsewhere(scene, folder),
        None => emit::course::emit_with_files(scene, None),
    };
    let WrittenScene { text, files } = written.map_err(refuse)?;
    let mut companions = SidecarFiles::beside(target);
    for file in &files {
        let bytes = file.bytes().map_err(refuse)?;
        companions.put(&file.name, &bytes, interrupt)?;
    }
    output.commit(text.as_bytes(), interrupt)?;
    companions.keep();
    Ok(())
}

/// Whether two files are in one folder.
fn is_beside(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| {
        let folder = path.parent().unwrap_or(Path::new(""));
        Path::new(".").join(folder).canonicalize().ok()
    };
    folder(a) == folder(b)
}

fn cannot(input: &Input, reason: &str) -> Failure {
    Failure::Input(format!("`{}` can't be written so: {reason}", input.name()))
}

/// The destination of the IR, if any: an explanation goes to standard output instead.
fn target(args: &CompileArgs) -> Option<&Path> {
    let default = args.explain.is_none().then_some(Path::new("-"));
    args.output.as_deref().or(default)
}

fn by_extension(output: &Path) -> Result<Emit, Failure> {
    if output::is_stdout(output) {
        return Ok(Emit::Ir);
    }
    let name = output.to_string_lossy();
    match ExportFormat::of(&name) {
        Some(ExportFormat::Ir) => Ok(Emit::Ir),
        Some(ExportFormat::IrBinary) => Ok(Emit::IrBin),
        Some(ExportFormat::Text) => Ok(Emit::Yaml),
        Some(ExportFormat::Glb) => Ok(Emit::Glb),
        Some(ExportFormat::Gltf) => Ok(Emit::Gltf),
        Some(ExportFormat::Mitsuba) => Ok(Emit::Mitsuba),
        Some(ExportFormat::Pbrt) => Ok(Emit::Pbrt),
        Some(ExportFormat::Pov) => Ok(Emit::Pov),
        None => Err(Failure::Failed(format!(
            "unknown format `{}`; use {}, or give `--emit`",
            output.display(),
            ExportFormat::extensions()
        ))),
    }
}
