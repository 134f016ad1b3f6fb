//! Detects files that are no scenes by their first bytes, and explains how to use them.

use rtc_diag::{Diagnostic, clip_path, codes};

/// A file format that is no scene: its name, the test of its first bytes, and the hint.
type ForeignFile = (&'static str, fn(&[u8]) -> bool, &'static str);

const TEXTURE: &str = "name it in a scene as the `texture` of a material";
const SKY: &str = "name it in a scene, as `Environment: {file: …}`, or light a scene by `--env`";
const EXPORT: &str = "export the scene as glTF 2.0 (`.glb`) from the program that made it";
const CONVERT: &str =
    "convert it to PNG, JPEG or WebP, and name that as the `texture` of a material";
const TESSELLATE: &str =
    "open it in a program for CAD, and export triangles as glTF 2.0, STL or OBJ";
const UNPACK: &str = "unpack it, and give the scene in it";
const POINTS: &str = "convert it to PLY or XYZ, whose points are drawn";
const SPLATS: &str = "convert it to a PLY of splats, which are drawn";
const VOLUME: &str = "convert a surface of it to a mesh; grids of volumes are not rendered";

/// The formats with magic bytes.
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
        "a KTX texture",
        |b| b.starts_with(b"\xabKTX 20\xbb") || b.starts_with(b"\xabKTX 11\xbb"),
        CONVERT,
    ),
    ("a DDS texture", |b| b.starts_with(b"DDS \x7c"), CONVERT),
    ("a GIF picture", |b| b.starts_with(b"GIF8"), CONVERT),
    (
        "a TIFF picture",
        |b| b.starts_with(b"II*\0") || b.starts_with(b"MM\0*"),
        CONVERT,
    ),
    (
        "a BMP picture",
        |b| b.starts_with(b"BM") && b.get(6..10) == Some(&[0; 4]),
        CONVERT,
    ),
    ("a PDF document", |b| b.starts_with(b"%PDF-"), EXPORT),
    (
        "a pointer of Git LFS",
        |b| b.starts_with(b"version https://git-lfs"),
        "fetch the real file: `git lfs pull`",
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
    ("a 3MF model", is_3mf, EXPORT),
    (
        "an archive",
        |b| b.starts_with(b"PK\x03\x04") || b.starts_with(b"\x1f\x8b"),
        UNPACK,
    ),
    (
        "an archive",
        |b| {
            b.starts_with(b"7z\xbc\xaf\x27\x1c")
                || b.starts_with(b"Rar!\x1a\x07")
                || b.starts_with(b"\xfd7zXZ\0")
                || b.starts_with(b"\x28\xb5\x2f\xfd")
        },
        UNPACK,
    ),
    ("a Blender file", |b| b.starts_with(b"BLENDER"), EXPORT),
    (
        "an FBX file",
        |b| b.starts_with(b"Kaydara FBX") || is_text_fbx(b),
        EXPORT,
    ),
    ("a VRML file", |b| b.starts_with(b"#VRML"), EXPORT),
    (
        "an Open Inventor file",
        |b| b.starts_with(b"#Inventor"),
        EXPORT,
    ),
    (
        "a STEP file",
        |b| b.starts_with(b"ISO-10303-21"),
        TESSELLATE,
    ),
    ("an IGES file", is_iges, TESSELLATE),
    (
        "a BREP file",
        |b| b.starts_with(b"DBRep_DrawableShape"),
        TESSELLATE,
    ),
    (
        "a Rhino file",
        |b| b.starts_with(b"3D Geometry File Format"),
        TESSELLATE,
    ),
    ("a DXF drawing", is_dxf, TESSELLATE),
    ("a Maya file", |b| b.starts_with(b"//Maya ASCII"), EXPORT),
    ("a DirectX file", |b| b.starts_with(b"xof 030"), EXPORT),
    (
        "an Alembic file",
        |b| b.starts_with(b"Ogawa") || b.starts_with(b"\x89HDF"),
        EXPORT,
    ),
    (
        "a LightWave file",
        |b| b.starts_with(b"FORM") && b.get(8..11) == Some(b"LWO"),
        EXPORT,
    ),
    ("a file of POV-Ray", is_pov, EXPORT),
    (
        "an OpenVDB volume",
        |b| b.starts_with(b" BDV\0\0\0\0"),
        VOLUME,
    ),
    ("a NanoVDB volume", |b| b.starts_with(b"NanoVDB"), VOLUME),
    ("a LAS point cloud", |b| b.starts_with(b"LASF"), POINTS),
    ("an E57 point cloud", |b| b.starts_with(b"ASTM-E57"), POINTS),
    (
        "a PCD point cloud",
        |b| b.starts_with(b"# .PCD v") || b.starts_with(b"VERSION .7\nFIELDS"),
        POINTS,
    ),
    (
        "a file of compressed Gaussian splats",
        |b| b.starts_with(b"NGSP") || is_compressed_ply(b),
        SPLATS,
    ),
];

