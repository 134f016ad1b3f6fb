//! The input of a command: a scene from a file or standard input, as the arguments say.

use super::Failure;
use super::args::{self, GroundArg, ReadArgs};
use super::interrupt::Interrupt;
use super::project::Project;
use super::reporter::Reporter;
use rtc_front as front;
use rtc_ir::LoweredScene;
use rtc_passes::{
    self as passes, EnvironmentOverride, FillLight, StudioChoice, View, ViewAndLight,
};
use rtc_pipeline::{
    Input, LoadedScene, Options, PictureSetup, Provenance, RenderError, RenderObserver,
    RenderSubject, ValidatedScene,
};
use rtc_source::EditedFiles;
use rtc_valid as valid;
use std::io;
use std::path::Path;

/// Reads the file at `path`, or standard input if it is `-`.
pub(super) fn read(path: &Path, reading: &ReadArgs) -> Result<Input, Failure> {
    read_as(path, reading, false)
}

/// The same, with a record of what is read if `is_recorded`.
fn read_as(path: &Path, reading: &ReadArgs, is_recorded: bool) -> Result<Input, Failure> {
    let project = Project::of(path, reading)?;
    let options = Options {
        is_recorded,
        ..options(reading, project.as_ref())?
    };
    let mut input = open(path, reading.stdin_name.as_deref(), options);
    if let Some(project) = project {
        project.report_diagnostics(&mut input);
    }
    Ok(input)
}

/// Reads the file at `path`, or standard input for `-`, without an `rtc.toml`.
pub(super) fn open(path: &Path, stdin_name: Option<&str>, options: Options) -> Input {
    if path.as_os_str() == "-" {
        let name = stdin_name.unwrap_or("<stdin>").to_owned();
        Input::reader(name, io::stdin().lock(), options)
    } else {
        Input::file(path, options)
    }
}

/// The input options before the `rtc.toml` of the project.
pub(super) fn options(reading: &ReadArgs, project: Option<&Project>) -> Result<Options, Failure> {
    let ReadArgs {
        stdin_name: _,
        strict,
        lenient,
        asset_root,
        up_axis,
        point_size,
        time,
        animation,
        variant,
        camera,
        define,
        allow: _,
        warn: _,
        deny: _,
        limit: _,
        allow_huge: _,
        trust_project: _,
    } = reading;
    // What is typed comes before the settings of the project.
    let typed = reading.levels().map_err(Failure::Failed)?;
    let levels = project.map_or_else(|| typed.clone(), |own| own.levels(typed.clone()));
    let lent = || project.and_then(Project::asset_root);
    Ok(Options {
        front: front::FrontOptions {
            strict: *strict,
            lenient: *lenient,
            asset_root: asset_root.clone().or_else(lent),
            home: std::env::home_dir(),
            time: *time,
            animation: animation.clone(),
            variant: variant.clone(),
            camera: camera.clone(),
            point_size: *point_size,
            define: define.iter().cloned().collect(),
            up_axis: up_axis
                .map(Into::into)
                .or_else(|| project.and_then(Project::up_axis)),
            threads: 0,
        },
        valid: valid::ValidationOptions {
            limits: reading
                .limits(|limits| project.into_iter().for_each(|own| own.set_limits(limits))),
        },
        levels,
        edited: EditedFiles::default(),
        is_recorded: false,
    })
}

/// Reads the file at `path`, or standard input if it is `-`, to be shown in the view and the
/// light given.
pub(super) fn staged(
    path: &Path,
    reading: &ReadArgs,
    stage: &args::StageArgs,
) -> Result<Input, Failure> {
    set_stage(read(path, reading)?, stage)
}

/// The same, with a record of what is read, for a cache.
pub(super) fn staged_and_recorded(
    path: &Path,
    reading: &ReadArgs,
    stage: &args::StageArgs,
) -> Result<Input, Failure> {
    set_stage(read_as(path, reading, true)?, stage)
}

/// Has an input shown in the view and the light given.
pub(super) fn set_stage(mut input: Input, stage: &args::StageArgs) -> Result<Input, Failure> {
    let args::StageArgs {
        eye,
        center,
        up,
        yfov,
        orbit,
        env,
        env_color,
        sun,
        no_scene_lights,
        studio,
        ground,
        integrator,
    } = stage;
    // Read the environment image.
    let environment = match env {
        Some(path) => input.environment(path).map_err(Failure::Failed)?,
        None => env_color.map(EnvironmentOverride::Color),
    };
    // Override the view and the light of the scene.
    input.stage(ViewAndLight {
        view: View {
            eye: *eye,
            center: *center,
            up: *up,
            yfov: *yfov,
            orbit: *orbit,
        },
        integrator: integrator.map(Into::into),
        environment,
        suns: sun.clone(),
        without_lights: *no_scene_lights,
        all_around: false,
        studio: studio.map_or_else(StudioChoice::default, Into::into),
        ground: ground.map(|ground| ground == GroundArg::On),
    });
    Ok(input)
}

