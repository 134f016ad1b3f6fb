//! The images of a container: their pixels are a section, written from the scene and read into it
//! without a detour.

use super::columns::Stock;
use super::section::{Content, ElementType, SectionWriter};
use rtc_ir::{Image, Pixels};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// An image, with the section of its pixels in place of them.
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
    let pixels = body.push(ElementType::U8, 1, Content::Bytes(Cow::Borrowed(pixels)));
    StoredImage {
        name: name.clone(),
        width: *width,
        height: *height,
        kind: *kind,
        pixels,
    }
}

impl StoredImage {
    /// The image; none if its section is not there, is of another kind, or was taken before.
    pub(super) fn load(&self, stock: &mut Stock<'_>) -> Option<Image> {
        let Self {
            name,
            width,
            height,
            kind,
            pixels,
        } = self;
        let pixels = stock.take(*pixels)?.octets()?.to_vec().into();
        Some(Image {
            name: name.clone(),
            width: *width,
            height: *height,
            kind: *kind,
            pixels,
        })
    }
}
