//! Scenes of pbrt that ask for much.

use super::Repro;
use flate2::{Compression, write::GzEncoder};
use std::io::Write as _;

/// What scenes begin with.
const HEAD: &str = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
                    LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\"\nWorldBegin\n\
                    LightSource \"infinite\"\n";

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    [texts(), files(), geometry(), state()]
        .into_iter()
        .flatten()
        .collect()
}

/// Texts that are no scenes, or hardly.
fn texts() -> Vec<Repro> {
    vec![
        repeated("500 000 opening brackets", "[", 500_000, Some("PB001")),
        asked(
            "10 000 times a file of 1 MB of comments",
            vec![
                (
                    "a.pbrt",
                    format!("{HEAD}{}", "Include \"part.pbrt\"\n".repeat(10_000)),
                ),
                ("part.pbrt", "#\n".repeat(1 << 19)),
            ],
            Some("IO003"),
        ),
        repeated("500 000 quotes", "\" ", 500_001, Some("PB001")),
        repeated(
            "a list of 500 000 lists",
            "Shape \"sphere\" \"float radius\" [ ",
            30_000,
            Some("PB002"),
        ),
        repeated(
            "100 000 unknown directives",
            "Shap \"sphere\" TransformBegin TransformEnd\n",
            30_000,
            None,
        ),
        repeated(
            "100 000 directives without a name",
            "Shape ",
            100_000,
            Some("PB001"),
        ),
        checked(
            "a word of 2 MB",
            format!("{HEAD}{}", "x".repeat(2 << 20)),
            None,
        ),
        checked(
            "a name of 2 MB",
            format!("{HEAD}NamedMaterial \"{}\"", "x".repeat(2 << 20)),
            None,
        ),
        checked(
            "a parameter of 500 000 numbers that nobody asks for",
            format!(
                "{HEAD}Shape \"sphere\" \"float a\" [{}]",
                "1 ".repeat(500_000)
            ),
            None,
        ),
        checked(
            "a shape with 60 000 parameters",
            format!(
                "{HEAD}Shape \"sphere\" {}",
                numbered(60_000, |n| format!("\"float a{n}\" 1 "))
            ),
            None,
        ),
        checked(
            "a comment of 2 MB",
            format!("{HEAD}#{}", "#".repeat(2 << 20)),
            None,
        ),
        checked(
            "bytes that are no text",
            format!("{HEAD}{}", "\u{0}\u{1}\u{7f}\"\u{0}".repeat(9_000)),
            None,
        ),
        checked(
            "numbers beyond all bounds",
            format!("{HEAD}{}", "Scale 1e308 1e308 1e308 ".repeat(40))
                + "Shape \"sphere\" \"float radius\" 1e308",
            Some("VA001"),
        ),
    ]
}

/// Files that include others.
fn files() -> Vec<Repro> {
    let doubling = (0..40).map(|level| {
        let next = format!("Include \"{}.pbrt\"\n", level + 1);
        (format!("{level}.pbrt"), next.repeat(2).into_bytes())
    });
    let doubling = std::iter::once((
        "a.pbrt".to_owned(),
        format!("{HEAD}Include \"0.pbrt\"").into_bytes(),
    ))
    .chain(doubling);
    let many = format!("{HEAD}{}", "Include \"part.pbrt\"\n".repeat(60_000));
    let part = "Translate 1 0 0\n".repeat(60_000);
    vec![
        checked(
            "a file that includes itself",
            format!("{HEAD}Include \"a.pbrt\""),
            Some("PB002"),
        ),
        asked(
            "two files that include each other",
            vec![
                ("a.pbrt", format!("{HEAD}Include \"b.pbrt\"")),
                ("b.pbrt", "Include \"a.pbrt\"".to_owned()),
            ],
            Some("PB002"),
        ),
        Repro {
            name: "40 files that include the next one twice",
            files: doubling.collect(),
            arguments: check(),
            expected: Some("PB002"),
        },
        asked(
            "60 000 times a file of 1 MB",
            vec![("a.pbrt", many), ("part.pbrt", part)],
            Some("IO003"),
        ),
        checked(
            "30 000 files that are not there",
            format!(
                "{HEAD}{}",
                numbered(30_000, |n| format!("Include \"{n}.pbrt\"\n"))
            ),
            Some("PB002"),
        ),
        checked(
            "30 000 meshes that are not there",
            format!(
                "{HEAD}{}",
                numbered(30_000, |n| format!(
                    "Shape \"plymesh\" \"string filename\" \"{n}.ply\"\n"
                ))
            ),
            Some("PB002"),
        ),
        Repro {
            name: "a scene that unpacks to 1 GB",
            files: vec![("a.pbrt.gz".to_owned(), gzip(1 << 30))],
            arguments: ["check", "-q", "a.pbrt.gz"].map(str::to_owned).to_vec(),
            expected: Some("IO003"),
        },
        Repro {
            name: "a mesh that unpacks to 1 GB",
            files: vec![
                (
                    "a.pbrt".to_owned(),
                    format!("{HEAD}Shape \"plymesh\" \"string filename\" \"m.ply.gz\"")
                        .into_bytes(),
                ),
                ("m.ply.gz".to_owned(), gzip(1 << 30)),
            ],
            arguments: check(),
            expected: None,
        },
    ]
}

