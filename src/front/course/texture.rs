//! The textures, images and meshes that a scene refers to by file names. A file that is named
//! several times is one entity.

use super::assets::{AssetTarget, PendingAsset};
use super::decode::Spanned;
use super::value::FileName;

use rtc_ir::{
    Filter, Image, ImageId, Mesh, MeshId, Pixels, Sampled, Scene, Texture, TextureId, Wrap,
};
use rtc_source::Span;
use std::collections::BTreeMap;

/// The keyword for the texture coordinates of the surface, instead of a file.
const UV: &str = "UV";

/// One white pixel.
const WHITE_PIXEL: [u8; 3] = [255; 3];

/// One black pixel: three 32-bit floats.
const BLACK_PIXEL: [u8; 12] = [0; 12];

/// The files that the scene has named so far.
#[derive(Default)]
pub(super) struct NamedFiles {
    textures: BTreeMap<String, TextureId>,
    meshes: BTreeMap<(String, Option<String>), MeshId>,
    uv: Option<TextureId>,
    /// The images with alpha, for the textures of `standard` materials.
    sampled: BTreeMap<String, ImageId>,
    pub(super) pending_assets: Vec<PendingAsset>,
}

impl NamedFiles {
    /// The texture of a file. Its image has one white pixel until the file is loaded.
    pub(super) fn texture(
        &mut self,
        scene: &mut Scene,
        (FileName(file), span): (&FileName, Option<Span>),
    ) -> TextureId {
        if file.eq_ignore_ascii_case(UV) {
            return self.uv(scene);
        }
        let name = file.replace('\\', "/");
        if let Some(id) = self.textures.get(&name) {
            return *id;
        }
        let image = scene.add_image(white_image(name.clone()));
        self.pending_assets.push(PendingAsset {
            target: AssetTarget::Image(image),
            path: file.clone(),
            span,
        });
        let id = add(&mut scene.textures, Texture::Image(image), TextureId);
        self.textures.insert(name, id);
        id
    }

    /// The texture of a file with the sampling of glTF. Its image has one white pixel until the
    /// file is loaded.
    pub(super) fn sampled(
        &mut self,
        scene: &mut Scene,
        file: &Spanned<FileName>,
        (wrap, filter): ([Wrap; 2], Filter),
    ) -> TextureId {
        let name = file.value.0.replace('\\', "/");
        let image = self.sampled.get(&name).copied().unwrap_or_else(|| {
            let image = scene.add_image(white_image(name.clone()));
            self.sampled.insert(name, image);
            self.add_pending(AssetTarget::Sampled(image), file);
            image
        });
        let texture = Texture::Sampled(Sampled {
            image,
            wrap,
            filter,
        });
        add_texture(scene, texture)
    }

    /// The texture whose colours are the texture coordinates.
    pub(super) fn uv(&mut self, scene: &mut Scene) -> TextureId {
        *self
            .uv
            .get_or_insert_with(|| add(&mut scene.textures, Texture::Uv, TextureId))
    }

    /// The mesh of a file, or one part of it; empty until the file is loaded.
    pub(super) fn mesh(
        &mut self,
        scene: &mut Scene,
        file: &Spanned<FileName>,
        part: Option<&str>,
    ) -> MeshId {
        let name = file.value.0.replace('\\', "/");
        let key = (name.clone(), part.map(str::to_owned));
        if let Some(id) = self.meshes.get(&key) {
            return *id;
        }
        let empty = Mesh {
            name,
            part: key.1.clone(),
            ..Mesh::default()
        };
        let id = add(&mut scene.meshes, empty, MeshId);
        self.add_pending(AssetTarget::Mesh(id), file);
        self.meshes.insert(key, id);
        id
    }

    /// The image of an environment: one black pixel until the file is loaded.
    pub(super) fn environment(&mut self, scene: &mut Scene, file: &Spanned<FileName>) -> ImageId {
        let (name, pixels) = (file.value.0.replace('\\', "/"), BLACK_PIXEL.to_vec().into());
        let image = Image {
            name,
            width: 1,
            height: 1,
            kind: Pixels::Rgb32f,
            pixels,
        };
        let image = add(&mut scene.images, image, ImageId);
        self.add_pending(AssetTarget::Environment(image), file);
        image
    }

    /// Adds a glTF asset that is placed by `world_from_object`.
    pub(super) fn gltf(&mut self, world_from_object: [[f64; 3]; 4], file: &Spanned<FileName>) {
        self.add_pending(AssetTarget::Gltf(world_from_object), file);
    }

    pub(super) fn add_pending(&mut self, target: AssetTarget, file: &Spanned<FileName>) {
        self.pending_assets.push(PendingAsset {
            target,
            path: file.value.0.clone(),
            span: file.span,
        });
    }
}

/// The texture equal to `texture`, which is added if there is none.
pub(super) fn add_texture(scene: &mut Scene, texture: Texture) -> TextureId {
    let known = scene.textures.iter().position(|known| *known == texture);
    match known.map(u32::try_from) {
        Some(Ok(known)) => TextureId(known),
        Some(Err(_)) | None => add(&mut scene.textures, texture, TextureId),
    }
}

/// The texture whose colours are (u, 1 − v, 0): an image of the colours in the four corners,
/// between which it is interpolated. The first row is v = 1.
pub(super) fn add_uv_down(scene: &mut Scene) -> TextureId {
    let corners = [[0, 0, 0], [255, 0, 0], [0, 255, 0], [255, 255, 0]];
    let image = scene.add_image(Image {
        name: "texcoords.png".to_owned(),
        width: 2,
        height: 2,
        kind: Pixels::Rgb8,
        pixels: corners.concat().into(),
    });
    add(&mut scene.textures, Texture::Image(image), TextureId)
}

/// An image of one white pixel.
fn white_image(name: String) -> Image {
    Image {
        name,
        width: 1,
        height: 1,
        kind: Pixels::Rgb8,
        pixels: WHITE_PIXEL.to_vec().into(),
    }
}

fn add<T, Id>(list: &mut Vec<T>, item: T, id: fn(u32) -> Id) -> Id {
    let index = u32::try_from(list.len()).unwrap_or(u32::MAX);
    list.push(item);
    id(index)
}
