//! Suns and points without an end; other lights have no exact twin.

use super::MitsubaWriter;
use crate::twin::joined;
use rtc_ir::{Emitter, EntityKind, Field, Light, Punctual, ValuePath};
use rtc_math::{Vec3, unit};

impl MitsubaWriter<'_> {
    pub(super) fn lights(&mut self) {
        let scene = self.scene;
        let shining = scene.lights.iter().enumerate();
        for (index, light) in shining.filter(|(_, light)| light.shines()) {
            let place = ValuePath::new(EntityKind::Light, index, Field::Whole);
            match light {
                Light::Point(_) => {
                    let message = "a light without falloff is left out: Mitsuba has none";
                    self.told.no_twin(message, place);
                }
                Light::Punctual(punctual) => self.punctual(punctual, place),
            }
        }
    }

    fn punctual(&mut self, light: &Punctual, place: ValuePath) {
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
                    self.told.no_twin(message, place);
                }
                self.line(1, r#"<emitter type="point">"#);
                self.value(2, "point", "position", &joined(*position, ", "));
                self.rgb(2, "intensity", *intensity);
                self.line(1, "</emitter>");
            }
            Emitter::Spot { .. } => {
                let message = "a spot is left out: Mitsuba's fades in another way at its rim";
                self.told.no_twin(message, place);
            }
            Emitter::Lamp { .. } => {
                self.told
                    .no_twin("a measured lamp is left out: Mitsuba has none", place);
            }
        }
    }
}
