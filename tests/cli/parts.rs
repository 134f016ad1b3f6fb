//! Parts of a picture, merged: the bytes of one process, whatever is shared out and however.

use super::*;
use rtc::internals::pipeline::RenderShard;

/// The words of a render of a scene, and the name of its picture.
pub(super) const PICTURES: [(&[&str], &str); 9] = [
    (&["ball.json"], "a.png"),
    (
        &["ball.json", "--aperture-samples", "3", "--bits", "16"],
        "b.png",
    ),
    (
        &["ball.json", "--crop", "7,5,25,20", "--exposure", "0.5"],
        "c.png",
    ),
    (&["depth.json", "--crop", "9,3,20,20"], "d.png"),
    (&["paths.json", "--background", "transparent"], "e.png"),
    (&["paths.json", "--aov", "normal,depth,instance"], "f.exr"),
    (&["paths.json", "--aov", "error,uv,unmet,samples"], "g.exr"),
    (&["moving.yaml"], "h.png"),
    (&["anaglyph.yaml"], "i.png"),
];

/// A ball by path tracing with 40 samples, with these settings of the camera and of the ball.
fn text(camera: &str, ball: &str) -> String {
    format!(
        "Camera: {{eye: [0, 0, 6], center: [0, 0, 0], up: [0, 1, 0], fov: 40, viewSize: [40, 20]{camera}}}\n\
         PathParameters: {{samples: 40}}\nEnvironment: {{color: 1}}\nObjects:\n\
         - {{type: sphere, position: [0, 0, 0], radius: 1{ball}, material: {{type: standard}}}}\n"
    )
}