/// The extensions of binary files that have no magic bytes, or those of a common container.
const NAMED: &[(&str, &str, &str)] = &[
    ("spz", "a file of compressed Gaussian splats", SPLATS),
    ("splat", "a file of Gaussian splats", SPLATS),
    ("ksplat", "a file of compressed Gaussian splats", SPLATS),
    ("sog", "a file of compressed Gaussian splats", SPLATS),
];

/// The XML formats: the name of the root element, the name of the format, and the hint.
const XML: &[(&str, &str, &str)] = &[
    ("COLLADA", "a COLLADA file", EXPORT),
    ("X3D", "an X3D file", EXPORT),
    ("svg", "an SVG drawing", CONVERT),
    ("model", "the model of a 3MF package", EXPORT),
    ("amf", "an AMF model", EXPORT),
];

/// The number of bytes that are examined.
const HEAD: usize = 4096;

/// The diagnostic that a file is no scene, if its first bytes are those of another format.
pub fn foreign(name: &str, bytes: &[u8]) -> Option<Diagnostic> {
    // A scene of pbrt may be compressed, and a stage of USD an archive.
    if crate::pbrt::is_pbrt_gzip(name, bytes) || crate::usd::is_usd(name, bytes) {
        return None;
    }
    let head = &bytes[..bytes.len().min(HEAD)];
    let found = || FOREIGN.iter().find(|(_, begins, _)| begins(head));
    let known = named(name, head).or_else(|| found().map(|(format, _, hint)| (*format, *hint)));
    let (format, hint) = known.or_else(|| xml(head))?;
    let message = format!("`{}` is {format}, not a scene", clip_path(name));
    Some(Diagnostic::new(&codes::NOT_A_SCENE, message).hint(hint))
}

/// The format and the hint of a binary file by its extension.
fn named(name: &str, head: &[u8]) -> Option<(&'static str, &'static str)> {
    let (_, extension) = name.rsplit_once('.')?;
    let is_text = || {
        head.iter()
            .all(|byte| !byte.is_ascii_control() || byte.is_ascii_whitespace())
    };
    let found = NAMED
        .iter()
        .find(|(known, ..)| extension.eq_ignore_ascii_case(known));
    found
        .filter(|_| !is_text())
        .map(|(_, format, hint)| (*format, *hint))
}

/// Whether a PLY holds splats in chunks of packed numbers, as PlayCanvas writes them.
fn is_compressed_ply(head: &[u8]) -> bool {
    head.starts_with(b"ply") && contains(head, b" packed_position")
}

/// The text without a byte order mark and leading white space.
fn text(head: &[u8]) -> &[u8] {
    let mark: &[u8] = b"\xef\xbb\xbf";
    head.strip_prefix(mark).unwrap_or(head).trim_ascii_start()
}

fn contains(head: &[u8], part: &[u8]) -> bool {
    head.windows(part.len()).any(|window| window == part)
}

fn is_html(head: &[u8]) -> bool {
    let start = text(head);
    [&b"<!doctype html"[..], b"<html"].into_iter().any(|word| {
        let begin = start.get(..word.len());
        begin.is_some_and(|begin| begin.eq_ignore_ascii_case(word))
    })
}

/// The name and the hint of an XML document, if the file is one.
fn xml(head: &[u8]) -> Option<(&'static str, &'static str)> {
    let (name, is_declared) = xml_root(head)?;
    if name == crate::mitsuba::ROOT.as_bytes() {
        return None;
    }
    let known = XML.iter().find(|(root, ..)| root.as_bytes() == name);
    let known = known.map(|(_, is, hint)| (*is, *hint));
    known.or_else(|| is_declared.then_some(("a document of XML", EXPORT)))
}

