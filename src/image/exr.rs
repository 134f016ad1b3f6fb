//! EXR: floats of 32 or 16 bits per channel, unchanged except that they are finite, in one part,
//! with the chromaticities, the view, and the provenance.
//!
//! The encoder writes free attributes in a random order, and the Merkle tree is known last: once
//! the pixels are written, these attributes are written again, in their order.

use super::header::{BLOCK_ROWS, PictureHeader, StripSource};
use super::range::{is_half, narrow};
use super::{FileFormat, MerkleTree, Picture, PictureMetadata};
use ::exr::block::UncompressedBlock;
use ::exr::block::lines::LineRefMut;
use ::exr::block::writer::ChunksWriter;
use ::exr::error::{Error, UnitResult};
use ::exr::meta::attribute::{
    self, AttributeValue, ChannelDescription, Chromaticities, SampleType, Text,
};
use ::exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use ::exr::meta::{BlockDescription, attribute::LineOrder};
use ::exr::prelude::{Compression, Vec2, f16};
use std::borrow::Cow;
use std::io::{self, Seek, SeekFrom, Write};

/// The primaries of linear sRGB and its white, D65 (ITU-R BT.709-6, table 1, items 1.3 and 1.4).
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// The attribute of the Merkle tree, and its type.
pub(super) const TREE: &str = "rtc:tiles";
const TREE_TYPE: &str = "rtc:tree";

/// The bytes of a file before its header: the magic number and the version.
const PREAMBLE: u64 = 8;

/// The value of a pixel that a channel stores.
#[derive(Clone, Copy)]
pub(super) enum ChannelSource {
    /// A colour, by its index in the pixel.
    Color(usize),
    /// The opacity.
    Alpha,
    /// A value of the layers, by its index among those of the pixel.
    Layer(usize),
}

/// Writes a picture as EXR, block after block, as its strips come.
pub(super) fn write(
    head: &PictureHeader,
    out: impl Write + Seek,
    strips: &mut StripSource<'_>,
) -> io::Result<()> {
    write_file(head, out, strips).map_err(|error| match error {
        Error::Io(error) => error,
        other @ (Error::Aborted | Error::NotSupported(_) | Error::Invalid(_)) => {
            io::Error::other(other.to_string())
        }
    })
}

fn write_file(
    head: &PictureHeader,
    mut out: impl Write + Seek,
    strips: &mut StripSource<'_>,
) -> UnitResult {
    let sources = channels(head);
    let mut header = header(head, &sources);
    // The free attributes come before the 0 that ends the header.
    let mut others = Vec::new();
    header.write(&mut others)?;
    let start = PREAMBLE + others.len() as u64 - 1;
    let blank = head
        .has_tiles
        .then(|| vec![0; MerkleTree::length(head.size)]);
    header.own_attributes.other = free_attributes(head, blank).collect();
    ::exr::block::write(
        &mut out,
        [header].into_iter().collect(),
        true,
        |meta, chunks| {
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
                    let (name, source) = sources[line.location.channel];
                    let is_half = is_half(head.form, name);
                    let result = fill(&strip, rows.start, (source, is_half), line);
                    filled = std::mem::replace(&mut filled, Ok(())).and(result);
                };
                let data = UncompressedBlock::collect_block_data_from_lines(channels, block, fill);
                filled?;
                compressor.compress_block(index, UncompressedBlock { index: block, data })?;
            }
            Ok(())
        },
    )?;
    let tree = strips.tree(head).map(|tree| tree.bytes());
    out.seek(SeekFrom::Start(start))?;
    free_attributes(head, tree)
        .try_for_each(|(name, value)| attribute::write(name.as_slice(), &value, &mut out))
}

/// The attributes that the format does not know, in their order, with the bytes of the tree.
fn free_attributes(
    head: &PictureHeader,
    tree: Option<Vec<u8>>,
) -> impl Iterator<Item = (Text, AttributeValue)> {
    let words = |name, words: &str| {
        let value = (!words.is_empty()).then(|| AttributeValue::Text(text(words)));
        value.map(|value| (text(name), value))
    };
    let tree = tree.map(|bytes| {
        let (kind, bytes) = (text(TREE_TYPE), bytes.into());
        (text(TREE), AttributeValue::Custom { kind, bytes })
    });
    let all = [
        words("rtc:settings", &head.metadata.settings),
        tree,
        words("rtc:scene", &head.metadata.scene),
    ];
    all.into_iter().flatten()
}

