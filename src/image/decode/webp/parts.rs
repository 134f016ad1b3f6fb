//! The chunks of a WebP file that the decoder will decode, found in the same way: the first of each
//! kind, at the top or in the first picture of an animation.

use super::{DecodeError, ImageSize};

/// The coded streams of one picture.
pub(super) struct CodedStreams<'a> {
    /// The size of the picture. A frame of an animation may be smaller than the canvas.
    pub(super) size: ImageSize,
    pub(super) lossy: Option<&'a [u8]>,
    pub(super) lossless: Option<&'a [u8]>,
    pub(super) opacity: Option<&'a [u8]>,
}

/// A chunk of a RIFF file.
#[derive(Clone, Copy)]
struct RiffChunk<'a> {
    kind: &'a [u8; 4],
    /// The start of its contents.
    start: usize,
    /// The contents; the end of the file may cut them short.
    contents: &'a [u8],
    /// The start of the next chunk.
    end: usize,
}

impl<'a> RiffChunk<'a> {
    fn at(bytes: &'a [u8], at: usize) -> Option<Self> {
        let rest = bytes.get(at..)?;
        let (kind, rest) = rest.split_first_chunk::<4>()?;
        let (length, rest) = rest.split_first_chunk::<4>()?;
        let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
        let start = at + 8;
        Some(Self {
            kind,
            start,
            contents: rest.get(..length).unwrap_or(rest),
            end: start.saturating_add(length).saturating_add(length & 1),
        })
    }
}

impl<'a> CodedStreams<'a> {
    /// The parts of a file with a canvas of this size.
    pub(super) fn of(
        bytes: &'a [u8],
        canvas: ImageSize,
        is_animation: bool,
    ) -> Result<Self, DecodeError> {
        // Find the chunks of the file and of its first frame.
        let chunks = chunks(bytes);
        let frame = chunks.iter().find(|chunk| chunk.kind == b"ANMF");
        let within: Vec<_> = frame.map_or_else(Vec::new, |frame| {
            let first = RiffChunk::at(bytes, frame.start.saturating_add(16));
            let second = first.and_then(|first| RiffChunk::at(bytes, first.end));
            first.into_iter().chain(second).collect()
        });
        // Of an animation, only the first frame is read.
        if is_animation {
            let size = frame.and_then(|frame| frame_size(frame.contents));
            let size =
                size.ok_or_else(|| DecodeError::Damaged("a picture has no header".to_owned()))?;
            return Ok(Self::moving(size, &within));
        }
        // The image data is lossless, or lossy with a separate alpha plane.
        let first = |kind: &[u8; 4]| {
            let mut all = chunks.iter().chain(&within);
            all.find(|chunk| chunk.kind == kind)
                .map(|chunk| chunk.contents)
        };
        Ok(match first(b"VP8L") {
            lossless @ Some(_) => Self {
                size: canvas,
                lossy: None,
                lossless,
                opacity: None,
            },
            None => Self {
                size: canvas,
                lossy: first(b"VP8 "),
                lossless: None,
                opacity: first(b"ALPH"),
            },
        })
    }

    /// The streams of a picture of an animation.
    fn moving(size: ImageSize, chunks: &[RiffChunk<'a>]) -> Self {
        let part = |index: usize, kind: &[u8; 4]| {
            let chunk = chunks.get(index).filter(|chunk| chunk.kind == kind);
            chunk.map(|chunk| chunk.contents)
        };
        let opacity = part(0, b"ALPH");
        let behind = opacity.and_then(|_| chunks.get(1));
        Self {
            size,
            // After opacity the decoder does not check the kind of the chunk.
            lossy: behind
                .map(|chunk| chunk.contents)
                .or_else(|| part(0, b"VP8 ")),
            lossless: part(0, b"VP8L"),
            opacity,
        }
    }
}

/// The chunks at the top: one, or more if the first says so.
fn chunks(bytes: &[u8]) -> Vec<RiffChunk<'_>> {
    let Some(first) = RiffChunk::at(bytes, 12) else {
        return Vec::new();
    };
    if first.kind != b"VP8X" {
        return vec![first];
    }
    let length = RiffChunk::at(bytes, 0).map_or(0, |riff| riff.end - riff.start);
    let most = first.end.saturating_add(length.saturating_sub(12));
    let behind = |chunk: &RiffChunk<'_>| {
        Some(chunk.end)
            .filter(|end| *end < most)
            .and_then(|end| RiffChunk::at(bytes, end))
    };
    std::iter::successors(behind(&first), behind).collect()
}

/// The size in the header of a frame of an animation.
fn frame_size(contents: &[u8]) -> Option<ImageSize> {
    let side = |at: usize| {
        let [low, middle, high] = *contents.get(at..)?.first_chunk::<3>()?;
        Some(u32::from_le_bytes([low, middle, high, 0]) + 1)
    };
    Some(ImageSize {
        width: side(6)?,
        height: side(9)?,
    })
}

/// The width and height of a lossy picture; `None` if the bytes are not one.
pub(super) fn lossy_sides(stream: &[u8]) -> Option<[u32; 2]> {
    let [tag, _, _, 0x9d, 0x01, 0x2a, width @ .., _, _] = *stream.first_chunk::<10>()? else {
        return None;
    };
    let height = [stream[8], stream[9]];
    let side = |bytes| u32::from(u16::from_le_bytes(bytes) & 0x3fff);
    (tag & 1 == 0).then(|| [side(width), side(height)])
}
