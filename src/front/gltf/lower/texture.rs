//! Textures and images. Each is lowered once.

use super::super::document::Document;
use super::super::field::ObjectFields;
use super::super::report::AssetReport;
use rtc_diag::codes;
use rtc_ir::{
    self as ir, EntityField, EntityKind, Filter, ImageId, Map, Sampled, Scene, SourceSpans,
    TextureId, ValuePath, Wrap,
};
use rtc_math::{cos, sin, to_u32};
use std::collections::BTreeMap;

/// What became of the textures and images of the asset.
pub(super) struct LoweredTextures {
    textures: Vec<Option<Option<TextureId>>>,
    /// Those that Phong's model looks up.
    of_phong: BTreeMap<usize, TextureId>,
    /// The image that each picture of the document became.
    images: BTreeMap<usize, ImageId>,
}

/// The OpenGL codes of wrap modes, and of the nearest filter.
const CLAMP: u64 = 33071;
const MIRROR: u64 = 33648;
const NEAREST_FILTER: u64 = 9728;

impl LoweredTextures {
    pub(super) fn new(doc: &Document<'_>) -> Self {
        Self {
            textures: vec![None; doc.textures.len()],
            of_phong: BTreeMap::new(),
            images: BTreeMap::new(),
        }
    }

    /// The map of a texture info of a material, with the set of texture coordinates as glTF numbers
    /// it; `None` if its texture has no readable image.
    pub(super) fn map(
        &mut self,
        doc: &Document<'_>,
        info: ObjectFields<'_, '_>,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &mut AssetReport<'_, '_>,
    ) -> Option<Map> {
        let texture = self.texture(doc, info.index("index")?, scene, source_spans, report)?;
        let transform = info.extension("KHR_texture_transform");
        let set = transform
            .and_then(|fields| fields.integer("texCoord"))
            .or(info.integer("texCoord"))
            .unwrap_or(0);
        Some(Map {
            texture,
            set: u32::try_from(set).unwrap_or(u32::MAX),
            texture_from_surface: transform.map(texture_from_surface),
        })
    }

    /// The image of a texture as Phong's model looks it up; none if it can't be read.
    pub(super) fn of_phong(
        &mut self,
        doc: &Document<'_>,
        index: usize,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &AssetReport<'_, '_>,
    ) -> Option<TextureId> {
        if let Some(known) = self.of_phong.get(&index) {
            return Some(*known);
        }
        let texture = doc.textures.get(index)?;
        let image = self.image(doc, texture.source?, scene, source_spans, report)?;
        let id = TextureId(to_u32(scene.textures.len()));
        let place = ValuePath::new(
            EntityKind::Texture,
            scene.textures.len(),
            EntityField::Whole,
        );
        source_spans.record(place, report.json.span(texture.at));
        scene.textures.push(ir::Texture::Image(image));
        self.of_phong.insert(index, id);
        Some(id)
    }

    fn texture(
        &mut self,
        doc: &Document<'_>,
        index: usize,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &mut AssetReport<'_, '_>,
    ) -> Option<TextureId> {
        // Each texture is lowered once.
        if let Some(known) = self.textures.get(index)? {
            return *known;
        }
        let texture = &doc.textures[index];
        // Prefer the compressed image of an extension to that of the core.
        let mut images = [texture.ktx2, texture.webp, texture.source]
            .into_iter()
            .flatten();
        let image = images.find(|image| {
            doc.images
                .get(*image)
                .is_some_and(|image| image.picture.is_some())
        });
        let image = image.and_then(|image| self.image(doc, image, scene, source_spans, report));
        if image.is_none() {
            let message = "the texture has no readable image, so it has no effect";
            let message = message.to_owned();
            let hint = "give the texture a `source` that is PNG or JPEG".to_owned();
            report.add_with_hint(&codes::GLTF_MATERIAL_ODD, "", texture.at, message, hint);
        }
        // The sampler gives wrap modes and the filter.
        let sampler = texture
            .sampler
            .and_then(|sampler| doc.samplers.get(sampler));
        let wrap = sampler.map_or([Wrap::Repeat; 2], |sampler| sampler.wrap.map(wrap));
        let is_nearest = sampler.is_some_and(|sampler| sampler.mag_filter == Some(NEAREST_FILTER));
        let filter = if is_nearest {
            Filter::Nearest
        } else {
            Filter::Linear
        };
        // Store the texture with its origin.
        let id = image.map(|image| {
            let at = scene.textures.len();
            source_spans.record(
                ValuePath::new(EntityKind::Texture, at, EntityField::Whole),
                report.json.span(texture.at),
            );
            scene.textures.push(ir::Texture::Sampled(Sampled {
                image,
                wrap,
                filter,
            }));
            TextureId(to_u32(at))
        });
        self.textures[index] = Some(id);
        id
    }

    /// An image of the document; none if it can't be read.
    pub(super) fn image(
        &mut self,
        doc: &Document<'_>,
        index: usize,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &AssetReport<'_, '_>,
    ) -> Option<ImageId> {
        let image = doc.images.get(index)?;
        let picture = image.picture?;
        Some(*self.images.entry(picture).or_insert_with(|| {
            let at = scene.images.len();
            source_spans.record(
                ValuePath::new(EntityKind::Image, at, EntityField::Whole),
                report.json.span(image.at),
            );
            scene.images.push(ir::Image {
                name: image.name.clone(),
                ..doc.pictures[picture].clone()
            });
            ImageId(to_u32(at))
        }))
    }
}

fn wrap(code: u64) -> Wrap {
    match code {
        CLAMP => Wrap::Clamp,
        MIRROR => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

/// Scale, then rotation, then offset (`KHR_texture_transform`).
fn texture_from_surface(fields: ObjectFields<'_, '_>) -> [[f64; 3]; 2] {
    let [x, y] = fields.vector_or("offset", [0.0; 2]);
    let [u, v] = fields.vector_or("scale", [1.0; 2]);
    let angle = fields.number_or("rotation", 0.0);
    let (c, s) = (cos(angle), sin(angle));
    [[c * u, s * v, x], [-s * u, c * v, y]]
}
