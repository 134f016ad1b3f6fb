//! What the action for workflows makes of a pull request, whose files are those of strangers, and
//! what is handed in for the course.

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

/// Where programs are looked for: `rtc` first.
fn path() -> String {
    let programs = Path::new(env!("CARGO_BIN_EXE_rtc")).parent().unwrap();
    let others = std::env::var("PATH").unwrap_or_default();
    format!("{}:{others}", programs.display())
}

#[test]
fn names_of_files_stand_for_themselves() {
    let folder = repository();
    let path = path();
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
    assert!(
        !page.contains("<img src=x") && !page.contains("root:"),
        "{page}"
    );
    // Each scene has its picture; no page names the folder of the base.
    assert_eq!(page.matches("<img alt=").count(), NAMES.len(), "{page}");
    assert!(page.contains("width=device-width"), "{page}");
    for number in 1..=NAMES.len() {
        let name = |extension: &str| out.path().join(format!("compare/{number}.{extension}"));
        assert!(name("png").exists());
        let page = fs::read_to_string(name("html")).unwrap();
        assert!(!page.contains("/tmp"), "{number}");
    }
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

#[test]
fn scenes_of_one_name_have_thumbnails_each() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["x", "y"] {
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join("scene.json"), SCENE).unwrap();
    }
    let out = tempfile::tempdir().unwrap();
    let made = Command::new("bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("dist/action.sh"))
        .arg("thumbnails")
        .arg(out.path())
        .current_dir(folder.path())
        .envs([("PATH", path().as_str()), ("SIZE", "8")])
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", stderr(&made));
    for name in [
        "thumbnails/x/scene.png",
        "thumbnails/y/scene.png",
        "sheet.png",
    ] {
        assert!(out.path().join(name).exists(), "{name}");
    }
}

/// A model without lights and camera is lit and framed where it is compared.
#[test]
fn a_model_without_lights_is_compared_in_the_light() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.obj");
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    fs::write(&model, triangle).unwrap();
    git(folder.path(), &["init", "-q", "-b", "main"]);
    git(folder.path(), &["add", "."]);
    git(folder.path(), &["commit", "-q", "-m", "before"]);
    fs::write(&model, triangle.replace("v 0 1 0", "v 1 1 0")).unwrap();
    git(folder.path(), &["commit", "-q", "-a", "-m", "after"]);
    let out = tempfile::tempdir().unwrap();
    let made = Command::new("bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("dist/action.sh"))
        .arg("compare")
        .arg(out.path())
        .current_dir(folder.path())
        .envs([
            ("PATH", path().as_str()),
            ("BASE", "HEAD~1"),
            ("SIZE", "16"),
        ])
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", stderr(&made));
    let page = fs::read_to_string(out.path().join("compare/index.html")).unwrap();
    assert!(
        page.contains("rmse") && !page.contains("no difference"),
        "{page}"
    );
}

/// The archives have the licences of what the program is made of, and of nothing else.
#[test]
fn notices_are_of_the_packages_of_the_program() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let made = Command::new("bash")
        .arg(root.join("dist/notices.sh"))
        .arg("x86_64-unknown-linux-musl")
        .env("CARGO_NET_OFFLINE", "true")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", stderr(&made));
    let notices = String::from_utf8_lossy(&made.stdout);
    let has = |name: &str| {
        notices
            .lines()
            .any(|line| line.starts_with(&format!("{name} v")))
    };
    assert!(
        ["clap", "png", "exr", "rayon", "serde_json"]
            .into_iter()
            .all(has),
        "{notices}"
    );
    assert!(
        !["proptest", "insta", "rtc-cli", "windows-sys"]
            .into_iter()
            .any(has)
    );
    assert!(notices.contains("Permission is hereby granted") && notices.contains("Apache License"));
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

/// The hook and the action look at all files that a folder is searched for, meshes apart.
#[test]
fn hooks_and_the_action_know_all_names_of_scenes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let of = |file: &str| {
        let text = fs::read_to_string(root.join(file)).unwrap();
        let (_, list) = text.split_once(r"\.(yaml|").unwrap();
        let (list, _) = list.split_once(")$").unwrap();
        list.replace('\\', "")
    };
    for list in [of(".pre-commit-hooks.yaml"), of("dist/action.sh")] {
        let names: Vec<_> = list.split('|').collect();
        let is_scene = |name: &&str| rtc::internals::front::is_scene_name(&format!("a.{name}"));
        assert!(names.iter().all(is_scene), "{list}");
        for known in [
            "json", "glb", "xml", "pbrt", "pbrt.gz", "usda", "usdz", "rtir",
        ] {
            assert!(names.contains(&known), "{known}: {list}");
        }
    }
}

/// Runs the script that makes the archive of `scenes` and of the code in `code`.
fn submission(folder: &TempDir) -> Output {
    Command::new("bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("dist/submission.sh"))
        .args(["scenes", "out/hand-in.tar.gz", "code"])
        .current_dir(folder.path())
        .env("PATH", path())
        .output()
        .unwrap()
}

#[test]
fn a_submission_has_code_screenshots_and_a_readme() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("scenes/deep")).unwrap();
    fs::create_dir_all(at("code/src")).unwrap();
    let small = SCENE.replace("[40, 30]", "[8, 6]");
    fs::write(at("scenes/a.json"), &small).unwrap();
    fs::write(at("scenes/deep/b.json"), &small).unwrap();
    fs::write(at("scenes/package.json"), r#"{"version": "1"}"#).unwrap();
    fs::write(at("code/src/main.rs"), "fn main() {}").unwrap();
    let made = submission(&folder);
    assert!(made.status.success(), "{}", stderr(&made));
    let list = Command::new("tar")
        .arg("-tzf")
        .arg(at("out/hand-in.tar.gz"))
        .output()
        .unwrap();
    let list = String::from_utf8(list.stdout).unwrap();
    let files: Vec<_> = list.lines().filter(|name| !name.ends_with('/')).collect();
    let pictures = files.iter().filter(|name| name.starts_with("Screenshots/"));
    assert_eq!(pictures.count(), 2, "{list}");
    assert!(files.contains(&"Code/src/main.rs"), "{list}");
    assert!(files.contains(&"ReadMe.md"), "{list}");
    // A scene with errors makes no archive.
    fs::remove_file(at("out/hand-in.tar.gz")).unwrap();
    fs::write(at("scenes/a.json"), small.replace("[8, 6]", "[8]")).unwrap();
    assert!(!submission(&folder).status.success());
    assert!(!at("out/hand-in.tar.gz").exists());
}
