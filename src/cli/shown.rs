//! Picture files that a command is given, read within the budget of the run.

use super::Failure;
use rtc_image::{DecodeCost, DisplayedFile, DisplayedPicture};
use rtc_source::{Budget, LimitExceeded, Loader, Resource, SourceMap};
use std::path::Path;

/// The largest picture file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// The bytes of a picture file; by them the budget of the run grows.
pub(super) fn read(path: &Path, map: &SourceMap) -> Result<Vec<u8>, Failure> {
    let bytes = Loader.bytes(path, MAX_BYTES, map);
    bytes.map_err(|error| Failure::Failed(format!("`{}`: {error}", path.display())))
}

/// A picture file whose header was read.
pub(super) fn opened<'b>(
    path: &Path,
    bytes: &'b [u8],
    budget: &Budget,
) -> Result<DisplayedFile<'b>, Failure> {
    let file = DisplayedFile::open(bytes, budget.limit(Resource::Pixels));
    file.map_err(|error| Failure::Failed(format!("`{}` {error}", path.display())))
}

/// Charges the memory for decoding a file, unless it exceeds the limit.
pub(super) fn charge(path: &Path, cost: DecodeCost, budget: &Budget) -> Result<(), Failure> {
    let DecodeCost {
        pixels,
        memory,
        scratch,
    } = cost;
    let charged = budget
        .charge(Resource::Pixels, pixels)
        .and_then(|()| budget.has(Resource::Memory, memory.saturating_add(scratch)))
        .and_then(|()| budget.charge(Resource::Memory, memory));
    charged.map_err(|fault| over_limit(&format!("`{}`", path.display()), &fault))
}

/// The picture in a file that was charged.
pub(super) fn decoded(path: &Path, file: DisplayedFile<'_>) -> Result<DisplayedPicture, Failure> {
    let picture = file.decode();
    picture.map_err(|error| Failure::Failed(format!("`{}` {error}", path.display())))
}

/// The error that the memory exceeds the limit.
pub(super) fn over_limit(what: &str, fault: &LimitExceeded) -> Failure {
    Failure::Failed(format!("{what}: {fault}; {}", fault.hint()))
}
