//! KTX2 textures of Basis Universal: ETC1S, and UASTC with or without Zstandard. Level 0 of a 2D
//! texture is decoded.
//!
//! The container is read here, so each offset and length of the file is checked before the crate
//! `basisu` decodes blocks.

use super::layout::PixelLayout;
use super::{DecodeError, ImageSize};
use basisu::basislz::decoder::BitwiseDecoder;
use basisu::basislz::etc1s::Etc1sTranscoder;
use basisu::basislz::huffman::{FAST_LOOKUP_BITS, HuffmanDecodingTable};
use basisu::uastc::unpack::unpack_uastc;
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;
use std::ops::Range;

/// The first bytes of a KTX2 file.
pub(crate) const MAGIC: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Bytes of a UASTC block.
const UASTC_BLOCK: usize = 16;
/// Bytes of the header of the global data of BasisLZ, and of an entry for one image.
const GLOBAL_HEADER: usize = 20;
const IMAGE_ENTRY: usize = 20;
/// More than codebooks and prefix codes of BasisLZ take, in bytes.
const CODEBOOKS: u64 = 4 << 20;

pub(super) struct Ktx2<'a> {
    pub(super) layout: PixelLayout,
    size: ImageSize,
    blocks: BlockData<'a>,
}

enum BlockData<'a> {
    Etc1s(Etc1s<'a>),
    Uastc(&'a [u8]),
    /// UASTC in a Zstandard frame of this window.
    UastcZstd {
        frame: &'a [u8],
        window: u64,
    },
}

/// The parts of a texture of ETC1S.
struct Etc1s<'a> {
    endpoint_count: u32,
    selector_count: u32,
    endpoints: &'a [u8],
    selectors: &'a [u8],
    tables: &'a [u8],
    color: &'a [u8],
    alpha: Option<&'a [u8]>,
}

/// Integers and ranges of the file, checked against its length.
#[derive(Clone, Copy)]
struct FileBytes<'a>(&'a [u8]);

impl<'a> FileBytes<'a> {
    fn slice(self, start: u64, length: u64) -> Result<&'a [u8], DecodeError> {
        let end = start.checked_add(length);
        let range = |end| Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?);
        let range: Option<Range<usize>> = end.and_then(range);
        range
            .and_then(|range| self.0.get(range))
            .ok_or_else(|| DecodeError::damaged("it ends early"))
    }

    fn u16(self, at: u64) -> Result<u32, DecodeError> {
        let bytes = self.slice(at, 2)?;
        Ok(u32::from(u16::from_le_bytes([bytes[0], bytes[1]])))
    }

    fn u32(self, at: u64) -> Result<u32, DecodeError> {
        let bytes = self.slice(at, 4)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    fn u64(self, at: u64) -> Result<u64, DecodeError> {
        Ok(u64::from(self.u32(at)?) | u64::from(self.u32(at + 4)?) << 32)
    }
}

