//! The textures of a world, each with its image.

use crate::texture::sampled::{ColorSpace, Map};
use crate::texture::{Filter, Image, Texture, Wrap};
use rtc_math::IdTable;
use rtc_valid::{self as valid, ValidScene};
use std::sync::Arc;

/// The images and the textures of a scene, in its order.
pub(super) struct Textures {
    images: IdTable<valid::Image, Arc<Image>>,
    textures: IdTable<valid::Texture, Texture>,
}

impl Textures {
    pub(super) fn new(scene: &ValidScene) -> Self {
        let images = scene.images().iter().map(image).collect::<IdTable<_, _>>();
        let textures = scene
            .textures()
            .iter()
            .map(|texture| prepared(texture, &images))
            .collect();
        Self { images, textures }
    }

    pub(super) fn image(&self, index: valid::ImageId) -> Arc<Image> {
        Arc::clone(&self.images[index])
    }

    pub(super) fn texture(&self, index: valid::TextureId) -> Texture {
        self.textures[index].clone()
    }

    /// A map of a material of glTF.
    pub(super) fn map(&self, map: &valid::Map, color_space: ColorSpace) -> Map {
        let valid::Map {
            texture,
            set,
            texture_from_surface,
        } = *map;
        Map {
            texture: self.texture(texture),
            set: set.index(),
            texture_from_surface: Some(texture_from_surface)
                .filter(|rows| *rows != valid::Map::IDENTITY),
            color_space,
        }
    }
}

fn image(image: &valid::Image) -> Arc<Image> {
    let valid::Image {
        width,
        height,
        texels,
    } = image;
    Arc::new(Image {
        width: width.get(),
        height: height.get(),
        texels: texels.clone(),
    })
}

fn prepared(texture: &valid::Texture, images: &IdTable<valid::Image, Arc<Image>>) -> Texture {
    match *texture {
        valid::Texture::Uv => Texture::Uv,
        valid::Texture::Procedural(texture) => Texture::Procedural(Box::new(texture)),
        valid::Texture::Image(image) => Texture::Image(Arc::clone(&images[image])),
        valid::Texture::Sampled(valid::Sampled {
            image,
            wrap,
            filter,
        }) => Texture::Sampled {
            image: Arc::clone(&images[image]),
            wrap: wrap.map(|wrap| match wrap {
                valid::Wrap::Repeat => Wrap::Repeat,
                valid::Wrap::Mirror => Wrap::Mirror,
                valid::Wrap::Clamp => Wrap::Clamp,
            }),
            filter: match filter {
                valid::Filter::Linear => Filter::Linear,
                valid::Filter::Nearest => Filter::Nearest,
            },
        },
    }
}
