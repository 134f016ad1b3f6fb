//! `--cache`: what is taken from it is what would be rendered, whatever happens to the folder.

use super::*;
use std::path::PathBuf;
use std::time::Duration;

/// A scene in a folder, whose texture a second file holds.
fn textured() -> TempDir {
    let folder = folder();
    let text = "Eye: [0, 0, 50]\nimageSize: [24, 24]\nLights: [{position: [9, 9, 90], color: [1, 1, 1]}]\nObjects:\n\
        - {type: sphere, position: [0, 0, 0], radius: 9, \
        material: {color: [1, 0, 0], ka: 1, kd: 0, ks: 0, n: 1, texture: t.png}}\n";
    fs::write(folder.path().join("a.yaml"), text).unwrap();
    put_texture(&folder, "t.png", 200);
    folder
}

fn put_texture(folder: &TempDir, name: &str, red: u8) {
    let pixels = image::RgbImage::from_pixel(2, 2, image::Rgb([red, 9, 9]));
    pixels.save(folder.path().join(name)).unwrap();
}

/// Renders with the cache; the picture, and what `-v` says of the cache.
fn render(folder: &TempDir, more: &[&str]) -> (Vec<u8>, String) {
    let fixed = ["render", "a.yaml", "-o", "a.png", "--cache", "c", "-v"];
    let output = rtc(folder, &[&fixed, more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = stderr(&output);
    let own: Vec<_> = said
        .lines()
        .filter(|line| line.starts_with("cache: "))
        .collect();
    (
        fs::read(folder.path().join("a.png")).unwrap(),
        own.join("\n"),
    )
}

/// The same without the cache.
fn anew(folder: &TempDir, more: &[&str]) -> Vec<u8> {
    let fixed = ["render", "a.yaml", "-o", "anew.png"];
    let output = rtc(folder, &[&fixed, more].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    fs::read(folder.path().join("anew.png")).unwrap()
}

fn entries(folder: &TempDir) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.path().join("c")).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn a_picture_is_rendered_once_and_again_when_anything_changed() {
    let folder = textured();
    let first = render(&folder, &[]);
    assert!(first.1.contains("miss"), "{}", first.1);
    let second = render(&folder, &["--threads", "1"]);
    assert_eq!(first.0, second.0);
    assert!(second.1.contains("hit: no file"), "{}", second.1);
    // A texture, a setting, a format of samples.
    put_texture(&folder, "t.png", 100);
    let (picture, said) = render(&folder, &[]);
    assert!(
        said.contains("t.png` has changed") && said.contains("miss"),
        "{said}"
    );
    assert_eq!(picture, anew(&folder, &[]));
    assert_ne!(picture, first.0);
    for setting in [
        "--size=20x20",
        "--exposure=1",
        "--crop=0,0,9,9",
        "--no-metadata",
    ] {
        let (picture, said) = render(&folder, &[setting]);
        assert!(said.contains("miss"), "{setting}: {said}");
        assert_eq!(picture, anew(&folder, &[setting]), "{setting}");
        assert!(render(&folder, &[setting]).1.contains("hit: no file"));
    }
    // Another text of the same scene is read, not rendered.
    let text = fs::read_to_string(folder.path().join("a.yaml")).unwrap();
    fs::write(folder.path().join("a.yaml"), text + "# a comment\n").unwrap();
    let (_, said) = render(&folder, &[]);
    assert!(said.contains("hit: the same scene"), "{said}");
}

/// A file that would be found before the one that was read.
#[test]
fn a_file_that_comes_or_a_link_that_moves_is_noticed() {
    let folder = textured();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("given")).unwrap();
    fs::rename(path("t.png"), path("given/t.png")).unwrap();
    let root = ["--asset-root", "given"];
    let (red, _) = render(&folder, &root);
    assert!(render(&folder, &root).1.contains("hit: no file"));
    put_texture(&folder, "t.png", 50);
    let (picture, said) = render(&folder, &root);
    assert!(said.contains("came, went or moved"), "{said}");
    assert!(picture == anew(&folder, &root) && picture != red);
    #[cfg(unix)]
    {
        put_texture(&folder, "u.png", 10);
        fs::remove_file(path("t.png")).unwrap();
        std::os::unix::fs::symlink("u.png", path("t.png")).unwrap();
        assert_eq!(render(&folder, &[]).0, anew(&folder, &[]));
        put_texture(&folder, "w.png", 90);
        fs::remove_file(path("t.png")).unwrap();
        std::os::unix::fs::symlink("w.png", path("t.png")).unwrap();
        assert_eq!(render(&folder, &[]).0, anew(&folder, &[]));
    }
}

/// Warnings of the scene, of the arguments and of the pixels, from a hit that reads no scene.
#[test]
fn warnings_are_told_each_time() {
    let folder = textured();
    let text = fs::read_to_string(folder.path().join("a.yaml")).unwrap();
    let text = text.replace("position: [0, 0, 0]", "position: [0, 900, 0]") + "Shadws: true\n";
    fs::write(folder.path().join("a.yaml"), text).unwrap();
    for format in ["human", "short", "json", "sarif"] {
        let told = || {
            let form = ["--message-format", format, "--spp", "4"];
            let fixed = ["render", "a.yaml", "-o", "a.png", "--cache", "c"];
            let output = rtc(&folder, &[&fixed[..], &form].concat());
            assert_eq!(code(&output), 0, "{}", stderr(&output));
            let own = |line: &&str| !line.contains("a.png");
            stderr(&output)
                .lines()
                .filter(own)
                .map(String::from)
                .collect::<Vec<_>>()
        };
        let first = told();
        let all = first.join("\n");
        for part in ["Shadws", "no ray of the camera"] {
            assert!(all.contains(part), "{format}: {part}: {all}");
        }
        assert_eq!(told(), first, "{format}");
        let (_, said) = render(&folder, &["--message-format", format, "--spp", "4"]);
        assert!(!said.contains("hit: the same scene"), "{format}: {said}");
        let (_, said) = render(&folder, &["--message-format", format, "--spp", "4"]);
        assert_eq!(said.contains("hit: no file"), format != "sarif", "{said}");
    }
}

/// Magic number, key, content, hash: none may be wrong, and the entry is replaced.
#[test]
fn a_damaged_entry_is_rendered_again() {
    let folder = textured();
    let (picture, _) = render(&folder, &["--aov", "depth"]);
    let layer = fs::read(folder.path().join("a.depth.png")).unwrap();
    for at in [0, 10, 60, 200, usize::MAX] {
        for path in entries(&folder) {
            let mut bytes = fs::read(&path).unwrap();
            let last = bytes.len() - 1;
            bytes[at.min(last)] ^= 16;
            fs::write(&path, bytes).unwrap();
        }
        fs::remove_file(folder.path().join("a.depth.png")).unwrap();
        let (again, said) = render(&folder, &["--aov", "depth"]);
        assert_eq!(said.matches("damaged").count(), 2, "{said}");
        assert_eq!(again, picture);
        let (hit, said) = render(&folder, &["--aov", "depth"]);
        assert!(said.contains("hit: no file"), "{said}");
        assert_eq!(hit, picture);
        assert_eq!(fs::read(folder.path().join("a.depth.png")).unwrap(), layer);
    }
}

#[test]
fn a_cache_that_cannot_be_used_costs_a_warning_and_no_picture() {
    let folder = textured();
    fs::write(folder.path().join("c"), "a file").unwrap();
    let output = rtc(
        &folder,
        &["render", "a.yaml", "-o", "a.png", "--cache", "c"],
    );
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("warning: no cache in `c`"),
        "{}",
        stderr(&output)
    );
    assert_eq!(
        fs::read(folder.path().join("a.png")).unwrap(),
        anew(&folder, &[])
    );
    // An entry that can't be replaced.
    fs::remove_file(folder.path().join("c")).unwrap();
    render(&folder, &[]);
    for path in entries(&folder) {
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
    }
    let (picture, _) = render(&folder, &[]);
    assert_eq!(picture, anew(&folder, &[]));
    // Too small for any entry.
    let output = rtc(
        &folder,
        &[
            "render",
            "a.yaml",
            "-o",
            "a.png",
            "--cache",
            "d",
            "--cache-limit",
            "9",
        ],
    );
    assert_eq!(code(&output), 0);
    assert_eq!(fs::read_dir(folder.path().join("d")).unwrap().count(), 0);
}