/// The folder of all tests here: a ball, its distances, and its paths, with 40 samples a pixel; a
/// ball that moves, and one for two eyes.
pub(super) fn scenes() -> TempDir {
    let folder = folder();
    let write = |name: &str, mode: &str| {
        let text = scene_with("\"mode\": \"phong\"", &format!("\"mode\": {mode}"));
        let text = text.replace("\"irVersion\": 1", "\"irVersion\": 4");
        fs::write(folder.path().join(name), text).unwrap();
    };
    write("depth.json", "\"zbuffer\"");
    write(
        "paths.json",
        "{\"path\": {\"samples\": 40, \"multipleScattering\": true}}",
    );
    let moving = text(", shutter: [0, 1]", ", velocity: [1, 0, 0]");
    let anaglyph = text(", stereo: 0.3, stereoView: anaglyph", "");
    for (name, text) in [("moving.yaml", moving), ("anaglyph.yaml", anaglyph)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

pub(super) fn reported(folder: &TempDir, args: &[&str]) -> String {
    let output = rtc(folder, args);
    assert_eq!(code(&output), 0, "{args:?}: {}", stderr(&output));
    stderr(&output)
}

/// Renders the shares named, of so many; the names of the parts.
fn render(
    folder: &TempDir,
    words: &[&str],
    picture: &str,
    (by, count): (&str, u32),
    shares: impl IntoIterator<Item = u32>,
) -> Vec<String> {
    let part = |share: u32| {
        let (part, name) = (format!("{share}/{count}"), format!("{share}.rtp"));
        // The number of threads may differ from part to part.
        let threads = (1 + share % 3).to_string();
        let share = ["--part", &part, "--parts-by", by, "--picture", picture];
        let rest = ["--threads", &threads, "-o", &name];
        reported(folder, &[&["render"], words, &share, &rest].concat());
        name
    };
    shares.into_iter().map(part).collect()
}

fn merge(folder: &TempDir, parts: &[String], output: &str) -> std::process::Output {
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    rtc(folder, &[&["merge"], &parts[..], &["-o", output]].concat())
}

pub(super) fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

#[test]
fn parts_make_the_bytes_of_one_process() {
    let folder = scenes();
    for (words, picture) in PICTURES {
        reported(&folder, &[&["render"], words, &["-o", picture]].concat());
        let whole = bytes(&folder, picture);
        let ways: &[(&str, u32)] = if picture == "g.exr" {
            // Layers of samples tell of all samples of a pixel.
            &[("tiles", 1), ("tiles", 7)]
        } else if words[0] == "paths.json" {
            &[
                ("tiles", 1),
                ("tiles", 7),
                ("samples", 2),
                ("samples", 3),
                ("samples", 7),
            ]
        } else {
            &[("tiles", 1), ("tiles", 2), ("tiles", 7)]
        };
        let ways = match words[0].ends_with(".yaml") {
            true => &[("tiles", 3), ("samples", 2)],
            false => ways,
        };
        for path_at in ways {
            // In any order, and one of them twice.
            let mut parts = render(&folder, words, picture, *path_at, (1..=path_at.1).rev());
            parts.push(parts[0].clone());
            let merged = format!("merged-{picture}");
            let output = merge(&folder, &parts, &merged);
            assert_eq!(
                code(&output),
                0,
                "{words:?}, {path_at:?}: {}",
                stderr(&output)
            );
            assert!(bytes(&folder, &merged) == whole, "{words:?}, {path_at:?}");
        }
    }
}

#[test]
fn more_parts_than_tiles_are_no_harm_and_parts_of_parts_merge() {
    let folder = scenes();
    reported(&folder, &["render", "ball.json", "-o", "a.png"]);
    let parts = render(&folder, &["ball.json"], "a.png", ("tiles", 64), 1..=64);
    for (name, some) in [("left.rtp", &parts[..30]), ("right.rtp", &parts[30..])] {
        assert_eq!(code(&merge(&folder, some, name)), 0);
    }
    let halves = ["right.rtp", "left.rtp"].map(str::to_owned);
    assert_eq!(code(&merge(&folder, &halves, "b.png")), 0);
    assert!(bytes(&folder, "b.png") == bytes(&folder, "a.png"));
}

#[test]
fn a_part_that_is_missing_is_named_with_the_command_that_makes_it() {
    let folder = scenes();
    let words = ["ball.json", "--exposure", "0.25"];
    let parts = render(&folder, &words, "it is.png", ("tiles", 5), [1, 2, 4, 5]);
    let output = merge(&folder, &parts, "a.png");
    let reported = stderr(&output);
    assert_eq!(code(&output), 1);
    assert!(reported.contains("of 5 shares 3 is missing"), "{reported}");
    let command = "rtc render ball.json --exposure 0.25 --parts-by tiles --picture 'it is.png' \
                   --threads 2 --part 3/5 -o part-3.rtp";
    assert!(reported.contains(command), "{reported}");
    assert!(!folder.path().join("a.png").exists());
}

#[test]
fn parts_of_other_pictures_are_refused_by_what_differs() {
    let folder = scenes();
    let one = |name: &str, words: &[&str], count: &str| {
        let share = ["--part", count, "-o", name];
        reported(&folder, &[&["render"], words, &share].concat());
    };
    one("first.rtp", &["ball.json"], "1/2");
    one("scene.rtp", &["away.json"], "2/2");
    one("depth.rtp", &["ball.json", "--depth", "0"], "2/2");
    one("count.rtp", &["ball.json"], "2/3");
    one("look.rtp", &["ball.json", "--picture", "a.exr"], "2/2");
    let expected = [
        ("scene.rtp", "scene: xxh3:"),
        ("depth.rtp", "settings.maxDepth: 0 here, 1 there"),
        ("count.rtp", "shares: 3 by tiles here, 2 by tiles there"),
        ("look.rtp", "its look"),
    ];
    for (other, words) in expected {
        let output = merge(
            &folder,
            &["first.rtp".to_owned(), other.to_owned()],
            "a.png",
        );
        assert_eq!(code(&output), 1);
        assert!(
            stderr(&output).contains(words),
            "{other}: {}",
            stderr(&output)
        );
    }
    let output = merge(&folder, &["first.rtp".to_owned()], "a.exr");
    assert!(
        stderr(&output).contains("`--picture NAME.exr`"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn what_no_part_can_be_is_refused_before_work() {
    let folder = scenes();
    let refused = |words: &[&str], reason: &str| {
        let output = rtc(
            &folder,
            &[&["render", "ball.json", "--part", "1/2"], words].concat(),
        );
        assert_eq!(code(&output), 2, "{words:?}");
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    };
    refused(
        &["--target-error", "1"],
        "can't estimate the error of the whole picture",
    );
    refused(
        &["--time-budget", "1"],
        "can't estimate the error of the whole picture",
    );
    refused(&["-o", "a.png"], "name it .rtp");
    refused(
        &["--parts-by", "samples"],
        "only pictures of traced paths have parts by samples",
    );
    let layers = ["paths.json", "--aov", "error", "--picture", "a.exr"];
    let share = ["--part", "1/2", "--parts-by", "samples", "-o", "b.rtp"];
    let output = rtc(&folder, &[&["render"], &layers[..], &share].concat());
    assert_eq!(code(&output), 2);
    let words = "they have no parts by samples";
    assert!(stderr(&output).contains(words), "{}", stderr(&output));
    let output = rtc(&folder, &["render", "ball.json", "--part", "3/2"]);
    assert!(stderr(&output).contains("as 3/8"), "{}", stderr(&output));
}

#[test]
fn a_part_that_was_changed_is_refused() {
    let folder = scenes();
    let words = ["paths.json", "--aov", "depth"];
    let parts = render(&folder, &words, "a.exr", ("tiles", 1), [1]);
    let sound = bytes(&folder, &parts[0]);
    let load = |bytes: &[u8]| RenderShard::load(bytes, 1 << 20);
    assert_eq!(load(&sound).unwrap().save(), sound);
    for at in (0..sound.len()).step_by(97).chain(0..64) {
        let mut changed = sound.clone();
        changed[at] ^= 1 << (at % 8);
        assert!(load(&changed).is_err(), "byte {at}");
        assert!(load(&sound[..at]).is_err(), "{at} bytes");
    }
    assert_eq!(
        RenderShard::load(&sound, 100).unwrap_err().to_string(),
        "it is damaged: its shares can't be those of a picture"
    );
}

/// 32-bit floats, which the file of a picture has in places, end at 3.4·10³⁸.
#[test]
fn parts_of_a_huge_scene_merge() {
    let folder = scenes();
    for exponent in ["37", "39", "41", "58"] {
        let scene = format!(
            "Camera: {{eye: [0, 0, 6e{exponent}], center: [0, 0, 0], up: [0, 3e{exponent}, 0], viewSize: [12, 12]}}\n\
             Lights:\n- {{position: [3e{exponent}, -1e{exponent}, 8e{exponent}], color: [1, 1, 1]}}\n\
             Objects:\n- {{type: sphere, position: [0, 0, 0], radius: 1.6e{exponent}, \
             material: {{color: [1, 0, 0], ka: 0.3, kd: 0.4, ks: 0.5, n: 2}}}}\n"
        );
        fs::write(folder.path().join("huge.yaml"), scene).unwrap();
        let words = ["huge.yaml"];
        for picture in ["whole.png", "whole.exr"] {
            reported(&folder, &["render", "huge.yaml", "-o", picture]);
            let parts = render(&folder, &words, picture, ("tiles", 2), [1, 2]);
            let merged = format!("merged-{picture}");
            let output = merge(&folder, &parts, &merged);
            assert_eq!(code(&output), 0, "{exponent}: {}", stderr(&output));
            assert_eq!(
                bytes(&folder, &merged),
                bytes(&folder, picture),
                "{exponent}"
            );
        }
    }
}
