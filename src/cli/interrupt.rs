//! Ctrl-C, and being told to terminate: a flag for whoever works long, so that nothing half-written
//! stays behind.
//!
//! Whoever does not hear the first signal, a writer whose reader sleeps for instance, is ended by
//! the second.

use super::Failure;
use crate::pipeline::WriteObserver;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::{fs, process};

/// Whether the user wants us to stop.
pub(super) struct Interrupt(Arc<State>);

#[derive(Default)]
struct State {
    raised: AtomicBool,
    /// The file that is to disappear if we end at once.
    draft: Mutex<Option<PathBuf>>,
}

impl Interrupt {
    /// From now on the first Ctrl-C only raises the flag. To be called after reading: a read would
    /// not see the flag.
    pub(super) fn listen() -> Result<Self, Failure> {
        let state = Arc::new(State::default());
        let heard = Arc::clone(&state);
        ctrlc::set_handler(move || {
            if heard.raised.swap(true, Ordering::Relaxed) {
                heard.end();
            }
        })
        .map_err(|error| Failure::Trouble(format!("can't listen to Ctrl-C: {error}")))?;
        Ok(Self(state))
    }

    /// True after Ctrl-C.
    pub(super) fn is_raised(&self) -> bool {
        self.0.raised.load(Ordering::Relaxed)
    }
}

impl WriteObserver for Interrupt {
    fn is_stopped(&self) -> bool {
        self.is_raised()
    }

    fn draft(&self, path: Option<&Path>) {
        *self.0.draft() = path.map(Path::to_owned);
    }
}

impl State {
    fn draft(&self) -> std::sync::MutexGuard<'_, Option<PathBuf>> {
        self.draft.lock().unwrap_or_else(PoisonError::into_inner)
    }

    #[expect(
        clippy::disallowed_methods,
        reason = "the thread that works is beyond reach"
    )]
    fn end(&self) {
        if let Some(draft) = self.draft().take() {
            // There is nobody left to tell.
            let _ = fs::remove_file(draft);
        }
        process::exit(i32::from(Failure::Interrupted.exit_code()));
    }
}
