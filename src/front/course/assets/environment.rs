//! Loads the image of the environment.

use super::{AssetLoader, MissingAssetPolicy, PendingAsset};
use crate::pixels;
use rtc_ir::{ImageId, LoweredScene};

/// The largest file read, in bytes: the largest image in 32-bit floats.
const MAX_BYTES: u64 = 1 << 29;

/// Loads the image of the environment. If that fails, the scene has no environment.
pub(super) fn load(
    id: ImageId,
    pending: &PendingAsset,
    lowered: &mut LoweredScene,
    loader: &mut AssetLoader<'_>,
) {
    // Find, read and decode the file.
    let found = loader.find(pending, MissingAssetPolicy::Environment);
    let image = found.and_then(
        |found| match loader.loader.found(&found, MAX_BYTES, loader.map) {
            Ok(bytes) => {
                let image = pixels::environment(&pending.path, &bytes, loader.map.budget());
                let reject = |fault| {
                    let name = found.shown.display().to_string();
                    let diagnostic =
                        pixels::environment_rejection(&fault, &name).at(pending.span, "named here");
                    loader.reject(diagnostic, MissingAssetPolicy::Environment);
                };
                image.map_err(reject).ok()
            }
            Err(error) => {
                loader.unreadable(
                    &found,
                    &error.to_string(),
                    pending.span,
                    MissingAssetPolicy::Environment,
                );
                None
            }
        },
    );
    // Replace the placeholder.
    match (image, lowered.scene.images.get_mut(id.0 as usize)) {
        (Some(image), Some(slot)) => *slot = image,
        (_, _) => lowered.scene.environment = None,
    }
}
