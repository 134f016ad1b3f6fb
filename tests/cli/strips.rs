//! Pictures rendered in strips: the bytes of the whole; what has none is refused, and nothing stays behind.

use super::parts::{PICTURES, bytes, reported, scenes};
use super::*;

#[test]
fn strips_make_the_bytes_of_the_whole() {
    let folder = scenes();
    let more: [(&[&str], &str); 4] = [
        (
            &["ball.json", "--size", "37x53", "--supersampling", "3"],
            "g.png",
        ),
        (
            &["ball.json", "--size", "33x64", "--aov", "depth,uv"],
            "h.exr",
        ),
        (
            &[
                "paths.json",
                "--spp",
                "3",
                "--crop",
                "3,11,30,17",
                "--exposure",
                "auto",
            ],
            "i.png",
        ),
        (
            &[
                "ball.json",
                "--size",
                "20x1000",
                "--background",
                "0.5,1,0",
                "--bits",
                "16",
            ],
            "j.png",
        ),
    ];
    let all = PICTURES.into_iter().chain(more);
    // Distances and layers of samples have no strips.
    let has_strips =
        |(words, picture): &(&[&str], &str)| words[0] != "depth.json" && *picture != "g.exr";
    for (words, picture) in all.filter(has_strips) {
        let render = [&["render"], words, &["-o", picture]].concat();
        reported(&folder, &render);
        let whole = bytes(&folder, picture);
        for (strips, threads) in [("--strips=1", "3"), ("--strips=32", "1"), ("--strips", "2")] {
            fs::remove_file(folder.path().join(picture)).unwrap();
            reported(
                &folder,
                &[&render[..], &[strips, "--threads", threads]].concat(),
            );
            assert!(bytes(&folder, picture) == whole, "{words:?} {strips}");
        }
    }
}

#[test]
fn what_strips_find_is_what_the_whole_finds() {
    let folder = scenes();
    // Distances of 1e40 that no float holds, and a camera that sees nothing.
    let far =
        scene_with("[0, 0, 50]", "[0, 0, 1e40]").replace("\"radius\": 10", "\"radius\": 3e39");
    fs::write(folder.path().join("far.json"), far).unwrap();
    let depth = ["far.json", "--aov", "uv,depth,position", "-o", "a.exr"];
    for (words, code) in [
        (&depth[..], "RD004"),
        (&["away.json", "-o", "a.png"], "RD001"),
    ] {
        let render = [&["render", "--message-format", "short"], words].concat();
        let findings = |more: &[&str]| {
            let reported = reported(&folder, &[&render[..], more].concat());
            let lines = reported.lines().filter(|line| line.contains("RD0"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let whole = findings(&[]);
        assert!(whole.iter().any(|line| line.contains(code)), "{whole:?}");
        assert_eq!(findings(&["--strips=16"]), whole);
    }
}

#[test]
fn rays_run_out_at_the_same_pixel() {
    let folder = scenes();
    let render = ["render", "ball.json", "-o", "a.png", "--limit", "rays=9000"];
    let refused = |more: &[&str]| {
        let output = rtc(&folder, &[&render[..], more].concat());
        assert_eq!(code(&output), 1, "{}", stderr(&output));
        assert!(!folder.path().join("a.png").exists());
        stderr(&output)
    };
    let whole = refused(&[]);
    assert!(
        whole.contains("9000 rays: they run out at pixel"),
        "{whole}"
    );
    for threads in ["1", "2", "3"] {
        assert_eq!(refused(&["--strips=16", "--threads", threads]), whole);
    }
}

#[test]
fn what_must_be_known_as_a_whole_has_no_strips() {
    let folder = scenes();
    let before = names(folder.path());
    for (words, hint) in [
        (&["depth.json"][..], "`--aov depth`"),
        (&["ball.json", "--target-error", "1"], "`--supersampling`"),
        (&["ball.json", "--time-budget", "1"], "`--supersampling`"),
        (&["ball.json", "--verify-effects"], "`--crop`"),
        (&["ball.json", "-o", "-"], "`-o FILE`"),
        (&["ball.json", "--part", "1/2"], "--part"),
        (&["ball.json", "--checkpoint", "a.rtp"], "--checkpoint"),
    ] {
        let output = rtc(&folder, &[&["render"], words, &["--strips"]].concat());
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(
            stderr(&output).contains(hint),
            "{words:?}: {}",
            stderr(&output)
        );
        assert_eq!(names(folder.path()), before, "{words:?}");
    }
}

#[test]
fn frames_of_a_turntable_are_made_of_strips() {
    let folder = scenes();
    let turn = ["render", "ball.json", "--turntable", "2"];
    reported(&folder, &[&turn[..], &["-o", "whole-%04d.png"]].concat());
    let strips = ["--strips=16", "-o", "strips-%04d.png"];
    reported(&folder, &[&turn[..], &strips].concat());
    let frames = |kind: &str| {
        let pictures = names(folder.path());
        let own = pictures.iter().filter(|name| name.starts_with(kind));
        own.map(|name| bytes(&folder, name)).collect::<Vec<_>>()
    };
    assert!(frames("whole").len() == 2 && frames("whole") == frames("strips"));
}

#[cfg(unix)]
#[test]
fn a_render_that_is_ended_leaves_nothing_behind() {
    let folder = scenes();
    let before = names(folder.path());
    let words = [
        "render",
        "paths.json",
        "--spp",
        "4000",
        "-oa.png",
        "--strips=16",
    ];
    let mut child = command(folder.path(), &words).spawn().unwrap();
    let is_begun = || {
        names(folder.path())
            .iter()
            .any(|name| name.ends_with(".tmp"))
    };
    while !is_begun() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let pid = child.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(names(folder.path()), before);
}
