//! Writes the Phong model without transmission and maps. Its ambient term, a sum over the lights,
//! becomes one colour.

use super::{PovWriter, vector};
use crate::export::{enumeration, used_materials};
use rtc_ir::{Ambient, Light, Material, Phong, Standard, ValuePath};
use rtc_math::shortest;

impl PovWriter<'_> {
    /// Writes the materials of surfaces.
    pub(super) fn materials(&mut self) {
        for (index, material, path) in used_materials(self.scene) {
            self.material(index, material, path);
        }
    }

    fn material(&mut self, index: usize, material: &Material, path: ValuePath) {
        let phong = match material {
            Material::Phong(phong) => phong.clone(),
            Material::Standard(standard) => {
                let message = "a material of glTF is written as matt, in its base colour";
                self.reporter.unsupported(message, path);
                matt(standard)
            }
        };
        let missing_features = missing_features(&phong);
        if !missing_features.is_empty() {
            let message = format!(
                "a material is written without {}",
                enumeration(&missing_features)
            );
            self.reporter.unsupported(&message, path);
        }
        let ambient = vector(self.ambient_light().map(|channel| channel * phong.ka));
        let color = vector(phong.color);
        let [kd, ks, kr, n] = [phong.kd, phong.ks, phong.mirror_weight(), phong.n].map(shortest);
        self.line(&format!(
            "#declare M{index} = texture {{ pigment {{ rgb {color} }} finish {{ ambient rgb \
            {ambient} \
             diffuse {kd} phong {ks} phong_size {n} reflection {kr} }} }}"
        ));
    }

    /// The factor of the ambient term: the sum of the colours of all lights, or that of the ambient
    /// light.
    fn ambient_light(&self) -> [f64; 3] {
        if self.scene.settings.ambient == Ambient::Once {
            return self.scene.settings.ambient_light;
        }
        let points = self.scene.lights.iter().filter_map(Light::point);
        points.fold([0.0; 3], |sum, light| {
            [0, 1, 2].map(|channel| sum[channel] + light.color[channel])
        })
    }
}

fn matt(standard: &Standard) -> Phong {
    let [r, g, b, _] = standard.base_color;
    Phong {
        color: [r, g, b],
        ..Phong::MATT
    }
}

/// The features of a material that are not written.
fn missing_features(phong: &Phong) -> Vec<&'static str> {
    let parts = [
        (phong.kt > 0.0, "the transmitted light"),
        (phong.glossy_samples > 1, "the spread of its mirror image"),
        (phong.color_map.is_some(), "its texture"),
        (phong.specular_map.is_some(), "its specular map"),
        (phong.normal_map.is_some(), "its normal map"),
        (phong.bump.is_some(), "its bump map"),
    ];
    let parts = parts.into_iter().filter(|(has, _)| *has);
    parts.map(|(_, name)| name).collect()
}
