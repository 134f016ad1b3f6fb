//! Files for which no folder is searched: those of `.gitignore` and of `exclude` in an `rtc.toml`,
//! in the syntax of gitignore(5).
//!
//! A list applies to its folder and the folders below. The innermost list with a pattern that fits
//! decides, in it the last such pattern. What is in an ignored folder is ignored.

use super::project;
use globset::{GlobBuilder, GlobMatcher};
use rtc_source::{Loader, SourceMap};
use std::path::{Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// The name of the lists of git.
const NAME: &str = ".gitignore";

/// The root of a repository has this; lists above it mean others.
const REPOSITORY: &str = ".git";

/// The most bytes of a list, and the most patterns.
const MAX_BYTES: u64 = 1 << 20;
const MAX_PATTERNS: usize = 4096;

/// A line of a list.
struct IgnorePattern {
    glob: GlobMatcher,
    /// Whether it brings files back.
    is_negated: bool,
    /// Whether it means folders only.
    is_folder: bool,
}

/// The patterns of a folder.
struct IgnoreList {
    folder: PathBuf,
    patterns: Vec<IgnorePattern>,
}

/// The lists that apply where a walk is, the innermost last.
struct IgnoreLists {
    /// The folder that is searched, as it was named, and without links.
    root: PathBuf,
    resolved: PathBuf,
    lists: Vec<IgnoreList>,
}

/// Walks below a folder by names, past what is ignored or not `wanted`.
pub(super) fn traverse(
    root: &Path,
    folders: WalkDir,
    wanted: impl Fn(&DirEntry) -> bool,
) -> impl Iterator<Item = walkdir::Result<DirEntry>> {
    let mut lists = IgnoreLists::above(root);
    let entries = folders.sort_by_file_name().into_iter();
    entries.filter_entry(move |entry| wanted(entry) && lists.enter(entry))
}

impl IgnoreLists {
    /// The lists of a folder and of those above it, up to the root of its repository.
    fn above(root: &Path) -> Self {
        let resolved = root.canonicalize().unwrap_or_else(|_| root.to_owned());
        let mut folders = Vec::new();
        let mut is_in_repository = false;
        for folder in resolved.ancestors() {
            folders.push(folder);
            is_in_repository = folder.join(REPOSITORY).exists();
            if is_in_repository {
                break;
            }
        }
        let list = |folder: &&Path| IgnoreList::of(folder, is_in_repository || *folder == resolved);
        Self {
            root: root.to_owned(),
            lists: folders.iter().rev().map(list).collect(),
            resolved: resolved.clone(),
        }
    }

    /// Whether an entry is to be visited; then the lists of its folder apply.
    fn enter(&mut self, entry: &DirEntry) -> bool {
        let below = entry.path().strip_prefix(&self.root);
        let path = self.resolved.join(below.unwrap_or(Path::new("")));
        self.lists.retain(|list| path.starts_with(&list.folder));
        let is_folder = entry.file_type().is_dir();
        if entry.depth() == 0 {
            return true;
        }
        if self.ignore(&path, is_folder) {
            return false;
        }
        if is_folder {
            self.lists.push(IgnoreList::of(&path, true));
        }
        true
    }

    fn ignore(&self, path: &Path, is_folder: bool) -> bool {
        let statuses = self.lists.iter().rev();
        let mut statuses = statuses.filter_map(|list| list.status(path, is_folder));
        statuses.next().unwrap_or(false)
    }
}

impl IgnoreList {
    /// The list of a folder without links: that of git, if it counts, then that of its `rtc.toml`.
    fn of(folder: &Path, has_git: bool) -> Self {
        let read = |path: PathBuf| Loader.bytes(&path, MAX_BYTES, &SourceMap::default());
        let git = has_git.then(|| read(folder.join(NAME)).ok()).flatten();
        let git = git.and_then(|bytes| String::from_utf8(bytes).ok());
        let excluded = project::excluded(folder);
        let lines = git.iter().flat_map(|text| text.lines());
        let lines = lines.chain(excluded.iter().map(String::as_str));
        Self {
            folder: folder.to_owned(),
            patterns: lines
                .filter_map(IgnorePattern::read)
                .take(MAX_PATTERNS)
                .collect(),
        }
    }

    /// Whether it ignores a path; `None` if no pattern fits.
    fn status(&self, path: &Path, is_folder: bool) -> Option<bool> {
        let path = path.strip_prefix(&self.folder).ok()?;
        let mut fitting = self
            .patterns
            .iter()
            .rev()
            .filter(|pattern| (is_folder || !pattern.is_folder) && pattern.glob.is_match(path));
        fitting.next().map(|pattern| !pattern.is_negated)
    }
}

impl IgnorePattern {
    /// The pattern of a line, if it has one.
    fn read(line: &str) -> Option<Self> {
        let line = match line.trim_end() {
            // An escaped space at the end belongs to the name.
            short if short.ends_with('\\') && short.len() < line.len() => {
                line.get(..=short.len()).unwrap_or(short)
            }
            short => short,
        };
        let (is_negated, line) = match line.strip_prefix('!') {
            Some(rest) => (true, rest),
            None => (false, line),
        };
        let (is_folder, name) = match line.strip_suffix('/') {
            Some(rest) => (true, rest),
            None => (false, line),
        };
        if name.is_empty() || (name.starts_with('#') && !is_negated) {
            return None;
        }
        // With a `/` it is a path from the folder of the list, else a name in any folder.
        let pattern = match name.contains('/') {
            true => name.trim_start_matches('/').to_owned(),
            false => format!("**/{name}"),
        };
        let glob = GlobBuilder::new(&pattern)
            .literal_separator(true)
            .backslash_escape(true)
            .build();
        Some(Self {
            glob: glob.ok()?.compile_matcher(),
            is_negated,
            is_folder,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_are_those_of_git() {
        let list = |lines: &str| IgnoreList {
            folder: PathBuf::from("/r"),
            patterns: lines.lines().filter_map(IgnorePattern::read).collect(),
        };
        let status = |lines: &str, path: &str| {
            let is_folder = path.ends_with('/');
            let path = Path::new("/r").join(path.trim_end_matches('/'));
            list(lines).status(&path, is_folder)
        };
        for (lines, path, expected) in [
            ("a.yaml", "a.yaml", Some(true)),
            ("a.yaml", "x/y/a.yaml", Some(true)),
            ("/a.yaml", "x/a.yaml", None),
            ("x/a.yaml", "y/x/a.yaml", None),
            ("x/*.yaml", "x/a.yaml", Some(true)),
            ("x/*.yaml", "x/y/a.yaml", None),
            ("x/**", "x/y/a.yaml", Some(true)),
            ("**/y/a.yaml", "x/y/a.yaml", Some(true)),
            ("out/", "out/", Some(true)),
            ("out/", "x/out/", Some(true)),
            ("out/", "out", None),
            ("*.yaml\n!keep.yaml", "keep.yaml", Some(false)),
            ("!keep.yaml\n*.yaml", "keep.yaml", Some(true)),
            ("# a.yaml\n\n", "a.yaml", None),
            ("\\#a", "#a", Some(true)),
            ("a.yaml   ", "a.yaml", Some(true)),
            ("a[", "a[", None),
        ] {
            assert_eq!(status(lines, path), expected, "{lines:?}: {path}");
        }
    }
}
