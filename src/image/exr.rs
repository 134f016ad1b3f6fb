//! EXR: 32-bit floats per channel, as they are, unclamped, with where the picture came from as text attributes.
//!
//! The encoder keeps free attributes in hashed maps, whose order changes from run to run; each map here holds one.

use super::{EncodeError, Image, Origin};
use ::exr::meta::attribute::{AttributeValue, Text};
use ::exr::prelude::{Encoding, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage};
use std::io::Cursor;

/// The picture as EXR.
pub(super) fn encode(image: &Image, origin: &Origin) -> Result<Vec<u8>, EncodeError> {
    let Origin { software, scene, settings } = origin;
    let (width, height) = (image.width as usize, image.height as usize);
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b] = image.pixels[at.y() * width + at.x()].map(narrow);
        (r, g, b)
    });
    let attributes = LayerAttributes {
        software_name: Some(text(software)),
        other: [(text("rtc:settings"), AttributeValue::Text(text(settings)))].into(),
        ..LayerAttributes::default()
    };
    let layer = Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut file = ::exr::prelude::Image::from_layer(layer);
    file.attributes.other = [(text("rtc:scene"), AttributeValue::Text(text(scene)))].into();
    let mut bytes = Cursor::new(Vec::new());
    file.write().non_parallel().to_buffered(&mut bytes).map_err(|error| EncodeError(error.to_string()))?;
    Ok(bytes.into_inner())
}

#[expect(clippy::cast_possible_truncation, reason = "rounds to the nearest float, or to infinity")]
fn narrow(v: f64) -> f32 {
    v as f32
}

/// EXR text is Latin-1; what is not becomes a question mark.
fn text(words: &str) -> Text {
    Text::new_or_none(words).unwrap_or_else(|| {
        let latin = words.chars().map(|c| if u32::from(c) < 256 { c } else { '?' });
        Text::from(latin.collect::<String>().as_str())
    })
}

#[cfg(test)]
mod tests {
    use super::super::Form;
    use super::*;
    use ::exr::prelude::{ReadChannels, ReadLayers, read};

    fn bright() -> (Image, Form) {
        let pixels = vec![[0.0, 0.5, 1.0], [2.5, -1.0, 1e30], [0.1, f64::INFINITY, 1e-3], [3.0, 4.0, 5.0]];
        let origin =
            Origin { software: "rtc 1".into(), scene: "abc".into(), settings: "{\"size\":\"2×2→\"}".into() };
        (Image { width: 2, height: 2, pixels }, Form::Exr(origin))
    }

    #[test]
    fn floats_and_attributes_come_back() {
        let (image, form) = bright();
        let bytes = image.encode(&form).unwrap();
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
        let expected: Vec<[f32; 3]> = image.pixels.iter().map(|pixel| pixel.map(narrow)).collect();
        assert_eq!(read.layer_data.channel_data.pixels, expected);
        assert_eq!(read.layer_data.attributes.software_name, Some(text("rtc 1")));
        let attribute = |name| read.layer_data.attributes.other[&text(name)].clone().into_text().unwrap().to_string();
        assert_eq!([attribute("rtc:scene"), attribute("rtc:settings")], ["abc", "{\"size\":\"2×2?\"}"]);
    }

    #[test]
    fn the_same_picture_is_the_same_bytes() {
        let (image, form) = bright();
        let first = image.encode(&form).unwrap();
        assert!((0..16).all(|_| image.encode(&form).unwrap() == first));
        assert!(!first.windows(8).any(|window| window == b"capDate\0"));
    }
}
