//! Statistics from system files; none on systems without them.

use rtc_source::{Loader, SourceMap};
use std::path::Path;

/// The name of the processor.
pub(super) fn processor() -> Option<String> {
    reported("/proc/cpuinfo", "model name")
}

/// The bytes of this process on huge pages, as hierarchies request them.
pub(super) fn huge_pages() -> Option<u64> {
    let granted = reported("/proc/self/smaps_rollup", "AnonHugePages")?;
    let kib: u64 = granted.strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

/// The value of a name in a file.
fn reported(file: &str, name: &str) -> Option<String> {
    let mut map = SourceMap::default();
    let file = Loader.file(Path::new(file), &mut map).ok()?;
    let text = String::from_utf8_lossy(map.bytes(file)).into_owned();
    let line = text.lines().find(|line| line.starts_with(name))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}