/// The name of the root element of an XML document, and whether the document has a declaration.
pub(crate) fn xml_root(head: &[u8]) -> Option<(&[u8], bool)> {
    let mut rest = text(head);
    if !rest.starts_with(b"<") {
        return None;
    }
    let is_declared = rest.starts_with(b"<?xml");
    while rest.starts_with(b"<?") || rest.starts_with(b"<!") {
        let end: &[u8] = if rest.starts_with(b"<!--") {
            b"-->"
        } else {
            b">"
        };
        let at = rest.windows(end.len()).position(|window| window == end)?;
        rest = rest[at + end.len()..].trim_ascii_start();
    }
    let name = rest.strip_prefix(b"<")?;
    let is_end = |byte: &u8| !byte.is_ascii_alphanumeric() && !b":_-.".contains(byte);
    let name = &name[..name.iter().position(is_end).unwrap_or(name.len())];
    Some((name, is_declared))
}

/// The name of the first file of a ZIP archive.
fn first_in_zip(head: &[u8]) -> Option<&[u8]> {
    let length = head
        .starts_with(b"PK\x03\x04")
        .then(|| head.get(26..28))??;
    let length = usize::from(u16::from_le_bytes([length[0], length[1]]));
    head.get(30..30 + length)
}

fn is_3mf(head: &[u8]) -> bool {
    let first = first_in_zip(head);
    let is_part = |name: &[u8]| name.starts_with(b"3D/") || name.starts_with(b"Metadata/");
    let is_list = |name: &[u8]| name == b"[Content_Types].xml" || name == b"_rels/.rels";
    first.is_some_and(|name| is_part(name) || (is_list(name) && contains(head, b"3D/")))
}

pub(crate) fn is_usdz(head: &[u8]) -> bool {
    let is_layer = |name: &[u8]| {
        [&b".usdc"[..], b".usda", b".usd"]
            .iter()
            .any(|end| name.ends_with(end))
    };
    first_in_zip(head).is_some_and(is_layer)
}

fn is_text_fbx(head: &[u8]) -> bool {
    let start = text(head);
    start.starts_with(b"; FBX ") || start.starts_with(b"FBXHeaderExtension:")
}

/// The first line of an IGES file ends in `S` and the number 1.
fn is_iges(head: &[u8]) -> bool {
    let line = head.split(|byte| matches!(byte, b'\n' | b'\r')).next();
    line.and_then(|line| line.get(72..80)) == Some(b"S      1")
}

fn is_dxf(head: &[u8]) -> bool {
    let mut words = text(head).split(u8::is_ascii_whitespace);
    let mut words = words.by_ref().filter(|word| !word.is_empty());
    words.next() == Some(b"0") && words.next() == Some(b"SECTION")
}

/// The lines that are neither empty nor comments.
fn lines<'h>(head: &'h [u8], comment: &'static [u8]) -> impl Iterator<Item = &'h [u8]> {
    let lines = text(head).split(|byte| matches!(byte, b'\n' | b'\r'));
    let lines = lines.map(<[u8]>::trim_ascii);
    lines.filter(move |line| !line.is_empty() && !line.starts_with(comment))
}

