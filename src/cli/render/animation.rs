//! A turntable as one file, an animated PNG or a GIF: its pictures are written as they are
//! rendered, and the file appears with the last.

use super::super::output::Output;
use super::super::turntable::{Turntable, TurntableViews};
use super::super::{Failure, args, input as scene_input, reporter};
use super::RenderSetup;
use super::checkpoint::RunContext;
use rtc_image::{AnimatedGif, AnimatedPng, FileFormat, Picture, PictureHeader};
use rtc_math::to_u32;
use rtc_pipeline::RenderSubject;
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Pictures a second, unless they are given.
const RATE: u16 = 12;

/// The frames per second of an animation; `None` for other outputs.
pub(super) fn rate(args: &args::RenderArgs, output: &Path) -> Result<Option<u16>, Failure> {
    let refused = |message: &str| Err(Failure::Failed(message.to_owned()));
    match output.extension().is_some_and(is_apng) || is_gif(output) {
        false if args.fps.is_some() => {
            refused("`--fps` is for a turntable in one file; name it .apng or .gif")
        }
        false => Ok(None),
        true if args.turntable.is_none() => {
            refused("an animation is of a turntable; give `--turntable N`, or name it .png")
        }
        true if args.checkpoint.is_some() || args.strips.is_some() => refused(
            "`--checkpoint` and `--strips` are for the frames of a turntable; name them .png",
        ),
        true => Ok(Some(args.fps.unwrap_or(RATE))),
    }
}

impl RenderSetup {
    /// Renders views around the scene into one file, with the given frames per second.
    pub(super) fn shoot_animation(
        &self,
        (views, rate): (&TurntableViews, u16),
        subject: &mut RenderSubject,
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(), Failure> {
        let output = Output::open(&self.output, input)?;
        let mut failure = None;
        let mut write = |file: &mut File| {
            let run_context = (&mut *input, &mut *reporter, interrupt);
            let written = self.write_frames((views, rate), subject, run_context, file);
            written.map_err(|error| match error {
                FrameError::File(error) => error,
                FrameError::Work(error) => {
                    failure = Some(error);
                    ErrorKind::Other.into()
                }
            })
        };
        let written = output.commit_incrementally(&mut write, interrupt);
        failure.map_or(written, Err)
    }

    fn write_frames(
        &self,
        (views, rate): (&TurntableViews, u16),
        subject: &mut RenderSubject,
        (input, reporter, interrupt): RunContext<'_>,
        file: &mut File,
    ) -> Result<(), FrameError> {
        // The turntable rotates the camera about the scene.
        let table = Turntable::new(&subject.validated.lowered.scene, self.up, views.count);
        let frames = to_u32(views.shown.len());
        let mut begun: Option<FrameAnimation<'_>> = None;
        let mut file = Some(file);
        for frame in views.shown.clone() {
            // Render the frame.
            table.turn(&mut subject.validated, frame)?;
            subject.turn();
            let window = self.picture.window(&subject.validated.lowered.scene);
            let window = window.map_err(Failure::from)?;
            let room = self.picture.check_memory(subject, window);
            room.map_err(Failure::from)?;
            let run_context = (&mut *input, &mut *reporter, interrupt);
            let (picture, made) = self.take(subject, &self.output, window, run_context)?;
            // The first frame gives the size of the animation.
            if let Some(file) = file.take() {
                let head = PictureHeader::of(&picture, FileFormat::Png8);
                begun = Some(match is_gif(&self.output) {
                    true => FrameAnimation::Gif(AnimatedGif::begin(&head, rate, file)?),
                    false => FrameAnimation::Png(AnimatedPng::begin(&head, frames, rate, file)?),
                });
            }
            if let Some(animation) = &mut begun {
                animation.add(&picture)?;
            }
            scene_input::report_diagnostics(input, reporter)?;
            reporter.made(&made);
        }
        // Report a limit of the format, and end the file.
        if let Some(message) = remark(&self.output).filter(|_| !reporter.is_quiet()) {
            reporter::print_message(message);
        }
        begun.map_or(Ok(()), |animation| Ok(animation.finish()?))
    }
}

/// The picture file by whose kind each frame is made: one without opacities where a GIF, which has
/// no shades of them, shows it.
pub(super) fn still(output: &Path) -> PathBuf {
    output.with_extension(if is_gif(output) { "jpg" } else { "png" })
}

/// The message about the palette of an output.
fn remark(output: &Path) -> Option<&'static str> {
    let message = "note: a GIF holds 256 colours a picture; `-o NAME.apng` holds all of them";
    is_gif(output).then_some(message)
}

fn is_apng(extension: &OsStr) -> bool {
    extension.eq_ignore_ascii_case("apng")
}

fn is_gif(output: &Path) -> bool {
    let extension = output.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("gif"))
}

/// A file of frames that is partly written.
enum FrameAnimation<'f> {
    Png(AnimatedPng<&'f mut File>),
    Gif(AnimatedGif<&'f mut File>),
}

impl FrameAnimation<'_> {
    fn add(&mut self, picture: &Picture) -> io::Result<()> {
        match self {
            Self::Png(file) => file.add(picture),
            Self::Gif(file) => file.add(picture),
        }
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Png(file) => file.finish(),
            Self::Gif(file) => file.finish(),
        }
    }
}

/// Why a frame is not written.
enum FrameError {
    /// The file can't be.
    File(io::Error),
    /// There is no picture.
    Work(Failure),
}

impl From<io::Error> for FrameError {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

impl From<Failure> for FrameError {
    fn from(error: Failure) -> Self {
        Self::Work(error)
    }
}