/// Reads everything before the blocks.
pub(super) fn open(bytes: &[u8], most_pixels: u64) -> Result<(ImageSize, Ktx2<'_>), DecodeError> {
    let file = FileBytes(bytes);
    // The header: format, size, kind of texture, and number of mip levels.
    if file.u32(12)? != 0 {
        return Err(DecodeError::Unsupported(
            "KTX2 file without Basis Universal",
        ));
    }
    let size = ImageSize::within(most_pixels, file.u32(20)?, file.u32(24)?)?;
    if size.pixels() > u64::from(u32::MAX / 4) {
        return Err(size.too_large());
    }
    if file.u32(28)? != 0 {
        return Err(DecodeError::Unsupported("KTX2 file of a volume"));
    }
    if file.u32(32)? > 1 {
        return Err(DecodeError::Unsupported("KTX2 file of several layers"));
    }
    if file.u32(36)? != 1 {
        return Err(DecodeError::Unsupported("KTX2 file of a cube map"));
    }
    let levels = u64::from(file.u32(40)?.max(1));
    let supercompression = file.u32(44)?;
    // The first entry of the level index.
    let (offset, length, inflated) = (file.u64(80)?, file.u64(88)?, file.u64(96)?);
    let level = file.slice(offset, length)?;
    // The data format descriptor: color model, and the channels of its samples.
    let descriptor = u64::from(file.u32(48)?);
    let samples = u64::from(file.u32(52)?).saturating_sub(28) / 16;
    // The channels of UASTC with opacity are RGBA, 3, and RRRG, 5.
    let has_opacity = || {
        let channel = (file.u32(descriptor + 28)? >> 24) & 15;
        Ok::<_, DecodeError>(matches!(channel, 3 | 5))
    };
    let (blocks, has_alpha) = match (file.u32(descriptor + 12)? & 255, supercompression) {
        (163, 1) => {
            let has_alpha = samples > 1;
            let etc1s = Etc1s::open(file, level, levels, has_alpha)?;
            (BlockData::Etc1s(etc1s), has_alpha)
        }
        (166, 0) => (BlockData::Uastc(level), has_opacity()?),
        (166, 2) => {
            if inflated != uastc_bytes(size) {
                return Err(DecodeError::damaged("level 0 has another size"));
            }
            let window = zstd_window(FileBytes(level))?;
            let frame = level;
            (BlockData::UastcZstd { frame, window }, has_opacity()?)
        }
        _ => {
            return Err(DecodeError::Unsupported(
                "KTX2 file without Basis Universal",
            ));
        }
    };
    let layout = PixelLayout {
        channels: if has_alpha { 4 } else { 3 },
        is_wide: false,
    };
    Ok((
        size,
        Ktx2 {
            layout,
            size,
            blocks,
        },
    ))
}

/// Blocks across and down.
fn block_counts(size: ImageSize) -> (u32, u32) {
    (size.width.div_ceil(4), size.height.div_ceil(4))
}

/// Bytes of the blocks of an image in UASTC.
fn uastc_bytes(size: ImageSize) -> u64 {
    let (across, down) = block_counts(size);
    u64::from(across) * u64::from(down) * UASTC_BLOCK as u64
}

/// The window size of a Zstandard frame (RFC 8878, section 3.1.1.1).
fn zstd_window(frame: FileBytes<'_>) -> Result<u64, DecodeError> {
    if frame.u32(0)? != 0xFD2F_B528 {
        return Err(DecodeError::damaged("level 0 is not Zstandard"));
    }
    let descriptor = frame.slice(4, 1)?[0];
    if descriptor & 0x20 == 0 {
        let window = frame.slice(5, 1)?[0];
        let base = 1_u64 << (10 + (window >> 3));
        return Ok(base + base / 8 * u64::from(window & 7));
    }
    // A frame of a single segment: its window is its content.
    let at = 5 + [0, 1, 2, 4][usize::from(descriptor & 3)];
    match descriptor >> 6 {
        0 => Ok(u64::from(frame.slice(at, 1)?[0])),
        1 => Ok(u64::from(frame.u16(at)?) + 256),
        2 => Ok(u64::from(frame.u32(at)?)),
        _ => frame.u64(at),
    }
}

impl<'a> Etc1s<'a> {
    /// Reads the header of the global data, and the entry of the image of level 0.
    fn open(
        file: FileBytes<'a>,
        level: &'a [u8],
        levels: u64,
        has_alpha: bool,
    ) -> Result<Self, DecodeError> {
        let global = FileBytes(file.slice(file.u64(64)?, file.u64(72)?)?);
        let lengths = [global.u32(4)?, global.u32(8)?, global.u32(12)?].map(u64::from);
        let mut start = GLOBAL_HEADER as u64 + IMAGE_ENTRY as u64 * levels;
        let mut next = |length| {
            let part = global.slice(start, length);
            start += length;
            part
        };
        let [endpoints, selectors, tables] = lengths.map(&mut next);
        let slice = |at: u64| {
            let (offset, length) = (global.u32(at)?, global.u32(at + 4)?);
            FileBytes(level).slice(u64::from(offset), u64::from(length))
        };
        let entry = GLOBAL_HEADER as u64;
        Ok(Self {
            endpoint_count: global.u16(0)?,
            selector_count: global.u16(2)?,
            endpoints: endpoints?,
            selectors: selectors?,
            tables: tables?,
            color: slice(entry + 4)?,
            alpha: has_alpha.then(|| slice(entry + 12)).transpose()?,
        })
    }

