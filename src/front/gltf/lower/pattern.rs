//! The patterns of a material in `extras.rtc`, for which other programs see pictures.

use super::super::field::ObjectFields;
use rtc_ir::{EntityField, EntityKind, Map, Procedural, Scene, SourceSpans, Texture, ValuePath};
use rtc_math::{GradientNoise, TextureMapping, TexturePattern, to_u32};
use rtc_source::Span;

/// Adds the patterns of a material to the scene; returns their maps with the parameters that these
/// are.
pub(super) fn add_patterns(
    fields: ObjectFields<'_, '_>,
    span: Span,
    (scene, source_spans): (&mut Scene, &mut SourceSpans),
) -> Vec<(String, Map)> {
    let extras = fields.rtc_extras();
    let patterns = extras.iter().flat_map(|extras| extras.objects("patterns"));
    let mut maps = Vec::new();
    for pattern in patterns {
        let Some((parameter, texture)) = pattern.text("parameter").zip(texture(pattern)) else {
            continue;
        };
        let at = scene.textures.len();
        let place = ValuePath::new(EntityKind::Texture, at, EntityField::Whole);
        source_spans.record(place, span);
        scene.textures.push(texture);
        let rows = pattern.vector::<6>("textureFromSurface");
        let map = Map {
            texture: rtc_ir::TextureId(to_u32(at)),
            set: pattern.count_or("set", 0),
            texture_from_surface: rows.map(|[a, b, c, d, e, f]| [[a, b, c], [d, e, f]]),
        };
        maps.push((parameter, map));
    }
    maps
}

fn texture(fields: ObjectFields<'_, '_>) -> Option<Texture> {
    let seed = fields.count_or("seed", 0);
    let pattern = match fields.text("pattern")?.as_str() {
        "uv" => return Some(Texture::Uv),
        "checker" => TexturePattern::Checker,
        "stripes" => TexturePattern::Stripes,
        "noise" => TexturePattern::Noise(GradientNoise {
            seed,
            octaves: fields.count_or("octaves", 1),
        }),
        "worley" => TexturePattern::Worley { seed },
        _ => return None,
    };
    let [a, b, c, d, e, f] = fields.vector("colors")?;
    Some(Texture::Procedural(Procedural {
        pattern,
        colors: [[a, b, c], [d, e, f]],
        scale: fields.number("scale")?,
        mapping: match fields.text("mapping").as_deref() {
            Some("world") => TextureMapping::World,
            _ => TextureMapping::Uv,
        },
    }))
}