/// The software and the view of the picture, and its channels in blocks of rows.
fn header(head: &PictureHeader, sources: &[(&str, ChannelSource)]) -> Header {
    const COMPRESSION: Compression = Compression::ZIP16;
    const _: () = assert!(BLOCK_ROWS == 16, "as many rows as ZIP16 has in a block");
    let PictureMetadata {
        software,
        world_to_camera,
        ..
    } = &head.metadata;
    let [width, height] = head.size.map(|side| side as usize);
    let size = (width, height);
    // Attributes belong to the layer or to the whole image.
    let attributes = LayerAttributes {
        software_name: (!software.is_empty()).then(|| text(software)),
        world_to_camera: *world_to_camera,
        ..LayerAttributes::default()
    };
    let shared = ImageAttributes {
        chromaticities: Some(REC_709),
        ..ImageAttributes::with_size(size)
    };
    // Each channel has 16 or 32 bits.
    let channels = sources.iter().map(|(name, _)| {
        let kind = if is_half(head.form, name) {
            SampleType::F16
        } else {
            SampleType::F32
        };
        ChannelDescription::named(*name, kind)
    });
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
pub(super) fn channels(head: &PictureHeader) -> Vec<(&str, ChannelSource)> {
    let colors = ["R", "G", "B"].into_iter().enumerate();
    let colors = colors.map(|(k, name)| (name, ChannelSource::Color(k)));
    let alpha = head.has_alpha.then_some(("A", ChannelSource::Alpha));
    let layers = head.layers.iter().enumerate();
    let layers = layers.map(|(k, name)| (name.as_ref(), ChannelSource::Layer(k)));
    let mut all: Vec<_> = colors.chain(alpha).chain(layers).collect();
    all.sort_unstable_by_key(|(name, _)| *name);
    all
}

/// The source of each channel, and whether it has floats of 16 bits, in the same order.
pub(super) fn formats(head: &PictureHeader) -> Vec<(ChannelSource, bool)> {
    let channels = channels(head).into_iter();
    channels
        .map(|(name, source)| (source, is_half(head.form, name)))
        .collect()
}

/// Fills a row of one channel, in floats of 16 bits or not, from the strip whose first row is
/// given.
fn fill(
    strip: &Picture,
    top: usize,
    (source, is_half): (ChannelSource, bool),
    line: LineRefMut<'_>,
) -> UnitResult {
    let row = line.location.position.y() - top;
    if row >= strip.image.height as usize {
        return Err(Error::Invalid("a strip ends within a block".into()));
    }
    let first = row * strip.image.width as usize;
    let value = |column: usize| value(strip, first + column, (source, is_half));
    if is_half {
        // From 32 bits, as all machines round those alike.
        line.write_samples(|column| f16::from_f32(value(column)))
    } else {
        line.write_samples(value)
    }
}

/// The value of a pixel in a channel, of floats of 16 bits or not.
fn value(strip: &Picture, pixel: usize, (source, is_half): (ChannelSource, bool)) -> f32 {
    let width = strip.layers.names.len();
    let value = match source {
        ChannelSource::Color(k) => strip.image.pixels[pixel][k],
        ChannelSource::Alpha => f64::from(strip.alpha.as_ref().map_or(1.0, |a| a[pixel])),
        ChannelSource::Layer(k) => f64::from(strip.layers.values[pixel * width + k]),
    };
    narrow(value, is_half)
}

/// The samples of a picture, pixel after pixel, each in the order of its channels, little-endian.
pub(super) fn samples(picture: &Picture, form: FileFormat) -> Vec<u8> {
    let head = PictureHeader::of(picture, form);
    let channels = formats(&head);
    let mut bytes = Vec::new();
    for pixel in 0..picture.image.pixels.len() {
        for channel in &channels {
            let value = value(picture, pixel, *channel);
            match channel.1 {
                true => bytes.extend(f16::from_f32(value).to_le_bytes()),
                false => bytes.extend(value.to_le_bytes()),
            }
        }
    }
    bytes
}

/// The colour and the opacity of a pixel whose samples are those of [`samples`], and the values of
/// its layers, which are put into `layers`; `None` if it has another number of bytes.
pub(super) fn unpacked(
    channels: &[(ChannelSource, bool)],
    mut bytes: &[u8],
    layers: &mut [f32],
) -> Option<([f64; 3], f32)> {
    let (mut color, mut alpha) = ([0.0; 3], 1.0);
    for (source, is_half) in channels {
        let value;
        if *is_half {
            let (half, rest) = bytes.split_first_chunk()?;
            (value, bytes) = (f16::from_le_bytes(*half).to_f32(), rest);
        } else {
            let (float, rest) = bytes.split_first_chunk()?;
            (value, bytes) = (f32::from_le_bytes(*float), rest);
        }
        match *source {
            ChannelSource::Color(k) => color[k] = f64::from(value),
            ChannelSource::Alpha => alpha = value,
            ChannelSource::Layer(k) => layers[k] = value,
        }
    }
    bytes.is_empty().then_some((color, alpha))
}

/// EXR text is Latin-1; other characters become question marks.
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
    use super::super::{Image, PixelLayers};
    use super::*;
    use ::exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
    use std::io::Cursor;

    fn bright() -> (Picture, PictureHeader) {
        let pixels = vec![
            [0.0, 0.5, 1.0],
            [2.5, -1.0, 1e30],
            [0.1, f64::INFINITY, 1e-3],
            [3.0, 4.0, 5.0],
        ];
        let picture = Picture::opaque(Image {
            width: 2,
            height: 2,
            pixels,
        });
        let mut head = PictureHeader::of(&picture, FileFormat::Exr);
        head.metadata = PictureMetadata {
            software: "rtc 1".into(),
            scene: "abc".into(),
            settings: "{\"size\":\"2×2→\"}".into(),
            world_to_camera: Some([0.5; 16]),
            layer: String::new(),
        };
        (picture, head)
    }

    #[test]
    fn floats_and_attributes_come_back() {
        let (picture, head) = bright();
        let bytes = head.encode(&picture).unwrap();
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
            .map(|pixel| pixel.map(|value| narrow(value, false)))
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
        let view = read.layer_data.attributes.world_to_camera;
        assert_eq!(view, Some([0.5; 16]));
        assert_eq!(read.attributes.chromaticities, Some(REC_709));
    }

    #[test]
    fn channels_of_layers_are_named_and_keep_their_pixels() {
        let (mut picture, _) = bright();
        picture.alpha = Some(vec![0.0, 0.25, 0.5, 1.0]);
        let values = (0..12_u8).map(f32::from).collect();
        picture.layers = PixelLayers {
            names: vec!["uv.U", "uv.V", "depth.Z"],
            values,
        };
        let bytes = picture.encode(FileFormat::Exr).unwrap();
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
    fn half_floats_are_the_nearest_and_distances_keep_32_bits() {
        let (mut picture, _) = bright();
        picture.layers = PixelLayers {
            names: vec!["depth.Z", "normal.X"],
            values: [70_001.0, 0.1].repeat(4),
        };
        let bytes = picture.encode(FileFormat::ExrHalf).unwrap();
        let reader = read().no_deep_data().largest_resolution_level();
        let reader = reader.all_channels().first_valid_layer().all_attributes();
        let read = reader.from_buffered(Cursor::new(bytes)).unwrap();
        let channel = |name: &str| {
            let mut list = read.layer_data.channel_data.list.iter();
            let found = list.find(|channel| channel.name == text(name)).unwrap();
            let samples = &found.sample_data;
            let is_half = matches!(samples, FlatSamples::F16(_));
            (is_half, samples.values_as_f32().collect::<Vec<_>>())
        };
        let half = |values: [f32; 4]| values.map(|value| f16::from_f32(value).to_f32()).to_vec();
        let blue = half([1.0, 65_504.0, 1e-3, 5.0]);
        assert_eq!(channel("B"), (true, blue));
        assert_eq!(channel("G").1[2], 65_504.0);
        assert_eq!(channel("normal.X"), (true, half([0.1; 4])));
        assert_eq!(channel("depth.Z"), (false, vec![70_001.0; 4]));
    }

    #[test]
    fn the_same_picture_is_the_same_bytes() {
        let (picture, head) = bright();
        let first = head.encode(&picture).unwrap();
        assert!((0..16).all(|_| head.encode(&picture).unwrap() == first));
        assert!(!first.windows(8).any(|window| window == b"capDate\0"));
    }
}
