//! The memory for the prefix codes of a lossless picture. The codes are read up to the pixels, and
//! not kept. There may be 65536 groups of codes, and a group may take 500 times its bytes in the
//! file.
//!
//! The terms are those of the WebP Lossless Bitstream Specification.

use super::prefix::{BitReader, CODE, PrefixCode};
use super::{DecodeError, ImageSize};

/// The memory of the decoder for the prefix codes of a picture, in bytes. A plane of opacity has no
/// header.
pub(super) fn codes(stream: &[u8], size: ImageSize, has_header: bool) -> Result<u64, DecodeError> {
    let header = if has_header { 40 } else { 0 };
    picture(&mut BitReader::of(stream, header), size).ok_or_else(|| {
        let words = "it ends before its pixels, or has invalid prefix codes";
        DecodeError::Damaged(words.to_owned())
    })
}

fn picture(bits: &mut BitReader<'_>, size: ImageSize) -> Option<u64> {
    let width = transforms(bits, size)?;
    let alphabets = alphabets(bits)?;
    let groups = if bits.flag()? {
        sub_image(bits, [width, size.height])? + 1
    } else {
        1
    };
    // The decoder collects them in a list that doubles: while it grows, old and new list exist.
    let list = u64::from(groups.max(4).next_power_of_two()) * 5 * CODE * 3 / 2;
    (0..groups).try_fold(list, |sum, _| {
        let group = alphabets.iter().try_fold(0, |sum, alphabet| {
            Some(sum + PrefixCode::read(bits, *alphabet)?.memory())
        })?;
        Some(sum + group)
    })
}

/// Skips the transforms, and returns the width of the picture before they are undone.
fn transforms(bits: &mut BitReader<'_>, size: ImageSize) -> Option<u32> {
    let mut width = size.width;
    let mut is_known = [false; 4];
    while bits.flag()? {
        let kind = bits.read(2)?;
        if std::mem::replace(is_known.get_mut(kind as usize)?, true) {
            return None;
        }
        match kind {
            // The predictor and the colour transform.
            0 | 1 => drop(sub_image(bits, [width, size.height])?),
            // The subtract-green transform.
            2 => {}
            _ => {
                let colors = bits.read(8)? + 1;
                pixels(bits, colors)?;
                width = blocks(width, packing(colors));
            }
        }
    }
    Some(width)
}

/// The number of pixels packed into one for a number of colours, as a power of two.
fn packing(colors: u32) -> u32 {
    match colors {
        0..=2 => 3,
        3..=4 => 2,
        5..=16 => 1,
        _ => 0,
    }
}

/// The number of blocks of 2^`bits` pixels along a side.
fn blocks(side: u32, bits: u32) -> u32 {
    side.div_ceil(1 << bits)
}

/// Skips an image with one pixel for each block of another image; otherwise as [`pixels`].
fn sub_image(bits: &mut BitReader<'_>, of: [u32; 2]) -> Option<u32> {
    let block = bits.read(3)? + 2;
    let [width, height] = of.map(|side| blocks(side, block));
    pixels(bits, width.saturating_mul(height))
}

/// Skips the pixels of an image inside the picture, which has one group of codes. Returns the
/// largest number in red and green together: the number of a group of codes.
fn pixels(bits: &mut BitReader<'_>, count: u32) -> Option<u32> {
    let alphabets = alphabets(bits)?;
    let mut group = Vec::with_capacity(alphabets.len());
    for alphabet in alphabets {
        group.push(PrefixCode::read(bits, alphabet)?);
    }
    let [green, red, blue, alpha, distance] = group.as_slice() else {
        return None;
    };
    let (mut largest, mut done) = (0, 0);
    while done < count {
        let before = bits.at();
        let symbol = u32::from(green.symbol(bits)?);
        done += match symbol {
            0..LENGTHS => {
                let red = u32::from(red.symbol(bits)?);
                blue.symbol(bits)?;
                alpha.symbol(bits)?;
                largest = largest.max(red << 8 | symbol);
                1
            }
            LENGTHS..COLORS => {
                let length = extended(bits, symbol - LENGTHS)?;
                let distance = u32::from(distance.symbol(bits)?);
                extended(bits, distance)?;
                length
            }
            // An entry of the colour cache.
            _ => 1,
        };
        // All further pixels are equal, and take no bits.
        if bits.at() == before {
            break;
        }
    }
    Some(largest)
}

/// The first symbol of green that is a length of a back-reference.
const LENGTHS: u32 = 256;

/// The first symbol of green that is an entry of the colour cache.
const COLORS: u32 = LENGTHS + 24;

/// A length or a distance. Its symbol gives the number of extra bits.
fn extended(bits: &mut BitReader<'_>, symbol: u32) -> Option<u32> {
    if symbol < 4 {
        return Some(symbol + 1);
    }
    let count = (symbol - 2) >> 1;
    Some(((2 + (symbol & 1)) << count) + bits.read(count)? + 1)
}

/// Reads the size of the colour cache. Returns the number of symbols of each code of a group: green
/// with lengths and cache entries, red, blue, alpha, distance.
fn alphabets(bits: &mut BitReader<'_>) -> Option<[u16; 5]> {
    let cache = if bits.flag()? {
        let count = bits.read(4)?;
        (1..=11).contains(&count).then_some(1 << count)?
    } else {
        0
    };
    Some([280 + cache, 256, 256, 256, 40])
}
