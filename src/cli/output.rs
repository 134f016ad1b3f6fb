//! Where results go: standard output, a stream, or a file, which appears whole or not at all.

use super::Failure;
use super::interrupt::Interrupt;
use rtc_diag::{clean_json, clean_lines};
use rtc_pipeline::{AtomicFile, FolderIdentity, Input, sidecar_folder};
use rtc_source::{Loader, SourceMap};
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

/// How long to wait for a reader before looking again, and for a signal.
const WAIT: Duration = Duration::from_millis(10);

/// Whether a result goes to standard output: by `-`, or by a system name for it.
pub(super) fn is_stdout(path: &Path) -> bool {
    const NAMES: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    NAMES.iter().any(|own| path.as_os_str() == *own)
}

/// A writable destination of a result.
pub(super) struct Output {
    /// As the user calls it.
    name: String,
    place: OutputTarget,
}

enum OutputTarget {
    Stdout,
    /// A device or a pipe, which cannot be replaced.
    OutputStream(PathBuf),
    File(AtomicFile),
}

/// What writes a result.
type OutputWriter<'w> = &'w dyn Fn(&mut dyn Write) -> io::Result<()>;

impl Output {
    /// Checks that `path` (`-` is standard output) can be written and is none of the input files,
    /// before a long computation.
    pub(super) fn open(path: &Path, input: &Input) -> Result<Self, Failure> {
        Self::open_unless_read(path, input.map())
    }

    /// Opens `path` for writing, unless it is a file that the source map has read.
    pub(super) fn open_unless_read(path: &Path, read: &SourceMap) -> Result<Self, Failure> {
        if is_stdout(path) {
            return Ok(Self {
                name: "standard output".to_owned(),
                place: OutputTarget::Stdout,
            });
        }
        let name = format!("`{}`", path.display());
        if read.has_read(path) {
            return Err(Failure::Failed(format!(
                "can't write {name}: it is an input of this run"
            )));
        }
        let file = AtomicFile::at(path).map_err(|error| failure(&name, &error))?;
        let place = file.map_or_else(
            || OutputTarget::OutputStream(path.to_owned()),
            OutputTarget::File,
        );
        Ok(Self { name, place })
    }

    /// The name of a folder for files beside the result; `None` if the result is no file.
    pub(super) fn sidecar_folder(&self, path: &Path) -> Option<String> {
        let is_file = matches!(self.place, OutputTarget::File(_));
        sidecar_folder(path).filter(|_| is_file)
    }

    /// Writes the result; a file appears under its name only now, and not after a signal to stop.
    pub(super) fn commit(self, bytes: &[u8], interrupt: &Interrupt) -> Result<(), Failure> {
        self.commit_by(&|out| out.write_all(bytes), interrupt)
    }

    /// Lets `write` write the file during the computation, in any order; the file appears under its
    /// name at the end. Fails if the target is no file.
    pub(super) fn commit_incrementally(
        self,
        write: &mut dyn FnMut(&mut File) -> io::Result<()>,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let written = match &self.place {
            OutputTarget::Stdout | OutputTarget::OutputStream(_) => Err(io::Error::other(
                "strips need a file to be put together in; give `-o FILE`",
            )),
            OutputTarget::File(file) => file.write_incrementally(write, interrupt),
        };
        self.reported(written, interrupt)
    }

    /// Writes the result with the function `write`; else as [`Self::commit`].
    pub(super) fn commit_by(
        self,
        write: OutputWriter<'_>,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let written = match &self.place {
            OutputTarget::Stdout => through_stdout(write),
            OutputTarget::OutputStream(target) => {
                stream(target, interrupt).and_then(|mut stream| write(&mut stream))
            }
            OutputTarget::File(file) => file.write(write, interrupt),
        };
        self.reported(written, interrupt)
    }

    /// The message of a failed write.
    fn reported(&self, written: io::Result<()>, interrupt: &Interrupt) -> Result<(), Failure> {
        written.map_err(|error| match interrupt.is_raised() {
            true => Failure::Interrupted,
            false => failure(&self.name, &error),
        })
    }
}

