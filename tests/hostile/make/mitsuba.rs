//! Scenes of Mitsuba that ask for much.

use super::Repro;
use flate2::{Compression, write::ZlibEncoder};
use std::io::Write as _;

/// What every scene has.
const SENSOR: &str = "<sensor type=\"perspective\"><film type=\"hdrfilm\">\
    <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/></film></sensor>\
    <emitter type=\"constant\"/>";

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    [
        texts(),
        parameters(),
        files(),
        references(),
        shared_bsdfs(),
        values(),
        meshes(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Texts that are no scenes, or hardly.
fn texts() -> Vec<Repro> {
    vec![
        repeated(
            "100 000 elements in each other",
            "<bsdf type=\"twosided\">",
            100_000,
            Some("MI001"),
        ),
        checked(
            "20 000 elements in each other, closed",
            "<bsdf type=\"twosided\">".repeat(20_000) + &"</bsdf>".repeat(20_000),
            Some("MI002"),
        ),
        Repro {
            name: "entities that double 30 times",
            files: vec![("a.xml".to_owned(), entities().into_bytes())],
            arguments: check(),
            expected: Some("SC009"),
        },
        checked(
            "a comment of 2 MB",
            format!("<!--{}-->", "#".repeat(2 << 20)),
            None,
        ),
        checked(
            "a plugin with a name of 2 MB",
            format!("<bsdf type=\"{}\"/>", "x".repeat(2 << 20)),
            None,
        ),
        checked(
            "an element with 20 000 attributes",
            format!(
                "<bsdf type=\"diffuse\" {}/>",
                numbered(20_000, |n| format!("a{n}=\"1\" "))
            ),
            Some("MI001"),
        ),
        checked(
            "2 000 namespaces beside 2 000 elements with one",
            numbered(2_000, |n| format!("<a xmlns:a{n}=\"u{n}\"/>"))
                + &"<a xmlns:b=\"c\"/>".repeat(2_000),
            Some("MI001"),
        ),
        checked(
            "20 000 transforms in each other",
            shape(
                "sphere",
                &format!(
                    "<transform name=\"to_world\">{}{}</transform>",
                    "<transform>".repeat(20_000),
                    "</transform>".repeat(20_000)
                ),
            ),
            Some("MI002"),
        ),
        repeated(
            "100 000 unknown elements",
            "<fnord/>",
            100_000,
            Some("MI002"),
        ),
        repeated(
            "50 000 unknown shapes",
            "<shape type=\"fnord\"/>",
            50_000,
            None,
        ),
        repeated(
            "50 000 sensors",
            "<sensor type=\"perspective\"/>",
            50_000,
            None,
        ),
        checked(
            "bytes that are no text",
            "\u{1}\u{7f}".repeat(9_000),
            Some("MI001"),
        ),
    ]
}

/// Ten entities, each of which is the last one ten times.
fn entities() -> String {
    let levels = numbered(30, |n| format!("<!ENTITY e{} \"&e{n};&e{n};\">", n + 1));
    format!("<!DOCTYPE scene [<!ENTITY e0 \"x\">{levels}]><scene version=\"3.0.0\">&e30;</scene>")
}

/// Parameters that multiply.
fn parameters() -> Vec<Repro> {
    vec![
        checked(
            "parameters that double 40 times",
            "<default name=\"p0\" value=\"xx\"/>".to_owned()
                + &numbered(40, |n| {
                    format!("<default name=\"p{}\" value=\"$p{n}$p{n}\"/>", n + 1)
                })
                + "<bsdf type=\"$p40\"/>",
            None,
        ),
        checked(
            "50 000 parameters",
            numbered(50_000, |n| format!("<default name=\"p{n}\" value=\"1\"/>"))
                + &numbered(50_000, |n| format!("<bsdf type=\"$p{n}\"/>")),
            None,
        ),
        checked(
            "a parameter of 1 MB, 20 000 times",
            format!("<default name=\"p\" value=\"{}\"/>", "x".repeat(1 << 20))
                + &"<bsdf type=\"$p\"/>".repeat(20_000),
            Some("IO003"),
        ),
        checked(
            "30 000 other names for an element of 30 000",
            format!(
                "<bsdf type=\"twosided\" id=\"a\">{}</bsdf>",
                "<bsdf type=\"diffuse\"/>".repeat(30_000)
            ) + &numbered(30_000, |n| format!("<alias id=\"a\" as=\"b{n}\"/>")),
            None,
        ),
        checked(
            "30 000 other names behind 30 000 elements",
            "<bsdf type=\"diffuse\" id=\"a\"/>".to_owned()
                + &"<bsdf type=\"diffuse\"/>".repeat(30_000)
                + &numbered(30_000, |n| format!("<alias id=\"a\" as=\"b{n}\"/>")),
            None,
        ),
        checked(
            "a chain of 30 000 other names",
            "<bsdf type=\"diffuse\" id=\"a0\"/>".to_owned()
                + &numbered(30_000, |n| {
                    format!("<alias id=\"a{n}\" as=\"a{}\"/>", n + 1)
                }),
            None,
        ),
    ]
}

/// Files that include others, or are not there.
fn files() -> Vec<Repro> {
    let scene = |body: &str| format!("<scene version=\"3.0.0\">{body}</scene>").into_bytes();
    let include = |name: &str| format!("<include filename=\"{name}\"/>");
    let doubling = (0..40).map(|level| {
        let next = include(&format!("{}.xml", level + 1));
        (format!("{level}.xml"), scene(&next.repeat(2)))
    });
    let doubling = std::iter::once(("a.xml".to_owned(), scene(&include("0.xml")))).chain(doubling);
    vec![
        checked(
            "a file that includes itself",
            include("a.xml"),
            Some("MI002"),
        ),
        Repro {
            name: "40 files that include the next one twice",
            files: doubling.collect(),
            arguments: check(),
            expected: Some("MI002"),
        },
        Repro {
            name: "30 000 times a file of 1 MB",
            files: vec![
                ("a.xml".to_owned(), scene(&include("b.xml").repeat(30_000))),
                (
                    "b.xml".to_owned(),
                    scene(&"<bsdf type=\"diffuse\"/>".repeat(45_000)),
                ),
            ],
            arguments: check(),
            expected: Some("IO003"),
        },
        checked(
            "20 000 meshes that are not there",
            numbered(20_000, |n| shape("obj", &file(&format!("{n}.obj")))),
            Some("RE001"),
        ),
        checked(
            "5 000 meshes that are not there, in 5 000 folders",
            numbered(5_000, |n| format!("<path value=\"p{n}\"/>"))
                + &numbered(5_000, |n| shape("obj", &file(&format!("{n}.obj")))),
            Some("MI002"),
        ),
        checked(
            "20 000 meshes that are not there, in 32 folders",
            "<path value=\"p\"/>".repeat(32)
                + &numbered(20_000, |n| shape("obj", &file(&format!("{n}.obj")))),
            Some("RE001"),
        ),
    ]
}

/// References that multiply, or never end.
fn references() -> Vec<Repro> {
    let twice = |level: usize| {
        let next = format!("<ref id=\"b{}\"/>", level + 1);
        format!(
            "<bsdf type=\"blendbsdf\" id=\"b{level}\">{}</bsdf>",
            next.repeat(50)
        )
    };
    let nested = |level: usize| {
        let next = format!(
            "<shape type=\"instance\"><ref id=\"g{}\"/></shape>",
            level + 1
        );
        format!(
            "<shape type=\"shapegroup\" id=\"g{level}\">{}</shape>",
            next.repeat(50)
        )
    };
    vec![
        checked(
            "a BSDF inside itself",
            "<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>".to_owned()
                + &shape("sphere", "<ref id=\"a\"/>"),
            None,
        ),
        checked(
            "12 BSDFs of 50 references to the next one",
            numbered(12, twice)
                + "<bsdf type=\"diffuse\" id=\"b12\"/>"
                + &shape("rectangle", "<ref id=\"b0\"/><emitter type=\"area\"/>")
                + &shape("ply", &format!("<ref id=\"b0\"/>{}", file("a.ply"))),
            Some("RE001"),
        ),
        checked(
            "7 groups of 50 instances of the next one",
            numbered(7, nested)
                + "<shape type=\"shapegroup\" id=\"g7\"><shape type=\"sphere\"/></shape>"
                + &shape("instance", "<ref id=\"g0\"/>"),
            Some("IO003"),
        ),
        checked(
            "a group of instances of itself",
            format!(
                "<shape type=\"shapegroup\" id=\"a\">{}</shape>{}",
                shape("instance", "<ref id=\"a\"/>").repeat(50),
                shape("instance", "<ref id=\"a\"/>")
            ),
            Some("IO003"),
        ),
        checked(
            "100 000 references to nothing",
            "<ref id=\"x\"/>".repeat(100_000),
            Some("MI002"),
        ),
        checked(
            "30 000 lights with a back",
            shape("rectangle", "<emitter type=\"area\"/>").repeat(30_000),
            None,
        ),
    ]
}

/// BSDFs that many others hold.
fn shared_bsdfs() -> Vec<Repro> {
    vec![
        checked(
            "20 blends of the last one twice",
            "<bsdf type=\"diffuse\" id=\"b0\"/>".to_owned()
                + &numbered(20, |n| {
                    format!(
                        "<bsdf type=\"blendbsdf\" id=\"b{}\">{}</bsdf>",
                        n + 1,
                        format!("<ref id=\"b{n}\"/>").repeat(2)
                    )
                })
                + &shape("sphere", "<ref id=\"b20\"/>"),
            None,
        ),
        checked(
            "a chain of 10 000 BSDFs, each on a sphere",
            "<bsdf type=\"diffuse\" id=\"b0\"/>".to_owned()
                + &numbered(10_000, |n| {
                    format!(
                        "<bsdf type=\"twosided\" id=\"b{}\"><ref id=\"b{n}\"/></bsdf>{}",
                        n + 1,
                        shape("sphere", &format!("<ref id=\"b{n}\"/>"))
                    )
                }),
            None,
        ),
    ]
}

/// Numbers that are many, or beyond all bounds.
fn values() -> Vec<Repro> {
    let list = |number: &str| format!("{number} ").repeat(300_000);
    let sensor = |more: &str| format!("<sensor type=\"perspective\">{more}</sensor>");
    let film = |name: &str, value: &str| {
        sensor(&format!(
            "<film type=\"hdrfilm\"><integer name=\"{name}\" value=\"{value}\"/></film>"
        ))
    };
    vec![
        checked(
            "a spectrum of 300 000 pairs",
            bsdf(&format!(
                "<spectrum name=\"reflectance\" value=\"{}300000:1\"/>",
                numbered(300_000, |n| format!("{n}:1, "))
            )),
            None,
        ),
        checked(
            "a colour of 300 000 numbers",
            bsdf(&format!(
                "<rgb name=\"reflectance\" value=\"{}\"/>",
                list("1")
            )),
            Some("MI002"),
        ),
        checked(
            "a matrix of 300 000 numbers",
            shape(
                "sphere",
                &format!(
                    "<transform name=\"to_world\"><matrix value=\"{}\"/></transform>",
                    list("1")
                ),
            ),
            Some("MI002"),
        ),
        checked(
            "a transform of 100 000 steps",
            shape(
                "sphere",
                &format!(
                    "<transform name=\"to_world\">{}</transform>",
                    "<scale value=\"1e300\"/>".repeat(100_000)
                ),
            ),
            Some("VA001"),
        ),
        bare(
            "a film as wide as a number can say",
            film("width", "999999999999999"),
            Some("VA009"),
        ),
        bare("a film without pixels", film("width", "-1"), None),
        bare(
            "a field of view that is no number",
            sensor("<float name=\"fov\" value=\"nan\"/>"),
            Some("MI002"),
        ),
        checked(
            "numbers that are none",
            shape("sphere", "<float name=\"radius\" value=\"x\"/>").repeat(20_000),
            Some("MI002"),
        ),
    ]
}

/// Meshes that say more than they hold.
fn meshes() -> Vec<Repro> {
    let forged = |name, vertices: u64, triangles: u64, expected| Repro {
        name,
        files: vec![
            (
                "a.xml".to_owned(),
                scene(&shape("serialized", &file("a.serialized"))),
            ),
            (
                "a.serialized".to_owned(),
                serialized(vertices, triangles, 0),
            ),
        ],
        arguments: check(),
        expected: Some(expected),
    };
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n\
        property float y\nproperty float z\nproperty float color_0\nproperty float color_1\n\
        property float color_2\nend_header\n";
    let attribute = "<bsdf type=\"diffuse\"><texture type=\"mesh_attribute\" name=\"reflectance\">\
        <string name=\"name\" value=\"vertex_color\"/></texture></bsdf>";
    let colored = shape("ply", &format!("{}{attribute}", file("a.ply")));
    vec![
        forged("a mesh of 2⁶⁰ vertices", 1 << 60, 1, "IO003"),
        forged("a mesh of 2⁶⁰ triangles", 3, 1 << 60, "IO003"),
        Repro {
            name: "a mesh that unpacks to 1 GB",
            files: vec![
                (
                    "a.xml".to_owned(),
                    scene(&shape("serialized", &file("a.serialized"))),
                ),
                (
                    "a.serialized".to_owned(),
                    serialized(40_000_000, 40_000_000, 1 << 30),
                ),
            ],
            arguments: check(),
            expected: Some("IO003"),
        },
        Repro {
            name: "a mesh whose name unpacks to 200 MB",
            files: vec![
                (
                    "a.xml".to_owned(),
                    scene(&shape("serialized", &file("a.serialized"))),
                ),
                ("a.serialized".to_owned(), named(200 << 20)),
            ],
            arguments: check(),
            expected: Some("RE006"),
        },
        Repro {
            name: "5 000 meshes of a file of 1 MB",
            files: vec![
                (
                    "a.xml".to_owned(),
                    scene(&numbered(5_000, |n| {
                        let index = format!("<integer name=\"shape_index\" value=\"{n}\"/>");
                        shape("serialized", &(file("a.serialized") + &index))
                    })),
                ),
                ("a.serialized".to_owned(), vec![0x1c; 1 << 20]),
            ],
            arguments: check(),
            expected: Some("RE006"),
        },
        Repro {
            name: "a coloured mesh of 4 000 000 000 vertices",
            files: vec![
                ("a.xml".to_owned(), scene(&colored)),
                ("a.ply".to_owned(), ply.into()),
            ],
            arguments: check(),
            expected: Some("RE006"),
        },
    ]
}

/// A `.serialized` file of version 4 with these counts, and so many bytes of zeros after them.
fn serialized(vertices: u64, triangles: u64, zeros: usize) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    // Single precision; no name.
    encoder.write_all(&0x1000_u32.to_le_bytes()).unwrap();
    encoder.write_all(&[0]).unwrap();
    encoder.write_all(&vertices.to_le_bytes()).unwrap();
    encoder.write_all(&triangles.to_le_bytes()).unwrap();
    let block = vec![0; 1 << 20];
    for _ in 0..zeros / block.len() {
        encoder.write_all(&block).unwrap();
    }
    let mut bytes = [0x041c_u16.to_le_bytes(), 4_u16.to_le_bytes()].concat();
    bytes.extend(encoder.finish().unwrap());
    bytes.extend(0_u64.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes
}

/// A `.serialized` file whose mesh has a name of so many bytes.
fn named(length: usize) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&0x1000_u32.to_le_bytes()).unwrap();
    let block = vec![b'a'; 1 << 20];
    for _ in 0..length / block.len() {
        encoder.write_all(&block).unwrap();
    }
    let mut bytes = [0x041c_u16.to_le_bytes(), 4_u16.to_le_bytes()].concat();
    bytes.extend(encoder.finish().unwrap());
    bytes.extend(0_u64.to_le_bytes());
    bytes.extend(1_u32.to_le_bytes());
    bytes
}

