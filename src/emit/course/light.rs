//! The lights and the surroundings back to text.

use super::Text;
use super::material::file_name;
use crate::ir::{Environment, Image, Light, PointLight, Punctual};

impl Text {
    pub(super) fn light(&mut self, light: &Light) -> Result<(), String> {
        match light {
            Light::Point(PointLight {
                position,
                color,
                radius,
            }) => {
                self.numbers("- position", position, 2);
                self.numbers("color", color, 4);
                if *radius != 0.0 {
                    self.number("radius", *radius, 4);
                }
            }
            Light::Punctual(Punctual { emitter, intensity }) => {
                let spelling = emitter
                    .spelling()
                    .ok_or("a point or spot light in physical units has no spelling")?;
                self.line(2, &format!("- type: {}", spelling.kind));
                for (key, value) in &spelling.triples {
                    self.numbers(key, value, 4);
                }
                if let Some(file) = spelling.file {
                    self.line(4, &format!("file: {}", file_name(file)?));
                }
                self.numbers(spelling.intensity, intensity, 4);
            }
        }
        Ok(())
    }

    pub(super) fn environment(
        &mut self,
        environment: &Environment,
        images: &[Image],
    ) -> Result<(), String> {
        let Environment {
            radiance,
            image,
            image_from_world,
        } = environment;
        if image_from_world.is_some() {
            return Err("the environment is turned, and its angles are forgotten".to_owned());
        }
        self.line(0, "Environment:");
        self.numbers("color", radiance, 2);
        if let Some(image) = image {
            let image = images
                .get(image.0 as usize)
                .ok_or("the environment refers to an image that does not exist")?;
            self.line(2, &format!("file: {}", file_name(&image.name)?));
        }
        Ok(())
    }
}
