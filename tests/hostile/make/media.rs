//! Images, meshes and scenes that are small and ask for much.

use super::{Repro, webp};
use exr::prelude::{
    Compression, Encoding, Image, Layer, LayerAttributes, SpecificChannels, WritableImage, f16,
};
use image::{ExtendedColorType, ImageEncoder};
use png::{BitDepth, ColorType};
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    let mut all = vec![
        checked(
            "an 8k PNG by twelve names",
            twelve_textures(),
            vec![("t.png", white_png(8192))],
            None,
        ),
        checked(
            "an OBJ of 50 000 faces by twelve names",
            twelve_meshes(),
            vec![("t.obj", obj(50_000))],
            None,
        ),
        checked(
            "an OBJ of a million faces",
            meshes(&["t.obj"]),
            vec![("t.obj", obj(1_000_000))],
            None,
        ),
        checked(
            "an OFF of a million faces",
            meshes(&["t.off"]),
            vec![("t.off", off(1_000_000))],
            None,
        ),
    ];
    all.extend(pictures());
    for (what, name, bytes, expected) in [
        (
            "an HDR of 2²⁵ pixels in a row",
            "t.hdr",
            hdr(1 << 25),
            "IO003",
        ),
        (
            "an EXR of 8192 × 4096",
            "t.exr",
            exr(8192, 4096, Encoding::SMALL_LOSSLESS),
            "IO003",
        ),
        (
            "an EXR whose differences go below zero",
            "t.exr",
            below_zero(),
            "RE004",
        ),
    ] {
        let scene = format!("{CAMERA}Environment: {{file: {name}}}\nObjects: []\n");
        all.push(checked(what, scene, vec![(name, bytes)], Some(expected)));
    }
    all.extend(endless());
    all
}

/// Pictures whose headers tell of more than there is, or of too much.
fn pictures() -> Vec<Repro> {
    let mut all = Vec::new();
    let coded = [
        ("a JPEG of 16384² pixels", huge_jpeg(), "IO003"),
        ("a JPEG cut in the middle", cut_jpeg(), "RE004"),
        ("a PNG of 16384² pixels of a bit", white_png(16384), "IO003"),
        (
            "a PNG that claims a side of 2³¹ − 1",
            claim_png((1 << 31) - 1),
            "RE005",
        ),
    ];
    let ktx2 = [
        (
            "a KTX2 that claims 16384² pixels",
            claim_ktx2(16384),
            "IO003",
        ),
        (
            "a KTX2 that claims a side of 2³¹ − 1",
            claim_ktx2((1 << 31) - 1),
            "RE005",
        ),
    ];
    let coded = coded.into_iter().chain(ktx2);
    for (what, bytes, expected) in coded.chain(webp::all()) {
        all.push(checked(
            what,
            textures(&["t.png"]),
            vec![("t.png", bytes)],
            Some(expected),
        ));
    }
    all.push(checked(
        "a PNG with a profile of 475 MB",
        textures(&["t.png"]),
        vec![("t.png", profile_bomb())],
        None,
    ));
    all
}

/// Scenes whose rays have no end, and what is harmless however much it might take.
fn endless() -> Vec<Repro> {
    let rays = ["--limit", "rays=100000"];
    // Rays go round for ever in a room of mirrors, and branch at the ball in it.
    let ball = sphere("ks: 1, kt: 1, eta: 1.5");
    let glass = format!(
        "MaxRecursionDepth: 1000000\n{CAMERA}Objects:\n{ball}{}",
        room()
    );
    let lobes = format!(
        "MaxRecursionDepth: 8\n{CAMERA}Objects:\n{}- {{type: plane, position: [0, -1, 0], normal: [0, 1, 0], material: \
         {{color: [1, 1, 1], ka: 1, kd: 1, ks: 1, n: 4, glossySamples: 24}}}}\n",
        sphere("ks: 1, n: 4, glossySamples: 24")
    );
    let points = format!(
        "LightSamples: 4294967295\nShadows: true\n{CAMERA}Lights:\n- {{position: [5, 5, 5], color: [1, 1, 1], radius: \
         1}}\nObjects:\n{}",
        sphere("ks: 0")
    );
    vec![
        rendered("glass of a million bounces", &glass, &rays, Some("RD006")),
        rendered(
            "lobes of 24 directions at each of 8 bounces",
            &lobes,
            &rays,
            Some("RD006"),
        ),
        rendered("2³² − 1 points of a light", &points, &[], Some("VA010")),
        rendered(
            "lobes, by paths that do not branch",
            &lobes,
            &["--integrator", "path", "--spp", "1"],
            None,
        ),
        rendered(
            "a mirror of a million bounces",
            &glass.replace(&room(), "").replace("kt: 1", "kt: 0"),
            &[],
            None,
        ),
    ]
}

