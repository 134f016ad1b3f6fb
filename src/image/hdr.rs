//! The reader of Radiance HDR files: pixels of three mantissas and a shared exponent, flat or
//! run-length encoded, in the old or the new way.

use super::decode::{DecodeError, ImageSize};

/// The one format of pixels that is read.
const FORMAT: &[u8] = b"32-bit_rle_rgbe";

/// Red, green, blue, and the exponent that they share.
pub(super) type Rgbe = [u8; 4];

/// A file whose header was read.
pub(super) struct Hdr<'a> {
    pub(super) size: ImageSize,
    /// The bytes after the header.
    rest: HdrBytes<'a>,
}

impl<'a> Hdr<'a> {
    /// Reads the header: lines up to an empty one, and one with the size. Of the lines only the
    /// format is used.
    pub(super) fn open(file: &'a [u8], most_pixels: u64) -> Result<Self, DecodeError> {
        let mut rest = HdrBytes(file);
        loop {
            let line = rest.line()?;
            if line.is_empty() {
                break;
            }
            let format = format_of(line).filter(|format| *format != FORMAT);
            if let Some(format) = format {
                let name = String::from_utf8_lossy(format.get(..20).unwrap_or(format));
                return Err(DecodeError::damaged(format_args!(
                    "its pixels are `{name}`"
                )));
            }
        }
        let [width, height] = sides(rest.line()?)?;
        let size = ImageSize::within(most_pixels, width, height)?;
        Ok(Self { size, rest })
    }

    /// Bytes that decoding takes beside the pixels: a row.
    pub(super) fn scratch(&self) -> u64 {
        u64::from(self.size.width) * 4
    }

    /// Decodes to three floats a pixel, in the byte order of the machine.
    pub(super) fn decode(mut self, into: &mut [u8]) -> Result<(), DecodeError> {
        let mut row = vec![Rgbe::default(); self.size.width as usize];
        for into in into.chunks_exact_mut(row.len() * 12) {
            self.rest.row(&mut row)?;
            let values = row.iter().flat_map(|pixel| light(*pixel));
            let channels = into.as_chunks_mut::<4>().0;
            for (channel, value) in channels.iter_mut().zip(values) {
                *channel = value.to_ne_bytes();
            }
        }
        Ok(())
    }
}

/// The format that a line states, if any.
fn format_of(line: &[u8]) -> Option<&[u8]> {
    let equals = line.iter().position(|byte| *byte == b'=')?;
    let (key, value) = (line.get(..equals)?, line.get(equals + 1..)?);
    let is_format = key.trim_ascii() == b"FORMAT" && !value.is_empty();
    is_format.then(|| value.trim_ascii())
}

/// Width and height of `-Y height +X width`: rows from the top, each from the left.
fn sides(line: &[u8]) -> Result<[u32; 2], DecodeError> {
    let mut words = line
        .split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty());
    let mut side = |sign: &[u8]| {
        let is_signed = words.next() == Some(sign);
        let number = std::str::from_utf8(words.next()?).ok()?;
        number.parse().ok().filter(|_| is_signed)
    };
    match (side(b"-Y"), side(b"+X")) {
        (Some(height), Some(width)) => Ok([width, height]),
        _ => Err(DecodeError::damaged("its size is not `-Y 2 +X 3` or so")),
    }
}

/// A mantissa times two to the exponent minus 136. The least exponents give subnormal numbers, none
/// of which is rounded.
fn light([red, green, blue, exponent]: Rgbe) -> [f32; 3] {
    let exponent = u32::from(exponent);
    let power = match exponent {
        0 | 1 => exponent << 22,
        _ => (exponent - 1) << 23,
    };
    let scale = f32::from_bits(power) / 256.0;
    [red, green, blue].map(|mantissa| scale * f32::from(mantissa))
}

/// A run at the start of the rest of a row, and the bytes after it.
fn split(row: &mut [Rgbe], length: usize) -> Result<(&mut [Rgbe], &mut [Rgbe]), DecodeError> {
    row.split_at_mut_checked(length)
        .ok_or_else(|| DecodeError::damaged("a run is longer than its row"))
}

/// The rest of a file.
struct HdrBytes<'a>(&'a [u8]);

impl<'a> HdrBytes<'a> {
    /// The next line, without its end.
    fn line(&mut self) -> Result<&'a [u8], DecodeError> {
        if self.0.is_empty() {
            return Err(DecodeError::damaged("it ends in its header"));
        }
        let end = memchr::memchr(b'\n', self.0).unwrap_or(self.0.len());
        let (line, rest) = self.0.split_at(end);
        self.0 = rest.get(1..).unwrap_or_default();
        Ok(line)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], DecodeError> {
        let split = self.0.split_at_checked(count);
        let taken;
        (taken, self.0) =
            split.ok_or_else(|| DecodeError::damaged("it ends before its last pixel"))?;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], DecodeError> {
        let taken = self.take(N)?.first_chunk().copied();
        Ok(taken.unwrap_or([0; N]))
    }

    /// Reads a row, which is not empty.
    fn row(&mut self, row: &mut [Rgbe]) -> Result<(), DecodeError> {
        match self.array()? {
            [2, 2, 0..128, _] => (0..4).try_for_each(|channel| self.channel(row, channel)),
            [1, 1, 1, _] => Err(DecodeError::damaged(
                "a row begins with a run of length zero",
            )),
            first => self.pixels(row, first),
        }
    }

    /// A channel of a row, in runs of one value and stretches of differing ones.
    fn channel(&mut self, row: &mut [Rgbe], channel: usize) -> Result<(), DecodeError> {
        let mut left = row;
        while !left.is_empty() {
            let [count] = self.array()?;
            let length = usize::from(if count > 128 { count - 128 } else { count });
            let (run, rest) = split(left, length)?;
            if count > 128 {
                let [value] = self.array()?;
                run.iter_mut().for_each(|pixel| pixel[channel] = value);
            } else {
                let values = self.take(length)?;
                let pixels = run.iter_mut().zip(values);
                pixels.for_each(|(pixel, value)| pixel[channel] = *value);
            }
            left = rest;
        }
        Ok(())
    }

    /// Uncompressed pixels of a row, of which the first was read. A pixel of three ones repeats the
    /// one before it; of several in sequence, each counts 256 times the last one.
    fn pixels(&mut self, row: &mut [Rgbe], first: Rgbe) -> Result<(), DecodeError> {
        let Some((to, mut left)) = row.split_first_mut() else {
            return Ok(());
        };
        *to = first;
        let (mut last, mut unit) = (first, 1_usize);
        while !left.is_empty() {
            let mut length = 1;
            match self.array()? {
                [1, 1, 1, count] => {
                    length = usize::from(count).saturating_mul(unit);
                    unit = unit.saturating_mul(256);
                }
                pixel => (last, unit) = (pixel, 1),
            }
            let (run, rest) = split(left, length)?;
            run.fill(last);
            left = rest;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
