//! What the action for workflows makes of a pull request, whose files are those of strangers.

use super::*;

/// A name that would run in a page, one that would be a link in a summary, and one with letters
/// that git writes as numbers.
const NAMES: [&str; 4] = [
    "<img src=x onerror=alert(1)>.json",
    "[a](b) `c` *d*.json",
    "Würfel \"groß\".json",
    "two\nlines.json",
];

/// Runs git in a folder.
fn git(folder: &Path, args: &[&str]) {
    let fixed = [
        "-c",
        "user.name=x",
        "-c",
        "user.email=x@x",
        "-c",
        "commit.gpgsign=false",
        "-C",
    ];
    let made = Command::new("git")
        .args(fixed)
        .arg(folder)
        .args(args)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", stderr(&made));
}

/// A repository with a change of each of these files in a folder, and of a link out of it.
fn repository() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    let put = |text: &str| {
        for name in NAMES {
            fs::write(folder.path().join("scenes").join(name), text).unwrap();
        }
    };
    let small = SCENE.replace("[40, 30]", "[8, 6]");
    put(&small);
    git(folder.path(), &["init", "-q", "-b", "main"]);
    git(folder.path(), &["add", "."]);
    git(folder.path(), &["commit", "-q", "-m", "before"]);
    put(&small
        .replace("[30, 40, 60]", "[-30, 40, 60]")
        .replace("0.7", "0.4"));
    let link = folder.path().join("scenes/link.json");
    std::os::unix::fs::symlink("/etc/passwd", link).unwrap();
    git(folder.path(), &["add", "."]);
    git(folder.path(), &["commit", "-q", "-m", "after"]);
    folder
}

#[test]
fn names_of_files_stand_for_themselves() {
    let folder = repository();
    let programs = Path::new(env!("CARGO_BIN_EXE_rtc")).parent().unwrap();
    let path = format!(
        "{}:{}",
        programs.display(),
        std::env::var("PATH").unwrap_or_default()
    );
    let out = tempfile::tempdir().unwrap();
    let summary = out.path().join("summary.md");
    let made = Command::new("bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("dist/action.sh"))
        .arg("compare")
        .arg(out.path())
        .current_dir(folder.path())
        .env("PATH", path)
        .env("BASE", "HEAD~1")
        .env("SIZE", "8")
        .env("GITHUB_STEP_SUMMARY", &summary)
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", stderr(&made));
    let page = fs::read_to_string(out.path().join("compare/index.html")).unwrap();
    assert!(!page.contains("<img") && !page.contains("root:"), "{page}");
    for shown in [
        "&lt;img src=x onerror=alert(1)&gt;.json",
        "Würfel &quot;groß&quot;.json",
        "[a](b) `c` *d*.json",
        "two\nlines.json",
    ] {
        assert!(
            page.contains(&format!("{shown}</a></h2>")),
            "{shown}: {page}"
        );
    }
    assert_eq!(page.matches("<h2>").count(), NAMES.len());
    let summary = fs::read_to_string(summary).unwrap();
    assert_eq!(summary.lines().count(), NAMES.len(), "{summary}");
    let is_markup = |letter| "<>[]`*!".contains(letter);
    assert!(!summary.contains(is_markup), "{summary}");
}

/// What runs in a workflow is named by the hash of its commit: a tag can be moved.
#[test]
fn actions_are_named_by_their_hashes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workflows = fs::read_dir(root.join(".github/workflows")).unwrap();
    let files = workflows.map(|entry| entry.unwrap().path());
    for file in files.chain([root.join("action.yml")]) {
        let text = fs::read_to_string(&file).unwrap();
        let used = text.lines().filter_map(|line| line.split_once("uses: "));
        for (_, name) in used {
            let (_, version) = name.split_once('@').unwrap();
            let hash = version.split(' ').next().unwrap();
            let is_hash = hash.len() == 40 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
            assert!(is_hash, "{}: {name}", file.display());
        }
    }
}