/// Files that a result needs, in folders beside it: they go again unless they are to be kept.
pub(super) struct SidecarFiles {
    folder: PathBuf,
    /// The files and folders that were made, in this order.
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl SidecarFiles {
    /// None so far, beside the result at `path`.
    pub(super) fn beside(path: &Path) -> Self {
        Self {
            folder: folder_of(path).to_owned(),
            files: Vec::new(),
            folders: Vec::new(),
        }
    }

    /// Writes a file at a path relative to the folder of the result. An identical file is kept; any
    /// other existing file is an error.
    pub(super) fn put(
        &mut self,
        name: &str,
        bytes: &[u8],
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        let target = self.folder.join(name);
        let shown = format!("`{}`", target.display());
        if folder_of(&target) != self.folder && folder_of(&target).is_symlink() {
            let fault = io::Error::other("its folder is a link");
            return Err(failure(&shown, &fault));
        }
        match fs::symlink_metadata(&target) {
            Ok(there) if is_same(&there, &target, bytes) => return Ok(()),
            Ok(_) => {
                let fault = io::Error::other("there is something else of this name");
                return Err(failure(&shown, &fault));
            }
            Err(_) => {}
        }
        let written = self.make_folder(&target).and_then(|()| {
            let file = AtomicFile::at(&target)?.ok_or(ErrorKind::AlreadyExists)?;
            file.write(&|out| out.write_all(bytes), interrupt)
        });
        match written {
            Ok(()) => self.files.push(target),
            Err(_) if interrupt.is_raised() => return Err(Failure::Interrupted),
            Err(error) => return Err(failure(&shown, &error)),
        }
        Ok(())
    }

    fn make_folder(&mut self, target: &Path) -> io::Result<()> {
        let folder = folder_of(target);
        if !folder.is_dir() {
            fs::create_dir(folder)?;
            self.folders.push(folder.to_owned());
        }
        Ok(())
    }

    /// Lets them stay: the result is there.
    pub(super) fn keep(mut self) {
        self.files.clear();
        self.folders.clear();
    }
}

impl Drop for SidecarFiles {
    fn drop(&mut self) {
        // A folder that can't be removed stays: the original error is reported.
        for file in self.files.drain(..) {
            let _ = fs::remove_file(file);
        }
        for folder in self.folders.drain(..) {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Whether a file has these bytes.
fn is_same(there: &fs::Metadata, path: &Path, bytes: &[u8]) -> bool {
    let length = bytes.len() as u64;
    let read = || Loader.bytes(path, length, &SourceMap::default());
    there.is_file() && there.len() == length && read().is_ok_and(|own| own == bytes)
}

fn folder_of(target: &Path) -> &Path {
    target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// A device or a pipe whose waits a signal ends.
struct OutputStream<'i> {
    file: File,
    interrupt: &'i Interrupt,
}

/// Opens a stream; a pipe once it has a reader.
fn stream<'i>(path: &Path, interrupt: &'i Interrupt) -> io::Result<OutputStream<'i>> {
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
            opened => return opened.map(|file| OutputStream { file, interrupt }),
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

impl Write for OutputStream<'_> {
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

/// Checks that the folder of a result was not replaced since it was found.
pub(super) fn check_folder(folder: &FolderIdentity, path: &Path) -> Result<(), Failure> {
    let checked = folder.check();
    checked.map_err(|error| failure(&format!("`{}`", path.display()), &error))
}

/// A closed pipe is a reader that had enough; all else is trouble.
fn failure(name: &str, error: &io::Error) -> Failure {
    if error.kind() == ErrorKind::BrokenPipe {
        return Failure::ClosedPipe;
    }
    Failure::Failed(format!("can't write {name}: {error}"))
}

/// Writes to standard output; a closed pipe is no failure.
pub(super) fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    through_stdout(&|out| out.write_all(bytes)).map_err(|error| failure("standard output", &error))
}

/// Prints a text of lines to standard output, without characters that command a terminal.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    to_stdout(clean_lines(text).as_bytes())
}

/// The same for JSON.
pub(super) fn print_json(json: &str) -> Result<(), Failure> {
    to_stdout(clean_json(json).as_bytes())
}

fn through_stdout(write: OutputWriter<'_>) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    write(&mut stdout)?;
    stdout.flush()
}

/// Refuses to write bytes that are not text to a terminal.
pub(super) fn refuse_terminal(path: &Path) -> Result<(), Failure> {
    if is_stdout(path) && io::stdout().is_terminal() {
        return Err(Failure::Failed(
            "standard output is a terminal; give `-o FILE`, or `-o -` in a pipe".to_owned(),
        ));
    }
    Ok(())
}
