//! Two scenes: the differences of their IR, and their pictures from the camera of the new scene.

use super::super::Failure;
use super::super::args::DiffArgs;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::super::render::ended;
use super::super::reporter::Reporter;
use super::super::{input, simd};
use super::{ComparedInputs, DiffOutputs, report};
use rtc_codec::{ValueChange, changes};
use rtc_image::{BackgroundFill, DisplayedPicture, FileFormat, Picture};
use rtc_ir::{Camera, LoweredScene, Scene};
use rtc_passes::{Framing, ViewAndLight};
use rtc_pipeline::{
    Input, LoadedScene, OutputTransform, PictureSetup, RenderObserver, RenderSubject,
};
use rtc_render::Film;
use rtc_study::Difference;
use std::path::Path;

/// A scene to be compared, as its picture is set up.
struct ComparedScene {
    input: Input,
    setup: PictureSetup,
    subject: RenderSubject,
}

/// Compares two scenes, and reports the differences.
pub(super) fn run(args: &DiffArgs, reporter: &mut Reporter) -> Result<(), Failure> {
    if [&args.new, &args.old]
        .iter()
        .all(|file| file.as_os_str() == "-")
    {
        let message = "standard input is one scene; give a file for the other";
        return Err(Failure::Failed(message.to_owned()));
    }
    let interrupt = Interrupt::listen()?;
    let mut pair = ScenePair::read(args, [&args.new, &args.old], true, reporter)?;
    let open = |path: &Option<_>| {
        let path: Option<&Path> = path.as_deref();
        let open = |path: &Path| {
            Output::open(path, &pair.old.input)?;
            Output::open(path, &pair.new.input)
        };
        path.map(open).transpose()
    };
    let outputs = DiffOutputs {
        map: open(&args.output)?,
        page: open(&args.html)?,
    };
    let [first, second] = pair.pictures(reporter, &interrupt)?;
    let compared = ComparedInputs {
        pictures: Some([&first, &second]),
        size: first.size(),
        changes: Some(&pair.changes),
    };
    report(
        args,
        outputs,
        &compared,
        (pair.new.input.map(), reporter),
        &interrupt,
    )
}

/// How the pictures of two scenes differ, whose diagnostics are reported.
pub(super) fn difference(
    paths: [&Path; 2],
    args: &DiffArgs,
    reporter: &mut Reporter,
    interrupt: &Interrupt,
) -> Result<Difference, Failure> {
    let mut pair = ScenePair::read(args, paths, false, reporter)?;
    let [new, old] = pair.pictures(reporter, interrupt)?;
    Ok(Difference::of(&new, &old, args.levels))
}

/// Two scenes, which one camera sees, and what differs in them.
struct ScenePair {
    new: ComparedScene,
    old: ComparedScene,
    changes: Vec<ValueChange>,
}

impl ScenePair {
    /// Reads the scenes, the new one first, and reports their diagnostics. The changes are found
    /// where they are told.
    fn read(
        args: &DiffArgs,
        paths: [&Path; 2],
        tells_changes: bool,
        reporter: &mut Reporter,
    ) -> Result<Self, Failure> {
        // What differs is told of the scenes as they are written, without the view and the studio
        // that an asset gets.
        let new = read(args, paths[0], reporter)?;
        let mut old = read(args, paths[1], reporter)?;
        if !new.1.has_camera() && !old.1.has_camera() {
            old.1.lowered.scene.camera = new.1.lowered.scene.camera.clone();
        }
        let changes = tells_changes.then(|| changes(&new.1.lowered.scene, &old.1.lowered.scene));
        let mut new = ComparedScene::validate(args, new, None, reporter)?;
        let mut old = ComparedScene::validate(args, old, Some(new.size()), reporter)?;
        let changes = changes.map_or_else(Vec::new, |found| {
            found.expect("proven scenes hold finite numbers only")
        });
        if let Some(camera) = shared_view(&new, &old) {
            new.see_by(&camera)?;
        }
        old.see_by(&new.scene().camera)?;
        Ok(Self { new, old, changes })
    }

