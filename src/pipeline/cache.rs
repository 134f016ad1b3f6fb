//! A folder of finished results by the hash of everything they depend on.
//!
//! Each entry is one file: a magic number, its key, the content, and the SHA-256 of all before. It
//! is written atomically and checked when read; a damaged one counts as absent. The folder is
//! bounded: the entries whose last use is longest ago are removed. Several processes may use it at
//! once, because no entry depends on another one and each is replaced as a whole.
//!
//! The hash finds damage, not forgery: whoever may write the folder may write wrong entries. So a
//! folder of another user, or one that all may write, is not used.

use super::{AtomicFile, WriteObserver};
use rtc_codec::{self as codec, Encoding};
use rtc_ir::Scene;
use rtc_source::{LoadError, Loader, SourceMap, is_own_folder};
use sha2::{Digest, Sha256};
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, DirEntry, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, SystemTime};

const MAGIC: &[u8; 8] = b"rtcache1";
const KEY_BYTES: usize = 32;
const HASH_BYTES: usize = 32;

/// The extension of the entries; other files of the folder are left alone.
const EXTENSION: &str = "rtc-entry";

/// The largest entry in bytes, however large the folder may be.
const MAX_ENTRY: u64 = 1 << 30;

/// The largest program that is hashed, in bytes.
const MAX_PROGRAM: u64 = 1 << 30;

/// The age of a temporary file whose process has ended.
const ABANDONED: Duration = Duration::from_secs(3600);

/// The hash of everything a result depends on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct CacheKey([u8; KEY_BYTES]);

impl CacheKey {
    /// The key of a kind of results that depend on these parts and on this program.
    #[must_use]
    pub fn of(kind: &str, parts: &[&[u8]]) -> Self {
        let mut hash = Sha256::new();
        let own = [kind.as_bytes(), program().as_bytes()];
        for part in own.iter().chain(parts) {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
        Self(hash.finalize().into())
    }

    /// The key with these hexadecimal digits, if it is one.
    #[must_use]
    pub fn parse(digits: &str) -> Option<Self> {
        let mut key = [0; KEY_BYTES];
        let pairs = digits.as_bytes().chunks(2);
        if pairs.len() != KEY_BYTES {
            return None;
        }
        for (byte, pair) in key.iter_mut().zip(pairs) {
            let pair = std::str::from_utf8(pair)
                .ok()
                .filter(|pair| pair.len() == 2)?;
            *byte = u8::from_str_radix(pair, 16).ok()?;
        }
        Some(Self(key))
    }
}

/// As hexadecimal digits.
impl fmt::Display for CacheKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// The SHA-256 of the IR of a valid scene with its assets.
///
/// # Panics
/// If a number is not finite, which a valid scene excludes.
#[must_use]
pub fn scene_digest(scene: &Scene) -> [u8; 32] {
    struct DigestWriter(Sha256);

    impl Write for DigestWriter {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.update(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    let encoded = codec::prepare(Encoding::Binary, scene);
    let encoded = encoded.expect("a valid scene has only finite numbers");
    let mut hash = DigestWriter(Sha256::new());
    encoded.write(&mut hash).expect("hashing does not fail");
    hash.0.finalize().into()
}

/// What identifies the program: its version and the hash of its file, as two builds of one version
/// may make different pictures.
fn program() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let read = |path: PathBuf| Loader.bytes(&path, MAX_PROGRAM, &SourceMap::default());
        let bytes = std::env::current_exe()
            .ok()
            .and_then(|path| read(path).ok());
        let hash = bytes.map(|bytes| xxhash_rust::xxh3::xxh3_128(&bytes));
        format!("{} {:032x}", super::setup::SOFTWARE, hash.unwrap_or(0))
    })
}

/// Why there is no entry; displays as a message.
#[derive(Debug)]
pub enum CacheMiss {
    /// There is none of this key.
    Absent,
    /// Its bytes are not those that were written.
    Damaged,
    /// It can't be read.
    Unreadable(LoadError),
}

impl fmt::Display for CacheMiss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent => f.write_str("there is no entry"),
            Self::Damaged => f.write_str("the entry is damaged"),
            Self::Unreadable(error) => write!(f, "the entry can't be read: {error}"),
        }
    }
}

/// A folder of entries.
#[derive(Clone, Debug)]
pub struct CacheFolder {
    folder: PathBuf,
    limit: u64,
}

