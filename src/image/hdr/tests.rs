//! The reader of Radiance HDR beside that of the crate `image`.

use super::*;
use ::image::ImageDecoder;
use ::image::codecs::hdr::HdrDecoder;
use std::io::Cursor;

/// The bytes of the pixels by the witness; `None` if it refuses the file.
fn witness(file: &[u8]) -> Option<Vec<u8>> {
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(file)).ok()?;
    let mut bytes = vec![0; usize::try_from(decoder.total_bytes()).ok()?];
    decoder.read_image(&mut bytes).ok()?;
    Some(bytes)
}

fn decode(file: &[u8]) -> Result<Vec<u8>, DecodeError> {
    let hdr = Hdr::open(file, 1 << 16)?;
    let mut bytes = hdr.size.buffer(12)?;
    hdr.decode(&mut bytes)?;
    Ok(bytes)
}

fn file(header: &str, size: [u32; 2], body: &[u8]) -> Vec<u8> {
    let [width, height] = size;
    let head = format!("#?RADIANCE\n{header}\n-Y {height} +X {width}\n");
    [head.as_bytes(), body].concat()
}

/// A row of 300 pixels in which each channel is a run, a stretch, and a run.
fn new_runs() -> Vec<u8> {
    let mut row = vec![2, 2, 1, 44];
    for channel in 0..4_u8 {
        row.extend([128 + 127, 10 + channel, 0, 73]);
        row.extend((0..73).map(|at| at * 3 + channel));
        row.extend([128 + 100, 120 + channel]);
    }
    row
}

/// The same length: a pixel, one repeated 258 times in two counts, flat ones, and a short run.
fn old_runs() -> Vec<u8> {
    let mut row = vec![9, 8, 7, 130, 1, 1, 1, 2, 1, 1, 1, 1];
    (0..36).for_each(|at: u8| row.extend([at, 200 - at, 1, 100 + at]));
    row.extend([1, 1, 1, 5]);
    row
}

#[test]
fn the_witness_reads_the_same_bits() {
    let flat: Vec<u8> = (0..=255)
        .flat_map(|exponent| [[1, 128, 255, exponent], [3, 0, 7, exponent]].concat())
        .collect();
    let headers = [
        "FORMAT=32-bit_rle_rgbe\n",
        "# made\n FORMAT =  32-bit_rle_rgbe \nEXPOSURE=2\nVIEW= -vp 1 2 3\n",
        "FORMAT=\n=\nrpict\n",
        "",
    ];
    for header in headers {
        let files = [
            file(header, [512, 1], &flat),
            file(header, [32, 16], &flat),
            file(header, [300, 1], &new_runs()),
            file(header, [300, 1], &old_runs()),
            file(header, [300, 2], &[new_runs(), old_runs()].concat()),
        ];
        for file in files {
            let bytes = decode(&file).unwrap();
            assert_eq!(bytes, witness(&file).unwrap());
            assert!(bytes.iter().any(|byte| *byte != 0));
        }
    }
}

#[test]
fn the_witness_refuses_the_same_files() {
    let header = "FORMAT=32-bit_rle_rgbe\n";
    let whole = file(header, [300, 2], &[new_runs(), old_runs()].concat());
    // The lengths of the last row follow the header; every byte is changed in turn.
    for at in 0..whole.len() {
        assert_eq!(
            decode(&whole[..at]).ok(),
            witness(&whole[..at]),
            "cut at {at}"
        );
        for byte in [0, 1, 2, b'=', b'\n', 128, 255, whole[at] ^ 1] {
            let mut file = whole.clone();
            file[at] = byte;
            let is_larger = matches!(decode(&file), Err(DecodeError::TooLarge { .. }));
            assert!(
                is_larger || decode(&file).ok() == witness(&file),
                "{byte} at {at}"
            );
        }
    }
}

#[test]
fn what_is_wrong_is_said() {
    let rgbe = "FORMAT=32-bit_rle_rgbe\n";
    let mut endless = vec![1, 2, 3, 4];
    (0..20).for_each(|_| endless.extend([1, 1, 1, 0]));
    let cases = [
        (
            file("FORMAT=32-bit_rle_xyze\n", [1, 1], b"0000"),
            "its pixels are `32-bit_rle_xyze`",
        ),
        (
            b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n".to_vec(),
            "it ends in its header",
        ),
        (
            b"#?RADIANCE\n\n+X 1 -Y 1\n0000".to_vec(),
            "its size is not `-Y 2 +X 3`",
        ),
        (
            b"#?RADIANCE\n\n-Y 1 +X\n0000".to_vec(),
            "its size is not `-Y 2 +X 3`",
        ),
        (file(rgbe, [0, 1], b""), "it has no pixels"),
        (file(rgbe, [1, 1], b"000"), "it ends before its last pixel"),
        (
            file(rgbe, [9, 1], &[1, 1, 1, 9]),
            "a row begins with a run of length zero",
        ),
        (
            file(rgbe, [9, 1], &[5, 5, 5, 5, 1, 1, 1, 9]),
            "a run is longer",
        ),
        (file(rgbe, [9, 1], &[2, 2, 0, 9, 138, 1]), "a run is longer"),
        (
            file(rgbe, [9, 1], &endless),
            "it ends before its last pixel",
        ),
        (file(rgbe, [u32::MAX, u32::MAX], b""), "has 4294967295"),
    ];
    for (file, words) in cases {
        let fault = decode(&file).unwrap_err().to_string();
        assert!(fault.contains(words), "{fault}");
    }
}
