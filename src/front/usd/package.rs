//! Packages (`.usdz`): ZIP archives whose files are stored as they are, the first one the stage.

use rtc_source::{Budget, LimitExceeded, Resource};
use std::collections::BTreeMap;
use std::ops::Range;

/// The memory of an entry, in bytes, rounded up.
const ENTRY: u64 = 256;

/// The files of a package: where the bytes of each are.
#[derive(Debug, Default)]
pub(super) struct UsdzPackage {
    pub(super) first: String,
    files: BTreeMap<String, Range<usize>>,
}

/// Why a package is not read.
pub(super) enum UsdzError {
    Damaged(&'static str),
    Limit(LimitExceeded),
}

pub(super) fn is_package(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

impl UsdzPackage {
    /// Reads the directory at the end of an archive.
    ///
    /// # Errors
    /// If it is damaged, compressed or too long.
    pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Self, UsdzError> {
        const CUT: UsdzError = UsdzError::Damaged("its list of files is cut off");
        let number = |at: usize, size: usize| {
            let bytes = bytes.get(at..at.checked_add(size)?)?;
            Some(
                bytes
                    .iter()
                    .rev()
                    .fold(0_usize, |sum, byte| (sum << 8) | usize::from(*byte)),
            )
        };
        let end = memchr::memmem::rfind(bytes, b"PK\x05\x06").ok_or(CUT)?;
        let mut at = number(end + 16, 4).ok_or(CUT)?;
        let mut package = Self::default();
        let mut taken = Vec::new();
        while bytes
            .get(at..)
            .is_some_and(|rest| rest.starts_with(b"PK\x01\x02"))
        {
            budget
                .charge(Resource::Memory, ENTRY)
                .map_err(UsdzError::Limit)?;
            let field = |offset: usize, size: usize| number(at + offset, size).ok_or(CUT);
            let (method, size) = (field(10, 2)?, field(20, 4)?);
            let (name, extra, comment) = (field(28, 2)?, field(30, 2)?, field(32, 2)?);
            let start = field(42, 4)?;
            let text = bytes.get(at + 46..at + 46 + name).ok_or(CUT)?;
            let text = String::from_utf8_lossy(text).into_owned();
            if method != 0 {
                return Err(UsdzError::Damaged("its files are compressed"));
            }
            // Before the bytes stands a header with a name and extra bytes of its own.
            let lengths = number(start + 26, 2)
                .zip(number(start + 28, 2))
                .ok_or(CUT)?;
            let (header, start) = (start, start + 30 + lengths.0 + lengths.1);
            bytes.get(start..start + size).ok_or(CUT)?;
            taken.push(header..start + size);
            if package.first.is_empty() {
                package.first.clone_from(&text);
            }
            package.files.insert(text, start..start + size);
            at += 46 + name + extra + comment;
        }
        // What is copied of an archive is never more than the archive.
        taken.sort_by_key(|range| range.start);
        if taken.windows(2).any(|pair| pair[1].start < pair[0].end) {
            return Err(UsdzError::Damaged("its files overlap"));
        }
        match package.first.is_empty() {
            true => Err(UsdzError::Damaged("it holds no file")),
            false => Ok(package),
        }
    }

    pub(super) fn file(&self, path: &str) -> Option<Range<usize>> {
        self.files.get(path).cloned()
    }
}

/// The package and the file in it of a path with brackets: `a.usdz[b.usda]`.
pub(super) fn bracketed(path: &str) -> Option<(&str, &str)> {
    path.strip_suffix(']')?.split_once('[')
}

/// A path relative to the folder of a file in the package, without `.` and `..`.
pub(super) fn joined(from: &str, path: &str) -> String {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut names = Vec::new();
    for name in folder.split('/').chain(path.split('/')) {
        match name {
            "" | "." => {}
            ".." => drop(names.pop()),
            name => names.push(name),
        }
    }
    names.join("/")
}
