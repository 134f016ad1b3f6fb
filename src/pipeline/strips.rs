//! Renders a picture strip by strip: each strip is written before the next is rendered. Only
//! one strip is in memory at a time; the file is, byte for byte, that of a render in one piece.

use super::output_transform::{ClippedValues, ResolvedOutputTransform};
use super::{Input, PictureSetup, RayCounter, RenderError, RenderObserver, RenderSubject};
use rtc_image::{BLOCK_ROWS, Picture, StripSource};
use rtc_render::{Crop, Film, RayCounts, RenderSelection};
use rtc_study::RenderGoal;
use rtc_valid::Mode;
use std::borrow::Cow;
use std::io::{self, BufWriter, Seek, Write};

/// The default number of pixels of a strip: a film of 60 MiB.
const PIXELS: u32 = 1 << 20;

/// The size of the write buffer in bytes.
const BUFFER: usize = 1 << 20;

/// Why a picture can't be rendered in strips.
const WHOLE: &str =
    "a JPEG or WebP is compressed as a whole, and has no strips; name it .png or .exr";
const GOAL: &str = "the error is known for a whole picture only, so `--target-error` and \
`--time-budget` have no strips; set the samples with `--spp` or `--supersampling`";
const DISTANCES: &str = "the brightness of a distance depends on all others, so a depth buffer \
has no strips; `--aov depth` of another mode holds distances as they are";
const SAMPLES: &str = "layers of samples (error, samples, unmet) have no strips; parts and \
checkpoints have them";
const VERIFY: &str = "`--verify-effects` compares whole pictures, and has no strips; verify a \
smaller picture, by `--size` or `--crop`";

/// The state of a render in strips.
struct StripRender<'r> {
    setup: &'r PictureSetup,
    subject: &'r mut RenderSubject,
    observer: &'r RenderObserver<'r>,
    look: &'r ResolvedOutputTransform,
    counter: RayCounter,
    /// The next strip; its height is 0 after the last.
    next: Crop,
    /// The row after the last.
    end: u32,
    counts: RayCounts,
    losses: ClippedValues,
}

impl PictureSetup {
    /// The first strip of a window, with about `rows` rows; by default as many as need little
    /// memory.
    #[must_use]
    pub fn first_strip(window: Crop, rows: Option<u32>) -> Crop {
        let rows = rows.unwrap_or_else(|| PIXELS / window.width.max(1) / BLOCK_ROWS * BLOCK_ROWS);
        let rows = rows.max(1).checked_next_multiple_of(BLOCK_ROWS);
        Crop {
            height: rows.unwrap_or(u32::MAX).min(window.height),
            ..window
        }
    }

    /// Checks that the picture can be rendered in strips.
    ///
    /// # Errors
    /// If it must be known as a whole.
    pub fn check_strips(&self, subject: &RenderSubject) -> Result<(), RenderError> {
        let is_distances = matches!(subject.validated.scene.settings().mode, Mode::Depth);
        let is_whole = self.look.kind.traits().is_whole;
        let reasons = [
            (is_whole, WHOLE),
            (self.goal != RenderGoal::default(), GOAL),
            (is_distances, DISTANCES),
            (self.verify, VERIFY),
            (self.is_measured(), SAMPLES),
        ];
        match reasons.iter().find(|(is_so, _)| *is_so) {
            Some((_, reason)) => Err(RenderError::Refused((*reason).to_owned())),
            None => Ok(()),
        }
    }

    /// Renders a window in strips of the height of the first, with at most `rays` rays, and writes
    /// the file incrementally. Returns the ray counts; diagnostics go to `input`.
    ///
    /// # Errors
    /// If the file can't be written; the inner error if there is no picture.
    pub fn render_strips(
        &self,
        subject: &mut RenderSubject,
        (window, first, rays): (Crop, Crop, u64),
        input: &mut Input,
        observer: &RenderObserver<'_>,
        out: impl Write + Seek,
    ) -> io::Result<Result<RayCounts, RenderError>> {
        // Prepare the header and the state.
        let look = self.look.resolve(&subject.validated.scene.settings().mode);
        let metadata = || self.metadata(&subject.validated.lowered.scene);
        let head = look.head([window.width, window.height], &self.look.aovs, metadata);
        let mut render = StripRender {
            setup: self,
            subject,
            observer,
            look: &look,
            counter: RayCounter::new(rays, first),
            next: first,
            end: window.y + window.height,
            counts: RayCounts::default(),
            losses: ClippedValues::default(),
        };
        // Write the file; it requests strip after strip.
        let mut render_error = None;
        let mut next = || match render.next_strip() {
            Ok(strip) => Ok(Cow::Owned(strip)),
            Err(error) => {
                render_error = Some(error);
                Err(io::ErrorKind::Other.into())
            }
        };
        let mut out = BufWriter::with_capacity(BUFFER, out);
        let written = head.write(&mut out, StripSource::new(&mut next));
        let written = written.and_then(|()| out.flush());
        if let Some(error) = render_error {
            return Ok(Err(error));
        }
        written?;
        // Report diagnostics.
        let StripRender { counts, losses, .. } = render;
        self.report_empty_picture(subject, &counts, input);
        let found = losses.picture_diagnostics(counts.unnumbered, look.kind, self.arithmetic);
        found
            .into_iter()
            .for_each(|diagnostic| input.push(diagnostic));
        Ok(Ok(counts))
    }
}

impl StripRender<'_> {
    /// Renders the next strip.
    fn next_strip(&mut self) -> Result<Picture, RenderError> {
        let Self {
            setup,
            subject,
            observer,
            look,
            counter,
            ..
        } = self;
        // The job of the strip.
        let job = RenderSelection {
            crop: Some(self.next),
            values: setup.look.values(&subject.validated.scene.settings().mode),
            background: setup.look.background(),
            ..RenderSelection::default()
        };
        // Render the film, and count its rays.
        counter.next_strip(self.next);
        let on_pixel = |step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && counter.step(step)
        };
        let film = setup.renderer(subject)?.1.render(&job, &on_pixel);
        if let Some(diagnostic) = subject.ran_out(counter, observer) {
            return Err(RenderError::RanOut(diagnostic));
        }
        let Film {
            image,
            coverage,
            counts,
        } = film.ok_or(RenderError::Stopped)?;
        self.counts = self.counts.plus(counts);
        // Render the layers, and move on.
        let layers = setup.layers(subject, &job, observer.is_stopped)?;
        let top = self.next.y + self.next.height;
        self.next = Crop {
            y: top,
            height: self.next.height.min(self.end - top),
            ..self.next
        };
        Ok(look.show(image, coverage, layers, &mut self.losses))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_are_whole_blocks_and_no_higher_than_the_picture() {
        let window = |width, height| Crop {
            x: 3,
            y: 5,
            width,
            height,
        };
        let rows = |width, height, rows| {
            let strip = PictureSetup::first_strip(window(width, height), rows);
            assert_eq!((strip.x, strip.y, strip.width), (3, 5, width));
            strip.height
        };
        assert_eq!(rows(40, 70, Some(1)), 16);
        assert_eq!(rows(40, 70, Some(17)), 32);
        assert_eq!(rows(40, 70, Some(u32::MAX)), 70);
        assert_eq!(rows(32_768, 32_768, None), 32);
        assert_eq!(rows(u32::MAX, 70, None), 16);
        assert_eq!(rows(1, 70, None), 70);
    }
}
