//! Renders that are saved on their way: killed, told to end or left alone, they end in the same bytes.

use super::parts::{bytes, scenes, told};
use super::*;
use rtc::internals::pipeline::PicturePart;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

/// A render that takes a while, into `a.png`, saved often.
const SLOW: [&str; 9] = [
    "render",
    "paths.json",
    "--spp",
    "960",
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

fn whole(folder: &TempDir) -> Vec<u8> {
    told(
        folder,
        &["render", "paths.json", "--spp", "960", "-o", "whole.png"],
    );
    bytes(folder, "whole.png")
}

#[test]
fn a_render_that_is_saved_on_its_way_has_the_bytes_of_one_that_is_not() {
    let folder = scenes();
    for (words, picture) in super::parts::PICTURES {
        let render = [&["render"], words, &["-o", picture]].concat();
        told(&folder, &render);
        let whole = bytes(&folder, picture);
        let saving = ["--checkpoint", "a.rtp", "--every", "0.001", "--restart"];
        told(&folder, &[&render[..], &saving].concat());
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
            PicturePart::load(&bytes(&folder, "a.rtp"), 1 << 20).unwrap();
        }
    }
    told(&folder, &SLOW);
    assert!(bytes(&folder, "a.png") == whole);
}

#[cfg(unix)]
#[test]
fn a_render_that_is_told_to_end_saves_and_says_how_to_go_on() {
    let folder = scenes();
    let whole = whole(&folder);
    let mut child = start(&folder);
    while !folder.path().join("a.rtp").exists() && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(1));
    }
    let pid = child.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    // On a very slow machine it may be done before the signal comes.
    if output.status.code() != Some(0) {
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(
            stderr(&output).contains("the same command goes on from there"),
            "{}",
            stderr(&output)
        );
        assert!(!folder.path().join("a.png").exists());
    }
    told(&folder, &SLOW);
    assert!(bytes(&folder, "a.png") == whole);
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
    told(&folder, &render);
    let other = [&render[..], &["--depth", "0"]].concat();
    let output = rtc(&folder, &other);
    assert_eq!(code(&output), 1);
    let words = "settings.maxDepth: 1 here, 0 there; `--restart` begins anew";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
    told(&folder, &[&other[..], &["--restart"]].concat());
    fs::write(folder.path().join("a.rtp"), "something else").unwrap();
    let output = rtc(&folder, &other);
    assert!(
        stderr(&output).contains("it is no part of a picture; `--restart`"),
        "{}",
        stderr(&output)
    );
}
