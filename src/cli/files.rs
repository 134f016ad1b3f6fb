//! Scenes by folders and patterns: which files are meant.
//!
//! In a folder, and among what fits a pattern, a YAML, JSON or XML file is a scene only if it looks
//! like one, and a pbrt file only if it is no part of another one. A file that the command line
//! names always is.
//!
//! No link is followed but the one that the command line names: it may lead round in circles, or to
//! what is no matter of the folder.

use super::{Failure, reporter};
use globset::{GlobBuilder, GlobMatcher};
use rtc_front::{is_scene_name, is_scene_text_name};
use rtc_pipeline::is_scene;
use rtc_source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// What makes a part of a path a pattern.
const WILD: [char; 3] = ['*', '?', '['];

/// Whether a file of this name is meant where a folder is given.
type NameTest = fn(&str) -> bool;

/// The extensions of scenes that other programs use for files of their own, or that parts of scenes
/// have, too.
const SHARED_EXTENSIONS: [&str; 6] = ["yaml", "yml", "json", "xml", "pbrt", "gz"];

/// Larger files are taken for scenes without a look.
const LONGEST_READ: u64 = 64 << 20;

/// The scenes that are meant.
pub(super) struct SceneFiles {
    pub(super) paths: Vec<PathBuf>,
    /// The number of files that have the name of a scene and are none.
    pub(super) skipped: usize,
}

impl SceneFiles {
    /// Says how many files were skipped, if any, unless only errors are wanted.
    pub(super) fn report_skipped(&self, is_quiet: bool) {
        match self.skipped {
            _ if is_quiet => {}
            0 => {}
            1 => reporter::say("1 file skipped that is no scene"),
            skipped => reporter::say(&format!("{skipped} files skipped that are no scenes")),
        }
    }
}

/// The scenes that are meant: each path as it is; of a folder all scenes below it; of a pattern
/// that is no file by itself, the scenes that fit it. What is found comes in the order of its
/// names, without hidden files and without links, and once. With `skip_others` a path that does not
/// look like a scene is skipped, too.
pub(super) fn scenes(paths: &[PathBuf], skip_others: bool) -> Result<SceneFiles, Failure> {
    named(paths, is_scene_name, skip_others)
}

/// The same for scenes that are texts of people.
pub(super) fn texts(paths: &[PathBuf]) -> Result<SceneFiles, Failure> {
    named(paths, is_scene_text_name, false)
}

/// Whether a file is a scene as far as its name and its first look tell. A file that can't be read
/// is one: the command that reads it reports why it can't.
fn looks_like_scene(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    let is_shared = SHARED_EXTENSIONS
        .iter()
        .any(|shared| extension.eq_ignore_ascii_case(shared));
    let bytes = || Loader.bytes(path, LONGEST_READ, &SourceMap::default());
    !is_shared || bytes().map_or(true, |bytes| is_scene(&path.to_string_lossy(), &bytes))
}

fn named(paths: &[PathBuf], is_meant: NameTest, skip_others: bool) -> Result<SceneFiles, Failure> {
    let (mut scenes, mut known, mut skipped) = (Vec::new(), BTreeSet::new(), 0);
    for path in paths {
        let found = if path.is_dir() {
            below(path, is_meant)?
        } else if is_pattern(path) {
            fitting(path, is_meant)?
        } else if skip_others && !looks_like_scene(path) {
            skipped += 1;
            continue;
        } else {
            known.insert(path.clone());
            scenes.push(path.clone());
            continue;
        };
        // Keep the scenes among the files that were not found before.
        let new = found.into_iter().filter(|path| known.insert(path.clone()));
        let (of_scenes, others): (Vec<_>, Vec<_>) = new.partition(|path| looks_like_scene(path));
        if of_scenes.is_empty() && !others.is_empty() {
            let count = others.len();
            return Err(Failure::Trouble(format!(
                "`{}`: there are no scenes among its {count} YAML, JSON and XML files",
                path.display()
            )));
        }
        skipped += others.len();
        scenes.extend(of_scenes);
    }
    Ok(SceneFiles {
        paths: scenes,
        skipped,
    })
}

/// Whether a path is none of a file but a pattern.
fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(WILD) && path.symlink_metadata().is_err()
}

