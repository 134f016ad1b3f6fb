//! The environments: pictures of light as the IR holds them.

use super::{Porter, Wanted, Without};
use crate::diag::{Diagnostic, codes};
use crate::image::{DecodeError, Radiance, decode_radiance, is_radiance};
use crate::ir::{Image, ImageId, Lowered, Pixels};
use crate::source::Kind;

/// The largest file read, in bytes: every pixel allowed, in 32-bit floats.
const MAX_BYTES: u64 = 1 << 29;

/// Such files.
pub(super) const KIND: Kind = Kind { extensions: &["hdr", "pic", "exr"], begins: is_radiance };

/// Brings the image of the environment; without its file there is none.
pub(super) fn bring(id: ImageId, wish: &Wanted, lowered: &mut Lowered, porter: &mut Porter<'_>) {
    let found = porter.find(wish, Without::Environment);
    let image = found.and_then(|found| match porter.loader.found(&found, MAX_BYTES, porter.map) {
        Ok(bytes) => {
            let refuse = |fault| {
                let finding = refusal(&fault, &found.shown.display().to_string()).at(wish.span, "named here");
                porter.refuse(finding, Without::Environment);
            };
            environment(&wish.path, &bytes).map_err(refuse).ok()
        }
        Err(error) => {
            porter.unreadable(&found, &error.to_string(), wish.span, Without::Environment);
            None
        }
    });
    match (image, lowered.scene.images.get_mut(id.0 as usize)) {
        (Some(image), Some(place)) => *place = image,
        (_, _) => lowered.scene.environment = None,
    }
}

/// The image of a Radiance HDR or OpenEXR file.
///
/// # Errors
/// If the bytes are no such file, damaged, or ask for too much.
pub fn environment(name: &str, bytes: &[u8]) -> Result<Image, DecodeError> {
    let Radiance { width, height, pixels } = decode_radiance(bytes)?;
    let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(|channel| channel.to_le_bytes()).collect();
    Ok(Image { name: name.to_owned(), width, height, kind: Pixels::Rgb32f, pixels: bytes.into() })
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
