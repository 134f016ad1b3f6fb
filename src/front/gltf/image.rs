//! Images: their bytes, their media types, and their decoding.

use super::buffer::{BufferViewUsage, BufferViewUsages, ByteRange, Bytes, byte_range};
use super::document::Document;
use super::features;
use super::field::ObjectFields;
use super::report::AssetReport;
use crate::pixels::{self, ChargedFile, PixelDecodeError};
use rtc_diag::{Code, codes};
use rtc_image::{DecodeError, OpacityUse, Pixels};
use rtc_ir as ir;
use rtc_source::tree::{NodeId, NodeKind};
use rtc_source::{Budget, LimitExceeded};
use std::collections::BTreeMap;

/// An image.
#[derive(Debug)]
pub(super) struct Image {
    pub(super) at: NodeId,
    pub(super) name: String,
    pub(super) view: Option<usize>,
    /// The declared type: `mimeType`, or else that of a data URI.
    pub(super) media: Option<String>,
    /// What its first bytes say.
    pub(super) format: Option<ImageCoding>,
    /// The bytes of its file or URI; those of a view stay there.
    pub(super) bytes: Option<Bytes<'static>>,
    /// Which picture of the document it is, if it is sound.
    pub(super) picture: Option<usize>,
}

/// A format of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ImageCoding {
    Png,
    Jpeg,
    WebP,
    Ktx2,
}

impl ImageCoding {
    pub(super) fn media(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Jpeg => "image/jpeg",
            Self::WebP => "image/webp",
            Self::Ktx2 => "image/ktx2",
        }
    }

    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else if bytes.starts_with(b"\xff\xd8") {
            Some(Self::Jpeg)
        } else if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
            Some(Self::WebP)
        } else if bytes.starts_with(b"\xabKTX 20\xbb\r\n\x1a\n") {
            Some(Self::Ktx2)
        } else {
            None
        }
    }

    /// True if the bytes end before the header with the size.
    fn ends_early(self, bytes: &[u8]) -> bool {
        match self {
            Self::Png => bytes.len() < 33,
            Self::Jpeg => jpeg_ends_early(bytes),
            Self::WebP => bytes.len() < 30,
            Self::Ktx2 => bytes.len() < 28,
        }
    }
}

/// Walks over the segments of a JPEG up to its frame header.
fn jpeg_ends_early(bytes: &[u8]) -> bool {
    let mut at = 2;
    loop {
        match (bytes.get(at), bytes.get(at + 1)) {
            (Some(0xff), Some(0xff)) => at += 1,
            (Some(0xff), Some(0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf)) => {
                return bytes.len() < at + 9;
            }
            (Some(0xff), Some(0x01 | 0xd0..=0xd7)) => at += 2,
            (Some(0xff), Some(_)) => match bytes.get(at + 2..at + 4) {
                Some(length) => {
                    let length = usize::from(u16::from_be_bytes([length[0], length[1]]));
                    if length < 2 {
                        return false;
                    }
                    at += 2 + length;
                }
                None => return true,
            },
            (Some(_), _) => return false,
            (None, _) => return true,
        }
    }
}

impl Image {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        Self {
            at: fields.at,
            name: fields.name(),
            view: fields.index("bufferView"),
            media: fields.text("mimeType"),
            format: None,
            bytes: None,
            picture: None,
        }
    }
}

impl Document<'_> {
    /// The bytes of an image, if they can be had.
    pub(super) fn image_bytes<'a>(&'a self, image: &'a Image) -> Option<&'a [u8]> {
        match (&image.bytes, image.view) {
            (Some(bytes), _) => Some(bytes),
            (None, Some(view)) => self.view_bytes(view),
            (None, None) => None,
        }
    }
}