/// The files that fit a pattern, and the scenes below the folders that do: at least one.
fn fitting(pattern: &Path, is_meant: NameTest) -> Result<Vec<PathBuf>, Failure> {
    let shown = pattern.display();
    let refused = |words: &str| Failure::Trouble(format!("`{shown}`: {words}"));
    let pattern = FilePattern::new(pattern).map_err(|words| refused(&words))?;
    let mut found = Vec::new();
    for entry in pattern.traverse() {
        let entry = entry.map_err(|error| refused(&reason(&error)))?;
        let path = pattern.shown(&entry);
        let kind = entry.file_type();
        if pattern.fits(path) && kind.is_dir() {
            found.extend(below(path, is_meant)?);
        } else if pattern.fits(path) && kind.is_file() {
            found.push(path.to_owned());
        }
    }
    match found.is_empty() {
        true => Err(refused("no file has such a name; links are not followed")),
        false => Ok(found),
    }
}

/// A pattern of paths.
struct FilePattern {
    /// The folder that it begins with, which is none itself.
    base: PathBuf,
    /// What follows, part by part, and as a whole.
    parts: Vec<String>,
    rest: GlobMatcher,
}

impl FilePattern {
    fn new(path: &Path) -> Result<Self, String> {
        let is_wild = |part: &Component<'_>| part.as_os_str().to_string_lossy().contains(WILD);
        let parts: Vec<_> = path.components().collect();
        let first = parts.iter().position(is_wild).unwrap_or(parts.len());
        let (base, rest) = parts.split_at(first);
        let rest = rest.iter().map(|part| part.as_os_str().to_str());
        let rest: Option<Vec<_>> = rest.map(|part| part.map(str::to_owned)).collect();
        let parts = rest.ok_or("a pattern is text")?;
        let glob = GlobBuilder::new(&parts.join("/"))
            .literal_separator(true)
            .backslash_escape(false)
            .build();
        let rest = glob.map_err(|error| error.kind().to_string())?;
        Ok(Self {
            base: base.iter().collect(),
            parts,
            rest: rest.compile_matcher(),
        })
    }

    /// What lies so deep that it may fit, but for what is hidden and not named.
    fn traverse(&self) -> impl Iterator<Item = walkdir::Result<DirEntry>> {
        let is_deep = self.parts.iter().any(|part| part.contains("**"));
        let depth = if is_deep {
            usize::MAX
        } else {
            self.parts.len()
        };
        let base = match self.base.as_os_str().is_empty() {
            true => Path::new("."),
            false => &self.base,
        };
        let traverse = WalkDir::new(base).min_depth(1).max_depth(depth);
        let is_named = |entry: &DirEntry| {
            let own = self.parts.get(entry.depth().saturating_sub(1));
            !is_hidden(entry) || own.is_some_and(|part| part.starts_with('.'))
        };
        traverse
            .sort_by_file_name()
            .into_iter()
            .filter_entry(is_named)
    }

    /// The path of what was found, as who wrote the pattern would write it.
    fn shown<'e>(&self, entry: &'e DirEntry) -> &'e Path {
        let path = entry.path();
        match self.base.as_os_str().is_empty() {
            true => path.strip_prefix(".").unwrap_or(path),
            false => path,
        }
    }

    fn fits(&self, path: &Path) -> bool {
        self.rest
            .is_match(path.strip_prefix(&self.base).unwrap_or(path))
    }
}

/// All scenes below a folder: at least one.
fn below(folder: &Path, is_meant: NameTest) -> Result<Vec<PathBuf>, Failure> {
    let refused = |words: &str| Failure::Trouble(format!("`{}`: {words}", folder.display()));
    let mut found = Vec::new();
    let entries = WalkDir::new(folder).sort_by_file_name().into_iter();
    for entry in entries.filter_entry(|entry| !is_hidden(entry)) {
        let entry = entry.map_err(|error| refused(&reason(&error)))?;
        let is_scene = is_meant(&entry.file_name().to_string_lossy());
        if is_scene && entry.file_type().is_file() {
            found.push(entry.into_path());
        }
    }
    match found.is_empty() {
        true => Err(refused("there are no scenes in this folder")),
        false => Ok(found),
    }
}

/// Whether the name of what was found, not of what was named, begins with a dot.
fn is_hidden(entry: &DirEntry) -> bool {
    entry.depth() > 0 && entry.file_name().as_encoded_bytes().starts_with(b".")
}

/// What the system said.
fn reason(error: &walkdir::Error) -> String {
    let said = error.io_error().map(ToString::to_string);
    said.unwrap_or_else(|| error.to_string())
}
