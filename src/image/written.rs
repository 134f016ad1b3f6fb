//! Picture files of this program, read back exactly: every bit of their samples, and their
//! provenance.

use super::decode::{DecodeCost, DecodeError, ImageSize};
use super::png::{TREE as TREE_CHUNK, pack};
use super::{
    BLOCK_ROWS, FileFormat, Image, MerkleTree, OpacityUse, Picture, PictureHeader, PictureMetadata,
    PixelFile, PixelLayers, StripSource, exr, is_radiance, xmp,
};
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{AttributeValue, SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use ::png::{BitDepth, ColorType, Decoder, Limits};
use image_webp::WebPDecoder;
use std::borrow::Cow;
use std::io::{self, Cursor};

/// The message for a file of another program.
const FOREIGN: DecodeError = DecodeError::Unsupported("picture of another program");

/// A picture file whose header was read.
pub struct WrittenFile<'a> {
    bytes: &'a [u8],
    cost: DecodeCost,
}

/// The contents of a picture file.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenPicture {
    /// The form of the file.
    pub form: FileFormat,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether it has opacities.
    has_alpha: bool,
    /// Whether the file has the bytes that this program writes for it. Others may hold what changes
    /// how viewers show it: further frames, colour profiles, an orientation.
    pub is_exact: bool,
    /// The names of its channels but for red, green, blue and opacity, in the order of the file.
    pub layers: Vec<String>,
    /// Its provenance.
    pub metadata: PictureMetadata,
    /// The tree over the tiles of its film, if it has one.
    pub tree: Option<MerkleTree>,
    /// The samples, pixel after pixel.
    samples: Vec<u8>,
}

impl<'a> WrittenFile<'a> {
    /// Reads the header of a PNG, WebP or EXR of at most this many pixels.
    ///
    /// # Errors
    /// If the bytes are no such file, its header is damaged or has more pixels.
    pub fn open(bytes: &'a [u8], most_pixels: u64) -> Result<Self, DecodeError> {
        let cost = if is_radiance(bytes) {
            let header = header(bytes)?;
            let [width, height] = size_of(&header);
            let pixels = ImageSize::within(most_pixels, width, height)?.pixels();
            let channels = header.channels.list.len() as u64;
            DecodeCost {
                pixels,
                memory: pixels.saturating_mul(12).saturating_mul(channels),
                scratch: (header.max_block_byte_size() as u64).saturating_mul(3),
            }
        } else {
            let cost = PixelFile::open(bytes, OpacityUse::Kept, most_pixels)?.cost();
            DecodeCost {
                memory: cost.memory.saturating_mul(3),
                ..cost
            }
        };
        Ok(Self { bytes, cost })
    }

    /// What decoding it will take.
    #[must_use]
    pub fn cost(&self) -> DecodeCost {
        self.cost
    }

    /// Decodes it.
    ///
    /// # Errors
    /// If the file is damaged or of a form that this program does not write.
    pub fn decode(self) -> Result<WrittenPicture, DecodeError> {
        let picture = match self.bytes {
            [0x89, b'P', ..] => read_png(self.bytes),
            [0xff, 0xd8, ..] => Err(DecodeError::Unsupported("JPEG, with losses")),
            [b'R', b'I', b'F', b'F', ..] => read_webp(self.bytes),
            _ if is_radiance(self.bytes) => read_exr(self.bytes),
            _ => Err(FOREIGN),
        }?;
        let is_exact = picture.encoded().is_ok_and(|own| own == self.bytes);
        Ok(WrittenPicture {
            is_exact,
            ..picture
        })
    }
}

