//! Decodes pixel files within the budget of the run. The cost of a file is charged before it is
//! decoded.

use super::over_limit;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use rtc_color::srgb_decoded;
use rtc_diag::{Diagnostic, codes};
use rtc_image::{
    DecodeCost, DecodeError, OpacityUse, PixelFile, Pixels, Radiance, RadianceFile, is_picture,
    is_radiance,
};
use rtc_ir as ir;
use rtc_source::{Budget, FileKind, LimitExceeded, Resource};

/// The image formats of textures.
pub const PICTURES: FileKind = FileKind {
    extensions: &["png", "jpg", "jpeg", "webp", "ktx2"],
    begins: is_picture,
};

/// The image formats of environments, and of textures that may be brighter than white, too.
pub const TEXTURES: FileKind = FileKind {
    extensions: &["png", "jpg", "jpeg", "webp", "ktx2", "exr", "hdr", "pic"],
    begins: |head| is_picture(head) || is_radiance(head),
};

/// Why an image could not be decoded.
#[derive(Debug)]
pub enum PixelDecodeError {
    /// The file is invalid.
    File(DecodeError),
    /// The image exceeds the budget.
    Limit(LimitExceeded),
}

impl From<DecodeError> for PixelDecodeError {
    fn from(error: DecodeError) -> Self {
        Self::File(error)
    }
}

/// Decodes a PNG, JPEG, WebP or KTX2.
///
/// # Errors
/// If the file has another format, is damaged, or exceeds the budget.
pub fn decode(
    bytes: &[u8],
    opacity: OpacityUse,
    budget: &Budget,
) -> Result<Pixels, PixelDecodeError> {
    let file = PixelFile::open(bytes, opacity, budget.limit(Resource::Pixels))?;
    charge(file.cost(), Resource::Textures, budget)?;
    Ok(file.decode()?)
}

/// A pixel file whose cost is charged, not decoded yet.
pub struct ChargedFile<'a> {
    bytes: &'a [u8],
    opacity: OpacityUse,
    most_pixels: u64,
    /// The bytes that decoding needs besides the pixels.
    scratch: u64,
}

/// Charges the cost of a PNG, JPEG, WebP or KTX2. The decoder is dropped, because it holds memory
/// of its own.
///
/// # Errors
/// As [`decode`], except for errors behind the header.
pub fn charge_file<'a>(
    bytes: &'a [u8],
    opacity: OpacityUse,
    budget: &Budget,
) -> Result<ChargedFile<'a>, PixelDecodeError> {
    let most_pixels = budget.limit(Resource::Pixels);
    let cost = PixelFile::open(bytes, opacity, most_pixels)?.cost();
    charge(cost, Resource::Textures, budget)?;
    Ok(ChargedFile {
        bytes,
        opacity,
        most_pixels,
        scratch: cost.scratch,
    })
}

impl ChargedFile<'_> {
    fn decode(&self) -> Result<Pixels, DecodeError> {
        PixelFile::open(self.bytes, self.opacity, self.most_pixels)?.decode()
    }
}

