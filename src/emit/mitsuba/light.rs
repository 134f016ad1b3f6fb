//! Writes suns and point lights without range; other lights have no exact equivalent.

use super::MitsubaWriter;
use crate::export::joined;
use rtc_ir::{Emitter, EntityKind, Field, Light, Punctual, ValuePath};
use rtc_math::{Vec3, unit};

impl MitsubaWriter<'_> {
    pub(super) fn lights(&mut self) {
        let scene = self.scene;
        let emitting = scene.lights.iter().enumerate();
        for (index, light) in emitting.filter(|(_, light)| light.emits()) {
            let path = ValuePath::new(EntityKind::Light, index, Field::Whole);
            match light {
                Light::Point(_) => {
                    let message = "a light without falloff is left out: Mitsuba has none";
                    self.reporter.unsupported(message, path);
                }
                Light::Punctual(punctual) => self.punctual(punctual, path),
            }
        }
    }

    fn punctual(&mut self, light: &Punctual, path: ValuePath) {
        let Punctual { emitter, intensity } = light;
        match emitter {
            Emitter::Sun { direction } => {
                let to = unit(Vec3::from_array(*direction)).unwrap_or(Vec3::Z);
                self.line(1, r#"<emitter type="directional">"#);
                self.value(2, "vector", "direction", &joined((-to).to_array(), ", "));
                self.rgb(2, "irradiance", *intensity);
                self.line(1, "</emitter>");
            }
            Emitter::Point { position, range } => {
                if range.is_some() {
                    let message = "Mitsuba's points have no range: this one shines beyond its own";
                    self.reporter.unsupported(message, path);
                }
                self.line(1, r#"<emitter type="point">"#);
                self.value(2, "point", "position", &joined(*position, ", "));
                self.rgb(2, "intensity", *intensity);
                self.line(1, "</emitter>");
            }
            Emitter::Spot { .. } => {
                let message = "a spot is left out: Mitsuba's has another falloff at its edge";
                self.reporter.unsupported(message, path);
            }
            Emitter::Photometric { .. } => {
                self.reporter
                    .unsupported("an IES light is left out: Mitsuba has none", path);
            }
        }
    }
}
