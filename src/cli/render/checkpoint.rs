//! A render that is saved on its way: what is done of it lies in a part (`.rtp`), and the same command
//! goes on from there, to the same bytes.

use super::super::merge::{read_part, unfit};
use super::super::output::Output;
use super::super::progress::RenderProgress;
use super::super::{Failure, args, input, interrupt::Interrupt, talk, talk::Talk};
use super::part::has_goal;
use super::shot::summary;
use super::{RenderSetup, halted};
use crate::pipeline::{
    Input, MOST_SHARES, NewFile, Observer, PicturePart, RenderError, RenderSubject, SharedBy,
    Shares,
};
use crate::render::{Crop, Tiles};
use crate::source::{Resource, SourceMap};
use std::path::PathBuf;
use std::time::Duration;

/// Shares of the first stretch of work; then as many as take the time that one may.
const FIRST: u32 = 64;

/// Where and how often a render is saved.
pub(super) struct Checkpoint {
    file: PathBuf,
    every: Duration,
    restarts: bool,
}

impl Checkpoint {
    /// The checkpoint asked for, if any.
    pub(super) fn new(args: &args::Render) -> Result<Option<Self>, Failure> {
        let Some(file) = args.checkpoint.clone() else {
            return Ok(None);
        };
        if has_goal(args) {
            return Err(Failure::Trouble(
                "a picture that is done when it is good enough can't be saved on its way; \
                 give its samples, by `--spp` or `--supersampling`, in place of a goal"
                    .to_owned(),
            ));
        }
        Ok(Some(Self {
            file,
            every: args.every,
            restarts: args.restart,
        }))
    }

    /// Adds what was saved, if anything is to be gone on from.
    fn add_saved(&self, done: &mut PicturePart, input: &Input) -> Result<(), Failure> {
        if self.restarts || !self.file.exists() {
            return Ok(());
        }
        let max_pixels = input.map().budget().limit(Resource::Pixels);
        // Noted in no map that matters: the file is written again.
        let saved = read_part(&self.file, max_pixels, &SourceMap::default());
        let added =
            saved.and_then(|saved| done.add(saved).map_err(|error| unfit(&self.file, &error)));
        added.map_err(|failure| match failure {
            Failure::Input(words) => Failure::Input(format!("{words}; `--restart` begins anew")),
            other @ (Failure::Findings
            | Failure::Unreadable
            | Failure::Trouble(_)
            | Failure::Interrupted
            | Failure::ClosedPipe) => other,
        })
    }

    /// Saves what is done, whole or not at all, and says so if that fails: the render goes on.
    fn try_save(&self, part: &PicturePart) -> bool {
        let saved = NewFile::save(&self.file, &part.save());
        if let Err(error) = &saved {
            let file = self.file.display();
            talk::say(&format!(
                "warning: `{file}` can't be written: {error}; the render goes on, what was saved before stays"
            ));
        }
        saved.is_ok()
    }
}

impl RenderSetup {
    /// Renders the picture, saving it on its way, and writes it.
    pub(super) fn shoot_saving(
        &self,
        checkpoint: &Checkpoint,
        subject: &mut RenderSubject,
        input: &mut Input,
        talk: &mut Talk,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let (window, output) = self.ready(subject, &self.output, input)?;
        // Whether it can be written is known before the work is done.
        Output::open(&checkpoint.file, input).map(drop)?;
        let mut done = self.begun(checkpoint, subject, window, input)?;
        let progress = RenderProgress::start(window.pixels() as u64, talk.is_quiet());
        let order = (window, input.rays());
        let traced = self.trace_saving(
            checkpoint,
            subject,
            &mut done,
            order,
            (interrupt, &progress),
        );
        let elapsed = progress.finish();
        if let Err(error) = traced {
            return halted(error, input, talk);
        }
        // Should the picture not be written, its samples are not lost.
        checkpoint.try_save(&done);
        let developed = done.develop();
        let (picture, counts, found) =
            developed.map_err(|error| Failure::Trouble(error.to_string()))?;
        found.into_iter().for_each(|finding| input.push(finding));
        input::tell(input, talk)?;
        let bytes = self.picture.encode(&picture, subject)?;
        let written = output.commit(&bytes, interrupt);
        if interrupt.is_raised() {
            checkpoint.end(&done);
        }
        written?;
        if !talk.is_quiet() {
            let size = [picture.image.width, picture.image.height];
            let (light, work) = (self.picture.light_told(), (&counts, elapsed));
            let verbose = talk.is_verbose();
            talk::say(&summary(&self.output, size, &light, work, verbose));
        }
        Ok(())
    }