impl WrittenPicture {
    /// The samples of a rectangle: its first column and row, and its width and height, all within
    /// the picture; in the order of [`samples`].
    #[must_use]
    pub fn part(&self, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Vec<u8> {
        let row = self.samples.len() / (self.size[1] as usize).max(1);
        let pixel = row / (self.size[0] as usize).max(1);
        let columns = left as usize * pixel..(left + width) as usize * pixel;
        let rows = self.samples.chunks_exact(row.max(1));
        let rows = rows.skip(top as usize).take(height as usize);
        rows.flat_map(|row| &row[columns.clone()])
            .copied()
            .collect()
    }
}

impl WrittenPicture {
    /// The file that this program writes of it.
    fn encoded(&self) -> io::Result<Vec<u8>> {
        let layers = self.layers.iter().cloned().map(Cow::Owned);
        let head = PictureHeader {
            size: self.size,
            has_alpha: self.has_alpha,
            layers: layers.collect(),
            form: self.form,
            is_color: true,
            metadata: self.metadata.clone(),
            has_tiles: self.tree.is_some(),
        };
        let mut top = 0;
        let mut next = || {
            let rows = BLOCK_ROWS.min(self.size[1] - top);
            let strip = self.strip(&head, top, rows);
            top += rows;
            strip.map(Cow::Owned)
        };
        let mut file = Cursor::new(Vec::new());
        let strips = StripSource::new(&mut next).with_tree(self.tree.clone());
        head.write(&mut file, strips)?;
        Ok(file.into_inner())
    }

    /// Some of its rows, as a picture that has the samples of the file.
    fn strip(&self, head: &PictureHeader, top: u32, rows: u32) -> io::Result<Picture> {
        let count = self.size[0] as usize * rows as usize;
        let samples = self.part([0, top], [self.size[0], rows]);
        let (channels, traits) = (exr::formats(head), self.form.traits());
        let mut pixels = Vec::with_capacity(count);
        let mut opacities = Vec::with_capacity(count);
        let mut values = Vec::with_capacity(count * head.layers.len());
        for pixel in samples.chunks_exact((samples.len() / count).max(1)) {
            let before = values.len();
            values.resize(before + head.layers.len(), 0.0);
            let read = match traits.is_linear {
                true => exr::unpacked(&channels, pixel, &mut values[before..]),
                false => display_values(pixel, traits.bits == 16),
            };
            let (color, opacity) = read.ok_or(io::ErrorKind::InvalidData)?;
            pixels.push(color);
            opacities.push(opacity);
        }
        let image = Image {
            width: self.size[0],
            height: rows,
            pixels,
        };
        Ok(Picture {
            alpha: self.has_alpha.then_some(opacities),
            layers: PixelLayers {
                names: vec![""; head.layers.len()],
                values,
            },
            ..Picture::opaque(image)
        })
    }
}

/// The colour and the opacity of a pixel of 8 or 16 bits a channel, in the middle between those
/// that are stored alike; it has no layers.
fn display_values(samples: &[u8], is_deep: bool) -> Option<([f64; 3], f32)> {
    let value = |channel: usize| {
        let (number, most) = match is_deep {
            true => {
                let pair = samples.as_chunks::<2>().0.get(channel)?;
                (u16::from_be_bytes(*pair), u16::MAX)
            }
            false => (u16::from(*samples.get(channel)?), u16::from(u8::MAX)),
        };
        Some((f64::from(number) + 0.5) / f64::from(most))
    };
    let color = [value(0)?, value(1)?, value(2)?];
    #[expect(
        clippy::cast_possible_truncation,
        reason = "steps of 16 bits are far apart"
    )]
    let opacity = value(3).map_or(1.0, |value| value as f32);
    Some((color, opacity))
}

/// The samples of a picture as a file of this format stores them, pixel by pixel: of a PNG in the
/// order of its bytes, of an EXR its channels by name, little-endian.
#[must_use]
pub fn samples(picture: &Picture, form: FileFormat) -> Vec<u8> {
    let traits = form.traits();
    if traits.is_linear {
        return exr::samples(picture, form);
    }
    let depth = match traits.bits {
        16 => BitDepth::Sixteen,
        _ => BitDepth::Eight,
    };
    let (mut all, mut bytes) = (Vec::new(), Vec::new());
    for row in 0..picture.image.height as usize {
        pack(picture, row, depth, &mut bytes);
        all.extend_from_slice(&bytes);
    }
    all
}

