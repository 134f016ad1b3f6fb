//! The environments: pictures of light as the IR holds them.

use crate::diag::{Diagnostic, codes};
use crate::image::{DecodeError, Radiance, decode_radiance};
use crate::ir::{Image, Pixels};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// The image of a Radiance HDR or OpenEXR file.
///
/// # Errors
/// If the bytes are no such file, damaged, or ask for too much.
pub fn environment(name: &str, bytes: &[u8]) -> Result<Image, DecodeError> {
    let Radiance { width, height, pixels } = decode_radiance(bytes)?;
    let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(|channel| channel.to_le_bytes()).collect();
    Ok(Image { name: name.to_owned(), width, height, kind: Pixels::Rgb32f, pixels: STANDARD.encode(bytes) })
}

/// What to say of such a file that can't be read.
#[must_use]
pub fn refusal(fault: &DecodeError, name: &str) -> Diagnostic {
    let (code, hint) = match fault {
        DecodeError::Format(_) => (&codes::BAD_PICTURE, "environments are Radiance HDR or OpenEXR"),
        DecodeError::Damaged(_) => (&codes::BAD_PICTURE, "save the picture again"),
        DecodeError::TooLarge { width: _, height: _ } => {
            (&codes::HUGE_PICTURE, "scale it down; an environment has at most 8192 × 4096 pixels")
        }
    };
    Diagnostic::new(code, format!("the environment `{name}` {fault}")).hint(hint)
}
