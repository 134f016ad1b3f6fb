//! Ctrl-C and other requests to terminate: a flag that long tasks poll, so that no half-written
//! file is left.
//!
//! The second signal ends a process that does not react to the first, for example one that waits
//! for a blocked pipe.

use super::Failure;
use rtc_pipeline::WriteObserver;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::{fs, io, process};

/// The number of the first signal, or 0; signals address the whole process.
static HEARD: AtomicU8 = AtomicU8::new(0);

/// The number of SIGINT, and of Ctrl-C where there are no signals.
const INTERRUPT: u8 = 2;

/// The listener, once there is one.
static LISTENER: OnceLock<Interrupt> = OnceLock::new();

/// Whether the user wants us to stop.
#[derive(Clone)]
pub(super) struct Interrupt(Arc<InterruptState>);

#[derive(Default)]
struct InterruptState {
    /// The file that is to disappear if we end at once.
    draft: Mutex<Option<PathBuf>>,
}

/// The exit code after a signal: 128 plus its number, as in a shell.
pub(super) fn exit_code() -> u8 {
    match HEARD.load(Ordering::Relaxed) {
        0 => 128 + INTERRUPT,
        signal => 128 + signal,
    }
}

/// True after a signal.
pub(super) fn is_heard() -> bool {
    HEARD.load(Ordering::Relaxed) != 0
}

impl Interrupt {
    /// From now on the first signal only sets the flag. Call this after reading input, since a
    /// blocking read does not check the flag. An existing listener keeps its flag.
    pub(super) fn listen() -> Result<Self, Failure> {
        if let Some(listener) = LISTENER.get() {
            return Ok(listener.clone());
        }
        let state = Arc::new(InterruptState::default());
        let received = Arc::clone(&state);
        let on_signal = move |signal| {
            let first = HEARD.compare_exchange(0, signal, Ordering::Relaxed, Ordering::Relaxed);
            if first.is_err() {
                received.end();
            }
        };
        listen_for(on_signal)
            .map_err(|error| Failure::Failed(format!("can't listen to signals: {error}")))?;
        Ok(LISTENER.get_or_init(|| Self(state)).clone())
    }

    /// True after a signal.
    #[expect(clippy::unused_self, reason = "nobody is heard before someone listens")]
    pub(super) fn is_raised(&self) -> bool {
        is_heard()
    }
}

/// From now on a write beyond the limit on the size of files is an error like others, and does not
/// end the process with something half-written left behind.
pub(super) fn outlive_full_files() {
    #[cfg(unix)]
    {
        // Without the handler it is as before.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default());
    }
}

/// Calls `on_signal` with the number of each terminating signal, in a thread of its own.
#[cfg(unix)]
fn listen_for(on_signal: impl Fn(u8) + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXCPU};
    let mut signals = signal_hook::iterator::Signals::new([SIGHUP, SIGTERM, SIGINT, SIGXCPU])?;
    let listener = std::thread::Builder::new().name("signals".to_owned());
    let listen = move || {
        let numbers = signals.forever().map(u8::try_from);
        numbers.for_each(|signal| on_signal(signal.unwrap_or(INTERRUPT)));
    };
    listener.spawn(listen).map(drop)
}

/// The same for Ctrl-C and similar events, which have no distinct numbers.
#[cfg(not(unix))]
fn listen_for(on_signal: impl Fn(u8) + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(move || on_signal(INTERRUPT)).map_err(io::Error::other)
}

impl WriteObserver for Interrupt {
    fn is_stopped(&self) -> bool {
        self.is_raised()
    }

    fn draft(&self, path: Option<&Path>) {
        *self.0.draft() = path.map(Path::to_owned);
    }
}

impl InterruptState {
    fn draft(&self) -> std::sync::MutexGuard<'_, Option<PathBuf>> {
        self.draft.lock().unwrap_or_else(PoisonError::into_inner)
    }

    #[expect(
        clippy::disallowed_methods,
        reason = "the thread that works is beyond reach"
    )]
    fn end(&self) {
        if let Some(draft) = self.draft().take() {
            // The reporter is gone.
            let _ = fs::remove_file(draft);
        }
        process::exit(i32::from(Failure::Interrupted.exit_code()));
    }
}
