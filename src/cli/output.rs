//! The one writer: a result appears whole or not at all.
//!
//! A file is written beside its target under another name, synced and renamed. An unfinished file
//! is removed.

use super::Failure;
use super::input::Input;
use super::interrupt::Interrupt;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;
use tempfile::NamedTempFile;

/// The most links that are followed to where a file is to be.
const MAX_LINKS: usize = 40;

/// How long to wait for a reader before looking again, and for a signal.
const WAIT: Duration = Duration::from_millis(10);

/// A place for a result, fit to be written.
pub(super) struct Output {
    /// As the user calls it.
    name: String,
    place: Place,
}

enum Place {
    Stdout,
    /// A device or a pipe, which cannot be replaced.
    Stream(PathBuf),
    /// A file, which will have these permissions if there is one already.
    File(PathBuf, Option<Permissions>),
}

/// What writes a result.
type Writer<'w> = &'w dyn Fn(&mut dyn Write) -> io::Result<()>;

impl Output {
    /// Looks whether `path`, `-` being standard output, can be written, so that a long work is not
    /// done in vain: it may be none of what was read.
    pub(super) fn open(path: &Path, input: &Input) -> Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Ok(Self {
                name: "standard output".to_owned(),
                place: Place::Stdout,
            });
        }
        let name = format!("`{}`", path.display());
        if input.has_read(path) {
            return Err(Failure::Trouble(format!(
                "can't write {name}: it is an input of this run"
            )));
        }
        let place = Place::new(path).map_err(|error| failure(&name, &error))?;
        Ok(Self { name, place })
    }

    /// Writes the result; a file appears under its name only now, and not after Ctrl-C.
    pub(super) fn commit(self, bytes: &[u8], interrupt: &Interrupt) -> Result<(), Failure> {
        self.commit_by(&|out| out.write_all(bytes), interrupt)
    }

    /// The same with a result that is written part by part.
    pub(super) fn commit_by(self, write: Writer<'_>, interrupt: &Interrupt) -> Result<(), Failure> {
        let written = match &self.place {
            Place::Stdout if is_closed_stdout() => {
                Err(io::Error::other("it is closed; give `-o FILE`"))
            }
            Place::Stdout => through_stdout(write),
            Place::Stream(target) => {
                stream(target, interrupt).and_then(|mut stream| write(&mut stream))
            }
            Place::File(target, permissions) => {
                replace(target, permissions.clone(), write, interrupt)
            }
        };
        written.map_err(|error| match interrupt.is_raised() {
            true => Failure::Interrupted,
            false => failure(&self.name, &error),
        })
    }
}

impl Place {
    fn new(path: &Path) -> io::Result<Self> {
        let present = fs::metadata(path).ok();
        let permissions = match &present {
            Some(meta) if meta.is_dir() => return Err(ErrorKind::IsADirectory.into()),
            Some(meta) if !meta.is_file() => return Ok(Self::Stream(path.to_owned())),
            Some(meta) if meta.permissions().readonly() => {
                return Err(io::Error::other("the file is read-only"));
            }
            Some(meta) => Some(meta.permissions()),
            None => None,
        };
        // A link stays a link: what it points to is replaced, or made.
        let target = path.canonicalize().or_else(|_| followed(path))?;
        let folder = folder_of(&target);
        // The errors of what follows name the draft, which means nothing to the user: the folder
        // and the kind say it.
        fs::metadata(folder)?;
        draft(folder).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self::File(target, permissions))
    }
}

/// The target of a path through links, which need not exist yet.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&target) {
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("too many links"))
}

fn folder_of(target: &Path) -> &Path {
    target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// An empty file with the permissions of any new one, gone when dropped.
fn draft(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rtc-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Writes a file beside its target and puts it in place, unless Ctrl-C comes before.
fn replace(
    target: &Path,
    permissions: Option<Permissions>,
    write: Writer<'_>,
    interrupt: &Interrupt,
) -> io::Result<()> {
    let mut draft = draft(folder_of(target)).map_err(|error| io::Error::from(error.kind()))?;
    let path = draft.path().to_owned();
    interrupt.guard(&path, || {
        if let Some(permissions) = permissions {
            draft.as_file().set_permissions(permissions)?;
        }
        // By the file itself: the errors of its wrapper name the draft.
        write(draft.as_file_mut())?;
        draft.as_file().sync_all()?;
        if interrupt.is_raised() {
            return Err(ErrorKind::Interrupted.into());
        }
        draft.persist(target).map_err(|error| error.error).map(drop)
    })
}

/// A device or a pipe whose waits a signal ends.
struct Stream<'i> {
    file: File,
    interrupt: &'i Interrupt,
}

/// Opens a stream; a pipe once it has a reader.
fn stream<'i>(path: &Path, interrupt: &'i Interrupt) -> io::Result<Stream<'i>> {
    let mut options = OpenOptions::new();
    options.write(true);
    #[cfg(unix)]
    {
        let flags = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();
        std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, flags);
    }
    loop {
        match options.open(path) {
            Err(error) if has_no_reader(&error) && !interrupt.is_raised() => thread::sleep(WAIT),
            opened => return opened.map(|file| Stream { file, interrupt }),
        }
    }
}

#[cfg(unix)]
fn has_no_reader(error: &io::Error) -> bool {
    error.raw_os_error() == Some(rustix::io::Errno::NXIO.raw_os_error())
}

#[cfg(not(unix))]
fn has_no_reader(_: &io::Error) -> bool {
    false
}

impl Write for Stream<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        loop {
            match self.file.write(bytes) {
                Err(error)
                    if error.kind() == ErrorKind::WouldBlock && !self.interrupt.is_raised() =>
                {
                    thread::sleep(WAIT);
                }
                written => return written,
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
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
    through_stdout(&|out| out.write_all(bytes)).map_err(|error| failure("standard output", &error))
}

fn through_stdout(write: Writer<'_>) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    write(&mut stdout)?;
    stdout.flush()
}

/// Where standard output is closed, as by `>&-`, the runtime opens `/dev/null` for it, to be read
/// and written; `>/dev/null` opens it to be written.
#[cfg(unix)]
fn is_closed_stdout() -> bool {
    use rustix::fs::{OFlags, fcntl_getfl, fstat};
    use std::os::unix::fs::MetadataExt;
    let stdout = io::stdout();
    let is_both = fcntl_getfl(&stdout).is_ok_and(|flags| flags & OFlags::RWMODE == OFlags::RDWR);
    let device = fstat(&stdout).map(|stat| stat.st_rdev);
    let null = fs::metadata("/dev/null").map(|null| null.rdev());
    is_both && matches!((device, null), (Ok(device), Ok(null)) if device == null && null != 0)
}

#[cfg(not(unix))]
fn is_closed_stdout() -> bool {
    false
}

/// Refuses to write bytes that are not text to a terminal.
pub(super) fn refuse_terminal(path: &Path) -> Result<(), Failure> {
    if path.as_os_str() == "-" && io::stdout().is_terminal() {
        return Err(Failure::Trouble(
            "standard output is a terminal; give `-o FILE`, or `-o -` in a pipe".to_owned(),
        ));
    }
    Ok(())
}
