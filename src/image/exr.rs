//! EXR: 32-bit floats per channel, as they are but finite, in one part, with where the picture came
//! from as text attributes.
//!
//! The encoder keeps free attributes in hashed maps, whose order changes from run to run; each map
//! here holds one.

use super::file::{BLOCK_ROWS, PictureHead, StripSource};
use super::range::narrow;
use super::{Origin, Picture};
use ::exr::block::UncompressedBlock;
use ::exr::block::lines::LineRefMut;
use ::exr::block::writer::ChunksWriter;
use ::exr::error::{Error, UnitResult};
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType, Text};
use ::exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use ::exr::meta::{BlockDescription, attribute::LineOrder};
use ::exr::prelude::Compression;
use std::borrow::Cow;
use std::io::{self, Seek, Write};

/// Which number of a pixel a channel holds.
#[derive(Clone, Copy)]
enum ChannelSource {
    /// A colour, by its place in the pixel.
    Color(usize),
    /// The opacity.
    Alpha,
    /// A number of the layers, by its place among those of the pixel.
    Layer(usize),
}

/// Writes a picture as EXR, block after block, as its strips come.
pub(super) fn write(
    head: &PictureHead,
    origin: &Origin,
    out: impl Write + Seek,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    let sources = channels(head);
    let header = header(head, origin, &sources);
    let written = ::exr::block::write(out, [header].into_iter().collect(), true, |meta, chunks| {
        let mut compressor = chunks.sequential_blocks_compressor(&meta);
        // The strip under way, and the rows it has.
        let (mut strip, mut rows) = (Cow::Owned(Picture::default()), 0..0);
        for (index, block) in meta.enumerate_ordered_header_block_indices() {
            while block.pixel_position.y() >= rows.end {
                // Two strips are not held at once.
                drop(strip);
                strip = strips.next_strip()?;
                rows = rows.end..rows.end + strip.image.height as usize;
            }
            let mut filled = Ok(());
            let channels = &meta.headers[0].channels;
            let fill = |line: LineRefMut<'_>| {
                let source = sources[line.location.channel].1;
                let result = fill(&strip, rows.start, source, line);
                filled = std::mem::replace(&mut filled, Ok(())).and(result);
            };
            let data = UncompressedBlock::collect_block_data_from_lines(channels, block, fill);
            filled?;
            compressor.compress_block(index, UncompressedBlock { index: block, data })?;
        }
        Ok(())
    });
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other @ (Error::Aborted | Error::NotSupported(_) | Error::Invalid(_)) => {
            io::Error::other(other.to_string())
        }
    })
}

