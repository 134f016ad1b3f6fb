//! The textures of images: one for each way in which an image is sampled.

use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_ir::{Sampled, Scene, SourceSpans, Texture, TextureId};
use rtc_source::Span;
use std::collections::BTreeMap;

/// The textures of a scene by their images.
#[derive(Debug, Default)]
pub(crate) struct SampledTextures(BTreeMap<u32, Vec<(Sampled, TextureId)>>);

impl SampledTextures {
    /// The texture of a way of sampling, which is added to the scene when it is first asked for.
    pub(crate) fn add(
        &mut self,
        sampled: Sampled,
        span: Span,
        (scene, spans): (&mut Scene, &mut SourceSpans),
    ) -> TextureId {
        let known = self.0.entry(sampled.image.0).or_default();
        if let Some((_, id)) = known.iter().find(|(other, _)| *other == sampled) {
            return *id;
        }
        let index = scene.textures.len();
        let id = TextureId(u32::try_from(index).unwrap_or(u32::MAX));
        known.push((sampled.clone(), id));
        scene.textures.push(Texture::Sampled(sampled));
        spans.record(
            ValuePath::new(EntityKind::Texture, index, EntityField::Whole),
            span,
        );
        id
    }
}