/// Checks the properties of each image.
pub(super) fn check(
    doc: &Document<'_>,
    purposes: &mut BufferViewUsages,
    report: &mut AssetReport<'_, '_>,
) {
    for image in doc
        .images
        .iter()
        .filter(|image| report.json.kind(image.at) == NodeKind::Map)
    {
        let fields = ObjectFields::new(report.json, image.at);
        if fields.text("uri").is_some() == fields.index("bufferView").is_some() {
            let message = "an image needs either a `uri` or a `bufferView`".to_owned();
            report.add(&codes::GLTF_TOGETHER, "ONE_OF_MISMATCH", image.at, message);
        }
        let Some(at) = fields.node("bufferView").filter(|_| image.view.is_some()) else {
            continue;
        };
        if fields.text("mimeType").is_none() {
            let message = "an image in a buffer view needs a `mimeType`".to_owned();
            report.add(&codes::GLTF_TOGETHER, "UNSATISFIED_DEPENDENCY", at, message);
        }
        purposes.set(image.view, BufferViewUsage::Image, at, report);
        if image
            .view
            .and_then(|view| doc.views.get(view))
            .is_some_and(|view| view.stride.is_some())
        {
            let message = "the buffer view of an image must not have a `byteStride`";
            let (alias, repair) = ("IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "the stride is ignored");
            report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
        }
    }
}

/// The reason for rejecting an image: a code, the validator's name for it, and a message.
type ImageError = (&'static Code, &'static str, String);

/// Checks the bytes of each image, and decodes them on the given number of threads, 0 for one per
/// core; identical bytes are decoded once.
pub(super) fn inspect(doc: &mut Document<'_>, threads: usize, report: &mut AssetReport<'_, '_>) {
    let mut decoded = decoded(doc, threads, report.budget);
    let mut known: BTreeMap<ByteRange, Result<usize, ImageError>> = BTreeMap::new();
    for index in 0..doc.images.len() {
        let image = &doc.images[index];
        let Some(bytes) = doc.image_bytes(image) else {
            continue;
        };
        let (at, media) = (image.at, image.media.as_deref());
        let Some(format) = ImageCoding::of(bytes) else {
            let message = "the image is not PNG, JPEG, WebP or KTX2".to_owned();
            report.add(
                &codes::GLTF_IMAGE_ODD,
                "IMAGE_UNRECOGNIZED_FORMAT",
                at,
                message,
            );
            continue;
        };
        check_media(doc, (format, media), at, report);
        if let Some(what) = features::unfollowed(format, bytes) {
            let message = format!("the image has {what}, which is ignored");
            report.add(
                &codes::GLTF_IMAGE_ODD,
                "IMAGE_FEATURES_UNSUPPORTED",
                at,
                message,
            );
        }
        let range = byte_range(bytes);
        let picture = match known.get(&range) {
            Some(picture) => picture.clone(),
            None => match decoded.remove(&range) {
                Some(Ok(picture)) => {
                    doc.pictures.push(picture);
                    Ok(doc.pictures.len() - 1)
                }
                Some(Err(ImageRejection::Limit(fault))) => {
                    return report.exceeded(at, "the image", &fault);
                }
                Some(Err(ImageRejection::Fault(fault))) => Err(fault),
                // One of them exceeds the budget, which was reported.
                None => continue,
            },
        };
        match &picture {
            Ok(picture) => remark_size(&doc.pictures[*picture], at, report),
            Err((code, alias, message)) => report.add(code, alias, at, message.clone()),
        }
        let image = &mut doc.images[index];
        (image.format, image.picture) = (Some(format), picture.as_ref().ok().copied());
        known.insert(range, picture);
    }
}

/// An image must have the declared type, and one that the asset allows.
fn check_media(
    doc: &Document<'_>,
    (format, media): (ImageCoding, Option<&str>),
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    if let Some(media) = media.filter(|media| *media != format.media()) {
        let message = format!(
            "the image is {}, not {} as declared",
            format.media(),
            super::report::shown(media)
        );
        let (alias, repair) = ("IMAGE_MIME_TYPE_INVALID", "the type is read from the data");
        report.repair(&codes::GLTF_IMAGE, alias, at, &message, repair);
    }
    let (name, extension) = match format {
        ImageCoding::Png | ImageCoding::Jpeg => return,
        ImageCoding::WebP => ("WebP", "EXT_texture_webp"),
        ImageCoding::Ktx2 => ("KTX2", "KHR_texture_basisu"),
    };
    if !doc.uses(extension) {
        let message = format!("a {name} image needs the extension `{extension}`");
        let (alias, repair) = ("IMAGE_NON_ENABLED_MIME_TYPE", "it is read");
        report.repair(&codes::GLTF_IMAGE, alias, at, &message, repair);
    }
}

fn remark_size(picture: &ir::Image, at: NodeId, report: &mut AssetReport<'_, '_>) {
    let ir::Image { width, height, .. } = picture;
    if !width.is_power_of_two() || !height.is_power_of_two() {
        let message = format!("the image has {width} × {height} pixels");
        report.add(&codes::GLTF_REMARK, "IMAGE_NPOT_DIMENSIONS", at, message);
    }
}

enum ImageRejection {
    Fault(ImageError),
    Limit(LimitExceeded),
}

/// The decoded images, up to the first that exceeds the budget: all are charged, in order, before
/// any is decoded.
fn decoded(
    doc: &Document<'_>,
    threads: usize,
    budget: &Budget,
) -> BTreeMap<ByteRange, Result<ir::Image, ImageRejection>> {
    let (mut pictures, mut admitted) = (BTreeMap::new(), BTreeMap::new());
    let images = doc.images.iter().filter_map(|image| doc.image_bytes(image));
    for (bytes, format) in images.filter_map(|bytes| Some((bytes, ImageCoding::of(bytes)?))) {
        let range = byte_range(bytes);
        if pictures.contains_key(&range) || admitted.contains_key(&range) {
            continue;
        }
        match admit(format, bytes, budget) {
            Ok(file) => {
                admitted.insert(range, file);
            }
            Err(refusal) => {
                let is_over = matches!(refusal, ImageRejection::Limit(_));
                pictures.insert(range, Err(refusal));
                if is_over {
                    break;
                }
            }
        }
    }
    // After an image is rejected for its size, the rest is not decoded.
    if pictures
        .values()
        .any(|range| matches!(range, Err(ImageRejection::Limit(_))))
    {
        return pictures;
    }
    let (places, files): (Vec<_>, Vec<_>) = admitted.into_iter().unzip();
    let made = pixels::decode_all(&files, threads, budget).into_iter();
    let made = made.map(|pixels| {
        pixels
            .map(picture)
            .map_err(|fault| ImageRejection::of(&fault))
    });
    pictures.extend(places.into_iter().zip(made));
    pictures
}

/// Charges an image to the budget of the run.
fn admit<'a>(
    format: ImageCoding,
    bytes: &'a [u8],
    budget: &Budget,
) -> Result<ChargedFile<'a>, ImageRejection> {
    if format.ends_early(bytes) {
        let message =
            "the image is incomplete: its data are shorter than its header says".to_owned();
        return Err(ImageRejection::Fault((
            &codes::GLTF_IMAGE,
            "IMAGE_UNEXPECTED_EOS",
            message,
        )));
    }
    pixels::charge_file(bytes, OpacityUse::Kept, budget).map_err(|refused| match refused {
        PixelDecodeError::Limit(fault) => ImageRejection::Limit(fault),
        PixelDecodeError::File(fault) => ImageRejection::of(&fault),
    })
}

impl ImageRejection {
    /// That an image can't be decoded.
    fn of(fault: &DecodeError) -> Self {
        let (code, alias) = match fault {
            DecodeError::TooLarge {
                width: _,
                height: _,
            } => (&codes::GLTF_HUGE_IMAGE, ""),
            DecodeError::Format(_) | DecodeError::Unsupported(_) | DecodeError::Damaged(_) => {
                (&codes::GLTF_IMAGE, "IMAGE_DATA_INVALID")
            }
        };
        Self::Fault((code, alias, format!("the image {fault}")))
    }
}

/// A picture without a name.
fn picture(pixels: Pixels) -> ir::Image {
    ir::Image {
        name: String::new(),
        width: pixels.width,
        height: pixels.height,
        kind: if pixels.has_alpha {
            ir::Pixels::Rgba8
        } else {
            ir::Pixels::Rgb8
        },
        pixels: pixels.bytes.into(),
    }
}
