//! Combinations: each cell of the table in `docs/book/src/reference/long-renders.md`.

use super::parts::{bytes, reported, scenes};
use super::*;
use Cell::{Made, Refused, Same};

/// What a way of working does to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell {
    /// The bytes are those without it.
    Same,
    /// It is made, of bytes that depend on the clock.
    Made,
    /// It is refused, with a hint that says this.
    Refused(&'static str),
}

/// The rows: what the table calls it, the words of a render, its picture, and what checkpoints, parts,
/// strips and frames do to it.
const ROWS: [(&str, &[&str], &str, [Cell; 4]); 11] = [
    (
        "target error",
        &["ball.json", "--target-error", "2"],
        "a.png",
        [
            Same,
            Refused("--supersampling"),
            Refused("--supersampling"),
            Same,
        ],
    ),
    (
        "time budget",
        &["ball.json", "--time-budget", "0.01"],
        "a.png",
        [
            Refused("cannot be used with"),
            Refused("--supersampling"),
            Refused("--supersampling"),
            Made,
        ],
    ),
    (
        "automatic exposure",
        &["paths.json", "--spp", "24", "--exposure", "auto"],
        "a.png",
        [Same; 4],
    ),
    (
        "denoising",
        &["paths.json", "--spp", "24", "--denoise"],
        "a.png",
        [
            Refused("cannot be used with"),
            Refused("cannot be used with"),
            Refused("cannot be used with"),
            Same,
        ],
    ),
    (
        "layers",
        &["ball.json", "--aov", "depth,normal"],
        "a.exr",
        [Same; 4],
    ),
    (
        "layers of samples",
        &["paths.json", "--aov", "depth,error,samples,unmet"],
        "a.exr",
        [Same, Same, Refused("have no strips"), Same],
    ),
    (
        "transparent background",
        &["paths.json", "--background", "transparent"],
        "a.png",
        [Same; 4],
    ),
    (
        "crop",
        &["ball.json", "--crop", "7,5,25,20"],
        "a.png",
        [Same; 4],
    ),
    (
        "supersampling",
        &["ball.json", "--supersampling", "3"],
        "a.png",
        [Same; 4],
    ),
    ("lens", &["lens.json"], "a.png", [Same; 4]),
    (
        "depth buffer",
        &["depth.json"],
        "a.png",
        [Same, Same, Refused("--aov depth"), Same],
    ),
];

/// The words of a checkpoint, of a part, of strips and of frames, where nothing else is asked.
const WAYS: [&[&str]; 4] = [
    &["--checkpoint", "a.rtp", "--every", "0.001", "--restart"],
    &["--part", "1/1"],
    &["--strips=16"],
    &["--turntable", "3", "--frames", "2..2"],
];

/// What a way of working calls its picture, and the picture looked at: of frames the second.
fn names_of(picture: &str, path_at: usize) -> [String; 2] {
    if path_at < 3 {
        return [picture, picture].map(str::to_owned);
    }
    ["a-%d.", "a-2."].map(|name| picture.replace("a.", name))
}

/// The bytes of the picture by a way of working.
fn made(folder: &TempDir, words: &[&str], picture: &str, path_at: usize) -> Vec<u8> {
    let render = [&["render"], words].concat();
    let [output, looked_at] = names_of(picture, path_at);
    if path_at == 1 {
        for part in [3, 1, 2] {
            let (part, name) = (format!("{part}/3"), format!("{part}.rtp"));
            let share = ["--picture", picture, "--part", &part, "-o", &name];
            reported(folder, &[&render[..], &share].concat());
        }
        reported(folder, &["merge", "1.rtp", "2.rtp", "3.rtp", "-o", picture]);
    } else {
        reported(
            folder,
            &[&render[..], WAYS[path_at], &["-o", &output]].concat(),
        );
    }
    bytes(folder, &looked_at)
}

/// The bytes of the picture without that way.
fn plain(folder: &TempDir, words: &[&str], picture: &str, path_at: usize) -> Vec<u8> {
    let [output, looked_at] = names_of(picture, path_at);
    let turn: &[&str] = if path_at == 3 {
        &["--turntable", "3"]
    } else {
        &[]
    };
    reported(
        folder,
        &[&["render"], words, turn, &["-o", &output]].concat(),
    );
    let whole = bytes(folder, &looked_at);
    fs::remove_file(folder.path().join(&looked_at)).unwrap();
    whole
}

fn folder_of_all() -> TempDir {
    let folder = scenes();
    let lens = scene_with(
        "\"radius\": 0, \"samples\": 1",
        "\"radius\": 2, \"samples\": 5",
    );
    fs::write(folder.path().join("lens.json"), lens).unwrap();
    folder
}

#[test]
fn each_cell_of_the_table_is_as_it_says() {
    let folder = folder_of_all();
    for (name, words, picture, cells) in ROWS {
        for (path_at, cell) in cells.into_iter().enumerate() {
            match cell {
                Same => {
                    let whole = plain(&folder, words, picture, path_at);
                    let same = made(&folder, words, picture, path_at) == whole;
                    assert!(same, "{name}: {:?}", WAYS[path_at]);
                }
                Made => drop(made(&folder, words, picture, path_at)),
                Refused(hint) => {
                    let named: &[&str] = if path_at == 2 { &["-o", picture] } else { &[] };
                    let render = [&["render"], words, WAYS[path_at], named].concat();
                    let output = rtc(&folder, &render);
                    assert_eq!(code(&output), 2, "{render:?}: {}", stderr(&output));
                    assert!(stderr(&output).contains(hint), "{}", stderr(&output));
                }
            }
        }
    }
}

#[test]
fn the_table_in_the_docs_has_these_cells() {
    let docs =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/book/src/reference/long-renders.md");
    let docs = fs::read_to_string(docs).unwrap();
    let (_, docs) = docs.split_once("## Combinations").unwrap();
    for (name, _, _, cells) in ROWS {
        let row = docs
            .lines()
            .find(|line| line.starts_with(&format!("| {name}")));
        let row = row.unwrap_or_else(|| panic!("there is no row of {name}"));
        let words: Vec<_> = row.split('|').skip(2).map(str::trim).collect();
        for (word, cell) in words.iter().zip(cells) {
            let is_refused = matches!(cell, Refused(_));
            assert_eq!(word.starts_with("no"), is_refused, "{row}");
            assert_eq!(word.starts_with("yes"), !is_refused, "{row}");
        }
    }
}
