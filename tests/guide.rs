//! The commands of the guide in the book work. A `console` block is compared with what the program
//! prints, as in the README; an `sh` block is run by bash in a folder with the scenes, and must
//! succeed. A block that takes too long, or needs other programs, is marked `norun`.

use super::readme::{commands, fault};
use super::repo::{files, root};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// The folders that scripts find, as they are in the repository.
const FOLDERS: [&str; 3] = ["scenes", "docs/book/scenes", "docs/book/mistakes"];

/// The pages of the guide.
fn pages() -> Vec<(PathBuf, String)> {
    let book = root("docs/book/src");
    let chapters = ["tutorial", "cookbook"].map(|chapter| files(&book.join(chapter), &["md"]));
    let pages = ["getting-started.md", "gallery.md"].map(|page| book.join(page));
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        (path, text)
    };
    let paths = pages.into_iter().chain(chapters.into_iter().flatten());
    paths.map(read).collect()
}

/// A folder with copies of the scenes.
fn folder_with_scenes() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in FOLDERS {
        let copies = folder.path().join(name);
        fs::create_dir_all(&copies).unwrap();
        for entry in fs::read_dir(root(name)).unwrap().map(Result::unwrap) {
            fs::copy(entry.path(), copies.join(entry.file_name())).unwrap();
        }
    }
    folder
}

/// The blocks of kind `sh`.
fn scripts(page: &str) -> impl Iterator<Item = &str> {
    let after_fences = page.split("\n```sh\n").skip(1);
    after_fences.map(|rest| rest.split("\n```").next().unwrap())
}

/// What is wrong with a script, if anything is.
fn script_fault(script: &str, folder: &Path) -> Option<String> {
    let program = Path::new(env!("CARGO_BIN_EXE_rtc"));
    let mut path = program.parent().unwrap().as_os_str().to_owned();
    path.push(":");
    path.push(env::var_os("PATH").unwrap());
    let output = Command::new("bash")
        .args(["-euo", "pipefail", "-c", script])
        .env("PATH", path)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    (!output.status.success()).then(|| format!("{script}\n{}\n{text}", output.status))
}

fn page_faults(page: &str) -> Vec<String> {
    let lines = page.lines().map(str::to_owned).collect::<Vec<_>>();
    let mut faults = Vec::new();
    for shown in commands(&lines) {
        if let Some(fault) = fault(&lines[shown.lines.clone()], &shown.args) {
            faults.push(format!("rtc {}: {fault}", shown.args.join(" ")));
        }
    }
    if cfg!(unix) {
        let folder = folder_with_scenes();
        faults.extend(scripts(page).filter_map(|script| script_fault(script, folder.path())));
    }
    faults
}

#[test]
fn the_commands_of_the_guide_work() {
    let pages = pages();
    assert!(!pages.is_empty(), "the guide has pages");
    let faults = pages.iter().flat_map(|(path, page)| {
        let faults = page_faults(page).into_iter();
        faults.map(|fault| format!("{}: {fault}", path.display()))
    });
    let faults = faults.collect::<Vec<_>>();
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}
