//! The errors of reading and rendering a scene.

use super::{Diagnostic, Severity};
use rtc_pipeline::RenderError;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why there is no scene, or no picture of it.
///
/// ```
/// use rtc::{Error, Scene};
///
/// match Scene::open("no-such-scene.yaml") {
///     Err(Error::Invalid(found)) => assert_eq!(found[0].code, "IO001"),
///     _ => panic!("there is no such file"),
/// }
/// ```
#[non_exhaustive]
pub enum Error {
    /// The scene can't be read or has errors: all diagnostics, including warnings.
    Invalid(Vec<Diagnostic>),
    /// The picture needs more rays than allowed. The diagnostic has the position of the limit.
    TooManyRays(Box<Diagnostic>),
    /// The request was rejected, with the reason: invalid options, too little memory, no threads.
    Refused(String),
    /// The caller stopped the render.
    Stopped,
    /// The picture could not be written.
    Unwritable {
        /// The path of the file.
        path: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
}

impl Error {
    /// The diagnostics of the error; empty if it is not about the scene.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Invalid(diagnostics) => diagnostics,
            Self::TooManyRays(diagnostic) => std::slice::from_ref(diagnostic),
            Self::Refused(_) | Self::Stopped | Self::Unwritable { .. } => &[],
        }
    }

    /// The error of a render; `diagnostic` converts a diagnostic to its public type.
    pub(super) fn of_render(
        error: RenderError,
        diagnostic: impl FnOnce(rtc_diag::Diagnostic) -> Diagnostic,
    ) -> Self {
        match error {
            RenderError::Stopped => Self::Stopped,
            RenderError::RanOut(found) => Self::TooManyRays(Box::new(diagnostic(*found))),
            RenderError::Refused(message) => Self::Refused(message),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(diagnostics) => {
                let errors = || {
                    let all = diagnostics.iter();
                    all.filter(|diagnostic| diagnostic.severity == Severity::Error)
                };
                match (errors().next(), errors().count()) {
                    (Some(first), 1) => write!(f, "the scene has an error: {}", first.short()),
                    (Some(first), count) => {
                        write!(f, "the scene has {count} errors, first {}", first.short())
                    }
                    (None, _) => f.write_str("the scene can't be read"),
                }
            }
            Self::TooManyRays(diagnostic) => f.write_str(&diagnostic.short()),
            Self::Refused(message) => f.write_str(message),
            Self::Stopped => f.write_str("stopped by the caller"),
            Self::Unwritable { path, error } => {
                write!(f, "can't write `{}`: {error}", path.display())
            }
        }
    }
}

/// The same as `Display`, so that `main` may return it.
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