/// Six mirrors about the camera.
fn room() -> String {
    (0..3).flat_map(|axis| [-1, 1].map(|side| (axis, side))).fold(String::new(), |mut walls, (axis, side)| {
        let (mut position, mut normal) = ([0; 3], [0; 3]);
        (position[axis], normal[axis]) = (12 * side, -side);
        writeln!(
            walls,
            "- {{type: plane, position: {position:?}, normal: {normal:?}, material: {{color: [1, 1, 1], ka: 0, kd: 0, ks: \
             1, n: 1}}}}"
        )
        .unwrap();
        walls
    })
}

fn sphere(keys: &str) -> String {
    let material = ["color: [1, 1, 1], ka: 1, kd: 1", keys].join(", ");
    let exponent = if keys.contains("n: ") { "" } else { ", n: 1" };
    format!(
        "- {{type: sphere, position: [0, 0, 0], radius: 1, material: {{{material}{exponent}}}}}\n"
    )
}

fn rendered(
    name: &'static str,
    scene: &str,
    arguments: &[&str],
    expected: Option<&'static str>,
) -> Repro {
    let arguments = ["render", "scene.yaml", "-o", "out.png", "-q"]
        .iter()
        .chain(arguments);
    let files = vec![("scene.yaml".to_owned(), scene.as_bytes().to_vec())];
    Repro {
        name,
        files,
        arguments: arguments.map(|word| (*word).to_owned()).collect(),
        expected,
    }
}

fn checked(
    name: &'static str,
    scene: String,
    files: Vec<(&'static str, Vec<u8>)>,
    expected: Option<&'static str>,
) -> Repro {
    let mut files: Vec<_> = files
        .into_iter()
        .map(|(name, bytes)| (name.to_owned(), bytes))
        .collect();
    files.push(("scene.yaml".to_owned(), scene.into_bytes()));
    Repro {
        name,
        files,
        arguments: ["check", "scene.yaml"].map(str::to_owned).into(),
        expected,
    }
}

const CAMERA: &str =
    "Camera: {eye: [0, 0, 10], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, 8], fov: 40}\n";

/// A scene with a sphere for each of these textures.
fn textures(names: &[&str]) -> String {
    names.iter().fold(format!("{CAMERA}Objects:\n"), |mut scene, name| {
        writeln!(
            scene,
            "- {{type: sphere, position: [0, 0, 0], radius: 1, material: {{color: [1, 1, 1], texture: {name}, ka: 1, \
             kd: 1, ks: 0, n: 1}}}}"
        )
        .unwrap();
        scene
    })
}

/// A scene with each of these meshes.
fn meshes(names: &[&str]) -> String {
    names
        .iter()
        .fold(format!("{CAMERA}Objects:\n"), |scene, name| {
            scene + &format!("- {{type: mesh, file: {name}}}\n")
        })
}

/// Twelve ways to write a name.
fn twelve(name: &str) -> Vec<String> {
    (0..12).map(|dots| "./".repeat(dots) + name).collect()
}

fn twelve_textures() -> String {
    let names = twelve("t.png");
    textures(&names.iter().map(String::as_str).collect::<Vec<_>>())
}

fn twelve_meshes() -> String {
    let names = twelve("t.obj");
    meshes(&names.iter().map(String::as_str).collect::<Vec<_>>())
}

/// An OBJ of so many equal faces.
fn obj(faces: usize) -> Vec<u8> {
    ["v 0 0 0\nv 1 0 0\nv 0 1 0\n", &"f 1 2 3\n".repeat(faces)]
        .concat()
        .into_bytes()
}

/// The same as OFF.
fn off(faces: usize) -> Vec<u8> {
    [
        &format!("OFF\n3 {faces} 0\n0 0 0\n1 0 0\n0 1 0\n"),
        &*"3 0 1 2\n".repeat(faces),
    ]
    .concat()
    .into_bytes()
}

/// A white PNG of a bit a pixel.
fn white_png(side: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side, side);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().unwrap();
    let mut stream = writer.stream_writer().unwrap();
    let row = vec![0xff; side as usize / 8];
    (0..side).for_each(|_| stream.write_all(&row).unwrap());
    stream.finish().unwrap();
    drop(writer);
    bytes
}

