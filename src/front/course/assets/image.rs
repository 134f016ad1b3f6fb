//! Loads the images of textures, and turns bump maps that hold normals into normal maps.

use super::{AssetLoader, AssetTarget, FileCache, MissingAssetPolicy, PendingAsset};
use crate::pixels::{self, PixelDecodeError};
use rtc_diag::{Diagnostic, DiagnosticSink, clip_path, codes};
use rtc_image::OpacityUse;
use rtc_ir::{
    Bump, EntityField, EntityKind, Image, ImageId, LoweredScene, Material, Pixels, Scene, Texture,
    TextureId, ValuePath,
};
use rtc_source::FoundFile;
use std::collections::BTreeMap;

/// The largest file read, in bytes: the largest image, uncompressed.
const MAX_BYTES: u64 = 1 << 30;

/// Loads an image. A file that was loaded before, under any name, gives the same image. `None` if
/// it can't be loaded.
pub(super) fn load(
    id: ImageId,
    pending: &PendingAsset,
    lowered: &mut LoweredScene,
    (cache, opacity): (&mut FileCache<ImageId>, OpacityUse),
    loader: &mut AssetLoader<'_>,
) -> Option<ImageId> {
    let found = loader.find(pending, policy(pending))?;
    let image = cache.get_or_load(&found, || {
        let image = lowered.scene.images.get_mut(id.0 as usize)?;
        *image = read(&image.name, &found, (pending, opacity), loader)?;
        Some(id)
    });
    image.copied()
}

/// Points textures to the loaded images, and removes textures of missing images from the materials.
pub(super) fn resolve_images(image_of: &BTreeMap<u32, Option<ImageId>>, scene: &mut Scene) {
    let mut missing = vec![false; scene.textures.len()];
    for (texture, missing) in scene.textures.iter_mut().zip(&mut missing) {
        let id = match texture {
            Texture::Image(id) => id,
            Texture::Sampled(sampled) => &mut sampled.image,
            Texture::Uv | Texture::Procedural(_) => continue,
        };
        match image_of.get(&id.0) {
            Some(Some(image)) => *id = *image,
            Some(None) => *missing = true,
            None => {}
        }
    }
    let is_missing = |texture: &TextureId| missing.get(texture.0 as usize) == Some(&true);
    for material in &mut scene.materials {
        let phong = match material {
            Material::Phong(phong) => phong,
            Material::Standard(standard) => {
                standard.retain_maps(|map| !is_missing(&map.texture));
                continue;
            }
        };
        for map in [
            &mut phong.color_map,
            &mut phong.specular_map,
            &mut phong.normal_map,
        ] {
            map.take_if(|texture| is_missing(texture));
        }
        phong.bump.take_if(|bump| is_missing(&bump.texture));
    }
}

/// The policy for a missing image.
fn policy(pending: &PendingAsset) -> MissingAssetPolicy {
    if let AssetTarget::Map(_) | AssetTarget::Mask(_) = pending.target {
        MissingAssetPolicy::Map
    } else {
        MissingAssetPolicy::Color
    }
}

fn read(
    name: &str,
    found: &FoundFile,
    (pending, opacity): (&PendingAsset, OpacityUse),
    loader: &mut AssetLoader<'_>,
) -> Option<Image> {
    // The images of an MTL material are combined byte by byte.
    let is_combined = matches!(policy(pending), MissingAssetPolicy::Map);
    let decode = if is_combined {
        pixels::picture
    } else {
        pixels::texture
    };
    match loader.loader.found(found, MAX_BYTES, loader.map) {
        Ok(bytes) => {
            let image = decode(name, &bytes, opacity, loader.map.budget());
            image
                .map_err(|fault| loader.reject(rejection(&fault, found, pending), policy(pending)))
                .ok()
        }
        Err(error) => {
            loader.unreadable(found, &error.to_string(), pending.span, policy(pending));
            None
        }
    }
}

fn rejection(fault: &PixelDecodeError, found: &FoundFile, pending: &PendingAsset) -> Diagnostic {
    let what = format!("the texture `{}`", found.shown.display());
    pixels::rejection(
        fault,
        &what,
        "textures are PNG, JPEG, WebP, EXR, HDR, or KTX2 with Basis Universal",
    )
    .at(pending.span, "named here")
}

/// Turns bump maps that hold normals into normal maps.
pub(super) fn find_normal_maps(lowered: &mut LoweredScene, sink: &mut DiagnosticSink) {
    let Scene {
        materials,
        textures,
        images,
        ..
    } = &mut lowered.scene;
    // Each image is examined once, whatever the number of its materials.
    let image = |texture: TextureId| match textures.get(texture.0 as usize) {
        Some(Texture::Image(image)) => Some(*image),
        Some(Texture::Uv | Texture::Sampled(_) | Texture::Procedural(_)) | None => None,
    };
    let mut is_normal_map: Vec<Option<bool>> = vec![None; images.len()];
    for (index, material) in materials.iter_mut().enumerate() {
        let Some(phong) = material.phong_mut() else {
            continue;
        };
        let (Some(Bump { texture, height: _ }), None) = (&phong.bump, phong.normal_map) else {
            continue;
        };
        let texture = *texture;
        let Some(image) = image(texture)
            .map(|image| image.0 as usize)
            .filter(|image| *image < images.len())
        else {
            continue;
        };
        // Replace the bump map by a normal map.
        if *is_normal_map[image].get_or_insert_with(|| holds_normals(&images[image])) {
            phong.normal_map = Some(texture);
            phong.bump = None;
            let message = format!(
                "`{}` holds normals, so it is used as a normal map",
                clip_path(&images[image].name)
            );
            let span = lowered.source_spans.span(ValuePath::new(
                EntityKind::Material,
                index,
                EntityField::Bump,
            ));
            sink.push(
                Diagnostic::new(&codes::NORMALS_AS_BUMP, message)
                    .at(span, "holds normals")
                    .hint("name it by `normalMap`"),
            );
        }
    }
}

/// Whether most pixels, decoded as 2·rgb − 1, are unit vectors that point out of the surface.
pub(super) fn holds_normals(image: &Image) -> bool {
    let pixels = match image.kind {
        Pixels::Rgb8 => image.pixels.as_chunks::<3>().0,
        Pixels::Rgba8 | Pixels::Rgb32f => &[],
    };
    let is_normal = |pixel: &&[u8; 3]| {
        let [x, y, z] = pixel.map(|channel| f64::from(channel) / 127.5 - 1.0);
        z > 0.0 && z > x && z > y && (0.75..1.25).contains(&(x * x + y * y + z * z))
    };
    2 * pixels.iter().filter(is_normal).count() > pixels.len()
}
