//! Writes the lights and the environment.

use super::SceneWriter;
use rtc_ir::{Environment, Light, PointLight, Punctual, PunctualKind, Scene};

impl<'s> SceneWriter<'s> {
    pub(super) fn light(&mut self, light: &'s Light) -> Result<(), String> {
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
                emitter,
                intensity,
                projected,
            }) => {
                if projected.is_some() {
                    return Err("a light projects a texture, and this format has none".to_owned());
                }
                let spelling = emitter.spelling();
                self.line(2, &format!("- type: {}", spelling.kind));
                for (key, value) in &spelling.triples {
                    self.numbers(key, value, 4);
                }
                for (key, value) in &spelling.numbers {
                    self.number(key, *value, 4);
                }
                if let PunctualKind::Photometric { photometry, .. } = emitter {
                    let name = self.names.photometry(photometry)?;
                    self.line(4, &format!("file: {name}"));
                }
                self.numbers(spelling.intensity, intensity, 4);
            }
        }
        Ok(())
    }

    pub(super) fn environment(
        &mut self,
        environment: &Environment,
        scene: &'s Scene,
    ) -> Result<(), String> {
        let Environment {
            radiance,
            image,
            image_from_world,
        } = environment;
        self.line(0, "Environment:");
        self.numbers("color", radiance, 2);
        if let Some(image) = image {
            let name = self.names.image(scene, *image)?;
            self.line(2, &format!("file: {name}"));
        }
        if let Some(rows) = image_from_world {
            let rows = self.list(rows.iter().flatten().copied());
            self.line(2, &format!("matrix: {rows}"));
        }
        Ok(())
    }
}
