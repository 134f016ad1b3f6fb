//! Textures: images as PNG, samplers, and how the materials look them up.

use super::document::{
    CLAMP_TO_EDGE, Image, Index, LINEAR, LINEAR_MIPMAP_LINEAR, MIN_HIT_DISTANCE, MIRRORED_REPEAT,
    REPEAT, Sampler, Texture, TextureInfo,
};
use super::writer::{GltfWriter, number};
use rtc_diag::codes;
use rtc_image::png_bytes;
use rtc_ir::{
    self as ir, EntityKind, Field, Filter, Map, Pixels, Sampled, TextureId, ValuePath, Wrap,
};
use rtc_math::{atan2, cos, sin};
use serde_json::{Value, json};

/// Pixels along the side of the picture that shows the colours (u, 0, v).
const UV_SIDE: u32 = 256;
/// The rows of the map from the coordinates of the course, where v grows upwards, to those of glTF.
const UPWARDS: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, -1.0, 1.0]];
/// How far a map may be from scales and a turn, as a share of it.
const SHEAR: f64 = 1e-9;

impl GltfWriter<'_> {
    /// What a material says of a map: the index of its texture, the set of coordinates, and their
    /// transformation.
    pub(super) fn texture_info(&mut self, map: &Map, place: ValuePath) -> TextureInfo {
        let Map {
            texture,
            set,
            texture_from_surface,
        } = map;
        let is_upward = matches!(
            self.scene.textures[texture.0 as usize],
            ir::Texture::Uv | ir::Texture::Image(_)
        );
        let map = match (is_upward, texture_from_surface) {
            (false, map) => *map,
            (true, None) => Some(UPWARDS),
            (true, Some([u, [a, b, c]])) => Some([*u, [-a, -b, 1.0 - c]]),
        };
        let index = self.texture(*texture, place);
        let extensions = map.map(|map| {
            self.root.extensions_used.insert("KHR_texture_transform");
            let transform = transform(map).unwrap_or_else(|| {
                let message = "a texture is sheared, for which glTF has no words";
                self.told.tell(&codes::GLTF_UNSAID, message, place);
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
    pub(super) fn texture(&mut self, id: TextureId, place: ValuePath) -> Index<Texture> {
        if let Some(known) = self.textures.get(&id.0) {
            return *known;
        }
        let (source, wrap, filter) = match &self.scene.textures[id.0 as usize] {
            ir::Texture::Uv => {
                let message = "the colours (u, 0, v) become a picture of them";
                self.told.tell(&codes::GLTF_NEARLY, message, place);
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
        };
        let sampler = self.sampler(wrap, filter);
        let index = Index::push(&mut self.root.textures, Texture { sampler, source });
        self.textures.insert(id.0, index);
        index
    }

    fn sampler(&mut self, wrap: [Wrap; 2], filter: Filter) -> Index<Sampler> {
        let [wrap_s, wrap_t] = wrap.map(wrapping);
        let [mag_filter, min_filter] = match filter {
            Filter::Linear => [LINEAR, LINEAR_MIPMAP_LINEAR],
            Filter::Nearest => [MIN_HIT_DISTANCE, MIN_HIT_DISTANCE],
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
        let sampler = Index::push(&mut self.root.samplers, sampler);
        self.samplers.insert(key, sampler);
        sampler
    }

    /// An image of the scene, with 8 bits a channel.
    pub(super) fn image(&mut self, id: u32) -> Index<Image> {
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
        let place = ValuePath::new(EntityKind::Image, id as usize, Field::Whole);
        let bytes = match kind {
            Pixels::Rgb8 | Pixels::Rgba8 => pixels.to_vec(),
            Pixels::Rgb32f => {
                let message = "a picture of floats as a texture is rounded to 8 bits a channel";
                self.told.tell(&codes::GLTF_UNSAID, message, place);
                pixels.as_chunks::<4>().0.iter().map(quantized).collect()
            }
        };
        let png = png_bytes([*width, *height], *kind == Pixels::Rgba8, &bytes);
        let image = self.png(png, name);
        self.images.insert(id, image);
        image
    }

    /// The picture of the colours (u, 0, v), v upwards.
    fn uv_image(&mut self) -> Index<Image> {
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

    fn png(&mut self, png: Vec<u8>, name: &str) -> Index<Image> {
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
        Index::push(&mut self.root.images, image)
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
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let byte = (f32::from_le_bytes(*bytes).clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}

/// The scales, turn and offset of `KHR_texture_transform` that make a map; none if it shears.
fn transform([[a, b, x], [c, d, y]]: [[f64; 3]; 2]) -> Option<Value> {
    let turn = if b == 0.0 && c == 0.0 {
        0.0
    } else {
        atan2(-c, a)
    };
    let (cos, sin) = (cos(turn), sin(turn));
    let (u, v) = (cos * a - sin * c, sin * b + cos * d);
    let back = [cos * u, sin * v, -sin * u, cos * v];
    let off = [a, b, c, d].into_iter().zip(back);
    let off = off
        .map(|(own, back)| (own - back).abs())
        .fold(0.0, f64::max);
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs());
    (off <= SHEAR * size).then(|| json!({ "offset": [x, y], "rotation": turn, "scale": [u, v] }))
}
