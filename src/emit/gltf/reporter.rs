//! Reports values that are written to `extras.rtc`.

use crate::reporter::Reporter;
use rtc_diag::codes;
use rtc_ir::ValuePath;

impl Reporter<'_> {
    /// Reports that `what` is written to `extras.rtc`.
    pub(super) fn in_extras(&mut self, what: &str, path: ValuePath) {
        let message = format!("{what} stands in `extras.rtc`, where only rtc reads it");
        self.report(&codes::GLTF_OWN_WORDS, &message, path);
    }
}
