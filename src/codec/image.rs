//! Images in a container: the pixels are a section, copied directly from and to the scene.

use super::columns::SectionReader;
use super::section::{ElementType, SectionContent, SectionWriter};
use rtc_ir::{Image, Pixels};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// An image with the index of its pixel section.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct StoredImage {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    width: u32,
    height: u32,
    kind: Pixels,
    pixels: usize,
}

/// Puts the pixels of an image into a section.
pub(super) fn store<'s>(image: &'s Image, body: &mut SectionWriter<'s>) -> StoredImage {
    let Image {
        name,
        width,
        height,
        kind,
        pixels,
    } = image;
    let pixels = body.push(
        ElementType::U8,
        1,
        SectionContent::Bytes(Cow::Borrowed(pixels)),
    );
    StoredImage {
        name: name.clone(),
        width: *width,
        height: *height,
        kind: *kind,
        pixels,
    }
}

impl StoredImage {
    /// The image; `None` if its section is missing, of another type, or was taken before.
    pub(super) fn load(&self, reader: &mut SectionReader<'_>) -> Option<Image> {
        let Self {
            name,
            width,
            height,
            kind,
            pixels,
        } = self;
        let pixels = reader.take(*pixels)?.octets()?.to_vec().into();
        Some(Image {
            name: name.clone(),
            width: *width,
            height: *height,
            kind: *kind,
            pixels,
        })
    }
}
