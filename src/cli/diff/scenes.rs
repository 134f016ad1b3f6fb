//! Two scenes: the differences of their IR, and their pictures from the camera of the new scene.

use super::super::Failure;
use super::super::args::DiffArgs;
use super::super::interrupt::Interrupt;
use super::super::output::Output;
use super::super::render::ended;
use super::super::reporter::Reporter;
use super::super::{input, simd};
use super::{ComparedInputs, DiffOutputs, report};
use rtc_codec::changes;
use rtc_image::{BackgroundFill, DisplayedPicture, FileFormat, Picture};
use rtc_ir::{Camera, Scene};
use rtc_pipeline::{Input, OutputTransform, PictureSetup, RenderObserver, RenderSubject};
use rtc_render::Film;
use std::path::Path;

/// A scene to be compared, as its picture is set up.
struct ComparedScene {
    input: Input,
    setup: PictureSetup,
    subject: RenderSubject,
}

/// Compares two scenes, and reports the differences.
pub(super) fn run(args: &DiffArgs) -> Result<(), Failure> {
    if [&args.new, &args.old]
        .iter()
        .all(|file| file.as_os_str() == "-")
    {
        let message = "standard input is one scene; give a file for the other";
        return Err(Failure::Failed(message.to_owned()));
    }
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = carry_out(args, &mut reporter);
    reporter.finish()?;
    outcome
}

fn carry_out(args: &DiffArgs, reporter: &mut Reporter) -> Result<(), Failure> {
    let interrupt = Interrupt::listen()?;
    let mut new = ComparedScene::read(args, &args.new, None, reporter)?;
    let mut old = ComparedScene::read(args, &args.old, Some(new.size()), reporter)?;
    let changed = changes(new.scene(), old.scene());
    let changed = changed.expect("proven scenes hold finite numbers only");
    let open = |path: &Option<_>| {
        let path: Option<&Path> = path.as_deref();
        let open = |path: &Path| {
            Output::open(path, &old.input)?;
            Output::open(path, &new.input)
        };
        path.map(open).transpose()
    };
    let outputs = DiffOutputs {
        map: open(&args.output)?,
        page: open(&args.html)?,
    };
    let first = new.picture(reporter, &interrupt)?;
    old.see_by(&new.scene().camera)?;
    let second = old.picture(reporter, &interrupt)?;
    let compared = ComparedInputs {
        pictures: Some([&first, &second]),
        size: first.size(),
        changes: Some(&changed),
    };
    let budget = new.input.map().budget();
    report(args, outputs, &compared, budget, &interrupt)
}

impl ComparedScene {
    /// Reads a scene, for a picture of the given size if any, and reports its diagnostics.
    fn read(
        args: &DiffArgs,
        file: &Path,
        size: Option<[u32; 2]>,
        reporter: &mut Reporter,
    ) -> Result<Self, Failure> {
        let mut input = input::read(file, &args.reading)?;
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
        let subject = input::subject(&mut setup, &mut input, reporter)?;
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
        let validated = &mut self.subject.validated;
        let unseen = || {
            let message = "the camera of the new scene can't see the old one";
            Failure::Failed(message.to_owned())
        };
        validated.scene = validated.scene.seen_by(camera).ok_or_else(unseen)?;
        validated.lowered.scene.camera = camera.clone();
        self.subject.turn();
        Ok(())
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