fn read_png(bytes: &[u8]) -> Result<WrittenPicture, DecodeError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: usize::MAX });
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(DecodeError::damaged)?;
    let length = reader.output_buffer_size().ok_or(FOREIGN)?;
    let mut samples = vec![0; length];
    reader
        .next_frame(&mut samples)
        .map_err(DecodeError::damaged)?;
    let info = reader.info();
    let form = match (info.color_type, info.bit_depth) {
        (ColorType::Rgb | ColorType::Rgba, BitDepth::Eight) => FileFormat::Png8,
        (ColorType::Rgb | ColorType::Rgba, BitDepth::Sixteen) => FileFormat::Png16,
        _ => return Err(FOREIGN),
    };
    let text = |name: &str| {
        let mut texts = info.utf8_text.iter();
        let found = texts.find(|text| text.keyword == name).cloned();
        // A text that was compressed is read up to 2 MiB.
        let read = found.and_then(|mut text| {
            text.decompress_text().ok()?;
            text.get_text().ok()
        });
        read.unwrap_or_default()
    };
    Ok(WrittenPicture {
        form,
        size: [info.width, info.height],
        has_alpha: info.color_type == ColorType::Rgba,
        is_exact: false,
        layers: Vec::new(),
        metadata: PictureMetadata {
            software: text("Software"),
            scene: text("rtc:scene"),
            settings: text("rtc:settings"),
            world_to_camera: None,
            layer: text("rtc:layer"),
        },
        tree: chunk(bytes, TREE_CHUNK.0).and_then(MerkleTree::read),
        samples,
    })
}

/// The content of the first chunk of this name, if it fits its checksum.
fn chunk(png: &[u8], name: [u8; 4]) -> Option<&[u8]> {
    let mut rest = png.get(8..)?;
    loop {
        let (length, after) = rest.split_first_chunk()?;
        let length = u32::from_be_bytes(*length) as usize;
        let (named, after) = after.split_at_checked(length.checked_add(4)?)?;
        let (sum, after) = after.split_first_chunk()?;
        if named.starts_with(&name) {
            let fits = crc32fast::hash(named) == u32::from_be_bytes(*sum);
            return fits.then(|| &named[4..]);
        }
        rest = after;
    }
}

fn read_webp(bytes: &[u8]) -> Result<WrittenPicture, DecodeError> {
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(DecodeError::damaged)?;
    if decoder.is_animated() || decoder.is_lossy() {
        return Err(FOREIGN);
    }
    let mut samples = vec![0; decoder.output_buffer_size().ok_or(FOREIGN)?];
    decoder
        .read_image(&mut samples)
        .map_err(DecodeError::damaged)?;
    let packet = decoder.xmp_metadata().map_err(DecodeError::damaged)?;
    let (metadata, tree) = xmp::read(&packet.unwrap_or_default());
    Ok(WrittenPicture {
        form: FileFormat::Webp,
        size: decoder.dimensions().into(),
        has_alpha: decoder.has_alpha(),
        is_exact: false,
        layers: Vec::new(),
        metadata,
        tree,
        samples,
    })
}

/// The header of an EXR of one layer.
fn header(bytes: &[u8]) -> Result<Header, DecodeError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false);
    let mut headers = meta.map_err(DecodeError::damaged)?.headers.into_iter();
    let first = headers.next().ok_or(FOREIGN)?;
    let is_plain = headers.next().is_none() && !first.deep;
    is_plain.then_some(first).ok_or(FOREIGN)
}

/// The sides of a layer in pixels.
fn size_of(header: &Header) -> [u32; 2] {
    let size = header.layer_size;
    [size.0, size.1].map(|side| u32::try_from(side).unwrap_or(u32::MAX))
}

