//! The writer of Radiance HDR files: linear values as three mantissas of 8 bits and a shared
//! exponent, run-length encoded (Ward, "Real Pixels", Graphics Gems II, 1991). A value is wrong by
//! at most 1/256 of the largest channel of its pixel; there is nothing below 0, and no opacity.

use super::hdr::Rgbe;
use super::header::{PictureHeader, StripSource};
use super::range::narrow;
use std::io::{self, Write};

/// The shortest run that is written as one.
const RUN: usize = 4;

/// Writes a picture, row after row, as its strips come.
pub(super) fn write(
    head: &PictureHeader,
    mut out: impl Write,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    let [width, height] = head.size;
    let software = &head.metadata.software;
    let mut bytes = b"#?RADIANCE\n".to_vec();
    if !software.is_empty() {
        writeln!(bytes, "SOFTWARE={software}")?;
    }
    write!(bytes, "FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n")?;
    let mut left = height;
    while left > 0 {
        let strip = strips.next_strip()?;
        left = left.saturating_sub(strip.image.height);
        for pixels in strip.image.pixels.chunks_exact(width as usize) {
            row(pixels, &mut bytes);
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    Ok(())
}

/// Appends a row: its four channels one after the other in runs, where its width can be told.
fn row(pixels: &[[f64; 3]], bytes: &mut Vec<u8>) {
    let pixels = pixels.iter().map(|pixel| shared(*pixel));
    let width = u16::try_from(pixels.len())
        .ok()
        .filter(|width| (8..0x8000).contains(width));
    let Some(width) = width else {
        return bytes.extend(pixels.flatten());
    };
    let pixels: Vec<Rgbe> = pixels.collect();
    bytes.extend([2, 2]);
    bytes.extend(width.to_be_bytes());
    for channel in 0..4 {
        runs(
            &pixels
                .iter()
                .map(|pixel| pixel[channel])
                .collect::<Vec<_>>(),
            bytes,
        );
    }
}

/// Appends bytes as runs of equal bytes, 128 more than their length before each, and as others,
/// their number before them.
fn runs(mut rest: &[u8], bytes: &mut Vec<u8>) {
    while let Some(first) = rest.first() {
        let most = rest.len().min(128);
        let equal = rest
            .iter()
            .take(127)
            .take_while(|byte| *byte == first)
            .count();
        let is_run = |at: &usize| {
            let next = rest.get(*at..at + RUN);
            next.is_some_and(|next| next.iter().all(|byte| *byte == next[0]))
        };
        if equal >= RUN {
            bytes.extend([128 + to_u8(equal), *first]);
            rest = &rest[equal..];
        } else {
            let (others, next) = rest.split_at((1..most).find(is_run).unwrap_or(most));
            bytes.push(to_u8(others.len()));
            bytes.extend(others);
            rest = next;
        }
    }
}

/// The pixel nearest to a colour. Values are rounded to the 256th part of the power of two above
/// the largest of them.
fn shared(pixel: [f64; 3]) -> Rgbe {
    const LARGEST: f64 = 255.0;
    let pixel = pixel.map(|value| f64::from(narrow(value, false)).max(0.0));
    let largest = pixel.into_iter().fold(0.0, f64::max);
    // The largest is m·2^exponent, 1/2 ≤ m < 1.
    let bits = i64::from_ne_bytes(largest.to_bits().to_ne_bytes());
    let mut exponent = (bits >> 52) - 1022;
    let rounded = |value: f64, exponent: i64| {
        let scale = f64::from_bits(((1023 + 8 - exponent).unsigned_abs()) << 52);
        (value * scale + 0.5).floor()
    };
    if exponent >= -128 && rounded(largest, exponent) > LARGEST {
        exponent += 1;
    }
    if exponent < -127 {
        return [0; 4];
    }
    let exponent = exponent.min(127);
    let [r, g, b] = pixel.map(|value| to_u8(rounded(value, exponent).min(LARGEST) as usize));
    [r, g, b, to_u8((exponent + 128).unsigned_abs() as usize)]
}

/// A number below 256.
fn to_u8(number: usize) -> u8 {
    u8::try_from(number).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, Picture, RadianceFile};

    /// The file of one row, read again.
    fn read(row: Vec<[f64; 3]>) -> (usize, Vec<f64>) {
        let width = u32::try_from(row.len()).unwrap();
        let image = Image {
            width,
            height: 1,
            pixels: row,
        };
        let file = Picture::opaque(image).encode(FileFormat::Hdr).unwrap();
        let read = RadianceFile::open(&file, 1 << 20)
            .unwrap()
            .decode()
            .unwrap();
        let values = read.bytes.as_chunks::<4>().0.iter();
        let values = values.map(|bytes| f64::from(f32::from_le_bytes(*bytes)));
        (file.len(), values.collect())
    }

    #[test]
    fn values_come_back_within_half_of_the_last_place_of_the_largest() {
        for width in [1, 7, 8, 300, 40_000] {
            let value = |index: u32| f64::from(index * 37 % 101) / f64::from(1 << (index % 20));
            let row: Vec<_> = (0..width)
                .map(|at| [value(at), value(at + 1), 0.25])
                .collect();
            let (_, values) = read(row.clone());
            for (pixel, read) in row.iter().zip(values.as_chunks::<3>().0) {
                let largest = pixel.iter().copied().fold(0.0, f64::max);
                for (value, read) in pixel.iter().zip(read) {
                    assert!(
                        (value - read).abs() <= largest / 255.0,
                        "{pixel:?} {read:?}"
                    );
                }
            }
        }
        let extremes = vec![[-1.0, f64::NAN, 0.0], [1e60, 0.0, 1e-60], [0.999, 0.0, 0.0]];
        let (_, values) = read(extremes);
        assert_eq!(values[..3], [0.0; 3]);
        assert!(values[3] > 1.6e38 && values[4..6] == [0.0; 2]);
        assert_eq!(values[6], 1.0);
    }

    #[test]
    fn equal_pixels_take_runs() {
        let (length, values) = read(vec![[0.5, 2.0, 8.0]; 1000]);
        assert!(
            length < 140 && values == [0.5, 2.0, 8.0].repeat(1000),
            "{length}"
        );
    }
}
