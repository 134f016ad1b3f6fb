//! Participating media, which are left out: the surfaces inside them are shown.

use super::Lowering;
use crate::exchange::SpannedText;
use rtc_diag::codes;

impl Lowering<'_> {
    /// Warns of a medium that shapes, lights or the camera are in.
    pub(super) fn medium_interface(&mut self, media: &[SpannedText]) {
        if let Some(medium) = media.iter().find(|medium| !medium.text.is_empty()) {
            let message = "participating media are not supported: they are rendered clear";
            self.report(&codes::PBRT_PLUGIN, medium.span, message);
        }
    }
}
