//! Writes the Phong model: its weights go to `extras.rtc`.

use super::writer::GltfWriter;
use rtc_diag::codes;
use rtc_ir::{Bump, Phong, ValuePath};
use serde_json::{Map as Block, Value, json};

impl GltfWriter<'_> {
    /// The weights and maps of the Phong model for `extras.rtc`.
    pub(super) fn phong(
        &mut self,
        phong: &Phong,
        has_uvs: bool,
        path: ValuePath,
    ) -> Block<String, Value> {
        let Phong {
            color,
            ka,
            kd,
            ks,
            n,
            kt,
            ior,
            glossy_samples,
            color_map,
            specular_map,
            normal_map,
            bump,
        } = phong;
        let message = "Phong's model becomes the metallic-roughness material that comes nearest";
        self.reporter.report(&codes::GLTF_NEARLY, message, path);
        self.reporter
            .in_extras("what Phong's model says of a material", path);
        let mut rtc_extras = json!({
            "color": color,
            "ka": ka,
            "kd": kd,
            "ks": ks,
            "n": n,
            "kt": kt,
            "eta": ior,
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
                rtc_extras[key] = self.texture(texture, path).value().into();
            }
        }
        if let Some(Bump { height, .. }) = bump.as_ref().filter(|_| has_uvs) {
            rtc_extras["bumpHeight"] = (*height).into();
        }
        Block::from_iter([("phong".to_owned(), rtc_extras)])
    }
}
