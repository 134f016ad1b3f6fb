//! The channels of a decoder, and their conversion to bytes of red, green, blue and opacity, in
//! place.

/// A pixel as a decoder writes it: grey, or red, green and blue, with opacity or without.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelLayout {
    /// From 1 to 4: grey, grey and opacity, colour, colour and opacity.
    pub(super) channels: usize,
    /// Whether a channel has two bytes, the high one first.
    pub(super) is_wide: bool,
}

impl PixelLayout {
    /// Bytes of a pixel.
    pub(super) fn bytes(self) -> usize {
        self.channels * if self.is_wide { 2 } else { 1 }
    }

    pub(super) fn has_alpha(self) -> bool {
        self.channels.is_multiple_of(2)
    }

    /// Where the decoder writes, in a buffer that has room for every pixel before and after: at its
    /// end, so that pixels that grow never run over those not yet converted.
    pub(super) fn place(self, buffer: &mut [u8], channels: usize) -> &mut [u8] {
        let pixels = buffer.len() / self.bytes().max(channels);
        let start = buffer.len() - pixels * self.bytes();
        &mut buffer[start..]
    }

    /// Converts pixels of the decoder to `channels` bytes, 3 or 4.
    pub(super) fn convert(self, buffer: &mut Vec<u8>, channels: usize) {
        let size = self.bytes();
        if size == channels && !self.is_wide {
            return;
        }
        let pixels = buffer.len() / size.max(channels);
        let start = buffer.len() - pixels * size;
        for pixel in 0..pixels {
            let made = self.pixel(&buffer[start + pixel * size..][..size]);
            buffer[pixel * channels..][..channels].copy_from_slice(&made[..channels]);
        }
        buffer.truncate(pixels * channels);
        buffer.shrink_to_fit();
    }

    #[inline]
    fn pixel(self, coded: &[u8]) -> [u8; 4] {
        let channel = |k: usize| {
            if self.is_wide {
                narrow([coded[2 * k], coded[2 * k + 1]])
            } else {
                coded[k]
            }
        };
        self.colored(channel, u8::MAX)
    }

    /// Red, green, blue and opacity of a coded pixel, from 0 to 1.
    pub(super) fn values(self, coded: &[u8]) -> [f64; 4] {
        let channel = |k: usize| {
            if self.is_wide {
                f64::from(u16::from_be_bytes([coded[2 * k], coded[2 * k + 1]])) / 65535.0
            } else {
                f64::from(coded[k]) / 255.0
            }
        };
        self.colored(channel, 1.0)
    }

    /// Red, green, blue and opacity by the channels of a pixel.
    #[inline]
    fn colored<T>(self, channel: impl Fn(usize) -> T, opaque: T) -> [T; 4] {
        let color = if self.channels < 3 {
            [channel(0), channel(0), channel(0)]
        } else {
            [channel(0), channel(1), channel(2)]
        };
        let [r, g, b] = color;
        let opacity = if self.has_alpha() {
            channel(self.channels - 1)
        } else {
            opaque
        };
        [r, g, b, opacity]
    }
}

/// The byte nearest to a number of 16 bits: 65535 is 255 · 257.
#[expect(clippy::cast_possible_truncation, reason = "at most 255")]
fn narrow(bytes: [u8; 2]) -> u8 {
    ((u32::from(u16::from_be_bytes(bytes)) + 128) / 257) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn converted(channels: usize, is_wide: bool, to: usize) -> Vec<u8> {
        let layout = PixelLayout { channels, is_wide };
        let mut buffer = vec![0; 2 * layout.bytes().max(to)];
        let coded = layout.place(&mut buffer, to);
        // Byte k of both pixels together is 10·k, those of wide channels doubled: then the value is
        // the same.
        let each = if is_wide { 2 } else { 1 };
        coded
            .iter_mut()
            .enumerate()
            .for_each(|(k, byte)| *byte = u8::try_from(k / each * 10).unwrap());
        layout.convert(&mut buffer, to);
        buffer
    }

    #[test]
    fn every_layout_becomes_bytes() {
        for is_wide in [false, true] {
            assert_eq!(converted(1, is_wide, 3), [0, 0, 0, 10, 10, 10]);
            assert_eq!(converted(2, is_wide, 3), [0, 0, 0, 20, 20, 20]);
            assert_eq!(converted(2, is_wide, 4), [0, 0, 0, 10, 20, 20, 20, 30]);
            assert_eq!(converted(3, is_wide, 3), [0, 10, 20, 30, 40, 50]);
            assert_eq!(converted(4, is_wide, 3), [0, 10, 20, 40, 50, 60]);
            assert_eq!(converted(4, is_wide, 4), [0, 10, 20, 30, 40, 50, 60, 70]);
        }
    }

    #[test]
    fn values_are_not_rounded() {
        let layout = |channels, is_wide| PixelLayout { channels, is_wide };
        let grey = 256.0 / 65535.0;
        assert_eq!(layout(1, true).values(&[1, 0]), [grey, grey, grey, 1.0]);
        assert_eq!(
            layout(4, false).values(&[0, 51, 255, 102]),
            [0.0, 0.2, 1.0, 0.4]
        );
    }

    #[test]
    fn sixteen_bits_are_rounded() {
        assert_eq!(
            [[0, 128], [0, 129], [255, 126], [255, 127]].map(narrow),
            [0, 1, 254, 255]
        );
    }
}
