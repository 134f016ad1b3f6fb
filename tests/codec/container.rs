//! No change of a container goes unnoticed: flipped bits, missing ends, parts that do not fit.

use super::*;

#[test]
fn every_flipped_bit_of_a_container_is_found() {
    for scene in [small(), large()] {
        flip_every_bit(&codec::encode(Encoding::Binary, &scene).unwrap());
    }
}

/// Stored hierarchies come back as they were; `encode` leaves them out.
#[test]
fn stored_hierarchies_are_read_as_they_were_written() {
    let tree = StoredTree {
        version: 1,
        surfaces: vec![[0, 3]].into(),
        items: vec![2, 0, 1].into(),
        links: vec![[7; StoredTree::WIDTH]].into(),
    };
    let scene = Scene {
        trees: vec![tree],
        ..small()
    };
    let mut file = Vec::new();
    let encoded = codec::prepare_with_trees(&scene).unwrap();
    encoded.write(&mut file).unwrap();
    flip_every_bit(&file);
    assert!(decode(Encoding::Binary, &file).unwrap() == scene);
    let plain = codec::encode(Encoding::Binary, &scene).unwrap();
    assert_eq!(plain, codec::encode(Encoding::Binary, &small()).unwrap());
    assert_eq!(codec::hash(&scene), codec::hash(&small()));
}

fn flip_every_bit(file: &[u8]) {
    for bit in 0..8 * file.len() {
        let mut bytes = file.to_vec();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(
            codec::detect_format(&bytes),
            Some(Encoding::Binary),
            "bit {bit}"
        );
        let (id, _, _) = fault(Encoding::Binary, &bytes);
        let expected = match bit / 8 {
            0..8 => &["IR004"][..],
            12..16 => &["IR005", "IR006"],
            _ => &["IR006"],
        };
        assert!(expected.contains(&id), "bit {bit}: {id}");
    }
}

#[test]
fn every_truncation_of_a_container_is_found() {
    let file = codec::encode(Encoding::Binary, &large()).unwrap();
    for length in 1..file.len() {
        assert_eq!(
            codec::detect_format(&file[..length]),
            Some(Encoding::Binary),
            "length {length}"
        );
        assert_eq!(
            fault(Encoding::Binary, &file[..length]).0,
            "IR005",
            "length {length}"
        );
    }
    let longer = [file.as_slice(), &[0]].concat();
    assert_eq!(fault(Encoding::Binary, &longer).0, "IR007");
}

#[test]
fn a_container_copied_as_text_is_recognised_and_says_so() {
    let file = codec::encode(Encoding::Binary, &small()).unwrap();
    let lines: Vec<u8> = file.iter().copied().filter(|byte| *byte != b'\r').collect();
    let seven_bits: Vec<u8> = file.iter().map(|byte| byte & 0x7f).collect();
    let latin1: String = file.iter().copied().map(char::from).collect();
    let lossy = String::from_utf8_lossy(&file).into_owned();
    let spoilt = [
        (lines, "line ends"),
        (seven_bits, "eighth bit"),
        (latin1.into(), "UTF-8"),
        (lossy.into(), "UTF-8"),
    ];
    for (bytes, word) in spoilt {
        assert_eq!(
            codec::detect_format(&bytes),
            Some(Encoding::Binary),
            "{word}"
        );
        let (finding, _) = *decode(Encoding::Binary, &bytes).unwrap_err();
        assert!(
            finding.code.id == "IR004" && finding.hints[0].text.contains(word),
            "{finding:?}"
        );
    }
}

#[test]
fn parts_that_do_not_fit_together_are_refused() {
    let file = codec::encode(Encoding::Binary, &small()).unwrap();
    assert!(decode(Encoding::Binary, &with_header(&file, |header| header)).is_ok());
    let cases = [
        (r#""order":0"#, r#""order":99"#, "IR007"),
        (r#""order":0"#, r#""order":1"#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"lights""#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"camera""#, "IR007"),
        (r#""key":"surfaces""#, r#""key":"things""#, "IR003"),
        (r#""offset":64"#, r#""offset":0"#, "IR007"),
        (r#""stride":6"#, r#""stride":5"#, "IR007"),
        (r#""stride":6"#, r#""stride":18446744073709551615"#, "IR007"),
        (r#""length":4"#, r#""length":18446744073709551612"#, "IR005"),
        (r#""radius":null"#, r#""radius":[null,null]"#, "IR007"),
        (r#""radius":null"#, r#""radios":null"#, "IR003"),
        (r#""shadows":true"#, r#""shadows":"yes""#, "IR003"),
        (r#"{"irVersion":5"#, r#"{"irVersion":6"#, "IR001"),
        (r#"{"irVersion":5"#, r#"{"irVersion":-2"#, "IR007"),
    ];
    for (old, new, expected) in cases {
        let bad = with_header(&file, |header| {
            assert!(header.contains(old), "{old} is not in {header}");
            header.replacen(old, new, 1)
        });
        assert_eq!(fault(Encoding::Binary, &bad).0, expected, "{new}");
    }
}

/// A short file can't ask for much memory: here each of 2 000 records would repeat 30 KB of text.
#[test]
fn a_table_that_would_grow_beyond_its_file_is_refused() {
    let mut scene = small();
    scene.surfaces = vec![scene.surfaces[0].clone(); 2_000];
    let file = codec::encode(Encoding::Binary, &scene).unwrap();
    let (old, long) = ("\"radius\":null", "x".repeat(30_000));
    let bomb = with_header(&file, |header| {
        header.replacen(old, &format!("\"name\":\"{long}\",{old}"), 1)
    });
    let (finding, _) = decode(Encoding::Binary, &bomb)
        .map_err(|fault| *fault)
        .unwrap_err();
    assert!(
        finding.code.id == "IR007" && finding.message.contains("repeats more text"),
        "{finding:?}"
    );
}