    /// Decodes to bytes of red, green, blue and opacity.
    fn decode(&self, size: ImageSize) -> Option<Vec<u8>> {
        // Codebooks and prefix codes.
        if !self.has_decodable_codes() {
            return None;
        }
        let mut transcoder = Etc1sTranscoder::new();
        let has_codebooks = transcoder.decode_palettes(
            self.endpoint_count,
            self.endpoints,
            self.selector_count,
            self.selectors,
        );
        if !has_codebooks || !transcoder.decode_tables(self.tables) {
            return None;
        }
        // The slices: colors, and opacity.
        let ((across, down), ImageSize { width, height }) = (block_counts(size), size);
        let mut rgba = size.buffer(4).ok()?;
        match self.alpha {
            None => transcoder
                .transcode_slice_rgba32(self.color, across, down, width, height, None, &mut rgba)?,
            Some(alpha) => transcoder.transcode_image_rgba32(
                self.color, alpha, across, down, width, height, None, &mut rgba,
            )?,
        }
        Some(rgba)
    }

    /// Whether the decoder of the crate stays within the tables of all prefix codes. Of a code with
    /// one symbol it builds a part of the tree only, if the symbol is longer than its lookup table.
    fn has_decodable_codes(&self) -> bool {
        let next = |bits: &mut BitwiseDecoder<'_>| {
            let mut table = HuffmanDecodingTable::new();
            bits.read_huffman_table(&mut table) && {
                let mut used = table.code_sizes.iter().filter(|size| **size > 0);
                match (used.next(), used.next()) {
                    (Some(only), None) => u32::from(*only) <= FAST_LOOKUP_BITS,
                    _ => true,
                }
            }
        };
        let four_codes = |bytes| {
            let mut bits = BitwiseDecoder::new(bytes);
            (0..4).all(|_| next(&mut bits))
        };
        // Selectors have three flags, and a code if the last of them is not set.
        let mut selectors = BitwiseDecoder::new(self.selectors);
        let is_raw = selectors.get_bits(3) & 4 != 0;
        four_codes(self.endpoints) && four_codes(self.tables) && (is_raw || next(&mut selectors))
    }
}

impl Ktx2<'_> {
    /// The memory of decoding besides the pixels, in bytes.
    pub(super) fn scratch(&self) -> u64 {
        let (across, down) = block_counts(self.size);
        let indices = u64::from(across) * u64::from(down) * 4;
        match &self.blocks {
            BlockData::Etc1s(_) => CODEBOOKS + indices + 4 * self.size.pixels(),
            BlockData::Uastc(_) => 0,
            // The buffer of the decoder holds the window and a block, and grows by doubling.
            BlockData::UastcZstd { frame: _, window } => window
                .saturating_add(1 << 18)
                .saturating_mul(4)
                .saturating_add(uastc_bytes(self.size)),
        }
    }

    pub(super) fn decode(self, into: &mut [u8]) -> Result<(), DecodeError> {
        let Self {
            layout,
            size,
            blocks,
        } = self;
        match blocks {
            BlockData::Etc1s(etc1s) => {
                let rgba = etc1s.decode(size);
                let rgba = rgba.ok_or_else(|| DecodeError::damaged("ETC1S data is invalid"))?;
                let pixels = into
                    .chunks_exact_mut(layout.channels)
                    .zip(rgba.chunks_exact(4));
                pixels.for_each(|(pixel, rgba)| pixel.copy_from_slice(&rgba[..pixel.len()]));
                Ok(())
            }
            BlockData::Uastc(blocks) => unpack(blocks, size, layout.channels, into),
            BlockData::UastcZstd { frame, window: _ } => {
                let mut blocks = ImageSize { width: 1, ..size }.buffer(0)?;
                inflate(frame, uastc_bytes(size), &mut blocks)?;
                unpack(&blocks, size, layout.channels, into)
            }
        }
    }
}

