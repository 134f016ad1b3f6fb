//! Phong's model: the material of glTF that comes nearest, and its own weights in `extras.rtc`.

use super::writer::GltfWriter;
use crate::diag::codes;
use crate::ir::{Bump, Map, Phong, Place, Standard, TextureId};
use crate::standard::{PhongTerms, fit_phong};
use gltf::json::Value;
use serde_json::{Map as Block, json};

/// The material of glTF that comes nearest, as traced paths show Phong's model. But for what
/// refracts, its index of refraction is that of glTF's dielectric: Phong's speaks of rays that go
/// through, and where none do it would be a surface without highlights.
pub(super) fn nearest(phong: &Phong) -> Standard {
    let fit = fit_phong(&PhongTerms {
        color: phong.color,
        kd: phong.kd,
        ks: phong.ks,
        n: phong.n,
        kt: phong.kt,
        eta: phong.eta,
    });
    let [r, g, b] = fit.base_color;
    let map = |texture: Option<TextureId>| {
        texture.map(|texture| Map {
            texture,
            set: 0,
            texture_from_surface: None,
        })
    };
    let default = Standard::default();
    let refracts = fit.transmission > 0.0;
    Standard {
        base_color: [r, g, b, 1.0],
        base_color_map: map(phong.color_map),
        normal_map: map(phong.normal_map),
        metallic: fit.metallic,
        roughness: fit.roughness,
        specular: fit.specular,
        transmission: fit.transmission,
        thickness: fit.thickness,
        ior: if refracts { fit.ior } else { default.ior },
        // A volume has one side, and both of anything else are seen.
        double_sided: !refracts,
        ..default
    }
}

impl GltfWriter<'_> {
    /// The weights and maps of Phong's model for `extras.rtc`.
    pub(super) fn phong(
        &mut self,
        phong: &Phong,
        has_uvs: bool,
        place: Place,
    ) -> Block<String, Value> {
        let Phong {
            color,
            ka,
            kd,
            ks,
            n,
            kt,
            eta,
            glossy_samples,
            color_map,
            specular_map,
            normal_map,
            bump,
        } = phong;
        let message = "Phong's model becomes the metallic-roughness material that comes nearest";
        self.told.tell(&codes::GLTF_NEARLY, message, place);
        self.told
            .own_words("what Phong's model says of a material", place);
        let mut own = json!({
            "color": color,
            "ka": ka,
            "kd": kd,
            "ks": ks,
            "n": n,
            "kt": kt,
            "eta": eta,
            "glossySamples": glossy_samples,
        });
        let bump_map = bump.as_ref().map(|Bump { texture, .. }| *texture);
        let maps = [
            ("colorMap", color_map),
            ("specularMap", specular_map),
            ("normalMap", normal_map),
            ("bumpMap", &bump_map),
        ];
        for (key, texture) in maps {
            if let Some(texture) = texture.filter(|_| has_uvs) {
                own[key] = self.texture(texture, place).value().into();
            }
        }
        if let Some(Bump { height, .. }) = bump.as_ref().filter(|_| has_uvs) {
            own["bumpHeight"] = (*height).into();
        }
        Block::from_iter([("phong".to_owned(), own)])
    }
}
