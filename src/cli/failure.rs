//! The reasons why a command fails, with their exit codes.

use super::interrupt;

/// Why a command did not do its work.
#[derive(Debug)]
pub(super) enum Failure {
    /// The input has errors, which were reported.
    Reported,
    /// The input can't be used so, for this reason.
    Input(String),
    /// A file could not be read, which was reported.
    Unreadable,
    /// A usage, file or internal error, with its message.
    Failed(String),
    /// Ctrl-C, or another signal to stop.
    Interrupted,
    /// The reader of our output closed the pipe.
    ClosedPipe,
}

impl Failure {
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::ClosedPipe => 0,
            Self::Reported | Self::Input(_) => 1,
            Self::Unreadable | Self::Failed(_) => 2,
            Self::Interrupted => interrupt::exit_code(),
        }
    }
}
