//! The images: pixel files as the IR holds them, and bump maps that turn out to hold normals.

use super::{Porter, Wanted, Without};
use crate::diag::{Diagnostic, Sink, clip_path, codes};
use crate::image::{DecodeError, Pixels, decode, is_picture};
use crate::ir::{Bump, Field, ImageId, Lowered, Material, Noun, Place, Scene, Texture, TextureId};
use crate::source::{Found, Kind};

/// The largest pixel file read, in bytes: as large as the largest picture with every pixel stored plainly.
const MAX_BYTES: u64 = 1 << 30;

/// Such files.
pub(super) const KIND: Kind = Kind { extensions: &["png", "jpg", "jpeg", "webp"], begins: is_picture };

/// Brings one image; without its file no material looks at it.
pub(super) fn bring(id: ImageId, wish: &Wanted, lowered: &mut Lowered, porter: &mut Porter<'_>) {
    let pixels = porter.find(wish, Without::Color).and_then(|found| read(&found, wish, porter));
    match (pixels, lowered.scene.images.get_mut(id.0 as usize)) {
        (Some(Pixels { width, height, bytes }), Some(image)) => {
            (image.width, image.height) = (width, height);
            image.pixels = bytes.into();
        }
        (_, _) => forget(id, &mut lowered.scene),
    }
}

fn read(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<Pixels> {
    match porter.loader.found(found, MAX_BYTES, porter.map) {
        Ok(bytes) => decode(&bytes).map_err(|fault| porter.refuse(refusal(&fault, found, wish), Without::Color)).ok(),
        Err(error) => {
            porter.unreadable(found, &error.to_string(), wish.span, Without::Color);
            None
        }
    }
}

fn refusal(fault: &DecodeError, found: &Found, wish: &Wanted) -> Diagnostic {
    let message = format!("the texture `{}` {fault}", found.shown.display());
    let (code, hint) = match fault {
        DecodeError::Format(_) => (&codes::BAD_PICTURE, "textures are PNG, JPEG or WebP"),
        DecodeError::Damaged(_) => (&codes::BAD_PICTURE, "save the picture again"),
        DecodeError::TooLarge { width: _, height: _ } => {
            (&codes::HUGE_PICTURE, "scale it down; a texture has at most 16384 × 16384 pixels")
        }
    };
    Diagnostic::new(code, message).at(wish.span, "named here").hint(hint)
}

/// Takes an image out of every material.
fn forget(id: ImageId, scene: &mut Scene) {
    let textures = &scene.textures;
    let is_it = |texture: &TextureId| textures.get(texture.0 as usize) == Some(&Texture::Image(id));
    for phong in scene.materials.iter_mut().filter_map(Material::phong_mut) {
        for map in [&mut phong.color_map, &mut phong.specular_map, &mut phong.normal_map] {
            map.take_if(|texture| is_it(texture));
        }
        phong.bump.take_if(|bump| is_it(&bump.texture));
    }
}

/// Makes normal maps of the bump maps that hold normals.
pub(super) fn find_normal_maps(lowered: &mut Lowered, sink: &mut Sink) {
    let Scene { materials, textures, images, .. } = &mut lowered.scene;
    let image = |texture: TextureId| match textures.get(texture.0 as usize) {
        Some(Texture::Image(image)) => Some(*image),
        Some(Texture::Uv | Texture::Sampled(_)) | None => None,
    };
    let mut known: Vec<Option<bool>> = vec![None; images.len()];
    for (index, material) in materials.iter_mut().enumerate() {
        let Some(phong) = material.phong_mut() else { continue };
        let (Some(Bump { texture, height: _ }), None) = (&phong.bump, phong.normal_map) else { continue };
        let texture = *texture;
        let Some(image) = image(texture).map(|image| image.0 as usize).filter(|image| *image < images.len()) else {
            continue;
        };
        if *known[image].get_or_insert_with(|| holds_normals(&images[image].pixels)) {
            phong.normal_map = Some(texture);
            phong.bump = None;
            let message = format!("`{}` holds normals, so it is used as a normal map", clip_path(&images[image].name));
            let span = lowered.origins.span(Place::new(Noun::Material, index, Field::Bump));
            sink.push(
                Diagnostic::new(&codes::NORMALS_AS_BUMP, message)
                    .at(span, "holds normals")
                    .hint("name it by `normalMap`"),
            );
        }
    }
}

/// True if most pixels, taken as 2·rgb − 1, are directions that point out of the surface.
fn holds_normals(pixels: &[u8]) -> bool {
    let pixels = pixels.as_chunks::<3>().0;
    let is_normal = |pixel: &&[u8; 3]| {
        let [x, y, z] = pixel.map(|channel| f64::from(channel) / 127.5 - 1.0);
        z > 0.0 && z > x && z > y && (0.75..1.25).contains(&(x * x + y * y + z * z))
    };
    2 * pixels.iter().filter(is_normal).count() > pixels.len()
}
