//! EXR: 32-bit floats per channel, as they are but finite, in one part, with where the picture came
//! from as text attributes.
//!
//! The encoder keeps free attributes in hashed maps, whose order changes from run to run; each map
//! here holds one.

use super::range::narrow;
use super::{EncodeError, Origin, Picture};
use ::exr::meta::attribute::{AttributeValue, Text};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, SmallVec, WritableImage,
};
use std::io::Cursor;

/// The picture as EXR.
pub(super) fn encode(picture: &Picture, origin: &Origin) -> Result<Vec<u8>, EncodeError> {
    let Origin {
        software,
        scene,
        settings,
    } = origin;
    let size = (picture.image.width as usize, picture.image.height as usize);
    let attributes = LayerAttributes {
        software_name: Some(text(software)),
        other: [(text("rtc:settings"), AttributeValue::Text(text(settings)))].into(),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        channels(picture),
    );
    let mut file = ::exr::prelude::Image::from_layer(layer);
    file.attributes.other = [(text("rtc:scene"), AttributeValue::Text(text(scene)))].into();
    let mut bytes = Cursor::new(Vec::new());
    file.write()
        .non_parallel()
        .to_buffered(&mut bytes)
        .map_err(|error| EncodeError(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// All channels, in the order of their names, as the format wants them.
fn channels(picture: &Picture) -> AnyChannels<FlatSamples> {
    let Picture {
        image,
        alpha,
        layers,
    } = picture;
    let color =
        |k: usize| FlatSamples::F32(image.pixels.iter().map(|pixel| narrow(pixel[k])).collect());
    let mut list: SmallVec<[_; 4]> = [("R", 0), ("G", 1), ("B", 2)]
        .into_iter()
        .map(|(name, k)| (name, color(k)))
        .collect();
    list.extend(
        alpha
            .iter()
            .map(|alpha| ("A", FlatSamples::F32(alpha.clone()))),
    );
    list.extend(layers.names.iter().enumerate().map(|(k, name)| {
        let values = layers.values.iter().skip(k).step_by(layers.names.len());
        (
            *name,
            FlatSamples::F32(values.map(|value| narrow(f64::from(*value))).collect()),
        )
    }));
    AnyChannels::sort(
        list.into_iter()
            .map(|(name, samples)| AnyChannel::new(name, samples))
            .collect(),
    )
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
