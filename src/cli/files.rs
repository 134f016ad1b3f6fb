//! Scenes by folders and patterns: which files are meant.
//!
//! In a folder, or matching a pattern, a YAML, JSON or XML file is a scene only if it looks like
//! one, and a pbrt file only if no other file includes it. A file named on the command line always
//! is a scene.
//!
//! Only a link named on the command line is followed: others may form cycles or leave the folder.
//! Scenes that are [`ignored`] are not found, either.

use super::input::is_picture;
use super::{Failure, ignored, reporter};
use globset::{GlobBuilder, GlobMatcher};
use rtc_front::{is_scene_name, is_scene_text_name};
use rtc_pipeline::is_scene;
use rtc_source::{Loader, SourceMap};
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// The characters that make a path component a pattern.
const WILD: [char; 3] = ['*', '?', '['];

/// Whether a file of this name is meant where a folder is given.
type FileNameFilter = fn(&str) -> bool;

/// The extensions of scenes that other programs use for files of their own, or that parts of scenes
/// have, too.
const SHARED_EXTENSIONS: [&str; 6] = ["yaml", "yml", "json", "xml", "pbrt", "gz"];

/// Larger files are taken for scenes without a look.
const LONGEST_READ: u64 = 64 << 20;

/// The scenes that are meant.
pub(super) struct SceneFiles {
    pub(super) paths: Vec<PathBuf>,
    /// The folder of each, within the folder or the pattern by which it was found; of a path that
    /// was named, its folder there.
    pub(super) folders: Vec<PathBuf>,
    /// The number of files that have the name of a scene and are none.
    pub(super) skipped: usize,
}

impl SceneFiles {
    /// Reports how many files were skipped, unless only errors are wanted.
    pub(super) fn report_skipped(&self, is_quiet: bool) {
        match self.skipped {
            _ if is_quiet => {}
            0 => {}
            1 => reporter::print_message("1 file skipped that is no scene"),
            skipped => {
                reporter::print_message(&format!("{skipped} files skipped that are no scenes"))
            }
        }
    }
}

/// The scenes of the arguments: a path as it is, all scenes below a folder, the scenes that match a
/// pattern. A path that exists is no pattern. Results are sorted by name and unique, without hidden
/// files and links. With `skip_others`, paths that do not look like a scene are skipped, too.
pub(super) fn scenes(paths: &[PathBuf], skip_others: bool) -> Result<SceneFiles, Failure> {
    named(paths, is_scene_name, skip_others)
}

/// The same for scenes that are texts of people.
pub(super) fn texts(paths: &[PathBuf]) -> Result<SceneFiles, Failure> {
    named(paths, is_scene_text_name, false)
}

/// Whether a file is a scene judging by its name and its first bytes. True for an unreadable file:
/// the command that reads it reports the error.
fn looks_like_scene(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    let is_shared = SHARED_EXTENSIONS
        .iter()
        .any(|shared| extension.eq_ignore_ascii_case(shared));
    let bytes = || Loader.bytes(path, LONGEST_READ, &SourceMap::default());
    !is_shared || bytes().map_or(true, |bytes| is_scene(&path.to_string_lossy(), &bytes))
}

fn named(
    paths: &[PathBuf],
    is_meant: FileNameFilter,
    skip_others: bool,
) -> Result<SceneFiles, Failure> {
    let (mut scenes, mut known, mut skipped) = (Vec::new(), BTreeSet::new(), 0);
    let mut folders = Vec::new();
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
            folders.push(folder_within(Path::new(""), path));
            scenes.push(path.clone());
            continue;
        };
        let base = match path.is_dir() {
            true => path.clone(),
            false => path
                .components()
                .take_while(|part| !is_wild(part))
                .collect(),
        };
        // Keep the scenes among the files that were not found before.
        let new = found.into_iter().filter(|path| known.insert(path.clone()));
        let (found_scenes, others): (Vec<_>, Vec<_>) = new.partition(|path| looks_like_scene(path));
        if found_scenes.is_empty() && !others.is_empty() {
            let count = others.len();
            return Err(Failure::Failed(format!(
                "`{}`: there are no scenes among its {count} YAML, JSON and XML files",
                path.display()
            )));
        }
        skipped += others.len();
        folders.extend(found_scenes.iter().map(|scene| folder_within(&base, scene)));
        scenes.extend(found_scenes);
    }
    Ok(SceneFiles {
        paths: scenes,
        folders,
        skipped,
    })
}

