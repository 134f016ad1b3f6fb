//! Scenes by folders and patterns: which files are meant.

use super::Failure;
use glob::MatchOptions;
use rtc_front::{is_scene_name, is_scene_text_name};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Whether a file of this name is meant where a folder is given.
type NameTest = fn(&str) -> bool;

/// The files that are meant: each path as it is; of a folder all scenes below it, by their names;
/// of a pattern that is no file by itself, what fits it. What is found comes in the order of its
/// names, without what is hidden, and once.
pub(super) fn scenes(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    named(paths, is_scene_name)
}

/// The same for scenes that are texts of people.
pub(super) fn texts(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    named(paths, is_scene_text_name)
}

fn named(paths: &[PathBuf], is_meant: NameTest) -> Result<Vec<PathBuf>, Failure> {
    let mut scenes = Vec::new();
    for path in paths {
        if path.is_dir() {
            add(&mut scenes, below(path, is_meant)?);
        } else if is_pattern(path) {
            for fit in fitting(path)? {
                match fit.is_dir() {
                    true => add(&mut scenes, below(&fit, is_meant)?),
                    false => add(&mut scenes, vec![fit]),
                }
            }
        } else {
            scenes.push(path.clone());
        }
    }
    Ok(scenes)
}

/// Adds the files that are not there yet.
fn add(scenes: &mut Vec<PathBuf>, found: Vec<PathBuf>) {
    for path in found {
        if !scenes.contains(&path) {
            scenes.push(path);
        }
    }
}

/// Whether a path is none of a file but a pattern.
fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?', '[']) && path.symlink_metadata().is_err()
}

/// What fits a pattern: at least one file or folder.
fn fitting(pattern: &Path) -> Result<Vec<PathBuf>, Failure> {
    let shown = pattern.display();
    let refused = |words: &str| Failure::Trouble(format!("`{shown}`: {words}"));
    let options = MatchOptions {
        case_sensitive: true,
        require_literal_separator: true,
        require_literal_leading_dot: true,
    };
    let text = pattern
        .to_str()
        .ok_or_else(|| refused("a pattern is text"))?;
    let fits = glob::glob_with(text, options).map_err(|error| refused(error.msg))?;
    let fits: Result<Vec<_>, _> = fits.collect();
    let fits = fits.map_err(|error| refused(&error.error().to_string()))?;
    if fits.is_empty() {
        return Err(refused("no file has such a name"));
    }
    Ok(fits)
}

/// All scenes below a folder: at least one.
fn below(folder: &Path, is_meant: NameTest) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    let refused = |words: &str| Failure::Trouble(format!("`{}`: {words}", folder.display()));
    walk(folder, is_meant, &mut found).map_err(|error| refused(&error.to_string()))?;
    if found.is_empty() {
        return Err(refused("there are no scenes in this folder"));
    }
    Ok(found)
}

/// Links to folders are not followed: they may lead round in circles.
fn walk(folder: &Path, is_meant: NameTest, found: &mut Vec<PathBuf>) -> io::Result<()> {
    let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
    entries.sort_unstable_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let (name, path) = (entry.file_name(), entry.path());
        let name = name.to_string_lossy();
        if name.starts_with('.') {
            continue;
        }
        if entry.file_type()?.is_dir() {
            walk(&path, is_meant, found)?;
        } else if is_meant(&name) && path.is_file() {
            found.push(path);
        }
    }
    Ok(())
}
