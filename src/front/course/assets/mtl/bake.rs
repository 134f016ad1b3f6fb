//! Bakes textures of `standard` materials that combine several MTL maps or convert one: colour with
//! opacity, roughness with metallic, normals from heights.

use super::super::AssetLoader;
use super::super::image::holds_normals;
use super::cache::MapPlacement;
use crate::over_limit;
use rtc_diag::{Diagnostic, clip_path, codes};
use rtc_ir::{
    Image, ImageId, LoweredScene, Map, Material, MaterialId, Pixels, Sampled, Scene, Standard,
    Texture, TextureId,
};
use rtc_source::{Resource, Span};
use std::collections::BTreeMap;

/// A texture to bake once its images are loaded.
pub(crate) struct PendingTextureBake {
    pub(super) material: MaterialId,
    pub(super) baked: BakedMap,
    pub(super) placement: MapPlacement,
    pub(super) span: Span,
}

/// The sources of a baked texture.
pub(super) enum BakedMap {
    /// Colour and opacity.
    Opacity {
        color: Option<ImageId>,
        mask: ImageId,
    },
    /// Roughness and metallic.
    MetalRough {
        rough: Option<ImageId>,
        metal: Option<ImageId>,
    },
    /// Heights, and the height of white above black in texel widths.
    Normals { heights: ImageId, height: f64 },
}

/// An image that is sampled by the pixels of an image of another size.
struct ScaledImage<'a>(&'a Image);

impl ScaledImage<'_> {
    /// The RGBA pixel that contains pixel (x, y) of an image of the given size.
    fn pixel(&self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> [u8; 4] {
        let scaled =
            |at: u32, length: u32, size: u32| u64::from(at) * u64::from(length) / u64::from(size);
        let column = scaled(x, self.0.width, width);
        let index = scaled(y, self.0.height, height) * u64::from(self.0.width) + column;
        let size = self.0.kind.bytes();
        let offset = usize::try_from(index)
            .unwrap_or(usize::MAX)
            .saturating_mul(size);
        match self.0.pixels.get(offset..offset + size) {
            Some([r, g, b]) => [*r, *g, *b, u8::MAX],
            Some([r, g, b, alpha]) => [*r, *g, *b, *alpha],
            _ => [u8::MAX; 4],
        }
    }

    fn size(&self) -> [u32; 2] {
        [self.0.width, self.0.height]
    }

    fn has_alpha(&self) -> bool {
        let pixels = self.0.pixels.as_chunks::<4>().0;
        self.0.kind == Pixels::Rgba8 && pixels.iter().any(|[.., alpha]| *alpha < u8::MAX)
    }
}

/// Bakes the textures. `image_of` maps pending images to loaded ones; without its images a texture
/// is left out.
pub(crate) fn bake(
    bakes: Vec<PendingTextureBake>,
    image_of: &BTreeMap<u32, Option<ImageId>>,
    lowered: &mut LoweredScene,
    loader: &mut AssetLoader<'_>,
) {
    let loaded = |image: ImageId| image_of.get(&image.0).copied().flatten();
    // Materials with the same images share a texture.
    let mut known: BTreeMap<String, ImageId> = BTreeMap::new();
    for bake in bakes {
        let scene = &mut lowered.scene;
        // Resolve the images; skip the texture without them.
        let baked = match bake.baked {
            BakedMap::Opacity { color, mask } => loaded(mask).map(|mask| BakedMap::Opacity {
                color: color.and_then(loaded),
                mask,
            }),
            BakedMap::MetalRough { rough, metal } => Some(BakedMap::MetalRough {
                rough: rough.and_then(loaded),
                metal: metal.and_then(loaded),
            }),
            BakedMap::Normals { heights, height } => {
                loaded(heights).map(|heights| BakedMap::Normals { heights, height })
            }
        };
        let Some(baked) = baked else { continue };
        // TextureBake the image, or reuse an equal one.
        let key = baked.key();
        let image = match (known.get(&key), &baked) {
            (Some(image), _) => *image,
            (None, BakedMap::Normals { heights, .. })
                if scene
                    .images
                    .get(heights.0 as usize)
                    .is_some_and(holds_normals) =>
            {
                report_normals(scene, *heights, bake.span, loader);
                *heights
            }
            (None, _) => {
                let bytes = baked.bytes(scene);
                if let Err(fault) = loader.map.budget().charge(Resource::Textures, bytes) {
                    let diagnostic = over_limit("the picture", &fault).at(bake.span, "named here");
                    loader.sink.push(diagnostic);
                    return;
                }
                let Some(image) = baked.image(scene) else {
                    continue;
                };
                scene.add_image(image)
            }
        };
        known.insert(key, image);
        // Add the texture to the material.
        let texture = TextureId(u32::try_from(scene.textures.len()).unwrap_or(u32::MAX));
        scene.textures.push(Texture::Sampled(Sampled {
            image,
            wrap: [bake.placement.wrap; 2],
            filter: rtc_ir::Filter::Linear,
        }));
        let map = Map {
            texture,
            set: 0,
            texture_from_surface: Some(bake.placement.texture_from_surface),
        };
        let material = scene.materials.get_mut(bake.material.0 as usize);
        if let Some(Material::Standard(standard)) = material {
            *baked.slot(standard) = Some(map);
        }
    }
}