/// Reads exactly this many bytes of a Zstandard frame.
fn inflate(frame: &[u8], length: u64, into: &mut Vec<u8>) -> Result<(), DecodeError> {
    let mut decoder = StreamingDecoder::new(frame).map_err(DecodeError::damaged)?;
    // The decoder buffers a whole read, so reads are short.
    into.try_reserve_exact(usize::try_from(length).unwrap_or(usize::MAX))
        .map_err(DecodeError::damaged)?;
    let mut part = vec![0; 1 << 16];
    loop {
        match decoder.read(&mut part).map_err(DecodeError::damaged)? {
            0 => break,
            count if into.len() as u64 + count as u64 > length => {
                return Err(DecodeError::damaged("level 0 is too long"));
            }
            count => into.extend_from_slice(&part[..count]),
        }
    }
    if (into.len() as u64) < length {
        return Err(DecodeError::damaged("level 0 is too short"));
    }
    Ok(())
}

/// Decodes blocks of UASTC.
fn unpack(
    blocks: &[u8],
    size: ImageSize,
    channels: usize,
    into: &mut [u8],
) -> Result<(), DecodeError> {
    if (blocks.len() as u64) < uastc_bytes(size) {
        return Err(DecodeError::damaged("level 0 is too short"));
    }
    let (width, height) = (size.width as usize, size.height as usize);
    let (blocks, _) = blocks.as_chunks::<UASTC_BLOCK>();
    for (row, blocks) in blocks
        .chunks(width.div_ceil(4))
        .take(height.div_ceil(4))
        .enumerate()
    {
        for (column, block) in blocks.iter().enumerate() {
            let texels = unpack_uastc(block, false);
            let texels = texels.ok_or_else(|| DecodeError::damaged("a UASTC block is invalid"))?;
            for (y, texels) in (4 * row..height).zip(texels.chunks_exact(4)) {
                for (x, texel) in (4 * column..width).zip(texels) {
                    let at = (y * width + x) * channels;
                    into[at..at + channels].copy_from_slice(&texel.c[..channels]);
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{OpacityUse, PixelFile};
    use super::*;

    const ETC1S: &[u8] = include_bytes!("../../../fuzz/corpus/image/etc1s.ktx2");
    const ETC1S_ALPHA: &[u8] = include_bytes!("../../../fuzz/corpus/image/etc1s-alpha.ktx2");
    const UASTC: &[u8] = include_bytes!("../../../fuzz/corpus/image/uastc.ktx2");
    const UASTC_ZSTD: &[u8] = include_bytes!("../../../fuzz/corpus/image/uastc-zstd.ktx2");

    fn decode(file: &[u8], opacity: OpacityUse) -> Result<super::super::Pixels, DecodeError> {
        PixelFile::open(file, opacity, 1 << 20)?.decode()
    }

    /// Three blocks of red, green and blue above three of white, grey and grey, cut at 10 × 6.
    fn expected(x: usize, y: usize, alpha: u8) -> [u8; 4] {
        match (x / 4, y / 4) {
            (0, 0) => [255, 0, 0, 255],
            (1, 0) => [0, 255, 0, 255],
            (2, 0) => [0, 0, 255, 255],
            (0, 1) => [255, 255, 255, alpha],
            _ => [99, 99, 99, 255],
        }
    }

    #[test]
    fn known_colors_are_decoded() {
        // ETC1S has 5 bits for a base color, and steps of 8 and 2 from it.
        for (file, alpha, tolerance) in [
            (ETC1S, None, 5),
            (ETC1S_ALPHA, Some(102), 5),
            (UASTC, Some(102), 0),
            (UASTC_ZSTD, Some(102), 0),
        ] {
            let pixels = decode(file, OpacityUse::Kept).unwrap();
            let channels = if alpha.is_some() { 4 } else { 3 };
            assert_eq!((pixels.width, pixels.height), (10, 6));
            assert_eq!(pixels.has_alpha, alpha.is_some());
            assert_eq!(pixels.bytes.len(), 60 * channels);
            for (index, pixel) in pixels.bytes.chunks(channels).enumerate() {
                let expected = expected(index % 10, index / 10, alpha.unwrap_or(255));
                let is_near = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= tolerance;
                assert!(
                    pixel.iter().zip(&expected).all(is_near),
                    "{index}: {pixel:?}"
                );
            }
            let opaque = decode(file, OpacityUse::Dropped).unwrap().bytes;
            let colors = pixels.bytes.chunks(channels).flat_map(|pixel| &pixel[..3]);
            assert!(opaque.iter().eq(colors));
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_rejected() {
        for file in [ETC1S, ETC1S_ALPHA, UASTC, UASTC_ZSTD] {
            for end in MAGIC.len()..file.len() {
                assert!(decode(&file[..end], OpacityUse::Kept).is_err(), "{end}");
            }
        }
    }

    #[test]
    fn offsets_and_lengths_of_any_size_are_rejected() {
        // Offsets of the descriptor, of the global data and of level 0, and lengths.
        for (file, places) in [
            (ETC1S, &[48, 64, 72, 80, 88, 172 + 20][..]),
            (UASTC, &[48, 80, 88]),
            (UASTC_ZSTD, &[48, 80, 88, 96]),
        ] {
            for at in places {
                for word in [[0xff; 4], [0xff, 0xff, 0xff, 0x7f]] {
                    let mut forged = file.to_vec();
                    forged[*at..at + 4].copy_from_slice(&word);
                    assert!(decode(&forged, OpacityUse::Kept).is_err(), "{at}");
                    if *at >= 64 {
                        forged[at + 4..at + 8].copy_from_slice(&word);
                        assert!(decode(&forged, OpacityUse::Kept).is_err(), "{at}");
                    }
                }
            }
        }
    }

    #[test]
    fn kinds_that_are_not_read_are_named() {
        for (at, value, kind) in [
            (12, 37, "without Basis Universal"),
            (28, 1, "volume"),
            (32, 2, "layers"),
            (36, 6, "cube map"),
            (44, 3, "without Basis Universal"),
        ] {
            let mut file = UASTC.to_vec();
            file[at] = value;
            let error = decode(&file, OpacityUse::Kept).unwrap_err().to_string();
            assert!(error.contains(kind), "{error}");
        }
    }

    #[test]
    fn a_prefix_code_of_one_long_symbol_is_rejected() {
        // A table of one symbol of 12 bits: 1 used symbol; 14 sizes of the code of sizes, the last
        // of which, for a size of 12, is 1; then this size.
        let table = [(1_u32, 14), (14, 5)]
            .into_iter()
            .chain([(0, 3); 13])
            .chain([(1, 3), (0, 1)]);
        let tables = (0..4).flat_map(|_| table.clone()).chain([(0, 1)]);
        let codes = [(0, 10), (2, 2)].into_iter().cycle().take(80);
        let bits = tables
            .chain(codes)
            .flat_map(|(value, count)| (0..count).map(move |k| u8::from(value >> k & 1 != 0)));
        let bits: Vec<u8> = bits.collect();
        let endpoints: Vec<u8> = bits
            .chunks(8)
            .map(|bits| bits.iter().rev().fold(0, |byte, bit| byte << 1 | bit))
            .collect();
        let (_, texture) = open(ETC1S, 1 << 10).unwrap();
        let BlockData::Etc1s(mut etc1s) = texture.blocks else {
            panic!()
        };
        assert!(etc1s.has_decodable_codes());
        etc1s.endpoints = &endpoints;
        assert!(!etc1s.has_decodable_codes());
        assert!(etc1s.decode(texture.size).is_none());
    }
}