impl CacheFolder {
    /// The folder at a path, which is made if it does not exist; its entries have at most `limit`
    /// bytes together.
    ///
    /// # Errors
    /// If it can't be made, or others may write entries there.
    pub fn at(path: &Path, limit: u64) -> io::Result<Self> {
        fs::create_dir_all(path)?;
        let folder = path.canonicalize()?;
        if !is_own_folder(&folder)? {
            let message = "it belongs to another user, or all may write it";
            return Err(io::Error::other(message));
        }
        Ok(Self { folder, limit })
    }

    /// The content of the entry of a key, whose last use is now.
    ///
    /// # Errors
    /// The reason, if there is none.
    pub fn get(&self, key: CacheKey) -> Result<Vec<u8>, CacheMiss> {
        let path = self.path(key);
        let bytes = Loader.bytes(&path, MAX_ENTRY, &SourceMap::default());
        let bytes = bytes.map_err(|error| match error {
            LoadError::Io(error) if error.kind() == ErrorKind::NotFound => CacheMiss::Absent,
            error @ (LoadError::Io(_) | LoadError::TooLarge { .. } | LoadError::NotRegular) => {
                CacheMiss::Unreadable(error)
            }
        })?;
        let content = checked(bytes, key).ok_or(CacheMiss::Damaged)?;
        // Without the time of its last use it is removed sooner.
        let opened = OpenOptions::new().append(true).open(&path);
        let _ = opened.and_then(|file| file.set_modified(SystemTime::now()));
        Ok(content)
    }

    /// Adds an entry, or replaces the one of the same key; then removes the entries that are too
    /// many. One that is larger than the folder may be is not added.
    ///
    /// # Errors
    /// An error of the system, or if the observer stopped it.
    pub fn put(
        &self,
        key: CacheKey,
        content: &[u8],
        observer: &dyn WriteObserver,
    ) -> io::Result<()> {
        let size = (MAGIC.len() + KEY_BYTES + content.len() + HASH_BYTES) as u64;
        if size > self.limit.min(MAX_ENTRY) {
            return Ok(());
        }
        let hash = Sha256::new().chain_update(MAGIC).chain_update(key.0);
        let hash: [u8; HASH_BYTES] = hash.chain_update(content).finalize().into();
        let parts: [&[u8]; 4] = [MAGIC, &key.0, content, &hash];
        let write = |out: &mut dyn Write| parts.iter().try_for_each(|part| out.write_all(part));
        let file = AtomicFile::at(&self.path(key))?.ok_or(ErrorKind::AlreadyExists)?;
        file.write(&write, observer)?;
        self.shrink()
    }

    /// Removes the entries whose last use is longest ago, until the others have at most the bytes
    /// allowed; and temporary files of processes that have ended.
    fn shrink(&self) -> io::Result<()> {
        let mut entries = Vec::new();
        // Other processes remove entries, too.
        for entry in fs::read_dir(&self.folder)?.flatten() {
            let Some(metadata) = entry.metadata().ok().filter(Metadata::is_file) else {
                continue;
            };
            let used = metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            if is_entry(&entry) {
                entries.push((used, entry.path(), metadata.len()));
            } else if is_draft(&entry) && used.elapsed().is_ok_and(|age| age > ABANDONED) {
                let _ = fs::remove_file(entry.path());
            }
        }
        entries.sort_unstable();
        let mut total: u64 = entries.iter().map(|(_, _, size)| size).sum();
        for (_, path, size) in entries {
            if total <= self.limit {
                break;
            }
            let removed = fs::remove_file(path);
            match removed {
                Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
                Ok(()) | Err(_) => total -= size,
            }
        }
        Ok(())
    }

    fn path(&self, key: CacheKey) -> PathBuf {
        self.folder.join(format!("{key}.{EXTENSION}"))
    }
}

/// The content of an entry, if its bytes are those that were written for this key.
fn checked(mut bytes: Vec<u8>, key: CacheKey) -> Option<Vec<u8>> {
    let (body, hash) = bytes.split_last_chunk::<HASH_BYTES>()?;
    let head = [MAGIC.as_slice(), &key.0].concat();
    let is_whole = body.starts_with(&head) && Sha256::digest(body).as_slice() == hash;
    if !is_whole {
        return None;
    }
    bytes.truncate(bytes.len() - HASH_BYTES);
    bytes.drain(..head.len());
    Some(bytes)
}

