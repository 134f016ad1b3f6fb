//! Writes the materials.

use super::SceneWriter;
use rtc_ir::{Bump, Material, Phong, Procedural, Scene, Texture, TextureId};
use rtc_math::{GradientNoise, TextureMapping, TexturePattern, shortest};

impl<'s> SceneWriter<'s> {
    pub(super) fn material(
        &mut self,
        key: &str,
        material: &Material,
        scene: &'s Scene,
    ) -> Result<(), String> {
        match material {
            Material::Phong(phong) => self.phong(key, phong, scene),
            Material::Standard(standard) => self.standard(key, standard, scene),
        }
    }

    fn phong(&mut self, key: &str, phong: &Phong, scene: &'s Scene) -> Result<(), String> {
        // Coefficients.
        let Phong {
            color,
            ka,
            kd,
            ks,
            kr,
            n,
            kt,
            fresnel,
            ior,
            glossy_samples,
            color_map,
            specular_map,
            normal_map,
            bump,
        } = phong;
        self.line(4, key);
        self.numbers("color", color, 6);
        for (key, value) in [("ka", ka), ("kd", kd), ("ks", ks), ("n", n)] {
            self.number(key, *value, 6);
        }
        // Parameters that are usually absent.
        if let Some(kr) = kr {
            self.number("kr", *kr, 6);
        }
        if *kt != 0.0 || *ior != 1.0 {
            self.number("kt", *kt, 6);
            self.number("eta", *ior, 6);
        }
        if *fresnel {
            self.line(6, "fresnel: true");
        }
        if *glossy_samples != 1 {
            self.line(6, &format!("glossySamples: {glossy_samples}"));
        }
        // Texture maps.
        if bump.as_ref().is_some_and(|bump| bump.height != 1.0) {
            return Err(
                "a bump map has another height than 1, and this format has none".to_owned(),
            );
        }
        let bump = bump.as_ref().map(|Bump { texture, height: _ }| texture);
        let maps = [
            ("texture", color_map.as_ref()),
            ("specularMap", specular_map.as_ref()),
            ("normalMap", normal_map.as_ref()),
            ("bump", bump),
        ];
        for (key, texture) in maps {
            if let Some(texture) = texture {
                let name = self.texture_name(*texture, scene)?;
                self.line(6, &format!("{key}: {name}"));
            }
        }
        Ok(())
    }

    /// The name of a texture in the text.
    fn texture_name(&mut self, texture: TextureId, scene: &'s Scene) -> Result<String, String> {
        match exists(texture, scene)? {
            Texture::Uv => Ok("UV".to_owned()),
            Texture::Sampled(_) => {
                Err("a material of the course looks at a texture of glTF".to_owned())
            }
            Texture::Image(image) => self.names.image(scene, *image),
            Texture::Procedural(texture) => Ok(format!("{{{}}}", self.pattern(texture))),
        }
    }
}

impl SceneWriter<'_> {
    /// The keys of a procedural texture.
    pub(super) fn pattern(&mut self, texture: &Procedural) -> String {
        let Procedural {
            pattern,
            colors: [first, second],
            scale,
            mapping,
        } = texture;
        let (word, parameters) = match pattern {
            TexturePattern::Checker => ("checker", String::new()),
            TexturePattern::Stripes => ("stripes", String::new()),
            TexturePattern::Noise(GradientNoise { seed, octaves }) => {
                ("noise", format!(", seed: {seed}, octaves: {octaves}"))
            }
            TexturePattern::Worley { seed } => ("worley", format!(", seed: {seed}")),
        };
        let colors = [first, second].map(|color| self.list(*color));
        let mapping = match mapping {
            TextureMapping::Uv => "",
            TextureMapping::World => ", mapping: world",
        };
        self.finite &= scale.is_finite();
        let (colors, scale) = (colors.join(", "), shortest(*scale));
        format!("pattern: {word}, colors: [{colors}], scale: {scale}{mapping}{parameters}")
    }
}

/// The texture to which a material refers.
pub(super) fn exists(TextureId(id): TextureId, scene: &Scene) -> Result<&Texture, String> {
    let texture = scene.textures.get(id as usize);
    texture.ok_or_else(|| "a material refers to a texture that does not exist".to_owned())
}
