//! Renders that are saved on their way: killed, told to end or left alone, they end in the same bytes.

use super::parts::{bytes, reported, scenes};
use super::*;
use rtc::internals::pipeline::RenderShard;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

/// A render that takes a while, into `a.png`, saved often.
const SLOW: [&str; 9] = [
    "render",
    "paths.json",
    "--spp",
    "160",
    "-oa.png",
    "--checkpoint",
    "a.rtp",
    "--every",
    "0.02s",
];

fn start(folder: &TempDir) -> Child {
    command(folder.path(), &SLOW)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits until it has saved for the first time.
#[cfg(unix)]
fn saved(folder: &TempDir, mut child: Child) -> Child {
    while !folder.path().join("a.rtp").exists() && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    child
}

fn whole(folder: &TempDir) -> Vec<u8> {
    reported(
        folder,
        &["render", "paths.json", "--spp", "160", "-o", "whole.png"],
    );
    bytes(folder, "whole.png")
}

#[test]
fn a_render_that_is_saved_on_its_way_has_the_bytes_of_one_that_is_not() {
    let folder = scenes();
    let goals: [(&[&str], &str); 3] = [
        (&["ball.json", "--target-error", "1.5"], "g.png"),
        (
            &[
                "paths.json",
                "--target-error",
                "4",
                "--aov",
                "error,depth,samples,unmet",
            ],
            "h.exr",
        ),
        (&["depth.json", "--target-error", "1"], "i.png"),
    ];
    for (words, picture) in super::parts::PICTURES.into_iter().chain(goals) {
        let render = [&["render"], words, &["-o", picture]].concat();
        reported(&folder, &render);
        let whole = bytes(&folder, picture);
        let saving = ["--checkpoint", "a.rtp", "--every", "0.001", "--restart"];
        reported(&folder, &[&render[..], &saving].concat());
        assert!(bytes(&folder, picture) == whole, "{words:?}");
    }
}

#[test]
fn a_render_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = scenes();
    let whole = whole(&folder);
    for wait in [20, 60, 110, 35] {
        let mut child = start(&folder);
        sleep(Duration::from_millis(wait));
        child.kill().unwrap();
        child.wait().unwrap();
        // What is there is a sound part, if anything is.
        if folder.path().join("a.rtp").exists() {
            RenderShard::load(&bytes(&folder, "a.rtp"), 1 << 20).unwrap();
        }
    }
    reported(&folder, &SLOW);
    assert!(bytes(&folder, "a.png") == whole);
}

#[cfg(unix)]
#[test]
fn a_render_that_is_told_to_end_saves_and_says_how_to_go_on() {
    let folder = scenes();
    let whole = whole(&folder);
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let child = start(&folder);
        let child = saved(&folder, child);
        let pid = child.id().to_string();
        Command::new("kill").args([signal, &pid]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        // On a very slow machine it may be done before the signal comes.
        if output.status.code() != Some(0) {
            assert_eq!(output.status.code(), Some(code), "{}", stderr(&output));
            let words = "the same command resumes";
            assert!(stderr(&output).contains(words), "{}", stderr(&output));
            assert!(!folder.path().join("a.png").exists());
        }
        reported(&folder, &SLOW);
        assert!(bytes(&folder, "a.png") == whole);
        fs::remove_file(folder.path().join("a.rtp")).unwrap();
        fs::remove_file(folder.path().join("a.png")).unwrap();
    }
}

/// A part of the ball's picture, as a render that was ended has saved it.
#[cfg(unix)]
fn begin(folder: &TempDir) -> Vec<u8> {
    let part = ["--part", "2/6", "--picture", "a.png", "-o", "a.rtp"];
    reported(folder, &[&["render", "ball.json"], &part[..]].concat());
    bytes(folder, "a.rtp")
}

#[cfg(unix)]
#[test]
fn where_the_disk_is_full_the_render_goes_on_and_what_was_saved_stays() {
    let folder = folder();
    reported(&folder, &["render", "ball.json", "-o", "whole.png"]);
    let (before, all) = (begin(&folder), names(folder.path()));
    // A write beyond 16 blocks fails, which the picture does not take.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$@\"";
    let rtc = env!("CARGO_BIN_EXE_rtc");
    let output = Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", limited, "sh", rtc, "render", "ball.json", "-oa.png"])
        .args(["--checkpoint", "a.rtp", "--every", "0.001s"])
        .output()
        .unwrap();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let words = "warning: `a.rtp` can't be written: ";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
    assert!(bytes(&folder, "a.png") == bytes(&folder, "whole.png"));
    assert!(bytes(&folder, "a.rtp") == before);
    let drafts = names(folder.path()).len() - all.len();
    assert_eq!(drafts, 1, "the picture alone is new");
}

