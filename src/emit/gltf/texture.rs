//! Writes textures: images as PNG, samplers, and texture references.

use super::document::{
    CLAMP_TO_EDGE, GltfIndex, Image, LINEAR, LINEAR_MIPMAP_LINEAR, MIRRORED_REPEAT, NEAREST_FILTER,
    REPEAT, Sampler, Texture, TextureInfo,
};
use super::writer::{GltfWriter, number};
use rtc_color::nearest8;
use rtc_diag::codes;
use rtc_image::png_bytes;
use rtc_ir::{
    self as ir, EntityField, EntityKind, Filter, Map, Pixels, Procedural, Sampled, TextureId,
    ValuePath, Wrap,
};
use rtc_math::{TextureMapping, Vec3, atan2, cos, sin};
use serde_json::{Value, json};

/// The side in pixels of the image of the colours (u, 0, v).
const UV_SIDE: u32 = 256;
/// The side in pixels of the picture of a pattern.
const PATTERN_SIDE: u32 = 512;
/// The rows of the map from texture coordinates of the course, v upwards, to those of glTF.
const UPWARDS: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]];
/// The largest shear of a map that counts as none, relative to its size.
const SHEAR: f64 = 1e-9;

impl GltfWriter<'_> {
    /// The reference to a texture: its index, the set of coordinates, and their transform.
    pub(super) fn texture_info(&mut self, map: &Map, path: ValuePath) -> TextureInfo {
        let Map {
            texture,
            set,
            texture_from_surface,
        } = map;
        let is_upward = matches!(
            self.scene.textures[texture.0 as usize],
            ir::Texture::Uv | ir::Texture::Image(_) | ir::Texture::Procedural(_)
        );
        let map = match (is_upward, texture_from_surface) {
            (false, map) => *map,
            (true, None) => Some(UPWARDS),
            (true, Some([u, [a, b, c]])) => Some([*u, [-a, -b, 1.0 - c]]),
        };
        let index = self.texture(*texture, path);
        let extensions = map.map(|map| {
            self.root.extensions_used.insert("KHR_texture_transform");
            let transform = transform(map).unwrap_or_else(|| {
                let message = "a texture is sheared, which glTF can't express";
                self.reporter.report(&codes::GLTF_UNSAID, message, path);
                json!({})
            });
            json!({ "KHR_texture_transform": transform })
        });
        TextureInfo {
            index,
            scale: None,
            tex_coord: *set,
            extensions,
        }
    }

    /// A texture of the scene.
    pub(super) fn texture(&mut self, id: TextureId, path: ValuePath) -> GltfIndex<Texture> {
        if let Some(known) = self.textures.get(&id.0) {
            return *known;
        }
        let (source, wrap, filter) = match &self.scene.textures[id.0 as usize] {
            ir::Texture::Uv => {
                let message = "the colours (u, 0, v) become a picture of them";
                self.reporter
                    .report(&codes::GLTF_APPROXIMATED, message, path);
                (self.uv_image(), [Wrap::Clamp; 2], Filter::Linear)
            }
            ir::Texture::Image(image) => (
                self.image(number(*image)),
                [Wrap::Repeat; 2],
                Filter::Linear,
            ),
            ir::Texture::Sampled(Sampled {
                image,
                wrap,
                filter,
            }) => (self.image(number(*image)), *wrap, *filter),
            ir::Texture::Procedural(texture) => {
                let image = self.pattern_image(texture, path);
                (image, [Wrap::Repeat; 2], Filter::Linear)
            }
        };
        let sampler = self.sampler(wrap, filter);
        let index = GltfIndex::push(&mut self.root.textures, Texture { sampler, source });
        self.textures.insert(id.0, index);
        index
    }

    fn sampler(&mut self, wrap: [Wrap; 2], filter: Filter) -> GltfIndex<Sampler> {
        let [wrap_s, wrap_t] = wrap.map(wrapping);
        let [mag_filter, min_filter] = match filter {
            Filter::Linear => [LINEAR, LINEAR_MIPMAP_LINEAR],
            Filter::Nearest => [NEAREST_FILTER, NEAREST_FILTER],
        };
        let key = [wrap_s, wrap_t, mag_filter];
        if let Some(known) = self.samplers.get(&key) {
            return *known;
        }
        let sampler = Sampler {
            mag_filter,
            min_filter,
            wrap_s,
            wrap_t,
        };
        let sampler = GltfIndex::push(&mut self.root.samplers, sampler);
        self.samplers.insert(key, sampler);
        sampler
    }

    /// An image of the scene, with 8 bits per channel.
    pub(super) fn image(&mut self, id: u32) -> GltfIndex<Image> {
        if let Some(known) = self.images.get(&id) {
            return *known;
        }
        let ir::Image {
            name,
            width,
            height,
            kind,
            pixels,
        } = &self.scene.images[id as usize];
        let path = ValuePath::new(EntityKind::Image, id as usize, EntityField::Whole);
        let bytes = match kind {
            Pixels::Rgb8 | Pixels::Rgba8 => pixels.to_vec(),
            Pixels::Rgb32f => {
                let message = "a picture of floats as a texture is rounded to 8 bits a channel";
                self.reporter.report(&codes::GLTF_UNSAID, message, path);
                pixels.as_chunks::<4>().0.iter().map(quantized).collect()
            }
        };
        let png = png_bytes([*width, *height], *kind == Pixels::Rgba8, &bytes);
        let image = self.png(png, name);
        self.images.insert(id, image);
        image
    }

    /// The image of the colours (u, 0, v), v upwards.
    fn uv_image(&mut self) -> GltfIndex<Image> {
        if let Some(known) = self.uv_image {
            return known;
        }
        let byte = |step: u32| u8::try_from(step * 255 / (UV_SIDE - 1)).unwrap_or(u8::MAX);
        let pixels: Vec<u8> = (0..UV_SIDE)
            .flat_map(|y| (0..UV_SIDE).flat_map(move |x| [byte(x), 0, byte(UV_SIDE - 1 - y)]))
            .collect();
        let png = png_bytes([UV_SIDE; 2], false, &pixels);
        let image = self.png(png, "UV");
        self.uv_image = Some(image);
        image
    }

    /// Whether a texture is a pattern in space.
    pub(super) fn is_in_space(&self, id: TextureId) -> bool {
        match &self.scene.textures[id.0 as usize] {
            ir::Texture::Procedural(texture) => texture.mapping == TextureMapping::World,
            ir::Texture::Uv | ir::Texture::Image(_) | ir::Texture::Sampled(_) => false,
        }
    }

    /// The picture of a pattern over the unit square of texture coordinates, or its mean colour.
    fn pattern_image(&mut self, texture: &Procedural, path: ValuePath) -> GltfIndex<Image> {
        let is_in_space = texture.mapping == TextureMapping::World;
        let side = if is_in_space { 1 } else { PATTERN_SIDE };
        let solid = texture.solid();
        let color = |x: u32, y: u32| {
            let [u, v] = [x, side - 1 - y].map(|k| (f64::from(k) + 0.5) / f64::from(side));
            let color = solid.map_or(Vec3::ZERO, |solid| match is_in_space {
                true => solid.mean(),
                false => solid.color(Vec3::new(u, v, 0.0)),
            });
            color.to_array().map(nearest8)
        };
        let pixels: Vec<u8> = (0..side)
            .flat_map(|y| (0..side).flat_map(move |x| color(x, y)))
            .collect();
        let (code, message) = match is_in_space {
            true => (
                &codes::GLTF_UNSAID,
                "a pattern in space becomes the mean of its colours",
            ),
            false => (
                &codes::GLTF_APPROXIMATED,
                "a pattern becomes a picture of it",
            ),
        };
        self.reporter.report(code, message, path);
        self.png(png_bytes([side; 2], false, &pixels), "pattern")
    }

    fn png(&mut self, png: Vec<u8>, name: &str) -> GltfIndex<Image> {
        let (uri, buffer_view) = match self.folder {
            Some(folder) => (Some(self.file(folder, (name, "image", "png"), png)), None),
            None => (None, Some(self.view(&png, None))),
        };
        let image = Image {
            buffer_view,
            mime_type: "image/png",
            name: Some(name.to_owned()).filter(|name| !name.is_empty()),
            uri,
        };
        GltfIndex::push(&mut self.root.images, image)
    }
}

fn wrapping(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => REPEAT,
        Wrap::Mirror => MIRRORED_REPEAT,
        Wrap::Clamp => CLAMP_TO_EDGE,
    }
}

/// A little-endian float as a byte, 1 as 255.
fn quantized(bytes: &[u8; 4]) -> u8 {
    nearest8(f32::from_le_bytes(*bytes).into())
}

/// The scale, rotation and offset of `KHR_texture_transform` that equal a map; `None` if it has
/// shear.
fn transform([[a, b, x], [c, d, y]]: [[f64; 3]; 2]) -> Option<Value> {
    let rotation = if b == 0.0 && c == 0.0 {
        0.0
    } else {
        atan2(-c, a)
    };
    let (cos, sin) = (cos(rotation), sin(rotation));
    let (u, v) = (cos * a - sin * c, sin * b + cos * d);
    let back = [cos * u, sin * v, -sin * u, cos * v];
    let off = [a, b, c, d].into_iter().zip(back);
    let off = off
        .map(|(entry, back)| (entry - back).abs())
        .fold(0.0, f64::max);
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs());
    (off <= SHEAR * size)
        .then(|| json!({ "offset": [x, y], "rotation": rotation, "scale": [u, v] }))
}
