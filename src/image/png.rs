//! PNG of 8 and 16 bits per channel: red, green, blue, and opacity where there is one. A picture
//! says that its colours are those of sRGB, and where it came from; never when it was made.

use super::header::{PictureHeader, StripSource};
use super::{MerkleTree, Picture};
use ::png::chunk::ChunkType;
use ::png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};
use rtc_color as color;
use std::io::{self, Write};

/// The compressed bytes of a pixel chunk that are buffered before writing.
const CHUNK: usize = 1 << 16;

/// The chunk of the Merkle tree, at the end of the file: it may be left out, is of this program,
/// and is void for other pixels (PNG, third edition, 5.4).
pub(super) const TREE: ChunkType = ChunkType(*b"rtMT");

/// Writes a picture with a number of bits per channel, row by row, as its strips arrive.
pub(super) fn write(
    head: &PictureHeader,
    depth: BitDepth,
    out: impl Write,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    let kind = (depth, head.has_alpha);
    png(head.size, kind, Some(head), out, |rows| {
        let mut bytes = Vec::new();
        let mut left = head.size[1];
        while left > 0 {
            let strip = strips.next_strip()?;
            left = left.saturating_sub(strip.image.height);
            for row in 0..strip.image.height as usize {
                pack(&strip, row, depth, &mut bytes);
                rows.write_all(&bytes)?;
            }
        }
        Ok(strips.tree(head))
    })
}

/// The samples of a row, as the format has them.
pub(super) fn pack(strip: &Picture, row: usize, depth: BitDepth, bytes: &mut Vec<u8>) {
    let width = strip.image.width as usize;
    bytes.clear();
    for index in row * width..(row + 1) * width {
        let alpha = strip.alpha.as_ref().map(|alpha| f64::from(alpha[index]));
        let samples = strip.image.pixels[index].iter().copied().chain(alpha);
        if depth == BitDepth::Sixteen {
            bytes.extend(samples.flat_map(|v| color::quantize16(v).to_be_bytes()));
        } else {
            bytes.extend(samples.map(color::quantize8));
        }
    }
}

/// Pixels of 8 bits a channel, in rows from the top, as they are: red, green, blue, and opacity if
/// there is one.
///
/// # Panics
/// If there are not as many as width and height say.
#[must_use]
pub fn png_bytes(size: [u32; 2], has_alpha: bool, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let kind = (BitDepth::Eight, has_alpha);
    let write = |rows: &mut dyn Write| rows.write_all(pixels).map(|()| None);
    png(size, kind, None, &mut bytes, write).expect("the number of pixels matches the size");
    bytes
}

/// A PNG of the written rows, followed by the tree over their tiles if there is one; with a header,
/// the colour space and the provenance.
fn png(
    size: [u32; 2],
    kind: (BitDepth, bool),
    head: Option<&PictureHeader>,
    out: impl Write,
    write: impl FnOnce(&mut dyn Write) -> io::Result<Option<MerkleTree>>,
) -> io::Result<()> {
    let mut out = CheckedWriter { out, fault: None };
    let written = encode(&mut out, size, kind, head, write);
    out.fault.map_or(written, Err)
}

