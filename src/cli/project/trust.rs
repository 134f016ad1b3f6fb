//! The trust in `rtc.toml` files: the folders that the user's own settings list.

use super::super::Failure;
use super::MAX_BYTES;
use rtc_source::Loader;
use std::env;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// The key of the list.
const LIST: &str = "trusted-projects";

/// The trust in an `rtc.toml`.
pub(super) enum ProjectTrust {
    /// Everything.
    Full,
    /// It may lower limits, and add this folder, that of the scene, to the search.
    Within(PathBuf),
}

/// Whether the user's own settings list a folder without links, or one above it. A list that others
/// can write is ignored.
pub(super) fn is_listed(folder: &Path) -> Result<bool, Failure> {
    let Some(path) = own_settings() else {
        return Ok(false);
    };
    let Ok(file) = Loader.owned(&path, MAX_BYTES) else {
        return Ok(false);
    };
    let listed = listed(&file.bytes).ok_or_else(|| {
        let message =
            "the only key is `trusted-projects`, a list of folders, as `[\"/home/me/scenes\"]`";
        Failure::Failed(format!("`{}`: {message}", path.display()))
    })?;
    let holds = |own: &PathBuf| {
        let own = own.canonicalize();
        own.is_ok_and(|own| folder.starts_with(own))
    };
    Ok(file.is_trusted && listed.iter().any(holds))
}

/// The folders of the list; `None` if the text is no such list.
fn listed(bytes: &[u8]) -> Option<Vec<PathBuf>> {
    let table = DeTable::parse(std::str::from_utf8(bytes).ok()?).ok()?;
    let mut folders = Vec::new();
    for (key, value) in table.get_ref() {
        let DeValue::Array(list) = value.get_ref() else {
            return None;
        };
        if key.get_ref() != LIST {
            return None;
        }
        for folder in list {
            let folder = PathBuf::from(folder.get_ref().as_str()?);
            folders.extend(folder.is_absolute().then_some(folder));
        }
    }
    Some(folders)
}

/// The path of the user's own settings.
fn own_settings() -> Option<PathBuf> {
    let named = |name| env::var_os(name).map(PathBuf::from);
    let given = named("XDG_CONFIG_HOME").or_else(|| named("APPDATA"));
    let folder = given.filter(|folder| folder.is_absolute());
    let folder = folder.or_else(|| Some(env::home_dir()?.join(".config")))?;
    Some(folder.join("rtc").join("config.toml"))
}
