//! A turntable with checkpoints: finished frames and the state of the current frame are saved.

use super::super::Failure;
use super::super::output::Output;
use super::super::turntable::{self, Turntable, Views};
use super::RenderSetup;
use super::checkpoint::{RunContext, Saving};
use rtc_math::to_u32;
use rtc_pipeline::{RenderSubject, hash_of_file};
use rtc_source::{Loader, SourceMap};
use std::ops::Range;
use std::path::Path;

/// The largest picture file whose hash is checked, in bytes.
const MAX_BYTES: u64 = 1 << 36;

impl RenderSetup {
    /// Renders the frames that are missing, and writes them.
    pub(super) fn turn_saving(
        &self,
        views: &Views,
        mut saving: Saving<'_>,
        subject: &mut RenderSubject,
        (input, reporter, interrupt): RunContext<'_>,
    ) -> Result<(), Failure> {
        let table = Turntable::new(&subject.validated.lowered.scene, self.up, views.count);
        let path = |frame| turntable::name(&self.output, frame);
        let mut frames = views.shown.clone();
        let Range { start, end } = frames;
        frames.try_for_each(|frame| Output::open(&path(frame), input).map(drop))?;
        let turn = |subject: &mut RenderSubject, frame| {
            table.turn(&mut subject.validated, frame)?;
            subject.turn();
            Ok::<(), Failure>(())
        };
        let finished = saving.finished.clone();
        let begun = to_u32(finished.len());
        let begun = start.saturating_add(begun);
        if begun >= end {
            let count = end - start;
            return Err(saving.refused(&format!("it is of more than {count} frames")));
        }
        if saving.saved.is_some() {
            // The checkpoint is checked against the scene before any frame is rendered.
            turn(subject, begun)?;
            let window = self.picture.window(&subject.validated.lowered.scene)?;
            saving.saved = Some(self.begun(&mut saving, subject, window)?);
        }
        for (frame, hash) in
            (start..end).zip(finished.iter().map(Some).chain(std::iter::repeat(None)))
        {
            let output = path(frame);
            if hash.is_some_and(|hash| is_there(&output, hash)) {
                continue;
            }
            turn(subject, frame)?;
            if hash.is_some() {
                self.render_picture(subject, &output, input, reporter, interrupt)?;
            } else {
                saving.output = output;
                self.shoot_saving(
                    &mut saving,
                    subject,
                    (&mut *input, &mut *reporter, interrupt),
                )?;
            }
        }
        Ok(())
    }
}

/// Whether a file has this hash.
fn is_there(path: &Path, hash: &str) -> bool {
    let bytes = Loader.bytes(path, MAX_BYTES, &SourceMap::default());
    bytes.is_ok_and(|bytes| hash_of_file(&bytes) == hash)
}
