//! The diagnostic for a file that is not found.

use super::{MissingFile, PendingAsset};
use rtc_diag::{Diagnostic, clip_path, codes};
use std::path::PathBuf;

/// The diagnostic for a file that is not found; `similar` is the name of an existing one.
pub(super) fn missing(
    pending: &PendingAsset,
    fault: &MissingFile,
    similar: Option<&str>,
) -> Diagnostic {
    let name = clip_path(&pending.path);
    match fault {
        MissingFile::NoFolder => {
            let message =
                format!("`{name}` cannot be found: a scene from standard input has no folder");
            Diagnostic::new(&codes::FILE_OUTSIDE, message)
                .at(pending.span, "no folder to search")
                .hint("pass the folder of its files with `--asset-root FOLDER`")
        }
        MissingFile::Absent(searched) => {
            Diagnostic::new(&codes::FILE_NOT_FOUND, format!("there is no file `{name}`"))
                .at(pending.span, "not found")
                .hint(match similar {
                    Some(name) => format!("did you mean `{}`?", clip_path(name)),
                    None => searched_paths(searched),
                })
                .hint(HINT)
        }
        MissingFile::Outside(searched) => {
            let message = format!("`{name}` leaves the folder of the scene");
            Diagnostic::new(&codes::FILE_OUTSIDE, message)
                .at(pending.span, "not followed")
                .hint(searched_paths(searched))
                .hint(HINT)
        }
    }
}

/// The hint for a file in another folder.
const HINT: &str = "put the file beside the scene, or allow its folder with `--asset-root`";

/// The paths where a file was searched, at most a few of them.
fn searched_paths(searched: &[PathBuf]) -> String {
    const MAX_SHOWN: usize = 6;
    let shown: Vec<String> = searched
        .iter()
        .take(MAX_SHOWN)
        .map(|path| format!("`{}`", clip_path(&path.to_string_lossy())))
        .collect();
    let more = searched.len().saturating_sub(MAX_SHOWN);
    let tail = if more > 0 {
        format!(" and {more} more places")
    } else {
        String::new()
    };
    if shown.is_empty() {
        "name a file".to_owned()
    } else {
        format!("searched at {}{tail}", shown.join(", "))
    }
}