    /// The pictures of both.
    fn pictures(
        &mut self,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<[DisplayedPicture; 2], Failure> {
        let new = self.new.picture(reporter, interrupt)?;
        Ok([new, self.old.picture(reporter, interrupt)?])
    }
}

/// Reads a scene, to be lit and framed as `rtc render` does, and reports its diagnostics.
fn read(
    args: &DiffArgs,
    file: &Path,
    reporter: &mut Reporter,
) -> Result<(Input, LoadedScene), Failure> {
    let mut input = input::read(file, &args.reading)?;
    input.stage(ViewAndLight::default());
    let loaded = input::load(&mut input, reporter)?;
    Ok((input, loaded))
}

/// The view of both scenes, if the new one has no camera.
fn shared_view(new: &ComparedScene, old: &ComparedScene) -> Option<Camera> {
    let framing = Framing {
        size: Some(new.size()),
        ..new.subject.framing()?
    };
    let old_framing = old.subject.framing().unwrap_or_default();
    framing.camera(&[subject(framing, new), subject(old_framing, old)])
}

/// What is framed of a scene.
fn subject(framing: Framing, compared: &ComparedScene) -> (&Scene, Option<usize>) {
    let LoweredScene {
        scene,
        source_spans,
    } = &compared.subject.validated.lowered;
    framing.subject(scene, source_spans)
}

impl ComparedScene {
    /// Validates a scene, for a picture of the given size if any, and reports its diagnostics.
    fn validate(
        args: &DiffArgs,
        (mut input, loaded): (Input, LoadedScene),
        size: Option<[u32; 2]>,
        reporter: &mut Reporter,
    ) -> Result<Self, Failure> {
        let look = OutputTransform::new(FileFormat::Png8, None, None, BackgroundFill::Film, &[]);
        let look = look.map_err(|message| Failure::Failed(message.to_owned()))?;
        let mut setup = PictureSetup {
            overrides: args.wanted.overrides(),
            set: args.wanted.set.clone(),
            arithmetic: args.wanted.arithmetic.into(),
            crop: args.wanted.crop,
            simd: simd::level()?,
            ..PictureSetup::new(look)
        };
        setup.overrides.size = size.or(setup.overrides.size);
        let subject = input::validated(&mut setup, loaded, &mut input, reporter)?;
        Ok(Self {
            input,
            setup,
            subject,
        })
    }

    fn scene(&self) -> &Scene {
        &self.subject.validated.lowered.scene
    }

    fn size(&self) -> [u32; 2] {
        self.scene().camera.size
    }

    /// Lets another camera, of the same size, look at it.
    fn see_by(&mut self, camera: &Camera) -> Result<(), Failure> {
        let unseen = "the camera of the new scene can't see the old one";
        let seen = self.subject.see_by(camera);
        seen.ok_or_else(|| Failure::Failed(unseen.to_owned()))
    }

    /// Its picture, as `rtc render` shows it.
    fn picture(
        &mut self,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<DisplayedPicture, Failure> {
        let Self {
            input,
            setup,
            subject,
        } = self;
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| interrupt.is_raised(),
        };
        let lit = setup.light(subject, input, &observer);
        lit.map_err(|error| ended(error, input, reporter))?;
        let window = setup.window(&subject.validated.lowered.scene)?;
        setup.check_memory(subject, window)?;
        let rays = input.rays();
        let film = setup.trace(subject, (window, rays), &observer);
        let Film {
            image,
            coverage,
            counts,
        } = film.map_err(|error| ended(error, input, reporter))?.film;
        let film = (image, coverage, &counts);
        let picture = setup.develop(subject, film, &[], input, observer.is_stopped)?;
        input::report_diagnostics(input, reporter)?;
        let Picture { image, .. } = picture;
        Ok(DisplayedPicture::of(image))
    }
}
