//! A picture in strips: each is rendered, written and let go before the next.

use super::super::progress::RenderProgress;
use super::super::{Failure, input, interrupt::Interrupt, output::Output, reporter::Reporter};
use super::{MadePicture, RenderSetup, halted};
use rtc_pipeline::{Input, Observer, PictureSetup, RenderSubject};
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;

impl RenderSetup {
    /// Renders one picture in strips of the given rows, and writes it.
    pub(super) fn shoot_strips(
        &self,
        rows: Option<u32>,
        (subject, path): (&mut RenderSubject, &Path),
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let setup = &self.picture;
        setup.check_strips(subject)?;
        let window = setup.window(&subject.validated.lowered.scene)?;
        let strip = PictureSetup::first_strip(window, rows);
        setup.check_memory(subject, strip)?;
        let output = Output::open(path, input)?;
        let progress = RenderProgress::start(window.pixels() as u64, reporter.is_quiet());
        let observer = Observer {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        let order = (window, strip, input.rays());
        let mut rendered = None;
        let mut write = |file: &mut File| {
            let done = setup.render_strips(subject, order, input, &observer, file)?;
            let is_done = done.is_ok();
            rendered = Some(done);
            is_done.then_some(()).ok_or(ErrorKind::Other.into())
        };
        let written = output.commit_slowly(&mut write, interrupt);
        let elapsed = progress.finish();
        let counts = match rendered {
            Some(Ok(counts)) => counts,
            Some(Err(error)) => return halted(error, input, reporter),
            None => return written,
        };
        written?;
        input::report_diagnostics(input, reporter)?;
        let size = [window.width, window.height];
        reporter.made(&MadePicture::new(path, setup, size, (counts, elapsed)));
        Ok(())
    }
}
