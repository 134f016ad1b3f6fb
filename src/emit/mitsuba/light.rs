//! Writes lights: suns, points without range and spots, whose profile is a picture, are exact.

use super::MitsubaWriter;
use crate::export::{joined, mean_over_directions};
use crate::picture;
use rtc_image::{FileFormat, Image as Radiances, Picture};
use rtc_ir::{Emitter, EntityKind, Environment, Field, Light, PointLight, Punctual, ValuePath};
use rtc_math::{Basis, Vec3, cos, shortest, sin, unit};
use rtc_profile::Profile;

/// The side in pixels of the picture of the profile of a spot.
const PROFILE: u32 = 256;
/// The widest angle from the axis that Mitsuba's spots are written with, in degrees: the picture of
/// the profile lies on a plane across the axis.
const WIDEST: f64 = 85.0;

impl MitsubaWriter<'_> {
    /// Writes all lights that emit; `None` if a picture exceeds the budget, which is reported.
    pub(super) fn lights(&mut self) -> Option<()> {
        let scene = self.scene;
        let emitting = scene.lights.iter().enumerate();
        for (index, light) in emitting.filter(|(_, light)| light.emits()) {
            let path = ValuePath::new(EntityKind::Light, index, Field::Whole);
            match light {
                Light::Point(light) => self.course_light(light, path),
                Light::Punctual(punctual) => self.punctual(punctual, path)?,
            }
        }
        Some(())
    }

    fn course_light(&mut self, light: &PointLight, path: ValuePath) {
        let message = "a light without falloff is written as a point light that is equally bright \
                       at the centre of the scene";
        self.reporter.unsupported(message, path);
        let middle = self.scene.bounding_sphere();
        let middle = middle.map_or(Vec3::ZERO, |sphere| sphere.center);
        let intensity = light.intensity_at(middle.to_array());
        self.point(light.position, intensity);
    }

    fn point(&mut self, position: [f64; 3], intensity: [f64; 3]) {
        self.shines = true;
        self.line(1, r#"<emitter type="point">"#);
        self.value(2, "point", "position", &joined(position, ", "));
        self.rgb(2, "intensity", intensity);
        self.line(1, "</emitter>");
    }

    fn punctual(&mut self, light: &Punctual, path: ValuePath) -> Option<()> {
        let Punctual { emitter, intensity } = light;
        if let Emitter::Photometric {
            position,
            direction,
            photometry,
            ..
        } = emitter
            && let Some(angles) = photometry.linear_falloff()
        {
            self.linear_spot(*position, *direction, angles, *intensity);
            return Some(());
        }
        self.reporter.simplified_light(emitter, "Mitsuba", path);
        match emitter {
            Emitter::Sun { direction } => {
                let to = unit(Vec3::from_array(*direction)).unwrap_or(Vec3::Z);
                self.shines = true;
                self.line(1, r#"<emitter type="directional">"#);
                self.value(2, "vector", "direction", &joined((-to).to_array(), ", "));
                self.rgb(2, "irradiance", *intensity);
                self.line(1, "</emitter>");
            }
            Emitter::Point { position, range: _ } => self.point(*position, *intensity),
            Emitter::Spot {
                position,
                direction,
                outer_angle,
                ..
            } => {
                let profile = emitter.profile().unwrap_or(Profile::Uniform);
                let frame = (*position, *direction, outer_angle.to_degrees());
                return self.spot(frame, *intensity, &profile, path);
            }
            Emitter::Photometric { position, .. } => {
                let mean = mean_over_directions(emitter);
                self.point(*position, intensity.map(|channel| channel * mean));
            }
        }
        Some(())
    }

    /// A spot whose edge fades as that of Mitsuba: the angles are in degrees.
    fn linear_spot(
        &mut self,
        position: [f64; 3],
        direction: [f64; 3],
        [beam, cutoff]: [f64; 2],
        intensity: [f64; 3],
    ) {
        let basis = Basis::around(unit(Vec3::from_array(direction)).unwrap_or(Vec3::Z));
        let position = Vec3::from_array(position);
        self.shines = true;
        self.line(1, r#"<emitter type="spot">"#);
        self.placed([basis.tangent, basis.bitangent, basis.normal, position]);
        self.rgb(2, "intensity", intensity);
        self.value(2, "float", "cutoff_angle", &shortest(cutoff));
        self.value(2, "float", "beam_width", &shortest(beam));
        self.line(1, "</emitter>");
    }

    /// A spot that is full up to its rim, under a picture of its profile. Mitsuba's own fades
    /// linearly in the angle.
    fn spot(
        &mut self,
        (position, direction, outer): ([f64; 3], [f64; 3], f64),
        intensity: [f64; 3],
        profile: &Profile,
        path: ValuePath,
    ) -> Option<()> {
        // Mitsuba's spot projects a bitmap onto a plane, so its angle is limited.
        if outer > WIDEST {
            let message = "a spot is written without what shines more than 85° from its axis";
            self.reporter.unsupported(message, path);
        }
        let cutoff = outer.min(WIDEST);
        // Sample the profile in directions through the pixels of the plane.
        let basis = Basis::around(unit(Vec3::from_array(direction)).unwrap_or(Vec3::Z));
        let reach = sin(cutoff.to_radians()) / cos(cutoff.to_radians());
        let at = |index: u32| ((f64::from(index) + 0.5) / f64::from(PROFILE) * 2.0 - 1.0) * reach;
        let pixel = |x: u32, y: u32| {
            let across = basis.tangent * at(x) + basis.bitangent * at(y);
            let to = unit(basis.normal + across).unwrap_or(basis.normal);
            [profile.factor(to); 3]
        };
        let places = (0..PROFILE).flat_map(|y| (0..PROFILE).map(move |x| (x, y)));
        // Write the factors as a bitmap beside the scene.
        let picture = Picture::opaque(Radiances {
            width: PROFILE,
            height: PROFILE,
            pixels: places.map(|(x, y)| pixel(x, y)).collect(),
        });
        let encoded = picture.encode(FileFormat::Exr);
        let encoded = encoded.map(|bytes| (bytes, "exr"));
        let file = self.beside("spot", encoded.map_err(|fault| fault.to_string()), path)?;
        self.shines = true;
        // Write the emitter with its bitmap.
        self.line(1, r#"<emitter type="spot">"#);
        let position = Vec3::from_array(position);
        self.placed([basis.tangent, basis.bitangent, basis.normal, position]);
        self.rgb(2, "intensity", intensity);
        self.value(2, "float", "cutoff_angle", &shortest(cutoff));
        self.value(2, "float", "beam_width", &shortest(cutoff * (1.0 - 1e-6)));
        self.line(2, r#"<texture type="bitmap" name="texture">"#);
        self.value(3, "string", "filename", &file);
        self.value(3, "boolean", "raw", "true");
        self.value(3, "string", "wrap_mode", "clamp");
        self.line(2, "</texture>");
        self.line(1, "</emitter>");
        Some(())
    }

    /// The environment, as a constant or a map.
    pub(super) fn environment(&mut self) -> Option<()> {
        let Some(Environment {
            radiance,
            image,
            image_from_world,
        }) = &self.scene.environment
        else {
            return Some(());
        };
        self.shines |= *radiance != [0.0; 3];
        let Some(image) = image else {
            self.line(1, r#"<emitter type="constant">"#);
            self.rgb(2, "radiance", *radiance);
            self.line(1, "</emitter>");
            return Some(());
        };
        let path = ValuePath::new(EntityKind::Environment, 0, Field::Whole);
        let image = &self.scene.images[image.0 as usize];
        let cost = u64::from(image.width) * u64::from(image.height) * 96;
        self.reporter.charge(cost, self.budget, path)?;
        let encoded = picture::environment(image, *radiance).map(|bytes| (bytes, "exr"));
        let encoded = encoded.map_err(|fault| fault.to_string());
        let file = self.beside(&image.name, encoded, path)?;
        // The middle of Mitsuba's map is +z, that of the IR is −z; the rows of the rotation are the
        // columns of its inverse.
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let rows = image_from_world.unwrap_or(identity);
        let [x, y, z] = rows.map(Vec3::from_array);
        self.line(1, r#"<emitter type="envmap">"#);
        self.value(2, "string", "filename", &file);
        self.placed([-x, y, -z, Vec3::ZERO]);
        self.line(1, "</emitter>");
        Some(())
    }
}
