//! What is told of values that only rtc reads from an asset.

use crate::told::Told;
use rtc_diag::codes;
use rtc_ir::ValuePath;

impl Told<'_> {
    /// Tells of a value that stands in `extras.rtc`; `what` says what the value is.
    pub(super) fn own_words(&mut self, what: &str, place: ValuePath) {
        let message = format!("{what} stands in `extras.rtc`, where only rtc reads it");
        self.tell(&codes::GLTF_OWN_WORDS, &message, place);
    }
}
