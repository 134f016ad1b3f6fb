//! The environments: pictures of light as the IR holds them.

use super::{Porter, Wanted, Without};
use crate::pixels;
use rtc_image::is_radiance;
use rtc_ir::{ImageId, Lowered};
use rtc_source::FileKind;

/// The largest file read, in bytes: every pixel allowed, in 32-bit floats.
const MAX_BYTES: u64 = 1 << 29;

/// Such files.
pub(super) const KIND: FileKind = FileKind {
    extensions: &["hdr", "pic", "exr"],
    begins: is_radiance,
};

/// Brings the image of the environment; without its file there is none.
pub(super) fn bring(id: ImageId, wish: &Wanted, lowered: &mut Lowered, porter: &mut Porter<'_>) {
    let found = porter.find(wish, Without::Environment);
    let image = found.and_then(
        |found| match porter.loader.found(&found, MAX_BYTES, porter.map) {
            Ok(bytes) => {
                let image = pixels::environment(&wish.path, &bytes, porter.map.budget());
                let refuse = |fault| {
                    let name = found.shown.display().to_string();
                    let finding = pixels::no_environment(&fault, &name).at(wish.span, "named here");
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
