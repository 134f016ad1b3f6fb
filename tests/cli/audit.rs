//! `rtc audit` and `rtc merge --audit` from outside: words, exit codes, and what is refused.

use super::parts::{reported, scenes};
use super::*;
use serde_json::Value;

/// What `rtc audit` says on stdout and its exit code.
fn audited(folder: &TempDir, args: &[&str]) -> (i32, String) {
    let output = rtc(folder, &[&["audit"], args].concat());
    (code(&output), String::from_utf8(output.stdout).unwrap())
}

/// The ball, and one of another red.
fn two_scenes() -> TempDir {
    let folder = scenes();
    let other = scene_with("\"color\": [1, 0, 0]", "\"color\": [0.9, 0, 0]");
    fs::write(folder.path().join("other.json"), other).unwrap();
    folder
}

#[test]
fn what_was_made_passes_however_it_was_made() {
    let folder = scenes();
    let ball: &[(&str, &[&str])] = &[
        ("a.png", &[]),
        ("b.webp", &["--aperture-samples", "3"]),
        ("c.exr", &["--crop", "3,5,30,20", "--exposure", "1"]),
        ("d.png", &["--strips=16"]),
        ("e.png", &["--background", "#336699", "--bits", "16"]),
        ("f.exr", &["--bits", "16", "--aov", "depth,normal"]),
        (
            "g.png",
            &["--size", "80x60", "--spp", "4", "--tonemap", "agx"],
        ),
        ("h.rtp", &["--part", "2/3"]),
    ];
    for (picture, words) in ball {
        let render = ["render", "ball.json", "-o", picture];
        reported(&folder, &[&render[..], words].concat());
        let (code, words) = audited(&folder, &[picture, "ball.json", "--seed", "3"]);
        assert!(
            code == 0 && words.contains("so none differs"),
            "{picture}: {words}"
        );
    }
    let paths: &[(&str, &[&str])] = &[
        ("i.png", &[]),
        ("j.exr", &["--clamp", "1"]),
        ("k.rtp", &["--part", "2/3", "--parts-by", "samples"]),
        ("l.webp", &["--exposure", "auto"]),
    ];
    for (picture, words) in paths {
        let render = ["render", "paths.json", "-o", picture];
        reported(&folder, &[&render[..], words].concat());
        let (code, words) = audited(&folder, &[picture, "paths.json", "--threads", "2"]);
        assert!(
            code == 0 && words.contains("so none differs"),
            "{picture}: {words}"
        );
    }
}

#[test]
fn the_words_say_how_sure_it_is_and_the_seed_repeats_them() {
    let folder = scenes();
    reported(&folder, &["render", "ball.json", "-o", "a.png"]);
    // 40 × 30 pixels are six tiles. Of two faults, four draws miss both once in 15 times; of three
    // never.
    let args = ["a.png", "ball.json", "--tiles", "4", "--seed", "9"];
    let (code, words) = audited(&folder, &args);
    assert_eq!(code, 0);
    assert_eq!(
        words,
        "a.png: 4 of 6 tiles of 256 pixels, rendered again (seed 9), are the same\n\
         98 % sure that fewer than 50 % of the tiles differ (3)\n"
    );
    assert_eq!(audited(&folder, &args), (0, words));
    let report = audited(&folder, &[&args[..], &["--format", "json"]].concat()).1;
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(
        (&report["passes"], &report["fewerThan"]),
        (&true.into(), &3.into())
    );
    assert_eq!(report["seed"], "9");
    assert_eq!(
        audited(&folder, &[&args[..], &["--quiet"]].concat()),
        (0, String::new())
    );
    // Without a seed there is a new one each time.
    let seeds = [0, 1].map(|_| audited(&folder, &["a.png", "ball.json"]).1);
    assert_ne!(seeds[0], seeds[1]);
}

#[test]
fn other_pixels_scenes_and_metadata_fail() {
    let folder = two_scenes();
    for (scene, picture) in [("ball.json", "a.png"), ("other.json", "b.png")] {
        reported(&folder, &["render", scene, "-o", picture]);
    }
    // The scene.
    let (code, words) = audited(&folder, &["a.png", "other.json"]);
    assert!(
        code == 1 && words.contains("the hash of the scene"),
        "{words}"
    );
    // The pixels of one picture, and what the other says of itself.
    let [a, b] = ["a.png", "b.png"].map(|name| fs::read(folder.path().join(name)).unwrap());
    fs::write(folder.path().join("c.png"), with_pixels_of(&a, &b)).unwrap();
    let (code, words) = audited(&folder, &["c.png", "ball.json", "--seed", "1"]);
    assert!(
        code == 1 && words.contains("its pixels, by their hash, first in column"),
        "{words}"
    );
    assert!(
        words.contains("tile ") && words.contains("in the file  "),
        "{words}"
    );
    // One bit of the root of an EXR, which stands in its head as it is.
    reported(&folder, &["render", "ball.json", "-o", "d.exr"]);
    let mut bytes = fs::read(folder.path().join("d.exr")).unwrap();
    let name = b"rtc:tiles\0rtc:tree\0";
    let at = bytes
        .windows(name.len())
        .position(|window| window == name)
        .unwrap();
    bytes[at + name.len() + 4 + 2 + 31] ^= 1;
    fs::write(folder.path().join("e.exr"), bytes).unwrap();
    let (code, words) = audited(&folder, &["e.exr", "ball.json"]);
    assert!(
        code == 1 && words.contains("the root of its hashes"),
        "{words}"
    );
}