#[cfg(unix)]
#[test]
fn where_the_folder_becomes_read_only_the_render_goes_on_and_what_was_saved_stays() {
    use std::os::unix::fs::PermissionsExt;
    let folder = scenes();
    let whole = whole(&folder);
    let (saves, gone) = (folder.path().join("saves"), folder.path().join("gone"));
    fs::create_dir(&saves).unwrap();
    let mut args = SLOW;
    args[6] = "saves/a.rtp";
    let child = command(folder.path(), &args).stderr(Stdio::piped()).spawn();
    let mut child = child.unwrap();
    while !saves.join("a.rtp").exists() && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    fs::set_permissions(&saves, fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write nevertheless: then the folder goes away.
    let is_read_only = fs::write(saves.join("trial"), "").is_err();
    if !is_read_only {
        fs::rename(&saves, &gone).unwrap();
    }
    let is_early = child.try_wait().unwrap().is_none();
    let output = child.wait_with_output().unwrap();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let words = "the render continues, and the last checkpoint stays";
    assert!(
        !is_early || stderr(&output).contains(words),
        "{}",
        stderr(&output)
    );
    assert!(bytes(&folder, "a.png") == whole);
    let kept = if is_read_only { &saves } else { &gone };
    RenderShard::load(&fs::read(kept.join("a.rtp")).unwrap(), 1 << 20).unwrap();
    fs::set_permissions(kept, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn what_belongs_to_a_flag_is_refused_without_it() {
    let folder = folder();
    for (words, flag) in [
        (["--every", "5s"], "--checkpoint"),
        (["--parts-by", "samples"], "--part"),
        (["--picture", "a.png"], "--part"),
        (["--restart", "-q"], "--checkpoint"),
    ] {
        let output = rtc(&folder, &[&["render", "ball.json"], &words[..]].concat());
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(stderr(&output).contains(flag), "{}", stderr(&output));
    }
}

#[test]
fn what_was_saved_of_another_picture_is_refused_and_begun_anew_if_asked() {
    let folder = scenes();
    let render = [
        "render",
        "ball.json",
        "-o",
        "a.png",
        "--checkpoint",
        "a.rtp",
    ];
    reported(&folder, &render);
    let other = [&render[..], &["--depth", "0"]].concat();
    let output = rtc(&folder, &other);
    assert_eq!(code(&output), 1);
    let words = "settings.maxDepth: 1 here, 0 there; `--restart` starts over";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
    reported(&folder, &[&other[..], &["--restart"]].concat());
    fs::write(folder.path().join("a.rtp"), "something else").unwrap();
    let output = rtc(&folder, &other);
    assert!(
        stderr(&output).contains("it is no part of a picture; `--restart`"),
        "{}",
        stderr(&output)
    );
}

/// Runs a command that is killed after each of these times, in milliseconds, and then to its end; how often
/// it was killed.
fn run_with_kills(folder: &TempDir, args: &[&str], waits: &[u64]) -> usize {
    let is_killed = |wait: &&u64| {
        let child = command(folder.path(), args).stderr(Stdio::null()).spawn();
        let mut child = child.unwrap();
        sleep(Duration::from_millis(**wait));
        child.kill().unwrap();
        !child.wait().unwrap().success()
    };
    let killed = waits.iter().filter(is_killed).count();
    reported(folder, args);
    killed
}

#[test]
fn a_picture_that_grows_to_its_goal_goes_on_to_the_same_bytes() {
    let folder = scenes();
    let goal = ["render", "paths.json", "--target-error", "0.7"];
    let render = [&goal[..], &["--aov", "error,samples,unmet,depth", "-o"]].concat();
    reported(&folder, &[&render[..], &["whole.exr"]].concat());
    let saving = ["a.exr", "--checkpoint", "a.rtp", "--every", "0.01s"];
    let saving = [&render[..], &saving].concat();
    run_with_kills(&folder, &saving, &[60, 110, 160, 90]);
    assert!(bytes(&folder, "a.exr") == bytes(&folder, "whole.exr"));
    // All of it is there.
    let before = bytes(&folder, "a.rtp");
    reported(&folder, &saving);
    assert!(bytes(&folder, "a.rtp") == before);
    let other = [&saving[..], &["--light-samples", "1"]].concat();
    assert_eq!(code(&rtc(&folder, &other)), 2);
    let other: Vec<_> = saving
        .iter()
        .map(|word| word.replace("0.7", "0.8"))
        .collect();
    let other: Vec<&str> = other.iter().map(String::as_str).collect();
    let output = rtc(&folder, &other);
    let words = "targetError: 0.7 here, 0.8 there; `--restart` starts over";
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
}

/// The frames that a turntable wrote, by their names.
fn frames(folder: &TempDir, name: &str) -> Vec<Vec<u8>> {
    let frame = |number| bytes(folder, &format!("{name}-{number}.png"));
    (1..=4).map(frame).collect()
}

#[test]
fn a_turntable_keeps_its_finished_frames_and_goes_on() {
    let folder = scenes();
    for goal in [["--spp", "48"], ["--target-error", "3"]] {
        let render = [&["render", "paths.json", "--turntable", "4"], &goal[..]].concat();
        reported(&folder, &[&render[..], &["-o", "whole-%d.png"]].concat());
        let saving = [
            "-oa-%d.png",
            "--checkpoint",
            "a.rtp",
            "--every",
            "0.01s",
            "--restart",
        ];
        let saving = [&render[..], &saving].concat();
        let (saving, anew) = (&saving[..saving.len() - 1], &saving[..]);
        reported(&folder, anew);
        assert!(frames(&folder, "a") == frames(&folder, "whole"), "{goal:?}");
        // A frame that is gone or another picture is rendered again, the others stay.
        fs::remove_file(folder.path().join("a-2.png")).unwrap();
        fs::write(folder.path().join("a-3.png"), "another").unwrap();
        let said = reported(&folder, saving);
        let is_said = |number: u32| said.contains(&format!("a-{number}.png: "));
        assert_eq!(
            [1, 2, 3, 4].map(is_said),
            [false, true, true, true],
            "{said}"
        );
        assert!(frames(&folder, "a") == frames(&folder, "whole"), "{goal:?}");
        fs::remove_file(folder.path().join("a.rtp")).unwrap();
        run_with_kills(&folder, saving, &[60, 150, 80]);
        assert!(frames(&folder, "a") == frames(&folder, "whole"), "{goal:?}");
    }
    let fewer = [
        "render",
        "paths.json",
        "--turntable",
        "3",
        "--target-error",
        "3",
    ];
    let saving = ["-oa-%d.png", "--checkpoint", "a.rtp"];
    let output = rtc(&folder, &[&fewer[..], &saving].concat());
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("more than 3 frames; `--restart`"));
}

#[test]
fn a_study_goes_on_from_its_renders_with_the_seconds_measured() {
    let folder = scenes();
    let cost = ["cost", "depth.json", "--effort", "quick"];
    let keeping = ["--checkpoint", "c.rtc", "--every", "0.001s"];
    let cost = [&cost[..], &keeping, &["--format", "json"]].concat();
    let rows = |args: &[&str]| {
        let output = rtc(&folder, args);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let study: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        study["rows"].as_array().unwrap().clone()
    };
    let (first, again) = (rows(&cost), rows(&cost));
    let is_marked = |row: &serde_json::Value| row["resumed"] == true;
    assert!(!first.is_empty() && !first.iter().any(is_marked));
    assert!(again.iter().all(is_marked));
    for (first, again) in first.iter().zip(&again) {
        for key in ["setting", "errors", "rays", "seconds"] {
            assert_eq!(first[key], again[key], "{key}");
        }
    }
    let anew = rows(&[&cost[..], &["--restart"]].concat());
    assert!(!anew.iter().any(is_marked));
    let other = rtc(&folder, &[&cost[..], &["--seed", "2"]].concat());
    assert_eq!(code(&other), 1);
    let words =
        "`c.rtc`: it belongs to another study: seed: 1 here, 2 there; `--restart` starts over";
    assert!(stderr(&other).contains(words), "{}", stderr(&other));
}