/// Whether the lines are directives and objects of POV-Ray.
fn is_pov(head: &[u8]) -> bool {
    const DIRECTIVES: [&[u8]; 5] = [
        b"#version",
        b"#include",
        b"#declare",
        b"#default",
        b"#macro",
    ];
    const THINGS: [&[u8]; 6] = [
        b"camera",
        b"light_source",
        b"global_settings",
        b"background",
        b"sphere",
        b"plane",
    ];
    let is_thing = |line: &[u8]| {
        let opens = |word: &&[u8]| {
            let rest = line.strip_prefix(*word);
            rest.is_some_and(|rest| rest.trim_ascii_start().starts_with(b"{"))
        };
        THINGS.iter().any(opens)
    };
    let mut lines = lines(head, b"//");
    let first = lines.next().unwrap_or_default();
    let is_directive = DIRECTIVES.iter().any(|word| first.starts_with(word));
    is_thing(first) || (is_directive && lines.any(is_thing))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        foreign("x", bytes).map_or_else(String::new, |diagnostic| diagnostic.message)
    }

    #[test]
    fn other_files_are_called_what_they_are() {
        let zip = |name: &str| {
            let length = u8::try_from(name.len()).unwrap();
            let mut head = b"PK\x03\x04".to_vec();
            head.extend([0; 22]);
            head.extend([length, 0, 0, 0]);
            head.extend(name.bytes());
            head
        };
        for (bytes, format) in [
            (&b"\x89PNG\r\n\x1a\n"[..], "a PNG picture"),
            (b"\n <!DOCTYPE HTML>\n<p>", "a page of HTML"),
            (
                b"version https://git-lfs.github.com/spec/v1\n",
                "a pointer of Git LFS",
            ),
            (
                b"\xef\xbb\xbf<?xml version=\"1.0\"?><COLLADA xmlns=\"x\">",
                "a COLLADA file",
            ),
            (b"<?xml version=\"1.0\"?><plist>", "a document of XML"),
            (
                b"#version 3.7;\n// a ball\ncamera { location 0 }",
                "a file of POV-Ray",
            ),
            (b"ISO-10303-21;\nHEADER;", "a STEP file"),
            (b"#VRML V2.0 utf8\n", "a VRML file"),
            (b"; FBX 7.3.0 project file\n", "an FBX file"),
            (b"Kaydara FBX Binary  \0", "an FBX file"),
            (b"\xabKTX 20\xbb\r\n\x1a\n", "a KTX texture"),
            (b"  0\r\nSECTION\r\n", "a DXF drawing"),
            (&zip("3D/3dmodel.model"), "a 3MF model"),
            (&zip("scene.yaml"), "an archive"),
            (b" BDV\0\0\0\0\xe0\0\0\0", "an OpenVDB volume"),
            (b"LASF\0\0\0\0", "a LAS point cloud"),
            (b"ASTM-E57\x01\0\0\0", "an E57 point cloud"),
            (
                b"# .PCD v0.7 - Point Cloud Data\nVERSION 0.7\n",
                "a PCD point cloud",
            ),
            (b"NGSP\x04\0\0\0", "a file of compressed Gaussian splats"),
            (
                b"ply\nelement chunk 1\nelement vertex 2\nproperty uint packed_position\n",
                "a file of compressed Gaussian splats",
            ),
        ] {
            assert_eq!(message(bytes), format!("`x` is {format}, not a scene"));
        }
    }

    #[test]
    fn binary_files_without_magic_bytes_are_known_by_their_names() {
        let is_splats = |name: &str, bytes: &[u8]| {
            let message = foreign(name, bytes).map(|diagnostic| diagnostic.message);
            message.is_some_and(|message| message.contains("Gaussian splats"))
        };
        assert!(is_splats("a.spz", b"\x1f\x8b\x08\0"));
        assert!(is_splats("a.SPLAT", b"\0\0\x80\x3f"));
        assert!(is_splats("a.sog", b"PK\x03\x04"));
        assert!(!is_splats("a.spz", b"Camera: {eye: [0, 0, 1]}\n"));
        assert!(!is_splats("a.gz", b"\x1f\x8b\x08\0"));
    }

    #[test]
    fn scenes_are_not_taken_for_others() {
        for scene in [
            "Camera: {eye: [0, 0, 1]}\n",
            "Camera:\n  eye: [0, 0, 1]\n",
            "{\"Camera\": {}}",
            "# a comment\nLights: []\n",
            "#include nothing\nLights: []\n",
            "{\"irVersion\": 4}",
            "MZ: 1\n",
            "version: 2\n",
            "Scale: 1\n",
            "OFF\n3 1 0\n",
            "# a scene\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"",
            "Film \"rgb\" \"string filename\" \"a:b.exr\"\n",
            "0 1 2\n",
            "BM: 1\nEye: 2",
            "",
        ] {
            assert_eq!(message(scene.as_bytes()), "", "{scene}");
        }
        assert_eq!(message(b"glTF\x02\0\0\0"), "");
    }
}