/// Shapes that become large.
fn geometry() -> Vec<Repro> {
    let triangle = "\"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]";
    let objects = "ObjectInstance \"o\"\n".repeat(100_000);
    vec![
        checked(
            "a triangle subdivided 12 times",
            format!("{HEAD}Shape \"loopsubdiv\" \"integer levels\" 12 {triangle}"),
            Some("IO003"),
        ),
        checked(
            "a triangle subdivided 10^9 times",
            format!("{HEAD}Shape \"loopsubdiv\" \"integer levels\" 1000000000 {triangle}"),
            Some("PB002"),
        ),
        checked(
            "20 000 triangles subdivided 8 times each",
            format!(
                "{HEAD}{}",
                format!("Shape \"loopsubdiv\" \"integer levels\" 8 {triangle}\n").repeat(20_000)
            ),
            Some("IO003"),
        ),
        checked(
            "100 000 instances of 1 000 spheres",
            format!(
                "{HEAD}ObjectBegin \"o\"\n{}ObjectEnd\n{objects}",
                "Shape \"sphere\"\n".repeat(1_000)
            ),
            Some("IO003"),
        ),
        checked(
            "100 000 cones",
            format!("{HEAD}{}", "Shape \"cone\"\n".repeat(100_000)),
            Some("IO003"),
        ),
        checked(
            "indices beyond all vertices",
            format!(
                "{HEAD}Shape \"trianglemesh\" \"integer indices\" [0 1 4000000000] \"point P\" [0 0 0 1 0 0 0 1 0]"
            ),
            Some("PB002"),
        ),
        checked(
            "a picture of 10^9 by 10^9 pixels",
            HEAD.replace(" 8", " 1000000000"),
            Some("VA009"),
        ),
    ]
}

/// States that are opened or copied often.
fn state() -> Vec<Repro> {
    vec![
        repeated(
            "300 000 attributes in each other",
            "AttributeBegin\n",
            300_000,
            Some("PB002"),
        ),
        repeated("300 000 ends of nothing", "AttributeEnd\n", 300_000, None),
        checked(
            "an attribute of 200 000 numbers for 30 000 shapes",
            format!(
                "{HEAD}Attribute \"shape\" \"point P\" [{}]\n{}",
                "1 2 3 ".repeat(70_000),
                "Shape \"sphere\"\n".repeat(30_000)
            ),
            None,
        ),
        checked(
            "30 000 copies of 30 000 attributes",
            format!(
                "{HEAD}{}{}",
                numbered(30_000, |n| format!(
                    "Attribute \"shape\" \"float a{n}\" 1\n"
                )),
                "AttributeBegin Attribute \"shape\" \"float b\" 1 AttributeEnd\n".repeat(30_000)
            ),
            Some("IO003"),
        ),
        checked(
            "9 000 attributes for 30 000 shapes",
            format!(
                "{HEAD}Attribute \"shape\" {}\n{}",
                numbered(9_000, |n| format!("\"float a{n}\" 1 ")),
                "Shape \"sphere\"\n".repeat(30_000)
            ),
            None,
        ),
        checked(
            "30 000 materials",
            format!(
                "{HEAD}{}",
                "Material \"diffuse\" Shape \"sphere\"\n".repeat(30_000)
            ),
            None,
        ),
        checked(
            "a chain of 100 000 textures",
            format!(
                "{HEAD}Texture \"0\" \"spectrum\" \"constant\"\n{}",
                numbered(50_000, |n| format!(
                    "Texture \"{}\" \"spectrum\" \"scale\" \"texture tex\" \"{n}\"\n",
                    n + 1
                ))
            ),
            None,
        ),
        checked(
            "100 000 checkerboards",
            format!(
                "{HEAD}Texture \"t\" \"spectrum\" \"checkerboard\"\n{}",
                "Material \"diffuse\" \"texture reflectance\" \"t\"\n".repeat(100_000)
            ),
            None,
        ),
    ]
}

fn check() -> Vec<String> {
    ["check", "-q", "a.pbrt"].map(str::to_owned).to_vec()
}

/// Checks a scene.
fn checked(name: &'static str, text: String, expected: Option<&'static str>) -> Repro {
    asked(name, vec![("a.pbrt", text)], expected)
}

/// Checks the first of some files.
fn asked(
    name: &'static str,
    files: Vec<(&'static str, String)>,
    expected: Option<&'static str>,
) -> Repro {
    let files = files
        .into_iter()
        .map(|(name, text)| (name.to_owned(), text.into_bytes()));
    Repro {
        name,
        files: files.collect(),
        arguments: check(),
        expected,
    }
}

fn repeated(name: &'static str, text: &str, times: usize, expected: Option<&'static str>) -> Repro {
    checked(name, format!("{HEAD}{}", text.repeat(times)), expected)
}

fn numbered(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}

/// So many spaces, compressed.
fn gzip(length: usize) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    let block = vec![b' '; 1 << 20];
    for _ in 0..length / block.len() {
        encoder.write_all(&block).unwrap();
    }
    encoder.finish().unwrap()
}
