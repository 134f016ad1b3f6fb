//! Sections of a container: what is in them, and that none is believed that lies.

use super::{decode, fault, frozen, large, with_header};
use rtc::internals::codec::{self, Encoding};
use rtc::internals::ir::{Scene, VertexColumn};

/// In files of version 2 every long list and text is a section, whatever it belongs to.
#[test]
fn long_lists_and_texts_of_older_files_have_sections_of_their_own() {
    let file = std::fs::read(frozen("v2/scene.rtir")).unwrap();
    let cases = [
        (r#""nested":true"#, r#""nested":false"#),
        (r#""nested":false"#, r#""nested":true"#),
        (r#"{"section":12,"#, r#"{"section":13,"#),
        (r#"{"section":12,"#, r#"{"section":99,"#),
        (r#""runs":["#, r#""runs":[{"section":3,"nested":false},"#),
    ];
    for (old, new) in cases {
        let bad = with_header(&file, |header| {
            assert!(header.contains(old), "{old} is not in {header}");
            header.replacen(old, new, 1)
        });
        assert_eq!(fault(Encoding::Binary, &bad).0, "IR007", "{new}");
    }
}

#[test]
fn the_header_does_not_grow_with_what_is_in_sections() {
    let mut scene = large();
    let header = |file: &[u8]| u32::from_le_bytes(file[12..16].try_into().unwrap());
    let before = header(&codec::encode(Encoding::Binary, &scene).unwrap());
    scene.meshes[0].positions = vec![[0.5; 3]; 10_000].into();
    scene.images[0].pixels = vec![7; 30_000].into();
    let file = codec::encode(Encoding::Binary, &scene).unwrap();
    assert!(header(&file) < before + 100);
    assert_eq!(decode(Encoding::Binary, &file).unwrap(), scene);
}

/// The number behind the first of these words in the header of a container.
fn number_after(file: &[u8], words: &str) -> usize {
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let header = std::str::from_utf8(&file[20..20 + length]).unwrap();
    let rest = header
        .split_once(words)
        .unwrap_or_else(|| panic!("{words} is not in {header}"))
        .1;
    rest.split(|c: char| !c.is_ascii_digit())
        .next()
        .unwrap()
        .parse()
        .unwrap()
}

/// A scene whose mesh has columns of both precisions.
fn meshed() -> Scene {
    let mut scene = large();
    let mesh = &mut scene.meshes[0];
    mesh.normals = VertexColumn::rounded(mesh.positions.iter());
    mesh.colors = VertexColumn::rounded(mesh.positions.iter().map(|[x, y, z]| [x, y, z, 0.1]));
    scene
}

/// Rewrites the bytes of a section and its hash in the header.
fn with_section(file: &[u8], section: usize, edit: impl Fn(&mut [u8])) -> Vec<u8> {
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let header: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
    let entry = &header["sections"][section];
    let number = |key: &str| usize::try_from(entry[key].as_u64().unwrap()).unwrap();
    let start = (20 + length).next_multiple_of(64) + number("offset");
    let mut file = file.to_vec();
    let bytes = &mut file[start..start + number("length")];
    edit(bytes);
    let hash = format!("{:016x}", xxhash_rust::xxh3::xxh3_64(bytes));
    with_header(&file, |header| {
        header.replacen(entry["xxh3"].as_str().unwrap(), &hash, 1)
    })
}

#[test]
fn columns_of_meshes_are_sections_in_the_precision_of_the_scene() {
    let scene = meshed();
    let file = codec::encode(Encoding::Binary, &scene).unwrap();
    let back = decode(Encoding::Binary, &file).unwrap();
    assert_eq!(format!("{back:?}"), format!("{scene:?}"));
    assert!(
        matches!(&back.meshes[0].normals, VertexColumn::Single(_))
            && matches!(&back.meshes[0].positions, VertexColumn::Double(_))
    );
    let section = |key: &str| number_after(&file, &format!("\"{key}\":"));
    let [positions, normals, colors, triangles] =
        ["positions", "normals", "colors", "triangles"].map(section);
    let pixels = section("pixels");
    let cases = [
        ("normals", normals, triangles),
        ("normals", normals, colors),
        ("normals", normals, positions),
        ("normals", normals, 999),
        ("triangles", triangles, normals),
        ("positions", positions, pixels),
        ("pixels", pixels, triangles),
        ("pixels", pixels, 999),
    ];
    for (key, old, new) in cases {
        let (old, new) = (format!("\"{key}\":{old}"), format!("\"{key}\":{new}"));
        let bad = with_header(&file, |header| header.replacen(&old, &new, 1));
        assert_eq!(fault(Encoding::Binary, &bad).0, "IR007", "{new}");
    }
    for (section, at, number) in [
        (positions, 8, 0x7ff_u16),
        (normals, 4, 0x7f8),
        (colors, 12, 0xff8),
    ] {
        let number = (number << 4).to_le_bytes();
        let size = if section == positions { 8 } else { 4 };
        let bad = with_section(&file, section, |bytes| {
            bytes[at + size - 2..at + size].copy_from_slice(&number)
        });
        let (finding, place) = *decode(Encoding::Binary, &bad).unwrap_err();
        assert!(
            finding.code.id == "IR007" && finding.message.contains("is not finite"),
            "{finding:?}"
        );
        assert!(
            place.len() <= 4 * size,
            "the number is pointed at: {place:?}"
        );
    }
}

/// Sections that are elsewhere, longer, shorter or in other units than the file has room for.
#[test]
fn sections_that_lie_are_refused() {
    let file = codec::encode(Encoding::Binary, &meshed()).unwrap();
    let last =
        |key: &str, header: &str| header.rfind(&format!("\"{key}\":")).unwrap() + key.len() + 3;
    let cases = [
        ("offset", "64", "IR007"),
        ("offset", "18446744073709551615", "IR007"),
        ("length", "12", "IR006"),
        ("length", "13", "IR007"),
        ("length", "1200", "IR005"),
        ("length", "18446744073709551600", "IR005"),
        ("stride", "0", "IR007"),
        ("stride", "4611686018427387904", "IR007"),
        ("element", "\"f16\"", "IR007"),
    ];
    for (key, value, expected) in cases {
        let bad = with_header(&file, |mut header| {
            let start = last(key, &header);
            let end = start + header.split_at(start).1.find([',', '}']).unwrap();
            header.replace_range(start..end, value);
            header
        });
        assert_eq!(fault(Encoding::Binary, &bad).0, expected, "{key} {value}");
    }
}