/// A PNG chunk.
fn chunk(kind: &[u8; 4], contents: &[u8]) -> Vec<u8> {
    let named = [kind.as_slice(), contents].concat();
    let length = u32::try_from(contents.len()).unwrap().to_be_bytes();
    [
        length.as_slice(),
        &named,
        &crc32fast::hash(&named).to_be_bytes(),
    ]
    .concat()
}

/// The contents of the chunks of a kind, put together.
fn contents(png: &[u8], kind: &[u8; 4]) -> Vec<u8> {
    let (mut found, mut at) = (Vec::new(), 8);
    while let Some(head) = png.get(at..at + 8) {
        let length = u32::from_be_bytes(head[..4].try_into().unwrap()) as usize;
        if head[4..] == *kind {
            found.extend_from_slice(&png[at + 8..at + 8 + length]);
        }
        at += 12 + length;
    }
    found
}

/// A KTX2 of ETC1S that claims another size.
fn claim_ktx2(side: u32) -> Vec<u8> {
    let mut bytes = include_bytes!("../../../fuzz/corpus/image/etc1s.ktx2").to_vec();
    bytes[20..24].copy_from_slice(&side.to_le_bytes());
    bytes[24..28].copy_from_slice(&side.to_le_bytes());
    bytes
}

/// A PNG of one pixel that claims another size.
fn claim_png(side: u32) -> Vec<u8> {
    let small = white_png(8);
    let mut head = contents(&small, b"IHDR");
    head[..4].copy_from_slice(&side.to_be_bytes());
    head[4..8].copy_from_slice(&side.to_be_bytes());
    [&small[..8], &chunk(b"IHDR", &head), &small[33..]].concat()
}

/// A PNG with a colour profile of 475 MB of zeros, packed as the rows of a picture are.
fn profile_bomb() -> Vec<u8> {
    let mut zeros = Vec::new();
    let mut encoder = png::Encoder::new(&mut zeros, 1 << 20, 475);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().unwrap();
    let mut stream = writer.stream_writer().unwrap();
    let row = vec![0; 1 << 20];
    (0..475).for_each(|_| stream.write_all(&row).unwrap());
    stream.finish().unwrap();
    drop(writer);
    let profile = [b"p\0\0".as_slice(), &contents(&zeros, b"IDAT")].concat();
    let small = white_png(8);
    [&small[..33], &chunk(b"iCCP", &profile), &small[33..]].concat()
}

/// A grey JPEG of noise.
fn jpeg(side: u32) -> Vec<u8> {
    let pixels: Vec<u8> = (0..side * side)
        .map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    let mut bytes = Vec::new();
    image::codecs::jpeg::JpegEncoder::new(&mut bytes)
        .write_image(&pixels, side, side, ExtendedColorType::L8)
        .unwrap();
    bytes
}

/// A small JPEG whose header tells of 16384² pixels.
fn huge_jpeg() -> Vec<u8> {
    let mut bytes = jpeg(8);
    let frame = bytes
        .windows(2)
        .position(|marker| marker == [0xff, 0xc0])
        .unwrap();
    bytes[frame + 5..frame + 9].copy_from_slice(&[0x40, 0, 0x40, 0]);
    bytes
}

fn cut_jpeg() -> Vec<u8> {
    let whole = jpeg(128);
    whole[..whole.len() / 2].to_vec()
}

/// A Radiance picture of one row, whose pixels are hardly there.
fn hdr(width: u32) -> Vec<u8> {
    let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X {width}\n");
    [head.as_bytes(), &[1; 960]].concat()
}

/// A black EXR.
fn exr(width: usize, height: usize, encoding: Encoding) -> Vec<u8> {
    let black = SpecificChannels::rgb(|_| (f16::ZERO, f16::ZERO, f16::ZERO));
    let layer = Layer::new((width, height), LayerAttributes::default(), encoding, black);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .unwrap();
    bytes.into_inner()
}

/// One of 4 × 4 pixels in B44, with differences of −128 to numbers of 0: they wrap round.
fn below_zero() -> Vec<u8> {
    let encoding = Encoding {
        compression: Compression::B44,
        ..Encoding::SMALL_LOSSLESS
    };
    let mut bytes = exr(4, 4, encoding);
    // At the end there are 14 bytes for each channel: a number, a shift, the differences.
    let start = bytes.len() - 3 * 14;
    let block = [&[0, 0, 8], [0; 11].as_slice()].concat();
    bytes.splice(start.., block.repeat(3));
    bytes
}