fn report_normals(scene: &Scene, image: ImageId, span: Span, loader: &mut AssetLoader<'_>) {
    let name = scene
        .images
        .get(image.0 as usize)
        .map_or("", |image| &*image.name);
    let message = format!(
        "`{}` holds normals, so it is used as a normal map",
        clip_path(name)
    );
    let note = Diagnostic::new(&codes::NORMALS_AS_BUMP, message).at(span, "holds normals");
    loader.sink.push(note.hint("name it by `norm`"));
}

impl BakedMap {
    /// The cache key: equal for equal sources.
    fn key(&self) -> String {
        match self {
            Self::Opacity { color, mask } => format!("opacity {color:?} {mask:?}"),
            Self::MetalRough { rough, metal } => format!("metal {rough:?} {metal:?}"),
            Self::Normals { heights, height } => format!("normals {heights:?} {height}"),
        }
    }

    /// The texture slot of the material that it fills.
    fn slot<'m>(&self, material: &'m mut Standard) -> &'m mut Option<Map> {
        match self {
            Self::Opacity { .. } => &mut material.base_color_map,
            Self::MetalRough { .. } => &mut material.metallic_roughness_map,
            Self::Normals { .. } => &mut material.normal_map,
        }
    }

    fn sources<'a>(&self, scene: &'a Scene) -> [Option<ScaledImage<'a>>; 2] {
        let source =
            |image: Option<ImageId>| Some(ScaledImage(scene.images.get(image?.0 as usize)?));
        match self {
            Self::Opacity { color, mask } => [source(*color), source(Some(*mask))],
            Self::MetalRough { rough, metal } => [source(*rough), source(*metal)],
            Self::Normals { heights, .. } => [source(Some(*heights)), None],
        }
    }

    /// The larger width and the larger height of the sources.
    fn size(&self, scene: &Scene) -> [u32; 2] {
        let sources = self.sources(scene).into_iter().flatten();
        sources.fold([1; 2], |[width, height], source| {
            let [own, high] = source.size();
            [width.max(own), height.max(high)]
        })
    }

    fn bytes(&self, scene: &Scene) -> u64 {
        let [width, height] = self.size(scene);
        4 * u64::from(width) * u64::from(height)
    }

    fn image(&self, scene: &Scene) -> Option<Image> {
        // Sample all sources at one size.
        let size = self.size(scene);
        let sources = self.sources(scene);
        let name = sources.iter().flatten().next()?.0.name.clone();
        let [first, second] = &sources;
        let pixel_at = |source: &Option<ScaledImage<'_>>, position: [u32; 2]| {
            source
                .as_ref()
                .map_or([u8::MAX; 4], |image| image.pixel(position, size))
        };
        let mask_has_alpha = second.as_ref().is_some_and(ScaledImage::has_alpha);
        let positions = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        // Combine the channels.
        let (kind, pixels): (Pixels, Vec<u8>) = match self {
            Self::Opacity { .. } => {
                let pixel = |position| {
                    let ([r, g, b, _], [grey, _, _, alpha]) =
                        (pixel_at(first, position), pixel_at(second, position));
                    [r, g, b, if mask_has_alpha { alpha } else { grey }]
                };
                (Pixels::Rgba8, positions.flat_map(pixel).collect())
            }
            Self::MetalRough { .. } => {
                let pixel = |position| {
                    [
                        u8::MAX,
                        pixel_at(first, position)[0],
                        pixel_at(second, position)[0],
                    ]
                };
                (Pixels::Rgb8, positions.flat_map(pixel).collect())
            }
            Self::Normals { height, .. } => {
                let [width, rows] = size;
                let height_at = |x: u32, y: u32| {
                    let [r, g, b, _] = pixel_at(first, [x % width, y % rows]);
                    (f64::from(r) + f64::from(g) + f64::from(b)) / 765.0
                };
                let pixel = |[x, y]: [u32; 2]| {
                    let right = height_at(x + 1, y) - height_at(x + width - 1, y);
                    let up = height_at(x, y + rows - 1) - height_at(x, y + 1);
                    encode_normal([-height * right / 2.0, -height * up / 2.0, 1.0])
                };
                (Pixels::Rgb8, positions.flat_map(pixel).collect())
            }
        };
        Some(Image {
            name,
            width: size[0],
            height: size[1],
            kind,
            pixels: pixels.into(),
        })
    }
}

/// Encodes a direction as a pixel of a normal map.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 0 to 255"
)]
fn encode_normal(direction: [f64; 3]) -> [u8; 3] {
    let square: f64 = direction
        .iter()
        .map(|component| component * component)
        .sum();
    direction.map(|component| ((component / square.sqrt() + 1.0) * 127.5).round() as u8)
}