fn is_entry(entry: &DirEntry) -> bool {
    let path = entry.path();
    let stem = path.file_stem().and_then(OsStr::to_str);
    path.extension() == Some(OsStr::new(EXTENSION)) && stem.and_then(CacheKey::parse).is_some()
}

/// Whether it is a file that [`AtomicFile`] had begun.
fn is_draft(entry: &DirEntry) -> bool {
    let name = entry.file_name();
    let name = name.to_string_lossy();
    name.starts_with(".rtc-") && name.ends_with(".tmp")
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Unobserved;

    impl WriteObserver for Unobserved {
        fn is_stopped(&self) -> bool {
            false
        }

        fn draft(&self, _: Option<&Path>) {}
    }

    fn key(number: u8) -> CacheKey {
        CacheKey::of("test", &[&[number]])
    }

    #[test]
    fn keys_have_digits_and_bounds_of_parts_count() {
        assert_eq!(
            CacheKey::parse(&key(1).to_string()).map(|own| own.0),
            Some(key(1).0)
        );
        assert!(CacheKey::parse("zz").is_none() && CacheKey::parse(&"ä".repeat(32)).is_none());
        let of = |parts: &[&[u8]]| CacheKey::of("test", parts).0;
        assert_ne!(of(&[b"ab", b"c"]), of(&[b"a", b"bc"]));
        assert_ne!(CacheKey::of("other", &[&[1]]).0, key(1).0);
    }

    /// Every byte of an entry counts: magic number, key, content, hash, and their number.
    #[test]
    fn a_damaged_entry_is_no_hit_and_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let cache = CacheFolder::at(folder.path(), 1 << 20).unwrap();
        assert!(matches!(cache.get(key(0)), Err(CacheMiss::Absent)));
        cache.put(key(0), b"content", &Unobserved).unwrap();
        assert_eq!(cache.get(key(0)).unwrap(), b"content");
        let path = cache.path(key(0));
        let whole = Loader
            .bytes(&path, MAX_ENTRY, &SourceMap::default())
            .unwrap();
        let flipped = (0..whole.len()).map(|at| {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << (at % 8);
            bytes
        });
        let cut = (0..whole.len()).map(|length| whole[..length].to_vec());
        let longer = [[whole.as_slice(), &[0]].concat()];
        for bytes in flipped.chain(cut).chain(longer) {
            AtomicFile::save(&path, &bytes).unwrap();
            assert!(matches!(cache.get(key(0)), Err(CacheMiss::Damaged)));
        }
        // The entry of another key is none of this one.
        AtomicFile::save(&cache.path(key(1)), &whole).unwrap();
        assert!(matches!(cache.get(key(1)), Err(CacheMiss::Damaged)));
        cache.put(key(0), b"content", &Unobserved).unwrap();
        assert_eq!(cache.get(key(0)).unwrap(), b"content");
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_that_all_may_write_is_not_used() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        for (mode, is_used) in [
            (0o777, false),
            (0o1777, false),
            (0o770, true),
            (0o755, true),
        ] {
            fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode)).unwrap();
            assert_eq!(
                CacheFolder::at(folder.path(), 1).is_ok(),
                is_used,
                "{mode:o}"
            );
        }
    }

    #[test]
    fn the_entries_used_last_stay_and_other_files_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let size = MAGIC.len() + KEY_BYTES + HASH_BYTES + 100;
        let cache = CacheFolder::at(folder.path(), 3 * size as u64).unwrap();
        AtomicFile::save(&folder.path().join("other.rtc-entry"), &[0; 1000]).unwrap();
        for number in 0..3 {
            cache.put(key(number), &[number; 100], &Unobserved).unwrap();
            let then = SystemTime::now() - Duration::from_secs(100 - u64::from(number));
            let file = OpenOptions::new()
                .append(true)
                .open(cache.path(key(number)));
            file.unwrap().set_modified(then).unwrap();
        }
        // The first is used again, so the second one goes.
        assert!(cache.get(key(0)).is_ok());
        cache.put(key(3), &[3; 100], &Unobserved).unwrap();
        let is_there = [0, 1, 2, 3].map(|number| cache.get(key(number)).is_ok());
        assert_eq!(is_there, [true, false, true, true]);
        // What is too large for the folder is not added.
        cache.put(key(4), &[4; 1000], &Unobserved).unwrap();
        assert!(matches!(cache.get(key(4)), Err(CacheMiss::Absent)));
        assert!(cache.get(key(3)).is_ok() && folder.path().join("other.rtc-entry").exists());
    }
}