#[test]
fn only_a_trusted_project_names_a_cache() {
    let folder = textured();
    fs::write(
        folder.path().join("rtc.toml"),
        "cache = \"own\"\ncache-limit = \"9MiB\"\n",
    )
    .unwrap();
    let output = rtc(&folder, &["render", "a.yaml", "-o", "a.png"]);
    assert!(
        stderr(&output).contains("`cache` is left out"),
        "{}",
        stderr(&output)
    );
    assert!(!folder.path().join("own").exists());
    let trusted = ["render", "a.yaml", "-o", "a.png", "--trust-project", "-v"];
    rtc(&folder, &trusted);
    let said = stderr(&rtc(&folder, &trusted));
    assert!(
        said.contains("hit: no file") && folder.path().join("own").is_dir(),
        "{said}"
    );
}

/// A disk that is full while an entry is written: a warning and the right picture, and no part of an
/// entry.
#[test]
#[cfg(unix)]
fn a_full_disk_leaves_no_wrong_picture() {
    let folder = textured();
    let noise = image::RgbImage::from_fn(24, 24, |x, y| {
        image::Rgb([(x * 71 + y * 113) as u8, (x * y * 37) as u8, (x * 53) as u8])
    });
    noise.save(folder.path().join("t.png")).unwrap();
    let expected = anew(&folder, &["--aov", "depth,normal"]);
    // No file may have more bytes: those of the pictures fit, and their entry does not.
    let script = "trap '' XFSZ; ulimit -f 2; exec \"$0\" render a.yaml -o a.png --aov depth,normal \
        --cache c";
    let mut shell = std::process::Command::new("bash");
    let limited = shell.args(["-c", script, env!("CARGO_BIN_EXE_rtc")]);
    let output = limited.current_dir(folder.path()).output().unwrap();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("the cache is not written"),
        "{}",
        stderr(&output)
    );
    assert_eq!(fs::read(folder.path().join("a.png")).unwrap(), expected);
    let (picture, said) = render(&folder, &["--aov", "depth,normal"]);
    assert!(picture == expected && said.contains("miss"), "{said}");
}

/// Processes that are killed at any time, and others beside them, leave no wrong picture.
#[test]
#[cfg(unix)]
fn killed_and_concurrent_processes_leave_no_wrong_picture() {
    let folder = textured();
    let expected = anew(&folder, &[]);
    let args = |name| ["render", "a.yaml", "-o", name, "--cache", "c", "-q"];
    for wait in [5, 15, 25, 40] {
        let mut killed = command(folder.path(), &args("a.png")).spawn().unwrap();
        let other = command(folder.path(), &args("b.png")).spawn();
        std::thread::sleep(Duration::from_millis(wait));
        killed.kill().unwrap();
        killed.wait().unwrap();
        assert!(other.unwrap().wait().unwrap().success());
        assert_eq!(fs::read(folder.path().join("b.png")).unwrap(), expected);
        assert_eq!(render(&folder, &[]).0, expected);
        for path in entries(&folder) {
            fs::remove_file(path).unwrap();
        }
    }
}
