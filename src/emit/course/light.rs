//! The lights and the surroundings back to text.

use super::Text;
use super::material::file_name;
use crate::ir::{Emitter, Environment, Image, Light, PointLight, Punctual};

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
            Light::Punctual(Punctual {
                emitter: Emitter::Sun { direction },
                intensity,
            }) => {
                self.line(2, "- type: sun");
                self.numbers("direction", direction, 4);
                self.numbers("irradiance", intensity, 4);
            }
            Light::Punctual(_) => {
                return Err("a point or spot light in physical units has no spelling".to_owned());
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
