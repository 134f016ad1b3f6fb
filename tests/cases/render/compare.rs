//! Two pictures beside each other: whether they are the same, the worst pixel, and both with their
//! difference as one picture.

use image::{ImageFormat, Rgb, RgbImage, Rgba, RgbaImage};
use libtest_mimic::Failed;
use std::cmp::Reverse;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

pub(super) enum EffectStatus {
    Same,
    /// How they differ, in words.
    Differs(String),
}

pub(super) fn decode(png: &[u8]) -> Result<RgbaImage, Failed> {
    Ok(image::load_from_memory_with_format(png, ImageFormat::Png)?.to_rgba8())
}

fn distance(a: &Rgba<u8>, b: &Rgba<u8>) -> u8 {
    (0..4).map(|k| a.0[k].abs_diff(b.0[k])).max().unwrap()
}

/// Compares two pictures, channel by channel.
pub(super) fn compare(
    expected: &[u8],
    actual: &[u8],
    tolerance: u8,
) -> Result<EffectStatus, Failed> {
    let (expected, actual) = (decode(expected)?, decode(actual)?);
    let sizes = [&expected, &actual].map(RgbaImage::dimensions);
    if sizes[0] != sizes[1] {
        return Ok(EffectStatus::Differs(format!(
            "{:?} pixels instead of {:?}",
            sizes[1], sizes[0]
        )));
    }
    let pairs = || expected.enumerate_pixels().zip(actual.pixels());
    let off = |((_, _, a), b): &((u32, u32, &Rgba<u8>), &Rgba<u8>)| distance(a, b);
    let count = pairs().filter(|pair| off(pair) > tolerance).count();
    // Of equals the first.
    let worst = pairs().min_by_key(|pair| Reverse(off(pair))).unwrap();
    if count == 0 {
        return Ok(EffectStatus::Same);
    }
    let ((x, y, a), b) = worst;
    Ok(EffectStatus::Differs(format!(
        "{count} of {} pixels are off by more than {tolerance}; the worst is ({x}, {y}): {:?} instead of {:?}",
        expected.len() / 4,
        b.0,
        a.0
    )))
}

/// Writes expected | actual | difference, enlarged, the difference as bright as it goes.
pub(super) fn panels(expected: &[u8], actual: &[u8], path: &Path) -> Result<(), Failed> {
    const SCALE: u32 = 4;
    const GAP: u32 = 8;
    let (expected, actual) = (decode(expected)?, decode(actual)?);
    let width = expected.width().max(actual.width());
    let height = expected.height().max(actual.height());
    let at = |picture: &RgbaImage, x, y| picture.get_pixel_checked(x, y).copied();
    let nothing = Rgba([0; 4]);
    let gain = expected
        .pixels()
        .zip(actual.pixels())
        .map(|(a, b)| distance(a, b))
        .max()
        .map_or(1, |most| 255 / most.max(1));
    // What is transparent is shown before grey.
    let shown = |pixel: Rgba<u8>| {
        let alpha = u32::from(pixel.0[3]);
        let over = |v: u8| u8::try_from((u32::from(v) * alpha + 128 * (255 - alpha)) / 255);
        Rgb([0, 1, 2].map(|k| over(pixel.0[k]).unwrap()))
    };
    let panel = |k: u32, x: u32, y: u32| {
        let pair = [&expected, &actual].map(|picture| at(picture, x, y).unwrap_or(nothing));
        match k {
            0 | 1 => shown(pair[k as usize]),
            _ => {
                let [a, b] = pair;
                let alpha = a.0[3].abs_diff(b.0[3]);
                Rgb([0, 1, 2].map(|c| a.0[c].abs_diff(b.0[c]).max(alpha).saturating_mul(gain)))
            }
        }
    };
    let step = width * SCALE + GAP;
    let mut whole = RgbImage::from_pixel(3 * step - GAP, height * SCALE, Rgb([255; 3]));
    for (x, y, pixel) in whole.enumerate_pixels_mut() {
        let (k, x) = (x / step, x % step / SCALE);
        if x < width {
            *pixel = panel(k, x, y / SCALE);
        }
    }
    let mut bytes = Cursor::new(Vec::new());
    whole.write_to(&mut bytes, ImageFormat::Png)?;
    fs::create_dir_all(path.parent().unwrap())?;
    Ok(fs::write(path, bytes.into_inner())?)
}

fn encode(picture: &RgbaImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// The comparison itself: what is off by less than allowed passes, the worst pixel is named, and
/// the third panel shows it.
pub(super) fn a_wrong_pixel_is_named_and_shown() {
    let expected = RgbaImage::from_pixel(5, 4, Rgba([10, 20, 30, 255]));
    let mut actual = expected.clone();
    actual.put_pixel(1, 1, Rgba([10, 21, 30, 255]));
    let verdict = |actual: &RgbaImage, tolerance| {
        compare(&encode(&expected), &encode(actual), tolerance).unwrap()
    };
    assert!(matches!(verdict(&actual, 1), EffectStatus::Same));
    assert!(matches!(verdict(&actual, 0), EffectStatus::Differs(_)));
    actual.put_pixel(3, 2, Rgba([10, 20, 80, 255]));
    let EffectStatus::Differs(words) = verdict(&actual, 1) else {
        panic!("a pixel is off by 50")
    };
    let wanted =
        "1 of 20 pixels are off by more than 1; the worst is (3, 2): [10, 20, 80, 255] instead of";
    assert!(words.starts_with(wanted), "{words}");
    let narrow = RgbaImage::new(4, 4);
    assert!(matches!(verdict(&narrow, 255), EffectStatus::Differs(_)));
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("render/a-wrong-pixel.png");
    panels(&encode(&expected), &encode(&actual), &path).unwrap();
    let whole = decode(&fs::read(path).unwrap()).unwrap();
    assert_eq!(whole.dimensions(), (3 * 20 + 2 * 8, 16));
    let middle = |panel: u32, x: u32, y: u32| whole.get_pixel(panel * 28 + 4 * x + 2, 4 * y + 2).0;
    assert_eq!(middle(0, 3, 2), [10, 20, 30, 255]);
    assert_eq!(middle(1, 3, 2), [10, 20, 80, 255]);
    assert_eq!(middle(2, 3, 2), [0, 0, 250, 255]);
    assert_eq!(middle(2, 0, 0), [0, 0, 0, 255]);
}
