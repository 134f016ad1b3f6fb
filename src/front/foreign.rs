//! Files that are no scenes: what they are, by their first bytes, and what a scene has to do with
//! them.

use rtc_diag::{Diagnostic, clip_path, codes};

/// A kind of file that is no scene: what it is, how it begins, and what to do with it.
type ForeignFile = (&'static str, fn(&[u8]) -> bool, &'static str);

const TEXTURE: &str = "name it in a scene, as the `texture` of a material";
const SKY: &str = "name it in a scene, as `Environment: {file: …}`, or light a scene by `--env`";
const EXPORT: &str = "export the scene as glTF 2.0 (`.glb`) from the program that made it";

const FOREIGN: &[ForeignFile] = &[
    ("a PNG picture", |b| b.starts_with(b"\x89PNG"), TEXTURE),
    (
        "a JPEG picture",
        |b| b.starts_with(b"\xff\xd8\xff"),
        TEXTURE,
    ),
    (
        "a WebP picture",
        |b| b.starts_with(b"RIFF") && b.get(8..12) == Some(b"WEBP"),
        TEXTURE,
    ),
    (
        "an EXR picture",
        |b| b.starts_with(b"\x76\x2f\x31\x01"),
        SKY,
    ),
    (
        "a Radiance HDR picture",
        |b| b.starts_with(b"#?RADIANCE") || b.starts_with(b"#?RGBE"),
        SKY,
    ),
    (
        "a pointer of Git LFS",
        |b| b.starts_with(b"version https://git-lfs"),
        "fetch the file that it stands for: `git lfs pull`",
    ),
    (
        "a page of HTML",
        is_html,
        "a page was saved instead of the file that it shows: fetch the file itself",
    ),
    (
        "a program",
        |b| b.starts_with(b"\x7fELF") || (b.starts_with(b"MZ") && b.contains(&0)),
        "give the scene that is meant",
    ),
    (
        "an archive",
        |b| b.starts_with(b"PK\x03\x04") || b.starts_with(b"\x1f\x8b"),
        "unpack it, and give the scene in it",
    ),
    ("a Blender file", |b| b.starts_with(b"BLENDER"), EXPORT),
    ("an FBX file", |b| b.starts_with(b"Kaydara FBX"), EXPORT),
    (
        "a USD file",
        |b| b.starts_with(b"#usda") || b.starts_with(b"PXR-USDC"),
        EXPORT,
    ),
];

/// How much of a file is looked at, in bytes.
const HEAD: usize = 4096;

/// Why a file is no scene, if its first bytes say that it is something else.
pub fn foreign(name: &str, bytes: &[u8]) -> Option<Diagnostic> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let (is, _, hint) = FOREIGN.iter().find(|(_, begins, _)| begins(head))?;
    let message = format!("`{}` is {is}, and no scene", clip_path(name));
    Some(Diagnostic::new(&codes::NOT_A_SCENE, message).hint(*hint))
}

fn is_html(head: &[u8]) -> bool {
    let start = head.trim_ascii_start();
    [&b"<!doctype html"[..], b"<html"].into_iter().any(|word| {
        let begin = start.get(..word.len());
        begin.is_some_and(|begin| begin.eq_ignore_ascii_case(word))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(bytes: &[u8]) -> String {
        foreign("x", bytes).map_or_else(String::new, |finding| finding.message)
    }

    #[test]
    fn other_files_are_called_what_they_are() {
        assert_eq!(
            told(b"\x89PNG\r\n\x1a\n"),
            "`x` is a PNG picture, and no scene"
        );
        assert_eq!(
            told(b"\n <!DOCTYPE HTML>\n<p>"),
            "`x` is a page of HTML, and no scene"
        );
        assert!(told(b"version https://git-lfs.github.com/spec/v1\n").contains("Git LFS"));
    }

    #[test]
    fn scenes_are_not_taken_for_others() {
        for scene in [
            "Camera: {eye: [0, 0, 1]}\n",
            "{\"Camera\": {}}",
            "# a comment\nLights: []\n",
            "{\"irVersion\": 4}",
            "MZ: 1\n",
            "version: 2\n",
            "OFF\n3 1 0\n",
            "",
        ] {
            assert_eq!(told(scene.as_bytes()), "", "{scene}");
        }
        assert_eq!(told(b"glTF\x02\0\0\0"), "");
    }
}
