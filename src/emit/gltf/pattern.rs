//! Writes the patterns of materials to `extras.rtc`: glTF has pictures only.

use super::writer::GltfWriter;
use rtc_ir::{Map, Material, Texture, ValuePath};
use rtc_math::{TextureMapping, TexturePattern};
use serde_json::{Map as JsonObject, Value, json};

impl GltfWriter<'_> {
    /// Writes the patterns of a material, each with the parameter whose map it is.
    pub(super) fn patterns(
        &mut self,
        material: &Material,
        rtc_extras: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let mut patterns = Vec::new();
        for (parameter, map) in material.maps() {
            let texture = &self.scene.textures[map.texture.0 as usize];
            if let Some(mut pattern) = pattern(texture) {
                pattern["parameter"] = json!(parameter);
                placed(&mut pattern, &map);
                patterns.push(pattern);
            }
        }
        if !patterns.is_empty() {
            self.reporter.in_extras("a pattern", path);
            rtc_extras.insert("patterns".to_owned(), patterns.into());
        }
    }
}

/// Writes where a surface shows a pattern.
fn placed(pattern: &mut Value, map: &Map) {
    if map.set != 0 {
        pattern["set"] = map.set.into();
    }
    if let Some(rows) = map.texture_from_surface {
        pattern["textureFromSurface"] = json!(rows.as_flattened());
    }
}

/// A pattern; `None` for an image.
fn pattern(texture: &Texture) -> Option<Value> {
    let texture = match texture {
        Texture::Uv => return Some(json!({ "pattern": "uv" })),
        Texture::Image(_) | Texture::Sampled(_) => return None,
        Texture::Procedural(texture) => texture,
    };
    let mut pattern = match texture.pattern {
        TexturePattern::Checker => json!({ "pattern": "checker" }),
        TexturePattern::Stripes => json!({ "pattern": "stripes" }),
        TexturePattern::Noise(noise) => {
            json!({ "pattern": "noise", "seed": noise.seed, "octaves": noise.octaves })
        }
        TexturePattern::Worley { seed } => json!({ "pattern": "worley", "seed": seed }),
    };
    pattern["colors"] = json!(texture.colors.as_flattened());
    pattern["scale"] = json!(texture.scale);
    if texture.mapping == TextureMapping::World {
        pattern["mapping"] = json!("world");
    }
    Some(pattern)
}
