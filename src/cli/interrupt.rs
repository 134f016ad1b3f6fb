//! Ctrl-C, and being told to terminate: a flag for whoever works long, so that nothing half-written stays behind.

use super::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user wants us to stop.
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on Ctrl-C only raises the flag. To be called after reading: a read would not see the flag.
    pub(super) fn listen() -> Result<Self, Failure> {
        let flag = Arc::new(AtomicBool::new(false));
        let raised = Arc::clone(&flag);
        ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed))
            .map_err(|error| Failure::Trouble(format!("can't listen to Ctrl-C: {error}")))?;
        Ok(Self(flag))
    }

    /// True after Ctrl-C.
    pub(super) fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
