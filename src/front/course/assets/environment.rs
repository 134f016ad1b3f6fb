//! The environments: pictures of light as the IR holds them.

use super::{Porter, Wanted, Without, over_limit};
use crate::diag::{Diagnostic, codes};
use crate::front::pixels::{self, Refused};
use crate::image::{DecodeError, Radiance, is_radiance};
use crate::ir::{Image, ImageId, Lowered, Pixels};
use crate::source::{Budget, Kind};

/// The largest file read, in bytes: every pixel allowed, in 32-bit floats.
const MAX_BYTES: u64 = 1 << 29;

/// Such files.
pub(super) const KIND: Kind = Kind {
    extensions: &["hdr", "pic", "exr"],
    begins: is_radiance,
};

/// Brings the image of the environment; without its file there is none.
pub(super) fn bring(id: ImageId, wish: &Wanted, lowered: &mut Lowered, porter: &mut Porter<'_>) {
    let found = porter.find(wish, Without::Environment);
    let image = found.and_then(
        |found| match porter.loader.found(&found, MAX_BYTES, porter.map) {
            Ok(bytes) => {
                let image = environment(&wish.path, &bytes, porter.map.budget());
                let refuse = |fault| {
                    let finding = refusal(&fault, &found.shown.display().to_string())
                        .at(wish.span, "named here");
                    porter.refuse(finding, Without::Environment);
                };
                image.map_err(refuse).ok()
            }
            Err(error) => {
                porter.unreadable(&found, &error.to_string(), wish.span, Without::Environment);
                None
            }
        },
    );
    match (image, lowered.scene.images.get_mut(id.0 as usize)) {
        (Some(image), Some(place)) => *place = image,
        (_, _) => lowered.scene.environment = None,
    }
}

/// The image of a Radiance HDR or OpenEXR file.
///
/// # Errors
/// If the bytes are no such file, damaged, or ask for too much.
pub fn environment(name: &str, bytes: &[u8], budget: &Budget) -> Result<Image, Refused> {
    budget.read(bytes.len());
    let Radiance {
        width,
        height,
        bytes,
    } = pixels::decode_radiance(bytes, budget)?;
    Ok(Image {
        name: name.to_owned(),
        width,
        height,
        kind: Pixels::Rgb32f,
        pixels: bytes.into(),
    })
}

/// What to say of such a file that can't be read.
#[must_use]
pub fn refusal(fault: &Refused, name: &str) -> Diagnostic {
    let fault = match fault {
        Refused::Limit(fault) => return over_limit(&format!("the environment `{name}`"), fault),
        Refused::File(fault) => fault,
    };
    let (code, hint) = match fault {
        DecodeError::Format(_) => (
            &codes::BAD_PICTURE,
            "environments are Radiance HDR or OpenEXR",
        ),
        DecodeError::Damaged(_) => (&codes::BAD_PICTURE, "save the picture again"),
        DecodeError::TooLarge {
            width: _,
            height: _,
        } => (
            &codes::HUGE_PICTURE,
            "scale it down, or set another limit by `--limit pixels=…`",
        ),
    };
    Diagnostic::new(code, format!("the environment `{name}` {fault}")).hint(hint)
}