/// The folder of a file below another folder, without what leads upwards.
fn folder_within(base: &Path, file: &Path) -> PathBuf {
    let folder = file.strip_prefix(base).unwrap_or(file).parent();
    let parts = folder.unwrap_or(Path::new("")).components();
    parts
        .filter(|part| matches!(part, Component::Normal(_)))
        .collect()
}

/// Whether a component of a path is a pattern.
fn is_wild(part: &Component<'_>) -> bool {
    part.as_os_str().to_string_lossy().contains(WILD)
}

/// Whether a path is none of a file but a pattern.
fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(WILD) && path.symlink_metadata().is_err()
}

/// The files that fit a pattern, and the scenes below the folders that do: at least one.
fn fitting(pattern: &Path, is_meant: FileNameFilter) -> Result<Vec<PathBuf>, Failure> {
    let refused = |message: &str| refused(pattern, message);
    let pattern = FilePattern::new(pattern).map_err(|message| refused(&message))?;
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
    /// The rest of the pattern, by component and as a whole.
    parts: Vec<String>,
    rest: GlobMatcher,
}

impl FilePattern {
    fn new(path: &Path) -> Result<Self, String> {
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

    /// The entries at a depth that may match, except hidden ones that are not named.
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
        ignored::traverse(base, traverse, is_named)
    }

    /// The path of an entry in the style of the pattern.
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

/// The scenes below a folder, by their paths in it; there may be none.
pub(super) fn scenes_below(folder: &Path) -> Result<BTreeSet<PathBuf>, Failure> {
    let mut found = named_below(folder, is_scene_name)?;
    found.retain(|path| looks_like_scene(path));
    let within = |path: &PathBuf| path.strip_prefix(folder).unwrap_or(path).to_owned();
    Ok(found.iter().map(within).collect())
}

/// All files below a folder with the name of a scene: at least one.
fn below(folder: &Path, is_meant: FileNameFilter) -> Result<Vec<PathBuf>, Failure> {
    let found = named_below(folder, is_meant)?;
    match found.is_empty() {
        true => Err(refused(folder, "there are no scenes in this folder")),
        false => Ok(found),
    }
}

/// All files below a folder with the name of a scene; there may be none.
fn named_below(folder: &Path, is_meant: FileNameFilter) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for entry in ignored::traverse(folder, WalkDir::new(folder), |entry| !is_hidden(entry)) {
        let entry = entry.map_err(|error| refused(folder, &reason(&error)))?;
        let is_scene = is_meant(&entry.file_name().to_string_lossy());
        if is_scene && entry.file_type().is_file() {
            found.push(entry.into_path());
        }
    }
    Ok(found)
}

/// The pictures below a folder, by their paths in it, sorted; without hidden files and links.
pub(super) fn pictures(folder: &Path) -> Result<BTreeSet<PathBuf>, Failure> {
    let mut found = BTreeSet::new();
    let entries = WalkDir::new(folder).into_iter();
    for entry in entries.filter_entry(|entry| !is_hidden(entry)) {
        let entry = entry.map_err(|error| refused(folder, &reason(&error)))?;
        let path = entry.path().strip_prefix(folder).unwrap_or(entry.path());
        if is_picture(path) && entry.file_type().is_file() {
            found.insert(path.to_owned());
        }
    }
    Ok(found)
}

/// Whether the name of a found entry, not of a named one, begins with a dot.
fn is_hidden(entry: &DirEntry) -> bool {
    entry.depth() > 0 && entry.file_name().as_encoded_bytes().starts_with(b".")
}

/// The failure of a path.
fn refused(path: &Path, message: &str) -> Failure {
    Failure::Failed(format!("`{}`: {message}", path.display()))
}

/// The error of the system.
fn reason(error: &walkdir::Error) -> String {
    let errors = error.io_error().map(ToString::to_string);
    errors.unwrap_or_else(|| error.to_string())
}
