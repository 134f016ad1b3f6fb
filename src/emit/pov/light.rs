//! Writes lights: points and soft lights of the course are exact; of those in physical units suns
//! and points are, other than close to a point.

use super::{PovWriter, vector};
use crate::export::{ExportedEnvironment, environment, mean_over_directions};
use crate::flat::around;
use crate::picture;
use rtc_ir::{EntityField, EntityKind, Light, PointLight, Punctual, PunctualKind, ValuePath};
use rtc_math::{Vec3, shortest, unit};
use std::f64::consts::PI;

/// The distance within which the light of a point no longer grows, in radii of the scene.
const NEAR: f64 = 1e-4;

impl PovWriter<'_> {
    /// Writes all lights that emit.
    pub(super) fn lights(&mut self) {
        let scene = self.scene;
        let emitting = scene.lights.iter().enumerate();
        for (index, light) in emitting.filter(|(_, light)| light.emits()) {
            let path = ValuePath::new(EntityKind::Light, index, EntityField::Whole);
            self.shines = true;
            match light {
                Light::Point(light) => self.course_light(light),
                Light::Punctual(light) => self.punctual(light, path),
            }
        }
    }

    /// A light of the course; a soft one is a grid of points on the disc that faces what it lights.
    fn course_light(&mut self, light: &PointLight) {
        let samples = self.scene.settings.light_samples;
        let soft = match light.radius > 0.0 && samples > 1 {
            true => {
                let (width, side) = (2.0 * light.radius, samples.isqrt().max(2));
                let width = shortest(width);
                format!(
                    " area_light <{width}, 0, 0>, <0, {width}, 0>, {side}, {side} circular orient \
                     jitter"
                )
            }
            false => String::new(),
        };
        let (position, color) = (vector(light.position), vector(light.color));
        self.line(&format!("light_source {{ {position}, rgb {color}{soft} }}"));
    }

    /// A light in physical units. POV-Ray's colours are those that a white surface reflects.
    fn punctual(&mut self, light: &Punctual, path: ValuePath) {
        let Punctual {
            emitter, intensity, ..
        } = light;
        let around = around(self.scene);
        self.reporter.simplified_light(light, "POV-Ray", path);
        let near = NEAR * around.radius;
        // POV-Ray fades by 2 / (1 + (distance / near)²).
        let color = |factor: f64| {
            vector(intensity.map(|channel| channel * factor / (2.0 * near * near * PI)))
        };
        let fade = format!("fade_distance {} fade_power 2", shortest(near));
        let text = match emitter {
            PunctualKind::Sun { direction } => {
                let to = unit(Vec3::from_array(*direction)).unwrap_or(Vec3::Z);
                let from = around.center + to * (1e3 * around.radius);
                let color = vector(intensity.map(|channel| channel / PI));
                format!(
                    "light_source {{ {}, rgb {color} parallel point_at {} }}",
                    vector(from.to_array()),
                    vector(around.center.to_array())
                )
            }
            PunctualKind::Point { position, .. } => {
                let (position, color) = (vector(*position), color(1.0));
                format!("light_source {{ {position}, rgb {color} {fade} }}")
            }
            PunctualKind::Spot {
                position,
                direction,
                inner_angle,
                outer_angle,
                ..
            } => {
                let message = "POV-Ray's spots fade in another way at their rim";
                self.reporter.unsupported(message, path);
                let at = Vec3::from_array(*position) + Vec3::from_array(*direction);
                format!(
                    "light_source {{ {}, rgb {} spotlight radius {} falloff {} tightness 0 \
                     point_at {} {fade} }}",
                    vector(*position),
                    color(1.0),
                    shortest(inner_angle.to_degrees()),
                    shortest(outer_angle.to_degrees()),
                    vector(at.to_array())
                )
            }
            PunctualKind::Photometric { position, .. } => {
                let color = color(mean_over_directions(emitter));
                format!(
                    "light_source {{ {}, rgb {color} {fade} }}",
                    vector(*position)
                )
            }
        };
        self.line(&text);
    }

    /// The environment, as the sky; `None` if its picture exceeds the budget.
    pub(super) fn environment(&mut self) -> Option<()> {
        let Some(environment) = environment(self.scene) else {
            return Some(());
        };
        let ExportedEnvironment {
            radiance,
            map,
            path,
        } = environment;
        self.shines |= radiance != [0.0; 3];
        let Some((image, [x, y, z])) = map else {
            self.line(&format!(
                "sky_sphere {{ pigment {{ rgb {} }} }}",
                vector(radiance)
            ));
            return Some(());
        };
        let cost = u64::from(image.width) * u64::from(image.height) * 96;
        self.reporter.charge(cost, self.budget, path)?;
        let bytes = picture::environment(image, radiance).ok()?;
        let Some((file, _)) = self.beside(&image.name, (bytes, "exr")) else {
            let message = "the environment map is left out: it needs a file beside the text, as with \
                           `-o FILE`";
            self.reporter.unsupported(message, path);
            return Some(());
        };
        // POV-Ray's map has its left edge at +x, and longitude grows from +x to +z.
        let columns = [z, y, -x, Vec3::ZERO];
        let columns = vector(columns.into_iter().flat_map(|column| column.to_array()));
        self.line(&format!(
            "sky_sphere {{ pigment {{ image_map {{ exr \"{file}\" map_type 1 interpolate 2 }} }} \
             matrix {columns} }}"
        ));
        Some(())
    }
}
