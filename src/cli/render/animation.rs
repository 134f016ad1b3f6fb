//! A turntable as one file, an animated PNG: its pictures are written as they are rendered, and the
//! file appears with the last.

use super::super::output::Output;
use super::super::turntable::{Turntable, Views};
use super::super::{Failure, args};
use super::RenderSetup;
use super::checkpoint::Desk;
use crate::image::{AnimatedPng, FileFormat, PictureHead};
use crate::pipeline::RenderSubject;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

/// Pictures a second, unless they are given.
const RATE: u16 = 12;

/// How many pictures a second the output shows; `None` of one that is no animation.
pub(super) fn rate(args: &args::Render, output: &Path) -> Result<Option<u16>, Failure> {
    let is_one = |extension: &std::ffi::OsStr| extension.eq_ignore_ascii_case("apng");
    let refused = |words: &str| Err(Failure::Trouble(words.to_owned()));
    match output.extension().is_some_and(is_one) {
        false if args.fps.is_some() => {
            refused("`--fps` is for a turntable in one file; name it .apng")
        }
        false => Ok(None),
        true if args.turntable.is_none() => {
            refused("an animated PNG is of a turntable; give `--turntable N`, or name it .png")
        }
        true if args.checkpoint.is_some() || args.strips.is_some() => refused(
            "`--checkpoint` and `--strips` are for the frames of a turntable; name them .png",
        ),
        true => Ok(Some(args.fps.unwrap_or(RATE))),
    }
}

impl RenderSetup {
    /// Renders views around the scene and writes them as one file, so many a second.
    pub(super) fn shoot_animation(
        &self,
        (views, rate): (&Views, u16),
        subject: &mut RenderSubject,
        (input, talk, interrupt): Desk<'_>,
    ) -> Result<(), Failure> {
        let output = Output::open(&self.output, input)?;
        let mut failure = None;
        let mut write = |file: &mut File| {
            let desk = (&mut *input, &mut *talk, interrupt);
            let written = self.write_frames((views, rate), subject, desk, file);
            written.map_err(|error| match error {
                FrameError::File(error) => error,
                FrameError::Work(error) => {
                    failure = Some(error);
                    ErrorKind::Other.into()
                }
            })
        };
        let written = output.commit_slowly(&mut write, interrupt);
        failure.map_or(written, Err)
    }

    fn write_frames(
        &self,
        (views, rate): (&Views, u16),
        subject: &mut RenderSubject,
        (input, talk, interrupt): Desk<'_>,
        file: &mut File,
    ) -> Result<(), FrameError> {
        let table = Turntable::new(&subject.proven.lowered.scene, self.up, views.count);
        let frames = u32::try_from(views.shown.len()).unwrap_or(u32::MAX);
        let mut begun: Option<AnimatedPng<&mut File>> = None;
        let mut file = Some(file);
        for frame in views.shown.clone() {
            table.turn(&mut subject.proven, frame)?;
            subject.turn();
            let window = self.picture.window(&subject.proven.lowered.scene);
            let window = window.map_err(Failure::from)?;
            let room = self.picture.find_room(subject, window);
            room.map_err(Failure::from)?;
            let desk = (&mut *input, &mut *talk, interrupt);
            let (picture, made) = self.take(subject, &self.output, window, desk)?;
            if let Some(file) = file.take() {
                let head = PictureHead::of(&picture, FileFormat::Png8);
                begun = Some(AnimatedPng::begin(&head, frames, rate, file)?);
            }
            if let Some(animation) = &mut begun {
                animation.add(&picture)?;
            }
            talk.made(&made);
        }
        begun.map_or(Ok(()), |animation| Ok(animation.finish()?))
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
