//! Why there is no scene, or no picture of it.

use super::{Finding, Severity};
use rtc_pipeline::RenderError;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why there is no scene, or no picture of it.
#[non_exhaustive]
pub enum Error {
    /// The scene can't be read or has errors: all that was found, warnings too.
    Invalid(Vec<Finding>),
    /// The picture would take more rays than the scene may: where they ran out.
    TooManyRays(Box<Finding>),
    /// It can't be done so, for this reason: options that don't fit, no memory, no threads.
    Refused(String),
    /// The caller said stop.
    Stopped,
    /// The picture could not be written.
    Unwritable {
        /// Where it was to be.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
}

impl Error {
    /// The findings it holds; none if it is not about the scene.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        match self {
            Self::Invalid(findings) => findings,
            Self::TooManyRays(finding) => std::slice::from_ref(finding),
            Self::Refused(_) | Self::Stopped | Self::Unwritable { .. } => &[],
        }
    }

    /// The same, of a render; `finding` makes public what was found.
    pub(super) fn of_render(
        error: RenderError,
        finding: impl FnOnce(rtc_diag::Diagnostic) -> Finding,
    ) -> Self {
        match error {
            RenderError::Stopped => Self::Stopped,
            RenderError::RanOut(found) => Self::TooManyRays(Box::new(finding(*found))),
            RenderError::Refused(words) => Self::Refused(words),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(findings) => {
                let errors = || {
                    let all = findings.iter();
                    all.filter(|finding| finding.severity == Severity::Error)
                };
                match (errors().next(), errors().count()) {
                    (Some(first), 1) => write!(f, "the scene has an error: {}", first.short()),
                    (Some(first), count) => {
                        write!(f, "the scene has {count} errors, first {}", first.short())
                    }
                    (None, _) => f.write_str("the scene can't be read"),
                }
            }
            Self::TooManyRays(finding) => f.write_str(&finding.short()),
            Self::Refused(words) => f.write_str(words),
            Self::Stopped => f.write_str("stopped by the caller"),
            Self::Unwritable { path, error } => {
                write!(f, "can't write `{}`: {error}", path.display())
            }
        }
    }
}

/// As it is displayed, so that `main` may return it.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Unwritable { error, .. } => Some(error),
            Self::Invalid(_) | Self::TooManyRays(_) | Self::Refused(_) | Self::Stopped => None,
        }
    }
}
