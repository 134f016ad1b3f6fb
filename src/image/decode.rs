//! Pixel files read: PNG, JPEG and WebP, told apart by content, to 8 bits a channel. Nothing is allocated before the
//! size of the picture is known to be within limits.

use ::image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::fmt;
use std::io::Cursor;

/// The most pixels of a picture that is read.
pub const MAX_PIXELS: u64 = 1 << 28;

/// The most bytes a decoder may ask for.
const MAX_BYTES: u64 = 1 << 30;

/// A picture of 8 bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Rows from the top; red, green, blue.
    pub bytes: Vec<u8>,
}

/// Why a file can't be read as a picture; prints as a clause about the file.
#[derive(Debug)]
pub enum DecodeError {
    /// It is no picture, or of a format that is not read, which then is named.
    Format(Option<&'static str>),
    /// It has more than [`MAX_PIXELS`], or takes too much memory.
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// It is damaged; in the decoder's words.
    Damaged(String),
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(None) => f.write_str("is not a picture"),
            Self::Format(Some(name)) => write!(f, "is a {name} file"),
            Self::TooLarge { width, height } => write!(f, "has {width} × {height} pixels"),
            Self::Damaged(words) => write!(f, "is damaged: {words}"),
        }
    }
}

/// Decodes a pixel file. Colours stay as stored: profiles and gamma are not applied, opacity is dropped, 16 bits are
/// rounded to 8.
///
/// # Errors
/// If the bytes are no such file, damaged, or ask for too much.
pub fn decode(bytes: &[u8]) -> Result<Pixels, DecodeError> {
    let picture = picture(bytes)?;
    Ok(Pixels { width: picture.width(), height: picture.height(), bytes: picture.into_rgb8().into_raw() })
}

/// Decodes a pixel file and keeps its opacity: if the second is true, pixels have four bytes.
///
/// # Errors
/// As [`decode`].
pub fn decode_with_alpha(bytes: &[u8]) -> Result<(Pixels, bool), DecodeError> {
    let picture = picture(bytes)?;
    let (width, height, has_alpha) = (picture.width(), picture.height(), picture.color().has_alpha());
    let bytes = if has_alpha { picture.into_rgba8().into_raw() } else { picture.into_rgb8().into_raw() };
    Ok((Pixels { width, height, bytes }, has_alpha))
}

/// Whether a file that begins so is one that [`decode`] reads.
#[must_use]
pub fn is_picture(head: &[u8]) -> bool {
    ::image::guess_format(head).is_ok_and(is_read)
}

/// The size that the head of a PNG claims.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let head = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n")?.get(4..16)?;
    let number = |at: usize| Some(u32::from_be_bytes(*head.get(at..)?.first_chunk()?));
    head.starts_with(b"IHDR").then_some((number(4)?, number(8)?))
}

fn is_read(format: ImageFormat) -> bool {
    matches!(format, ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)
}

fn picture(bytes: &[u8]) -> Result<DynamicImage, DecodeError> {
    let format = ::image::guess_format(bytes).map_err(|_| DecodeError::Format(None))?;
    if !is_read(format) {
        return Err(DecodeError::Format(Some(format.to_mime_type().trim_start_matches("image/"))));
    }
    if let Some((width, height)) = png_size(bytes).filter(|(w, h)| u64::from(*w) * u64::from(*h) > MAX_PIXELS) {
        // Its decoder finds another fault first.
        return Err(DecodeError::TooLarge { width, height });
    }
    let mut decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder().map_err(|e| damaged(&e))?;
    let (width, height) = decoder.dimensions();
    let too_large = DecodeError::TooLarge { width, height };
    if u64::from(width) * u64::from(height) > MAX_PIXELS || decoder.total_bytes() > MAX_BYTES {
        return Err(too_large);
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_BYTES);
    decoder.set_limits(limits).map_err(|e| damaged(&e))?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|e| match e {
        ImageError::Limits(_) => too_large,
        ImageError::Decoding(_)
        | ImageError::Encoding(_)
        | ImageError::Parameter(_)
        | ImageError::Unsupported(_)
        | ImageError::IoError(_) => damaged(&e),
    })?;
    if width == 0 || height == 0 {
        return Err(DecodeError::Damaged("it has no pixels".to_owned()));
    }
    Ok(picture)
}

fn damaged(error: &ImageError) -> DecodeError {
    DecodeError::Damaged(error.to_string())
}