fn read_exr(bytes: &[u8]) -> Result<WrittenPicture, DecodeError> {
    // Read all channels of the first layer.
    let header = header(bytes)?;
    let size = size_of(&header);
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes();
    let image = reader
        .from_buffered(Cursor::new(bytes))
        .map_err(DecodeError::damaged)?;
    let channels = &image.layer_data.channel_data.list;
    let names = channels.iter().map(|channel| channel.name.to_string());
    // Concatenate the samples pixel by pixel, channels in the order of the file.
    let mut samples = Vec::new();
    for pixel in 0..size[0] as usize * size[1] as usize {
        for channel in channels {
            match &channel.sample_data {
                FlatSamples::F16(values) => samples.extend(values[pixel].to_le_bytes()),
                FlatSamples::F32(values) => samples.extend(values[pixel].to_le_bytes()),
                FlatSamples::U32(values) => samples.extend(values[pixel].to_le_bytes()),
            }
        }
    }
    // Read the metadata from the attributes.
    let own = &header.own_attributes;
    let attribute = |name: &str| own.other.get(&Text::from(name));
    let words = |name| match attribute(name) {
        Some(AttributeValue::Text(words)) => words.to_string(),
        _ => String::new(),
    };
    let tree = match attribute(exr::TREE) {
        Some(AttributeValue::Custom { bytes, .. }) => MerkleTree::read(bytes),
        _ => None,
    };
    // The red channel tells the precision; further channels are layers.
    let is_layer = |name: &String| !["R", "G", "B", "A"].contains(&name.as_str());
    let red = header
        .channels
        .list
        .iter()
        .find(|channel| channel.name == *"R");
    Ok(WrittenPicture {
        form: match red.map(|red| red.sample_type) {
            Some(SampleType::F32) => FileFormat::Exr,
            Some(SampleType::F16) => FileFormat::ExrHalf,
            _ => return Err(FOREIGN),
        },
        size,
        has_alpha: channels.iter().any(|channel| channel.name == *"A"),
        is_exact: false,
        layers: names.filter(is_layer).collect(),
        metadata: PictureMetadata {
            software: own
                .software_name
                .as_ref()
                .map(ToString::to_string)
                .unwrap_or_default(),
            scene: words("rtc:scene"),
            settings: words("rtc:settings"),
            world_to_camera: own.world_to_camera,
            layer: String::new(),
        },
        tree,
        samples,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{TileHash, tile_count};
    use super::*;
    use ::png::text_metadata::ITXtChunk;

    const SIZE: [u32; 2] = [37, 21];

    const FORMS: [FileFormat; 5] = [
        FileFormat::Png8,
        FileFormat::Png16,
        FileFormat::Webp,
        FileFormat::Exr,
        FileFormat::ExrHalf,
    ];

    /// A picture with opacity, in an EXR with layers.
    fn picture(form: FileFormat) -> Picture {
        let pixels = 0..SIZE[0] * SIZE[1];
        let color = |at: u32| [0.001 * f64::from(at), 0.5, f64::from(at % 7) / 6.0];
        let layers = match form.is_linear() {
            true => PixelLayers {
                names: vec!["normal.X", "depth.Z"],
                values: pixels.clone().flat_map(|at| [0.5, at as f32]).collect(),
            },
            false => PixelLayers::default(),
        };
        Picture {
            image: Image {
                width: SIZE[0],
                height: SIZE[1],
                pixels: pixels.clone().map(color).collect(),
            },
            alpha: Some(pixels.map(|at| (at % 11) as f32 / 10.0).collect()),
            layers,
            tiles: (0..tile_count(SIZE))
                .map(|tile| TileHash::of_tile(&tile.to_le_bytes()))
                .collect(),
        }
    }

    fn head(picture: &Picture, form: FileFormat) -> PictureHeader {
        PictureHeader {
            metadata: PictureMetadata {
                software: "rtc 1".into(),
                scene: "abc".into(),
                settings: "{\"a\":[1,\"&<\"]}".into(),
                world_to_camera: form.is_linear().then_some([0.5; 16]),
                layer: String::new(),
            },
            ..PictureHeader::of(picture, form)
        }
    }

    fn decoded(bytes: &[u8]) -> WrittenPicture {
        WrittenFile::open(bytes, 1 << 20).unwrap().decode().unwrap()
    }

    #[test]
    fn what_is_written_is_read_back_in_every_form() {
        for form in FORMS {
            let picture = picture(form);
            let head = head(&picture, form);
            let bytes = head.encode(&picture).unwrap();
            assert!(
                (0..8).all(|_| head.encode(&picture).unwrap() == bytes),
                "{form:?}"
            );
            let written = decoded(&bytes);
            assert_eq!((written.form, written.size), (form, SIZE));
            assert!(written.is_exact, "{form:?}");
            assert_eq!(written.metadata, head.metadata, "{form:?}");
            let tree = MerkleTree::new(picture.tiles.clone(), &head.metadata);
            assert_eq!(written.tree, Some(tree), "{form:?}");
            assert_eq!(
                written.part([0, 0], SIZE),
                samples(&picture, form),
                "{form:?}"
            );
            let layers: &[&str] = match form.is_linear() {
                true => &["depth.Z", "normal.X"],
                false => &[],
            };
            assert_eq!(written.layers, layers);
        }
    }

    /// A PNG with one more chunk before its pixels, or behind the tree.
    fn with_chunk(png: &[u8], name: [u8; 4], content: &[u8], is_first: bool) -> Vec<u8> {
        let before: &[u8; 4] = if is_first { b"IDAT" } else { b"IEND" };
        let at = png.windows(4).position(|word| word == before).unwrap() - 4;
        let named = [&name, content].concat();
        let length = u32::try_from(content.len()).unwrap().to_be_bytes();
        let sum = crc32fast::hash(&named).to_be_bytes();
        [&png[..at], &length, &named, &sum, &png[at..]].concat()
    }

    #[test]
    fn a_file_that_holds_more_than_its_picture_is_not_exact() {
        for form in FORMS {
            let picture = picture(form);
            let sound = head(&picture, form).encode(&picture).unwrap();
            let mut others = vec![[&sound[..], b"x"].concat(), [&sound[..], &sound].concat()];
            if matches!(form, FileFormat::Png8 | FileFormat::Png16) {
                let chunks: [([u8; 4], &[u8]); 9] = [
                    (*b"acTL", &[0, 0, 0, 1, 0, 0, 0, 0]),
                    (*b"gAMA", &[0, 15, 66, 64]),
                    (*b"cICP", &[9, 16, 0, 1]),
                    (*b"bKGD", &[0, 255, 0, 0, 0, 0]),
                    (*b"pHYs", &[0, 0, 0, 1, 0, 0, 3, 232, 0]),
                    (
                        *b"eXIf",
                        b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x03\0\0",
                    ),
                    (*b"iCCP", b"a\0\0x\x9c\x03\0\0\0\0\x01"),
                    (*b"tEXt", b"a\0b"),
                    (*b"rtMT", &[1]),
                ];
                others.extend(chunks.iter().flat_map(|(name, content)| {
                    [true, false].map(|is_first| with_chunk(&sound, *name, content, is_first))
                }));
            } else if form == FileFormat::Webp {
                let mut more = sound.clone();
                more.extend(b"EXIF\x04\0\0\0MM\0*");
                let length = u32::try_from(more.len() - 8).unwrap();
                more[4..8].copy_from_slice(&length.to_le_bytes());
                others.push(more);
                // The orientation within the text of its provenance.
                let old = b"rdf:about=\"\"";
                let at = sound
                    .windows(old.len())
                    .position(|word| word == old)
                    .unwrap();
                let mut turned = sound.clone();
                turned[at..at + old.len()].copy_from_slice(b"xmp:Rota=\"3\"");
                others.push(turned);
            } else {
                // Another white, and pixels that are not square: floats in the head.
                for float in [0.3127_f32, 1.0] {
                    let at = sound
                        .windows(4)
                        .position(|word| word == float.to_le_bytes());
                    let mut changed = sound.clone();
                    changed[at.unwrap()..][..4].copy_from_slice(&0.5_f32.to_le_bytes());
                    others.push(changed);
                }
            }
            for other in others {
                let read = WrittenFile::open(&other, 1 << 20).and_then(WrittenFile::decode);
                assert!(!read.is_ok_and(|read| read.is_exact), "{form:?}");
            }
        }
    }

    #[test]
    fn a_part_is_that_of_the_picture() {
        for form in FORMS {
            let picture = picture(form);
            let written = decoded(&picture.encode(form).unwrap());
            let (all, pixels) = (samples(&picture, form), (SIZE[0] * SIZE[1]) as usize);
            let pixel = all.len() / pixels;
            let at = |x: usize, y: usize| &all[(y * SIZE[0] as usize + x) * pixel..][..pixel];
            let expected = [at(32, 16), at(33, 16), at(32, 17), at(33, 17)].concat();
            assert_eq!(written.part([32, 16], [2, 2]), expected, "{form:?}");
        }
    }

    #[test]
    fn without_hashes_a_file_says_no_more_than_before() {
        for form in FORMS {
            let mut picture = picture(form);
            picture.tiles.clear();
            let bytes = picture.encode(form).unwrap();
            let written = decoded(&bytes);
            assert_eq!(
                (written.tree, written.metadata),
                (None, PictureMetadata::default())
            );
            let has = |name: &[u8]| bytes.windows(name.len()).any(|window| window == name);
            assert!(
                ![&b"rtMT"[..], b"rtc:", b"XMP "]
                    .iter()
                    .any(|name| has(name)),
                "{form:?}"
            );
        }
    }

    #[test]
    fn foreign_and_damaged_files_are_refused() {
        let grey = {
            let mut bytes = Vec::new();
            let mut encoder = ::png::Encoder::new(&mut bytes, 1, 1);
            encoder.set_color(ColorType::Grayscale);
            let mut writer = encoder.write_header().unwrap();
            writer.write_image_data(&[1]).unwrap();
            writer.finish().unwrap();
            bytes
        };
        let file = WrittenFile::open(&grey, 9).unwrap().decode();
        assert!(matches!(file, Err(DecodeError::Unsupported(_))));
        for form in FORMS {
            let bytes = picture(form).encode(form).unwrap();
            assert!(WrittenFile::open(&bytes, 9).is_err(), "{form:?}");
            for length in 0..bytes.len().min(400) {
                let cut = &bytes[..length];
                let read = WrittenFile::open(cut, 1 << 20).and_then(WrittenFile::decode);
                assert!(read.is_err(), "{form:?}, {length}");
            }
        }
    }

    #[test]
    fn a_text_that_swells_is_not_read() {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(ColorType::Rgb);
        let mut text = ITXtChunk::new("rtc:settings", " ".repeat(1 << 22));
        text.compressed = true;
        let mut writer = encoder.write_header().unwrap();
        writer.write_text_chunk(&text).unwrap();
        writer.write_image_data(&[1, 2, 3]).unwrap();
        writer.finish().unwrap();
        assert!(bytes.len() < 1 << 15, "it is small: {}", bytes.len());
        assert_eq!(decoded(&bytes).metadata, PictureMetadata::default());
    }

    #[test]
    fn changed_bytes_are_read_or_refused() {
        let mut random = 1_u64;
        let mut next = |bound: usize| {
            random = rtc_math::mix(random);
            usize::try_from(random % bound as u64).unwrap()
        };
        for form in FORMS {
            let picture = picture(form);
            let sound = head(&picture, form).encode(&picture).unwrap();
            for _ in 0..400 {
                let mut bytes = sound.clone();
                for _ in 0..=next(3) {
                    // Mostly in the head, where the metadata are.
                    let at = next(bytes.len()).min(next(2 * bytes.len()));
                    bytes[at] = u8::try_from(next(256)).unwrap();
                }
                if let Ok(file) = WrittenFile::open(&bytes, 1 << 12) {
                    let _ = file.decode();
                }
            }
        }
    }
}