/// Decodes files on `threads` threads, 0 for one per core; one by one if the budget or the system
/// does not allow several. The results do not depend on the number of threads.
pub fn decode_all(
    files: &[ChargedFile<'_>],
    threads: usize,
    budget: &Budget,
) -> Vec<Result<Pixels, DecodeError>> {
    let scratch = files.iter().map(|file| file.scratch).max().unwrap_or(0);
    let has_room = |pool: &ThreadPool| {
        let at_once = pool.current_num_threads().min(files.len()) as u64;
        let scratch = scratch.saturating_mul(at_once);
        budget.has(Resource::Memory, scratch).is_ok()
    };
    let pool = || ThreadPoolBuilder::new().num_threads(threads).build().ok();
    let several = files.len() > 1 && threads != 1;
    match several.then(pool).flatten().filter(has_room) {
        Some(pool) => pool.install(|| files.par_iter().map(ChargedFile::decode).collect()),
        None => files.iter().map(ChargedFile::decode).collect(),
    }
}

/// Decodes a Radiance HDR or OpenEXR file.
///
/// # Errors
/// As [`decode`].
pub fn decode_radiance(bytes: &[u8], budget: &Budget) -> Result<Radiance, PixelDecodeError> {
    let file = RadianceFile::open(bytes, budget.limit(Resource::Pixels))?;
    charge(file.cost(), Resource::Memory, budget)?;
    Ok(file.decode()?)
}

/// Decodes the image of a texture of any of the [`TEXTURES`] formats.
///
/// # Errors
/// As [`decode`].
pub fn texture(
    name: &str,
    bytes: &[u8],
    opacity: OpacityUse,
    budget: &Budget,
) -> Result<ir::Image, PixelDecodeError> {
    match is_radiance(bytes) {
        true => environment(name, bytes, budget),
        false => picture(name, bytes, opacity, budget),
    }
}

/// Decodes the image of a texture of 8 bits a channel.
///
/// # Errors
/// As [`decode`].
pub fn picture(
    name: &str,
    bytes: &[u8],
    opacity: OpacityUse,
    budget: &Budget,
) -> Result<ir::Image, PixelDecodeError> {
    let Pixels {
        width,
        height,
        has_alpha,
        bytes,
    } = decode(bytes, opacity, budget)?;
    Ok(ir::Image {
        name: name.to_owned(),
        width,
        height,
        kind: match has_alpha {
            true => ir::Pixels::Rgba8,
            false => ir::Pixels::Rgb8,
        },
        pixels: bytes.into(),
    })
}

/// The radiance of a picture whose colours are coded as sRGB.
fn displayed_radiance(bytes: &[u8], budget: &Budget) -> Result<Radiance, PixelDecodeError> {
    let Pixels {
        width,
        height,
        bytes,
        ..
    } = decode(bytes, OpacityUse::Dropped, budget)?;
    let memory = 12 * u64::from(width) * u64::from(height);
    let charged = budget.charge(Resource::Memory, memory);
    charged.map_err(PixelDecodeError::Limit)?;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float"
    )]
    let decoded: [[u8; 4]; 256] =
        std::array::from_fn(|byte| (srgb_decoded(byte as f64 / 255.0) as f32).to_le_bytes());
    let bytes = bytes.iter().flat_map(|byte| decoded[usize::from(*byte)]);
    Ok(Radiance {
        width,
        height,
        bytes: bytes.collect(),
    })
}

/// Decodes the image of an environment: a Radiance HDR or OpenEXR file, or a picture of a display,
/// whose white is a radiance of 1.
///
/// # Errors
/// As [`decode`].
pub fn environment(
    name: &str,
    bytes: &[u8],
    budget: &Budget,
) -> Result<ir::Image, PixelDecodeError> {
    let Radiance {
        width,
        height,
        bytes,
    } = match is_picture(bytes) && !is_radiance(bytes) {
        true => displayed_radiance(bytes, budget)?,
        false => decode_radiance(bytes, budget)?,
    };
    Ok(ir::Image {
        name: name.to_owned(),
        width,
        height,
        kind: ir::Pixels::Rgb32f,
        pixels: bytes.into(),
    })
}

/// The diagnostic for an environment file that can't be decoded.
#[must_use]
pub fn environment_rejection(fault: &PixelDecodeError, name: &str) -> Diagnostic {
    let formats = "environments are Radiance HDR, OpenEXR, PNG, JPEG or WebP";
    rejection(fault, &format!("the environment `{name}`"), formats)
}

/// The diagnostic for a file that can't be decoded. `what` names it, `formats` lists the accepted
/// formats.
pub(super) fn rejection(fault: &PixelDecodeError, what: &str, formats: &'static str) -> Diagnostic {
    let fault = match fault {
        PixelDecodeError::Limit(fault) => return over_limit(what, fault),
        PixelDecodeError::File(fault) => fault,
    };
    let (code, hint) = match fault {
        DecodeError::Format(_) | DecodeError::Unsupported(_) => (&codes::BAD_PICTURE, formats),
        DecodeError::Damaged(_) => (&codes::BAD_PICTURE, "save the picture again"),
        DecodeError::TooLarge {
            width: _,
            height: _,
        } => (
            &codes::HUGE_PICTURE,
            "scale it down, or set another limit by `--limit pixels=…`",
        ),
    };
    Diagnostic::new(code, format!("{what} {fault}")).hint(hint)
}

fn charge(cost: DecodeCost, resource: Resource, budget: &Budget) -> Result<(), PixelDecodeError> {
    let DecodeCost {
        pixels,
        memory,
        scratch,
    } = cost;
    budget
        .charge(Resource::Pixels, pixels)
        .map_err(PixelDecodeError::Limit)?;
    // Scratch memory is freed again, so it is checked and not charged.
    budget
        .has(Resource::Memory, scratch)
        .map_err(PixelDecodeError::Limit)?;
    if resource == Resource::Memory {
        budget
            .has(resource, memory.saturating_add(scratch))
            .map_err(PixelDecodeError::Limit)?;
    }
    budget
        .charge(resource, memory)
        .map_err(PixelDecodeError::Limit)
}
