//! The time that a picture may take, from the start of the command to its file.

use rtc_diag::{Diagnostic, codes};
use rtc_render::Crop;
use rtc_study::CoarsePicture;
use std::cell::Cell;
use std::time::{Duration, Instant};

/// The start of the picture: for the first one that of the command, for others the end of the one
/// before.
pub(super) struct PictureClock(Cell<Instant>);

/// The time that a pixel takes from its samples to the file, about.
const WRITING: Duration = Duration::from_nanos(200);

/// The time from the encoded picture to the end of the program.
const ENDING: Duration = Duration::from_millis(10);

/// The tolerance of the time budget, absolute, or relative to it.
const LATE: Duration = Duration::from_millis(20);
const LATE_PART: f64 = 0.05;

#[expect(
    clippy::disallowed_methods,
    reason = "a budget is of the clock, and says so"
)]
impl PictureClock {
    /// Begins now.
    pub(super) fn start() -> Self {
        Self(Cell::new(Instant::now()))
    }

    /// The start of the picture.
    pub(super) fn begun(&self) -> Instant {
        self.0.get()
    }

    /// Begins now, of a command whose pictures before are made.
    pub(super) fn restart(&self) {
        self.0.set(Instant::now());
    }

    /// The time until samples end for the picture to be ready in a time, on a machine that is not
    /// quite idle.
    pub(super) fn sampling(time: Duration, crop: Crop) -> Duration {
        const BUSY: f64 = 0.98;
        time.saturating_sub(writing(crop)).mul_f64(BUSY)
    }

    /// The picture is ready except for its file: its time, and its messages about missing samples.
    pub(super) fn stop(
        &self,
        time: Option<Duration>,
        (coarse, crop): (Option<CoarsePicture>, Crop),
    ) -> Option<Diagnostic> {
        // As the file is still to be written.
        let took = self.begun().elapsed() + writing(crop);
        self.0.set(Instant::now());
        let time = time?;
        let is_late = took > time + LATE.max(time.mul_f64(LATE_PART));
        let message = match (is_late, coarse) {
            (false, None) => return None,
            (true, None) => late(took, time),
            (true, Some(coarse)) => format!("{}, and {}", late(took, time), lacking(coarse)),
            (false, Some(coarse)) => lacking(coarse),
        };
        let diagnostic = Diagnostic::new(&codes::TOO_SHORT, message);
        Some(match coarse {
            Some(CoarsePicture { complete_after, .. }) => diagnostic.hint(format!(
                "a sample for each pixel takes about `--time-budget {:.2}`",
                (complete_after + writing(crop)).as_secs_f64()
            )),
            None => diagnostic.hint(
                "reading, preparing and writing take time, too: a smaller `--size` takes less",
            ),
        })
    }
}

fn writing(crop: Crop) -> Duration {
    WRITING.mul_f64(crop.pixels() as f64) + ENDING
}

fn late(took: Duration, time: Duration) -> String {
    let [took, time] = [took, time].map(|time| time.as_secs_f64());
    format!("the picture takes about {took:.2} s, and was to take {time:.2} s")
}

fn lacking(CoarsePicture { block, .. }: CoarsePicture) -> String {
    format!("the picture is crude: blocks of up to {block} × {block} pixels show one of them")
}
