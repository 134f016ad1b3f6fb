//! Textures: the image, and the sampler.

use super::document::Document;
use super::field::ObjectFields;
use super::image::ImageCoding;
use super::report::{AssetReport, shown};
use rtc_diag::codes;
use rtc_source::tree::NodeId;

/// An image and its sampler.
#[derive(Debug)]
pub(super) struct Texture {
    pub(super) at: NodeId,
    /// A PNG or JPEG.
    pub(super) source: Option<usize>,
    /// A WebP image, which replaces it.
    pub(super) webp: Option<usize>,
    /// A KTX2 image, which replaces both.
    pub(super) ktx2: Option<usize>,
    pub(super) sampler: Option<usize>,
}

/// The wrap modes and the filter of a texture.
#[derive(Debug)]
pub(super) struct TextureSampler {
    pub(super) mag_filter: Option<u64>,
    pub(super) wrap: [u64; 2],
}

/// The code of OpenGL for repeating.
pub(super) const REPEAT: u64 = 10497;

impl Texture {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let source = |fields: ObjectFields<'_, '_>| fields.index("source");
        Self {
            at: fields.at,
            source: source(fields),
            webp: fields.extension("EXT_texture_webp").and_then(source),
            ktx2: fields.extension("KHR_texture_basisu").and_then(source),
            sampler: fields.index("sampler"),
        }
    }
}

impl TextureSampler {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let wrap = |key| fields.integer(key).unwrap_or(REPEAT);
        Self {
            mag_filter: fields.integer("magFilter"),
            wrap: [wrap("wrapS"), wrap("wrapT")],
        }
    }
}

/// Checks that the images of textures have the required formats.
pub(super) fn check(doc: &Document<'_>, report: &mut AssetReport<'_, '_>) {
    for texture in &doc.textures {
        // A wrong media type is reported; the data tell the real one.
        let faulty = |report: &mut AssetReport<'_, '_>, at, found: &str, wanted: &str| {
            let message = format!(
                "the media type of the image is {}; it must be {wanted}",
                shown(found)
            );
            report.repair(
                &codes::GLTF_IMAGE,
                "TEXTURE_INVALID_IMAGE_MIME_TYPE",
                at,
                &message,
                "the type is read from the data",
            );
        };
        // The core specification allows PNG and JPEG.
        let core = [ImageCoding::Png.media(), ImageCoding::Jpeg.media()];
        if let Some(found) = media(doc, texture.source).filter(|found| !core.contains(found)) {
            let at = report.json.at_or(texture.at, "source");
            faulty(report, at, found, "image/png or image/jpeg");
        }
        // Each extension allows one more format.
        let replacements = [
            ("EXT_texture_webp", texture.webp, ImageCoding::WebP.media()),
            (
                "KHR_texture_basisu",
                texture.ktx2,
                ImageCoding::Ktx2.media(),
            ),
        ];
        for (extension, image, wanted) in replacements {
            if let Some(found) = media(doc, image).filter(|found| *found != wanted) {
                let path = ["extensions", extension, "source"];
                let at = report.json.at(texture.at, &path).unwrap_or(texture.at);
                faulty(report, at, found, wanted);
            }
        }
    }
}

/// The declared format of an image, or else that of its bytes.
fn media<'d>(doc: &'d Document<'_>, image: Option<usize>) -> Option<&'d str> {
    let image = doc.images.get(image?)?;
    image
        .media
        .as_deref()
        .or(image.format.map(ImageCoding::media))
}