/// A PNG, but for its pixels, which are those of another.
fn with_pixels_of(png: &[u8], other: &[u8]) -> Vec<u8> {
    let is_of_pixels = |chunk: &&[u8]| &chunk[4..8] == b"IDAT";
    let pixels: Vec<_> = chunks(other).into_iter().filter(is_of_pixels).collect();
    let mut all = chunks(png);
    let first = all.iter().position(is_of_pixels).unwrap();
    all.retain(|chunk| !is_of_pixels(chunk));
    all.splice(first..first, pixels);
    [&png[..8], &all.concat()].concat()
}

/// The chunks of a PNG, with their lengths and checksums.
fn chunks(png: &[u8]) -> Vec<&[u8]> {
    let (mut found, mut rest) = (Vec::new(), &png[8..]);
    while let Some(length) = rest.first_chunk::<4>() {
        let (chunk, after) = rest.split_at(u32::from_be_bytes(*length) as usize + 12);
        found.push(chunk);
        rest = after;
    }
    found
}

#[test]
fn what_cannot_be_audited_is_refused_with_the_reason() {
    let folder = scenes();
    let pictures: &[(&[&str], &str, &str)] = &[
        (&["ball.json", "--no-metadata"], "a.png", "no hashes"),
        (&["paths.json", "--denoise"], "b.png", "denoised"),
        (
            &["paths.json", "--target-error", "8"],
            "c.png",
            "target error",
        ),
        (&["depth.json"], "d.png", "depth buffer"),
        (&["ball.json"], "e.jpg", "JPEG"),
    ];
    for (words, picture, reason) in pictures {
        reported(&folder, &[&["render"], *words, &["-o", picture]].concat());
        let output = rtc(&folder, &["audit", picture, words[0]]);
        assert_eq!(code(&output), 2, "{picture}");
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
    assert_eq!(audited(&folder, &["none.png", "ball.json"]).0, 2);
    fs::write(folder.path().join("f.rtp"), "a part?").unwrap();
    assert_eq!(audited(&folder, &["f.rtp", "ball.json"]).0, 1);
}

#[test]
fn settings_are_those_of_the_picture_and_are_told() {
    let folder = scenes();
    let words = ["render", "ball.json", "-o", "a.png", "--supersampling", "3"];
    reported(&folder, &words);
    let (code, words) = audited(&folder, &["a.png", "ball.json"]);
    assert_eq!(code, 0, "{words}");
    assert!(
        words.ends_with("  settings.supersampling: 3, in the scene 2\n"),
        "{words}"
    );
}

#[test]
fn parts_are_audited_before_they_are_merged() {
    let folder = two_scenes();
    let part = |scene: &str, share: &str, name: &str| {
        let part = ["--part", share, "--picture", "a.png", "-o", name];
        reported(&folder, &[&["render", scene], &part[..]].concat());
    };
    part("ball.json", "1/2", "1.rtp");
    part("ball.json", "2/2", "2.rtp");
    part("other.json", "2/2", "3.rtp");
    let merge = |parts: &[&str], picture: &str| {
        let audit = ["--audit", "9", "--scene", "ball.json", "-o", picture];
        rtc(&folder, &[&["merge"], parts, &audit[..]].concat())
    };
    let output = merge(&["1.rtp", "2.rtp"], "a.png");
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(stderr(&output).matches("so none differs").count(), 2);
    let (code_of_picture, words) = audited(&folder, &["a.png", "ball.json"]);
    assert!(
        code_of_picture == 0 && words.contains("so none differs"),
        "{words}"
    );
    let output = merge(&["1.rtp", "3.rtp"], "b.png");
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    assert!(stderr(&output).contains("3.rtp: its metadata are wrong"));
    assert!(!folder.path().join("b.png").exists());
    // Both or none.
    assert_eq!(
        code(&rtc(
            &folder,
            &["merge", "1.rtp", "--audit", "1", "-o", "c.png"]
        )),
        2
    );
}