    /// What was saved of the picture; none of its shares if nothing was.
    fn begun(
        &self,
        checkpoint: &Checkpoint,
        subject: &mut RenderSubject,
        window: Crop,
        input: &Input,
    ) -> Result<PicturePart, Failure> {
        let nobody = Observer {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        let order = (shares(window, [1, 0]), window, u64::MAX);
        let mut done = self.picture.part(subject, order, &nobody)?;
        checkpoint.add_saved(&mut done, input)?;
        Ok(done)
    }

    /// Renders the shares of the picture that are missing, and saves on the way.
    fn trace_saving(
        &self,
        checkpoint: &Checkpoint,
        subject: &mut RenderSubject,
        done: &mut PicturePart,
        (window, rays): (Crop, u64),
        (interrupt, progress): (&Interrupt, &RenderProgress),
    ) -> Result<(), RenderError> {
        let observer = Observer {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        let mut stretch = Stretch::new(checkpoint.every);
        let mut saved = progress.elapsed();
        while let Some(next) = next(done, stretch.shares) {
            let begun = progress.elapsed();
            let left = rays.saturating_sub(done.counts().rays());
            let order = (shares(window, next), window, left);
            let part = self.picture.part(subject, order, &observer);
            if let Err(RenderError::Stopped) = part {
                checkpoint.end(done);
            }
            let added = done.add(part?);
            added.map_err(|error| RenderError::Refused(error.to_string()))?;
            let now = progress.elapsed();
            stretch.adapt(next[1] - next[0] + 1, now.saturating_sub(begun));
            if now.saturating_sub(saved) >= checkpoint.every {
                checkpoint.try_save(done);
                saved = progress.elapsed();
            }
        }
        Ok(())
    }
}

/// Shares of a picture of about one tile each.
fn shares(window: Crop, [first, last]: [u32; 2]) -> Shares {
    let count = u32::try_from(Tiles::of(window).count()).unwrap_or(MOST_SHARES);
    Shares {
        by: SharedBy::Tiles,
        first,
        last,
        count: count.clamp(1, MOST_SHARES),
    }
}

impl Checkpoint {
    /// Saves before the end, and says how to go on.
    fn end(&self, part: &PicturePart) {
        let (shares, count) = part.shares();
        if !shares.is_empty() && self.try_save(part) {
            let (file, shares) = (self.file.display(), shares.len());
            talk::say(&format!(
                "saved {shares} of {count} shares in `{file}`; the same command goes on from there"
            ));
        }
    }
}

/// The first shares that are missing, side by side, at most so many: the first and the last of them.
fn next(done: &PicturePart, most: u32) -> Option<[u32; 2]> {
    let mut missing = done.missing();
    let first = missing.next()?;
    let last = missing
        .zip(first + 1..first.saturating_add(most))
        .take_while(|(share, expected)| share == expected)
        .last();
    Some([first, last.map_or(first, |(share, _)| share)])
}

/// How many shares are rendered at once: as many as take a part of the time between two saves.
struct Stretch {
    shares: u32,
    time: Duration,
}

impl Stretch {
    /// Longer ones save no more work, and lose more of it.
    const LONGEST: Duration = Duration::from_secs(10);

    fn new(every: Duration) -> Self {
        Self {
            shares: FIRST,
            time: (every / 4).min(Self::LONGEST),
        }
    }

    /// So many shares took so long.
    fn adapt(&mut self, shares: u32, took: Duration) {
        let ratio = self.time.as_secs_f64() / took.as_secs_f64().max(1e-6);
        let wanted = f64::from(shares) * ratio.clamp(0.25, 4.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a positive number, saturated"
        )]
        let wanted = wanted as u32;
        // All threads have work.
        self.shares = wanted.max(16);
    }
}
