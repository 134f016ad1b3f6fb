//! Pixel files: what becomes of them, and which are refused.

use super::{IMAGE, Outcome, bring, encoded, folder, pixels, png, write};
use image::{DynamicImage, ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use rtc::internals::front::FrontOptions;
use rtc::internals::ir::TextureId;

/// Brings a picture of these bytes.
fn picture(bytes: &[u8]) -> Outcome {
    let folder = folder();
    write(&folder, "inner/picture", bytes);
    bring(
        &folder.path().join("inner/scene.yaml"),
        IMAGE,
        "picture",
        &FrontOptions::default(),
    )
}

#[test]
fn pictures_of_each_format_become_pixels_from_the_top() {
    let mut small = RgbaImage::from_pixel(2, 1, Rgba([10, 20, 30, 0]));
    small.put_pixel(1, 0, Rgba([200, 100, 50, 255]));
    let small = DynamicImage::from(small);
    let bytes = [10, 20, 30, 200, 100, 50];
    for format in [ImageFormat::Png, ImageFormat::WebP] {
        let outcome = picture(&encoded(&small, format));
        let image = &outcome.lowered.scene.images[0];
        assert_eq!(
            (image.name.as_str(), image.width, image.height),
            ("picture", 2, 1),
            "{}",
            outcome.findings
        );
        assert_eq!(pixels(&outcome), bytes, "{format:?}");
    }
    let sixteen = picture(&encoded(&small.to_rgb16().into(), ImageFormat::Png));
    assert_eq!(pixels(&sixteen), bytes);
    let grey = picture(&encoded(
        &DynamicImage::from(image::GrayImage::from_pixel(1, 1, image::Luma([77]))),
        ImageFormat::Png,
    ));
    assert_eq!(pixels(&grey), [77; 3]);
    let plain = DynamicImage::from(RgbImage::from_pixel(8, 8, Rgb([180, 90, 60])));
    let jpeg = picture(&encoded(&plain, ImageFormat::Jpeg));
    let near = pixels(&jpeg)
        .iter()
        .zip([180_u8, 90, 60].iter().cycle())
        .all(|(a, b)| a.abs_diff(*b) <= 3);
    assert!(near && pixels(&jpeg).len() == 3 * 64, "{:?}", pixels(&jpeg));
}

/// The PNG with another width and height in its head, whose checksum is right.
fn with_size(png: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut bytes = png.to_vec();
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    let crc = crc32fast::hash(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    bytes
}

#[test]
fn pictures_that_cannot_be_are_refused() {
    let good = png([1, 2, 3]);
    let cases = [
        (good[..good.len() - 20].to_vec(), "RE004", "is damaged: "),
        (b"no picture".to_vec(), "RE004", "is not a picture"),
        (Vec::new(), "RE004", "is not a picture"),
        (b"GIF89a\x01\x00\x01\x00".to_vec(), "RE004", "is a gif file"),
        (
            with_size(&good, 70_000, 70_000),
            "RE005",
            "has 70000 × 70000 pixels",
        ),
        (
            with_size(&good, 0x7fff_ffff, 0x7fff_ffff),
            "RE005",
            "has 2147483647 × 2147483647 pixels",
        ),
        (with_size(&good, u32::MAX >> 1, u32::MAX >> 1), "RE00", ""),
        (with_size(&good, 0, 5), "RE004", "is damaged: "),
    ];
    for (bytes, code, words) in cases {
        let findings = picture(&bytes).findings;
        assert!(
            findings.starts_with(code) && findings.contains(words),
            "{words}: {findings}"
        );
        assert!(findings.contains(" error scene.yaml:1:3 "), "{findings}");
    }
}

#[test]
fn only_bump_maps_that_hold_normals_become_normal_maps() {
    for (color, becomes) in [
        ([128, 128, 255], true),
        ([190, 128, 235], true),
        ([128; 3], false),
        ([255; 3], false),
        ([150, 90, 40], false),
    ] {
        let outcome = picture(&png(color));
        let phong = outcome.lowered.scene.materials[0].phong().unwrap();
        let expected = if becomes {
            (Some(TextureId(1)), false)
        } else {
            (None, true)
        };
        assert_eq!(
            (phong.normal_map, phong.bump.is_some()),
            expected,
            "{color:?}"
        );
        assert_eq!(
            outcome.findings.starts_with("RE008 note"),
            becomes,
            "{}",
            outcome.findings
        );
    }
}

#[test]
fn a_jpeg_that_ends_early_is_damaged_and_one_that_came_in_scans_is_not() {
    let noise = image::GrayImage::from_fn(64, 64, |x, y| image::Luma([(x * 37 + y * 101) as u8]));
    let whole = encoded(&DynamicImage::from(noise), ImageFormat::Jpeg);
    for length in [whole.len() / 2, whole.len() - 30, whole.len() - 2] {
        let findings = picture(&whole[..length]).findings;
        assert!(
            findings.starts_with("RE004 error") && findings.contains("is damaged: "),
            "{length}: {findings}"
        );
    }
    // What follows the picture is none of it.
    let more = [whole.as_slice(), b"\xff\xd8 more"].concat();
    assert_eq!(pixels(&picture(&more)), pixels(&picture(&whole)));
    // A thumbnail in a segment ends the thumbnail alone.
    let thumbnail = [
        &whole[..2],
        b"\xff\xe1\x00\x06\xff\xd8\xff\xd9",
        &whole[2..whole.len() - 2],
    ]
    .concat();
    assert!(
        picture(&thumbnail)
            .findings
            .contains("is damaged: it ends before its last pixel")
    );
}