fn shape(plugin: &str, body: &str) -> String {
    format!("<shape type=\"{plugin}\">{body}</shape>")
}

fn bsdf(body: &str) -> String {
    shape("sphere", &format!("<bsdf type=\"diffuse\">{body}</bsdf>"))
}

fn file(name: &str) -> String {
    format!("<string name=\"filename\" value=\"{name}\"/>")
}

fn scene(body: &str) -> Vec<u8> {
    format!("<scene version=\"3.0.0\">{SENSOR}{body}</scene>").into_bytes()
}

fn check() -> Vec<String> {
    ["check", "-q", "a.xml"].map(str::to_owned).to_vec()
}

/// Checks a scene.
fn checked(name: &'static str, body: String, expected: Option<&'static str>) -> Repro {
    Repro {
        name,
        files: vec![("a.xml".to_owned(), scene(&body))],
        arguments: check(),
        expected,
    }
}

/// Checks a scene whose sensor is bad.
fn bare(name: &'static str, body: String, expected: Option<&'static str>) -> Repro {
    let text = format!("<scene version=\"3.0.0\">{body}<emitter type=\"constant\"/></scene>");
    Repro {
        name,
        files: vec![("a.xml".to_owned(), text.into_bytes())],
        arguments: check(),
        expected,
    }
}

fn repeated(name: &'static str, text: &str, times: usize, expected: Option<&'static str>) -> Repro {
    checked(name, text.repeat(times), expected)
}

fn numbered(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).map(line).collect()
}
