//! Phong's model without what goes through and without maps; the sum over the lights that its
//! ambient term is becomes one colour.

use super::{PovWriter, vector};
use crate::twin::{listed, worn};
use rtc_ir::{Ambient, Light, Material, Phong, Standard, ValuePath};
use rtc_math::shortest;

impl PovWriter<'_> {
    /// Writes the materials that surfaces have.
    pub(super) fn materials(&mut self) {
        for (index, material, place) in worn(self.scene) {
            self.material(index, material, place);
        }
    }

    fn material(&mut self, index: usize, material: &Material, place: ValuePath) {
        let phong = match material {
            Material::Phong(phong) => phong.clone(),
            Material::Standard(standard) => {
                let message = "a material of glTF is written as matt, in its base colour";
                self.told.no_twin(message, place);
                matt(standard)
            }
        };
        let unlike = unlike(&phong);
        if !unlike.is_empty() {
            let message = format!("a material is written without {}", listed(&unlike));
            self.told.no_twin(&message, place);
        }
        let ambient = vector(self.ambient_light().map(|channel| channel * phong.ka));
        let color = vector(phong.color);
        let [kd, ks, n] = [phong.kd, phong.ks, phong.n].map(shortest);
        self.line(&format!(
            "#declare M{index} = texture {{ pigment {{ rgb {color} }} finish {{ ambient rgb {ambient} \
             diffuse {kd} phong {ks} phong_size {n} reflection {ks} }} }}"
        ));
    }

    /// What the ambient term is multiplied by: the sum of the colours of all lights, or 1.
    fn ambient_light(&self) -> [f64; 3] {
        if self.scene.settings.ambient == Ambient::Once {
            return [1.0; 3];
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

/// The parts of a material that are not written.
fn unlike(phong: &Phong) -> Vec<&'static str> {
    let parts = [
        (phong.kt > 0.0, "the light that goes through"),
        (phong.glossy_samples > 1, "the spread of its mirror image"),
        (phong.color_map.is_some(), "its texture"),
        (phong.specular_map.is_some(), "its specular map"),
        (phong.normal_map.is_some(), "its normal map"),
        (phong.bump.is_some(), "its bump map"),
    ];
    let parts = parts.into_iter().filter(|(has, _)| *has);
    parts.map(|(_, words)| words).collect()
}
