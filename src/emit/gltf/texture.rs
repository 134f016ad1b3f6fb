//! Writes textures: images as PNG, samplers, and texture references.

use super::document::{
    CLAMP_TO_EDGE, GltfIndex, Image, LINEAR, LINEAR_MIPMAP_LINEAR, MIRRORED_REPEAT, NEAREST_FILTER,
    REPEAT, Sampler, Texture, TextureInfo,
};
use super::writer::{GltfWriter, number};
use crate::picture::{ColorCoding, IDENTITY, TexturePicture};
use rtc_diag::codes;
use rtc_image::png_bytes;
use rtc_ir::{
    self as ir, EntityField, EntityKind, Filter, Map, Pixels, Sampled, TextureId, ValuePath, Wrap,
};
use rtc_math::{atan2, cos, sin};
use serde_json::{Value, json};

/// The largest shear of a map that counts as none, relative to its size.
const SHEAR: f64 = 1e-9;

impl GltfWriter<'_> {
    /// The reference to a texture: its index, the set of coordinates, and their transform.
    pub(super) fn texture_info(
        &mut self,
        map: &Map,
        coding: ColorCoding,
        path: ValuePath,
    ) -> TextureInfo {
        let picture = TexturePicture::new(self.scene, &self.areas, map.texture);
        let rows = picture.rows(map);
        let index = self.texture(map.texture, coding, path);
        let extensions = (rows != IDENTITY).then(|| {
            self.root.extensions_used.insert("KHR_texture_transform");
            let transform = transform(rows).unwrap_or_else(|| {
                let message = "a texture is sheared, which glTF can't express";
                self.reporter.report(&codes::GLTF_UNSAID, message, path);
                json!({})
            });
            json!({ "KHR_texture_transform": transform })
        });
        TextureInfo {
            index,
            scale: None,
            tex_coord: map.set,
            extensions,
        }
    }

    /// A texture of the scene, with the coding of its colours.
    pub(super) fn texture(
        &mut self,
        id: TextureId,
        coding: ColorCoding,
        path: ValuePath,
    ) -> GltfIndex<Texture> {
        if let Some(known) = self.textures.get(&(id.0, coding)) {
            return *known;
        }
        let picture = TexturePicture::new(self.scene, &self.areas, id);
        let source = match &self.scene.textures[id.0 as usize] {
            ir::Texture::Image(image) | ir::Texture::Sampled(Sampled { image, .. }) => {
                self.image(number(*image), coding)
            }
            ir::Texture::Uv | ir::Texture::Procedural(_) => self.drawn(&picture, coding, path),
        };
        let sampler = self.sampler(picture.wrap, picture.filter);
        let index = GltfIndex::push(&mut self.root.textures, Texture { sampler, source });
        self.textures.insert((id.0, coding), index);
        index
    }

    fn sampler(&mut self, wrap: [Wrap; 2], filter: Filter) -> GltfIndex<Sampler> {
        let [wrap_s, wrap_t] = wrap.map(wrapping);
        // What is seen from afar is the mean of its texels.
        let min_filter = LINEAR_MIPMAP_LINEAR;
        let mag_filter = match filter {
            Filter::Linear => LINEAR,
            Filter::Nearest => NEAREST_FILTER,
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

    /// An image of the scene, with 8 bits per channel; floats are coded as asked.
    pub(super) fn image(&mut self, id: u32, coding: ColorCoding) -> GltfIndex<Image> {
        let is_float = self.scene.images[id as usize].kind == Pixels::Rgb32f;
        let key = (id, coding == ColorCoding::Srgb && is_float);
        if let Some(known) = self.images.get(&key) {
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
                let floats = pixels.as_chunks::<4>().0.iter();
                let floats = floats.map(|bytes| f32::from_le_bytes(*bytes));
                floats.map(|value| coding.byte(value.into())).collect()
            }
        };
        let png = png_bytes([*width, *height], *kind == Pixels::Rgba8, &bytes);
        let image = self.png(png, name);
        self.images.insert(key, image);
        image
    }

    /// The picture of a pattern, with colours up to white.
    fn drawn(
        &mut self,
        picture: &TexturePicture<'_>,
        coding: ColorCoding,
        path: ValuePath,
    ) -> GltfIndex<Image> {
        if let Some(loss) = picture.loss() {
            self.reporter.report(&codes::GLTF_APPROXIMATED, loss, path);
        }
        let (png, is_clipped) = picture.png(coding);
        if is_clipped {
            let message = "a pattern brighter than white is written as white";
            self.reporter.report(&codes::GLTF_UNSAID, message, path);
        }
        self.png(png, "pattern")
    }

    /// Whether a texture is a pattern, which rtc reads from `extras.rtc`.
    pub(super) fn is_pattern(&self, id: TextureId) -> bool {
        match &self.scene.textures[id.0 as usize] {
            ir::Texture::Uv | ir::Texture::Procedural(_) => true,
            ir::Texture::Image(_) | ir::Texture::Sampled(_) => false,
        }
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