/// Where the picture comes from, and its channels in blocks of so many rows.
fn header(head: &PictureHead, origin: &Origin, sources: &[(&str, ChannelSource)]) -> Header {
    const COMPRESSION: Compression = Compression::ZIP16;
    const _: () = assert!(BLOCK_ROWS == 16, "as many rows as ZIP16 has in a block");
    let Origin {
        software,
        scene,
        settings,
    } = origin;
    let [width, height] = head.size.map(|side| side as usize);
    let size = (width, height);
    let attributes = LayerAttributes {
        software_name: Some(text(software)),
        other: [(text("rtc:settings"), AttributeValue::Text(text(settings)))].into(),
        ..LayerAttributes::default()
    };
    let shared = ImageAttributes {
        other: [(text("rtc:scene"), AttributeValue::Text(text(scene)))].into(),
        ..ImageAttributes::with_size(size)
    };
    let channels = sources
        .iter()
        .map(|(name, _)| ChannelDescription::named(*name, SampleType::F32));
    Header::new(Text::default(), size, channels.collect())
        .with_encoding(
            COMPRESSION,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_attributes(attributes)
        .with_shared_attributes(shared)
}

/// All channels, in the order of their names, as the format wants them.
fn channels(head: &PictureHead) -> Vec<(&'static str, ChannelSource)> {
    let colors = ["R", "G", "B"].into_iter().enumerate();
    let colors = colors.map(|(k, name)| (name, ChannelSource::Color(k)));
    let alpha = head.has_alpha.then_some(("A", ChannelSource::Alpha));
    let layers = head.layers.iter().enumerate();
    let layers = layers.map(|(k, name)| (*name, ChannelSource::Layer(k)));
    let mut all: Vec<_> = colors.chain(alpha).chain(layers).collect();
    all.sort_by_key(|(name, _)| *name);
    all
}

/// Fills a row of one channel from the strip whose first row is given.
fn fill(strip: &Picture, top: usize, source: ChannelSource, line: LineRefMut<'_>) -> UnitResult {
    let row = line.location.position.y() - top;
    if row >= strip.image.height as usize {
        return Err(Error::Invalid("a strip ends within a block".into()));
    }
    let first = row * strip.image.width as usize;
    let width = strip.layers.names.len();
    line.write_samples(|column| {
        let pixel = first + column;
        match source {
            ChannelSource::Color(k) => narrow(strip.image.pixels[pixel][k]),
            ChannelSource::Alpha => strip.alpha.as_ref().map_or(1.0, |alpha| alpha[pixel]),
            ChannelSource::Layer(k) => narrow(f64::from(strip.layers.values[pixel * width + k])),
        }
    })
}

/// EXR text is Latin-1; what is not becomes a question mark.
fn text(words: &str) -> Text {
    Text::new_or_none(words).unwrap_or_else(|| {
        let latin = words
            .chars()
            .map(|c| if u32::from(c) < 256 { c } else { '?' });
        Text::from(latin.collect::<String>().as_str())
    })
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image, Layers};
    use super::*;
    use ::exr::prelude::{ReadChannels, ReadLayers, Vec2, read};
    use std::io::Cursor;

    fn bright() -> (Picture, FileFormat) {
        let pixels = vec![
            [0.0, 0.5, 1.0],
            [2.5, -1.0, 1e30],
            [0.1, f64::INFINITY, 1e-3],
            [3.0, 4.0, 5.0],
        ];
        let origin = Origin {
            software: "rtc 1".into(),
            scene: "abc".into(),
            settings: "{\"size\":\"2×2→\"}".into(),
        };
        (
            Picture::opaque(Image {
                width: 2,
                height: 2,
                pixels,
            }),
            FileFormat::Exr(origin),
        )
    }

    #[test]
    fn floats_and_attributes_come_back() {
        let (picture, form) = bright();
        let bytes = picture.encode(&form).unwrap();
        let read = read()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| vec![[0.0f32; 3]; size.area()],
                |pixels: &mut Vec<[f32; 3]>, at: Vec2<usize>, (r, g, b): (f32, f32, f32)| {
                    pixels[at.y() * 2 + at.x()] = [r, g, b];
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap();
        let expected: Vec<[f32; 3]> = picture
            .image
            .pixels
            .iter()
            .map(|pixel| pixel.map(narrow))
            .collect();
        assert_eq!(read.layer_data.channel_data.pixels, expected);
        assert_eq!(
            read.layer_data.attributes.software_name,
            Some(text("rtc 1"))
        );
        let attribute = |name| {
            read.layer_data.attributes.other[&text(name)]
                .clone()
                .into_text()
                .unwrap()
                .to_string()
        };
        assert_eq!(
            [attribute("rtc:scene"), attribute("rtc:settings")],
            ["abc", "{\"size\":\"2×2?\"}"]
        );
    }

    #[test]
    fn channels_of_layers_are_named_and_keep_their_pixels() {
        let (mut picture, form) = bright();
        picture.alpha = Some(vec![0.0, 0.25, 0.5, 1.0]);
        let values = (0..12_u8).map(f32::from).collect();
        picture.layers = Layers {
            names: vec!["uv.U", "uv.V", "depth.Z"],
            values,
        };
        let bytes = picture.encode(&form).unwrap();
        let reader = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer();
        let read = reader
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap();
        let list = read.layer_data.channel_data.list;
        let names: Vec<_> = list
            .iter()
            .map(|channel| channel.name.to_string())
            .collect();
        assert_eq!(names, ["A", "B", "G", "R", "depth.Z", "uv.U", "uv.V"]);
        let values = |k: usize| list[k].sample_data.values_as_f32().collect::<Vec<_>>();
        assert_eq!(
            [values(0), values(4), values(5)],
            [
                [0.0, 0.25, 0.5, 1.0],
                [2.0, 5.0, 8.0, 11.0],
                [0.0, 3.0, 6.0, 9.0]
            ]
        );
    }

    #[test]
    fn the_same_picture_is_the_same_bytes() {
        let (picture, form) = bright();
        let first = picture.encode(&form).unwrap();
        assert!((0..16).all(|_| picture.encode(&form).unwrap() == first));
        assert!(!first.windows(8).any(|window| window == b"capDate\0"));
    }
}