/// Reports new diagnostics, and fails if there are errors.
pub(super) fn report_diagnostics(
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let sink = input.take_diagnostics();
    let status = match input.is_read() {
        false => Err(Failure::Unreadable),
        true if sink.has_errors() => Err(Failure::Reported),
        true => Ok(()),
    };
    reporter.file(input.name(), sink, input.map())?;
    status
}

/// Lights the scene of a picture that needs light, and reports the diagnostics.
pub(super) fn light(
    setup: &mut PictureSetup,
    subject: &mut RenderSubject,
    input: &mut Input,
    interrupt: &Interrupt,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let observer = RenderObserver {
        on_step: &|_| (),
        is_stopped: &|| interrupt.is_raised(),
    };
    match setup.light(subject, input, &observer) {
        Ok(()) => report_diagnostics(input, reporter),
        Err(error) => halted(error, input, reporter),
    }
}

/// Ends a command with an unfinished render: exceeding the ray limit is a diagnostic of the scene.
pub(super) fn halted(
    error: RenderError,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    match error {
        RenderError::RanOut(diagnostic) => {
            input.push(*diagnostic);
            report_diagnostics(input, reporter)
        }
        error @ (RenderError::Stopped | RenderError::Refused(_)) => Err(error.into()),
    }
}

/// Validates a scene, and reports the diagnostics.
pub(super) fn require(
    input: &mut Input,
    reporter: &mut Reporter,
    change: impl FnOnce(&mut LoweredScene, &Provenance),
) -> Result<ValidatedScene, Failure> {
    let validated = input
        .load()
        .and_then(|loaded| input.validate(loaded, change));
    unless_refused(validated, input, reporter)
}

/// Whether a file is a picture, by its name.
pub(super) fn is_picture(path: &Path) -> bool {
    const PICTURES: [&str; 6] = ["png", "jpg", "jpeg", "webp", "exr", "hdr"];
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    PICTURES
        .iter()
        .any(|kind| extension.eq_ignore_ascii_case(kind))
}

/// The validated scene in the requested settings; its diagnostics are reported.
pub(super) fn subject(
    setup: &mut PictureSetup,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<RenderSubject, Failure> {
    let subject = match input.load() {
        Some(loaded) => setup.validate(loaded, input),
        None => Ok(None),
    };
    reported_subject(subject, input, reporter)
}

/// The scene of an input before its overrides; its diagnostics are reported.
pub(super) fn load(input: &mut Input, reporter: &mut Reporter) -> Result<LoadedScene, Failure> {
    let loaded = input.load();
    unless_refused(loaded, input, reporter)
}

/// A loaded scene in the requested settings; its diagnostics are reported.
pub(super) fn validated(
    setup: &mut PictureSetup,
    loaded: LoadedScene,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<RenderSubject, Failure> {
    let subject = setup.validate(loaded, input);
    reported_subject(subject, input, reporter)
}

/// The subject of a picture, if there is one; its diagnostics are reported.
fn reported_subject(
    subject: Result<Option<RenderSubject>, RenderError>,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<RenderSubject, Failure> {
    match subject {
        Ok(subject) => unless_refused(subject, input, reporter),
        Err(error) => {
            report_diagnostics(input, reporter)?;
            Err(error.into())
        }
    }
}

/// The result of a step, after its diagnostics are reported; an error if the input was rejected.
pub(super) fn unless_refused<T>(
    made: Option<T>,
    input: &mut Input,
    reporter: &mut Reporter,
) -> Result<T, Failure> {
    report_diagnostics(input, reporter)?;
    Ok(made.expect("what is refused has an error in the sink, and `tell` has returned it"))
}

/// Adds the studio as a fill light if requested, for commands that do not measure the scene's own
/// light.
pub(super) fn fill(lowered: &mut LoweredScene, provenance: &Provenance) {
    if provenance.fill == FillLight::Always {
        passes::fill(&mut lowered.scene, 0.0);
    }
}
