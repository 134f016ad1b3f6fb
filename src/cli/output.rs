//! The one writer: a result appears whole or not at all.
//!
//! A file is made beside its target under another name, synced and renamed; what is not finished disappears.

use super::Failure;
use super::interrupt::Interrupt;
use std::fs::{self, OpenOptions, Permissions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A place for a result, ready to be written.
pub(super) enum Output {
    /// Standard output.
    Stdout,
    /// A device or a pipe, which can't be replaced.
    Stream(PathBuf),
    /// A file, under its temporary name.
    File {
        /// Where it will appear.
        target: PathBuf,
        /// Where it is until then.
        draft: NamedTempFile,
    },
}

/// What writes a result.
type Writer<'w> = &'w dyn Fn(&mut dyn Write) -> io::Result<()>;

impl Output {
    /// Prepares to write to `path`, `-` being standard output, so that a long work is not done in vain.
    ///
    /// Without an [`Interrupt`] listening, Ctrl-C would leave the draft behind; so it asks for one.
    pub(super) fn open(path: &Path, _interrupt: &Interrupt) -> Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Ok(Self::Stdout);
        }
        let name = path.display();
        Self::beside(path).map_err(|error| failure(&format!("`{name}`"), &error))
    }

    fn beside(path: &Path) -> io::Result<Self> {
        // A link stays a link: what it points to is replaced.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let present = fs::metadata(&target).ok();
        let permissions = match &present {
            Some(meta) if meta.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Some(meta) if !meta.is_file() => return Ok(Self::Stream(target)),
            Some(meta) if meta.permissions().readonly() => return Err(io::Error::other("the file is read-only")),
            Some(meta) => Some(meta.permissions()),
            None => None,
        };
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let draft = draft(folder, permissions)?;
        Ok(Self::File { target, draft })
    }

    /// Writes the result; a file appears under its name only now, and not after Ctrl-C.
    pub(super) fn commit(self, bytes: &[u8], interrupt: &Interrupt) -> Result<(), Failure> {
        self.commit_by(&|out| out.write_all(bytes), interrupt)
    }

    /// The same with a result that is written part by part.
    pub(super) fn commit_by(self, write: Writer<'_>, interrupt: &Interrupt) -> Result<(), Failure> {
        let (target, written) = match self {
            Self::Stdout => return by_stdout(write),
            Self::Stream(target) => {
                let written = OpenOptions::new().write(true).open(&target).and_then(|mut to| write(&mut to));
                (target, written)
            }
            Self::File { target, mut draft } => {
                let synced = write(&mut draft).and_then(|()| draft.as_file().sync_all());
                if interrupt.is_raised() {
                    return Err(Failure::Interrupted);
                }
                let written = synced.and_then(|()| draft.persist(&target).map_err(|error| error.error).map(drop));
                (target, written)
            }
        };
        written.map_err(|error| failure(&format!("`{}`", target.display()), &error))
    }
}

/// An empty file with the permissions of the one it will replace, or those of any new file.
fn draft(folder: &Path, permissions: Option<Permissions>) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rtc-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    // The builder's errors name the draft, which means nothing to the user: the folder and the kind say it.
    fs::metadata(folder)?;
    let draft = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
    if let Some(permissions) = permissions {
        draft.as_file().set_permissions(permissions)?;
    }
    Ok(draft)
}

/// A closed pipe is a reader that had enough; all else is trouble.
fn failure(name: &str, error: &io::Error) -> Failure {
    if error.kind() == ErrorKind::BrokenPipe {
        return Failure::ClosedPipe;
    }
    Failure::Trouble(format!("can't write {name}: {error}"))
}

/// Writes to standard output; if its reader has gone that is no failure of ours.
pub(super) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    by_stdout(&|out| out.write_all(bytes))
}

fn by_stdout(write: Writer<'_>) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let written = write(&mut stdout).and_then(|()| stdout.flush());
    written.map_err(|error| failure("standard output", &error))
}

/// Refuses to write bytes that are not text to a terminal.
pub(super) fn refuse_terminal(path: &Path) -> Result<(), Failure> {
    if path.as_os_str() == "-" && io::stdout().is_terminal() {
        return Err(Failure::Trouble("standard output is a terminal; give `-o FILE`, or `-o -` in a pipe".to_owned()));
    }
    Ok(())
}