fn encode(
    out: impl Write,
    [width, height]: [u32; 2],
    (depth, has_alpha): (BitDepth, bool),
    head: Option<&PictureHeader>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<Option<MerkleTree>>,
) -> io::Result<()> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(if has_alpha {
        ColorType::Rgba
    } else {
        ColorType::Rgb
    });
    encoder.set_depth(depth);
    if head.is_some_and(|head| head.is_color) {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
    for (name, text) in head.into_iter().flat_map(|head| head.metadata.texts()) {
        encoder.add_itxt_chunk(name.to_owned(), text.to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer_with_size(CHUNK)?;
    let tree = write(&mut rows)?;
    rows.finish()?;
    if let Some(tree) = tree {
        writer.write_chunk(TREE, &tree.pruned().bytes())?;
    }
    writer.finish()?;
    Ok(())
}

/// Remembers the first error, since the encoder writes its last bytes where it can't return one.
struct CheckedWriter<W> {
    out: W,
    fault: Option<io::Error>,
}

impl<W: Write> Write for CheckedWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes);
        if let Err(fault) = &written
            && fault.kind() != io::ErrorKind::Interrupted
            && self.fault.is_none()
        {
            let error = fault.raw_os_error().map(io::Error::from_raw_os_error);
            self.fault = Some(error.unwrap_or_else(|| fault.kind().into()));
        }
        written
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, PictureMetadata};
    use super::*;

    fn ramp() -> Picture {
        let pixels = (0..35)
            .map(|i| [f64::from(i) / 34.0, 1.0 - f64::from(i) / 20.0, f64::NAN])
            .collect();
        Picture::opaque(Image {
            width: 7,
            height: 5,
            pixels,
        })
    }

    /// The pixels of a PNG, and its texts by their names.
    fn read(bytes: &[u8]) -> (Vec<u8>, Vec<(String, String)>) {
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes.to_vec()))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let texts = reader.info().utf8_text.iter();
        let texts = texts.map(|text| (text.keyword.clone(), text.get_text().unwrap()));
        (pixels, texts.collect())
    }

    #[test]
    fn where_it_came_from_is_read_and_changes_no_pixel() {
        let metadata = PictureMetadata {
            software: "rtc 1".into(),
            scene: "abc".into(),
            settings: "{\"size\":\"2×2→\"}".into(),
            ..PictureMetadata::default()
        };
        let encode = |metadata: PictureMetadata| {
            let head = PictureHeader {
                metadata,
                ..PictureHeader::of(&ramp(), FileFormat::Png8)
            };
            head.encode(&ramp()).unwrap()
        };
        let (before, none) = read(&encode(PictureMetadata::default()));
        let (after, texts) = read(&encode(metadata));
        assert_eq!((before, none), (after, Vec::new()));
        let expected = [
            ("Software", "rtc 1"),
            ("rtc:scene", "abc"),
            ("rtc:settings", "{\"size\":\"2×2→\"}"),
        ];
        let expected = expected.map(|(name, text)| (name.to_owned(), text.to_owned()));
        assert_eq!(texts, expected);
    }

    #[test]
    fn eight_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(FileFormat::Png8).unwrap()).unwrap();
        let expected: Vec<u8> = ramp()
            .image
            .pixels
            .iter()
            .flatten()
            .map(|&v| color::quantize8(v))
            .collect();
        assert_eq!(
            (
                (read.width(), read.height()),
                read.as_rgb8().unwrap().as_raw()
            ),
            ((7, 5), &expected)
        );
    }

    #[test]
    fn sixteen_bits_come_back() {
        let read = ::image::load_from_memory(&ramp().encode(FileFormat::Png16).unwrap()).unwrap();
        let expected: Vec<u16> = ramp()
            .image
            .pixels
            .iter()
            .flatten()
            .map(|&v| color::quantize16(v))
            .collect();
        assert_eq!(read.as_rgb16().unwrap().as_raw(), &expected);
    }

    #[test]
    fn opacity_comes_back_beside_the_colours() {
        let pixels = vec![[1.0, 0.5, 0.0]; 3];
        let mut picture = Picture::opaque(Image {
            width: 3,
            height: 1,
            pixels,
        });
        picture.alpha = Some(vec![0.0, 0.5, 1.0]);
        let read = |form| ::image::load_from_memory(&picture.encode(form).unwrap()).unwrap();
        let eight: Vec<u8> = [0, 127, 255]
            .into_iter()
            .flat_map(|alpha| [255, 127, 0, alpha])
            .collect();
        assert_eq!(read(FileFormat::Png8).as_rgba8().unwrap().as_raw(), &eight);
        let sixteen: Vec<u16> = [0, 32767, 65535]
            .into_iter()
            .flat_map(|alpha| [65535, 32767, 0, alpha])
            .collect();
        assert_eq!(
            read(FileFormat::Png16).as_rgba16().unwrap().as_raw(),
            &sixteen
        );
    }

    #[test]
    fn a_picture_is_of_srgb_and_tells_no_time() {
        let has = |bytes: &[u8], chunk: &str| bytes.windows(4).any(|w| w == chunk.as_bytes());
        let picture = ramp().encode(FileFormat::Png8).unwrap();
        assert!(has(&picture, "sRGB"));
        assert!(
            !["iCCP", "tIME", "tEXt", "iTXt"]
                .iter()
                .any(|chunk| has(&picture, chunk))
        );
        assert_eq!(picture, ramp().encode(FileFormat::Png8).unwrap());
        let numbers = png_bytes([1, 1], false, &[1, 2, 3]);
        assert!(!["sRGB", "gAMA"].iter().any(|chunk| has(&numbers, chunk)));
    }
}
