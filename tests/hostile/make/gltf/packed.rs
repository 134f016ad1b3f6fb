//! Images and compressed data that are used many times over, or stand for far more than they hold.

use super::super::Repro;
use super::{check, list, many, primitive, scene, zeros};
use image::{ExtendedColorType, ImageEncoder, codecs::png};

/// All of them.
pub(super) fn all() -> Vec<Repro> {
    vec![
        meshopt("300 views of the same meshopt data", None, |_| 0),
        meshopt(
            "300 views of meshopt data that differ in their lengths",
            Some("IO003"),
            |view| view,
        ),
        draco(),
        images(),
        image_ranges(),
        image_names(),
        data_uris(),
        clones_of_bounds(),
    ]
}

/// A view for each of 300 stretches of meshopt data, of 32 MB each.
fn meshopt(
    name: &'static str,
    expected: Option<&'static str>,
    less: impl Fn(usize) -> usize,
) -> Repro {
    const COUNT: usize = 2_000_000;
    const STRIDE: usize = 16;
    // Version 1: a control byte for each four bytes of a block of 256 elements says that nothing
    // changes.
    let data = [
        &[0xa1][..],
        &vec![0b1010_1010; COUNT.div_ceil(256) * STRIDE / 4],
        &[0; 24],
    ]
    .concat();
    let view = |view: usize| {
        // So many blocks less, each of 256 elements and of a control byte for each four bytes of an
        // element.
        let (count, length) = (
            COUNT - 256 * less(view),
            data.len() - STRIDE / 4 * less(view),
        );
        let size = count * STRIDE;
        let own = format!(
            r#""byteLength":{length},"byteStride":{STRIDE},"count":{count},"mode":"ATTRIBUTES""#
        );
        let own = format!(r#"{{"EXT_meshopt_compression":{{"buffer":0,{own}}}}}"#);
        format!(r#"{{"buffer":1,"byteLength":{size},"byteStride":{STRIDE},"extensions":{own}}}"#)
    };
    let fallback = r#"{"EXT_meshopt_compression":{"fallback":true}}"#;
    let parts = [
        r#""extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"]"#.to_owned(),
        format!(
            r#""buffers":[{{"byteLength":{}}},{{"byteLength":{},"extensions":{fallback}}}]"#,
            data.len(),
            COUNT * STRIDE
        ),
        many("bufferViews", 300, view),
    ];
    check(name, expected, &parts.join(","), &data)
}

/// A mesh of 10 000 points and triangles as Draco has it, in the plain form that it has too.
fn draco() -> Repro {
    const POINTS: u16 = 10_000;
    let varint = [0x90, 0x4e];
    let mut data = [&b"DRACO\x02\x02\x01\x00\0\0"[..], &varint, &varint, &[1]].concat();
    let corners = (0..POINTS).flat_map(|point| [point, (point + 1) % POINTS, (point + 2) % POINTS]);
    data.extend(corners.flat_map(u16::to_le_bytes));
    // One decoder of one attribute: positions of three 32-bit floats, with the number 0, stored
    // plainly.
    data.extend([1, 1, 0, 9, 3, 0, 0, 0]);
    data.resize(data.len() + usize::from(POINTS) * 12, 0);
    let own = r#"{"attributes":{"POSITION":0},"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}"#;
    let used = r#"["KHR_draco_mesh_compression"]"#;
    let indices = format!(
        r#"{{"componentType":5125,"type":"SCALAR","count":{}}}"#,
        3 * u32::from(POINTS)
    );
    let parts = [
        format!(r#""extensionsUsed":{used},"extensionsRequired":{used}"#),
        format!(r#""buffers":[{{"byteLength":{}}}]"#, data.len()),
        format!(
            r#""bufferViews":[{{"buffer":0,"byteLength":{}}}]"#,
            data.len()
        ),
        format!(
            r#""accessors":[{},{indices}]"#,
            zeros(POINTS.into(), "VEC3")
        ),
        format!(
            r#""meshes":[{{"primitives":[{}]}}]"#,
            list(6_000, |_| own.to_owned())
        ),
        r#""nodes":[{"mesh":0}]"#.to_owned(),
        scene(1),
    ];
    check(
        "a Draco primitive repeated 6 000 ×",
        None,
        &parts.join(","),
        &data,
    )
}

/// A grey PNG of 4096 × 4096 pixels.
fn picture() -> Vec<u8> {
    const SIDE: u32 = 4096;
    let mut bytes = Vec::new();
    let encoder = png::PngEncoder::new_with_quality(
        &mut bytes,
        png::CompressionType::Best,
        png::FilterType::NoFilter,
    );
    encoder
        .write_image(
            &vec![0; (SIDE * SIDE) as usize],
            SIDE,
            SIDE,
            ExtendedColorType::L8,
        )
        .unwrap();
    bytes
}

fn images() -> Repro {
    let picture = picture();
    let parts = [
        format!(r#""buffers":[{{"byteLength":{}}}]"#, picture.len()),
        format!(
            r#""bufferViews":[{{"buffer":0,"byteLength":{}}}]"#,
            picture.len()
        ),
        many("images", 30_000, |_| {
            r#"{"bufferView":0,"mimeType":"image/png"}"#.to_owned()
        }),
    ];
    check(
        "30 000 images on one view of a 4k PNG",
        None,
        &parts.join(","),
        &picture,
    )
}

/// The same with something behind the picture that is not the same in any two.
fn image_ranges() -> Repro {
    const COUNT: usize = 1_000;
    let mut picture = picture();
    let length = picture.len();
    picture.resize(length + COUNT, 0);
    let view = |extra| format!(r#"{{"buffer":0,"byteLength":{}}}"#, length + extra);
    let parts = [
        format!(r#""buffers":[{{"byteLength":{}}}]"#, picture.len()),
        many("bufferViews", COUNT, view),
        many("images", COUNT, |view| {
            format!(r#"{{"bufferView":{view},"mimeType":"image/png"}}"#)
        }),
    ];
    check(
        "1 000 images on views of a 4k PNG that differ",
        Some("IO003"),
        &parts.join(","),
        &picture,
    )
}

/// One file under many names, all shown.
fn image_names() -> Repro {
    let uri = |image: usize| {
        format!(
            r#"{{"uri":"{}{}"}}"#,
            "./".repeat(image % 20),
            if image < 20 { "t.png" } else { "%74.png" }
        )
    };
    let material = |texture| {
        format!(r#"{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{texture}}}}}}}"#)
    };
    let primitive = |material| {
        format!(r#"{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"material":{material}}}"#)
    };
    let parts = [
        r#""asset":{"version":"2.0"}"#.to_owned(),
        format!(r#""accessors":[{},{}]"#, zeros(3, "VEC3"), zeros(3, "VEC2")),
        many("images", 40, uri),
        many("textures", 40, |image| format!(r#"{{"source":{image}}}"#)),
        many("materials", 40, material),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, list(40, primitive)),
        r#""nodes":[{"mesh":0}]"#.to_owned(),
        scene(1),
    ];
    let json = format!("{{{}}}", parts.join(","));
    let files = vec![
        ("a.gltf".to_owned(), json.into_bytes()),
        ("t.png".to_owned(), picture()),
    ];
    let arguments = ["check", "a.gltf"].map(str::to_owned).to_vec();
    Repro {
        name: "one 4k PNG under 40 names",
        files,
        arguments,
        expected: None,
    }
}

/// The same bytes written many times in the text.
fn data_uris() -> Repro {
    let mut picture = Vec::new();
    let encoder = png::PngEncoder::new_with_quality(
        &mut picture,
        png::CompressionType::Best,
        png::FilterType::NoFilter,
    );
    encoder
        .write_image(&vec![0; 512 * 512], 512, 512, ExtendedColorType::L8)
        .unwrap();
    let uri = format!(
        r#"{{"uri":"data:image/png;base64,{}"}}"#,
        base64::Engine::encode(&base64::prelude::BASE64_STANDARD, picture)
    );
    let parts = many("images", 1_500, |_| uri.clone());
    check("1 500 images of the same data URI", None, &parts, &[])
}

/// Matrices with wrong bounds, many times over.
fn clones_of_bounds() -> Repro {
    const COUNT: usize = 16_000;
    let bound = |value: u8| list(16, |_| value.to_string());
    let accessor = format!(
        r#"{{"bufferView":0,"componentType":5126,"type":"MAT4","count":{COUNT},"min":[{}],"max":[{}]}}"#,
        bound(9),
        bound(8)
    );
    let bytes = vec![0; 64 * COUNT];
    let parts = [
        format!(r#""buffers":[{{"byteLength":{}}}]"#, bytes.len()),
        format!(
            r#""bufferViews":[{{"buffer":0,"byteLength":{}}}]"#,
            bytes.len()
        ),
        many("accessors", 60, |_| accessor.clone()),
        format!(r#""meshes":[{{"primitives":[{}]}}]"#, primitive(0)),
    ];
    check(
        "60 accessors of 16 000 matrices with wrong bounds",
        Some("GL029"),
        &parts.join(","),
        &bytes,
    )
}
