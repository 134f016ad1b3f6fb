//! The materials back to text.

use super::Text;
use crate::ir::{Bump, Material, Phong, Scene, Texture, TextureId};

/// The word that stands for the uv of the surface in place of a file.
const UV: &str = "UV";

impl Text {
    pub(super) fn material(
        &mut self,
        key: &str,
        material: &Material,
        scene: &Scene,
    ) -> Result<(), String> {
        let phong = material
            .phong()
            .ok_or("a material of glTF has no spelling")?;
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
        self.line(4, key);
        self.numbers("color", color, 6);
        for (key, value) in [("ka", ka), ("kd", kd), ("ks", ks), ("n", n)] {
            self.number(key, *value, 6);
        }
        if *kt != 0.0 || *eta != 1.0 {
            self.number("kt", *kt, 6);
            self.number("eta", *eta, 6);
        }
        if *glossy_samples != 1 {
            self.line(6, &format!("glossySamples: {glossy_samples}"));
        }
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
                self.line(6, &format!("{key}: {}", texture_name(*texture, scene)?));
            }
        }
        Ok(())
    }
}

/// What stands for a texture in a text.
fn texture_name(TextureId(id): TextureId, scene: &Scene) -> Result<String, String> {
    let texture = scene
        .textures
        .get(id as usize)
        .ok_or("a material refers to a texture that does not exist")?;
    match texture {
        Texture::Uv => Ok(UV.to_owned()),
        Texture::Sampled(_) => Err("a texture of glTF has no spelling".to_owned()),
        Texture::Image(image) => {
            let image = scene
                .images
                .get(image.0 as usize)
                .ok_or("a texture refers to an image that does not exist")?;
            file_name(&image.name)
        }
    }
}

/// The name of a file in quotes, if it names one.
pub(super) fn file_name(name: &str) -> Result<String, String> {
    if name.is_empty() || name.eq_ignore_ascii_case(UV) || name.contains('\\') {
        return Err(format!(
            "an image or mesh of the name `{}` comes from no file",
            name.escape_debug()
        ));
    }
    Ok(serde_json::Value::from(name).to_string())
}
