//! Writes lights: suns, points without range and spots, whose profile is a picture, are exact.

use super::MitsubaWriter;
use crate::export::{ExportedEnvironment, environment, joined};
use crate::path_tracer::{PathTracerLight, SpotEdge, SpotLight, lights};
use crate::picture;
use rtc_image::{FileFormat, Image as Radiances, Picture};
use rtc_ir::ValuePath;
use rtc_math::{OrthonormalBasis, Vec3, cos, shortest, sin, unit};

/// The side in pixels of the picture of the profile of a spot.
const PROFILE: u32 = 256;
/// The widest angle from the axis that Mitsuba's spots are written with, in degrees: the picture of
/// the profile lies on a plane across the axis.
const WIDEST: f64 = 85.0;

impl MitsubaWriter<'_> {
    /// Writes all lights that emit; `None` if a picture exceeds the budget, which is reported.
    pub(super) fn lights(&mut self) -> Option<()> {
        for (light, path) in lights(self.scene, "Mitsuba", &mut self.beside.reporter) {
            self.shines = true;
            match light {
                PathTracerLight::Distant {
                    to_light,
                    irradiance,
                } => {
                    self.line(1, r#"<emitter type="directional">"#);
                    let direction = joined((-to_light).to_array(), ", ");
                    self.value(2, "vector", "direction", &direction);
                    self.rgb(2, "irradiance", irradiance);
                    self.line(1, "</emitter>");
                }
                PathTracerLight::Point {
                    position,
                    intensity,
                } => {
                    self.line(1, r#"<emitter type="point">"#);
                    self.value(2, "point", "position", &joined(position, ", "));
                    self.rgb(2, "intensity", intensity);
                    self.line(1, "</emitter>");
                }
                PathTracerLight::Spot(spot) if spot.edge == SpotEdge::Linear => {
                    self.linear_spot(&spot);
                }
                PathTracerLight::Spot(spot) => self.spot(&spot, path)?,
            }
        }
        Some(())
    }

    /// A spot whose edge fades as that of Mitsuba.
    fn linear_spot(&mut self, spot: &SpotLight) {
        let basis = OrthonormalBasis::around(spot.direction);
        let position = Vec3::from_array(spot.position);
        let [beam, cutoff] = [spot.inner_angle, spot.outer_angle].map(f64::to_degrees);
        self.line(1, r#"<emitter type="spot">"#);
        self.placed([basis.tangent, basis.bitangent, basis.normal, position]);
        self.rgb(2, "intensity", spot.intensity);
        self.value(2, "float", "cutoff_angle", &shortest(cutoff));
        self.value(2, "float", "beam_width", &shortest(beam));
        self.line(1, "</emitter>");
    }

    /// A spot that is full up to its rim, under a picture of its profile. Mitsuba's own fades
    /// linearly in the angle.
    fn spot(&mut self, spot: &SpotLight, path: ValuePath) -> Option<()> {
        // Mitsuba's spot projects a bitmap onto a plane, so its angle is limited.
        let outer = spot.outer_angle.to_degrees();
        if outer > WIDEST {
            let message = "a spot is written without what shines more than 85° from its axis";
            self.beside.reporter.unsupported(message, path);
        }
        let cutoff = outer.min(WIDEST);
        // Sample the profile in directions through the pixels of the plane.
        let basis = OrthonormalBasis::around(spot.direction);
        let reach = sin(cutoff.to_radians()) / cos(cutoff.to_radians());
        let at = |index: u32| ((f64::from(index) + 0.5) / f64::from(PROFILE) * 2.0 - 1.0) * reach;
        let pixel = |x: u32, y: u32| {
            let across = basis.tangent * at(x) + basis.bitangent * at(y);
            let to = unit(basis.normal + across).unwrap_or(basis.normal);
            [spot.profile.factor(to); 3]
        };
        let places = (0..PROFILE).flat_map(|y| (0..PROFILE).map(move |x| (x, y)));
        // Write the factors as a bitmap beside the scene.
        let picture = Picture::opaque(Radiances {
            width: PROFILE,
            height: PROFILE,
            pixels: places.map(|(x, y)| pixel(x, y)).collect(),
        });
        let encoded = picture.encode(FileFormat::Exr).map(|bytes| (bytes, "exr"));
        let file = self.beside.picture("spot", encoded, path)?;
        // Write the emitter with its bitmap.
        self.line(1, r#"<emitter type="spot">"#);
        let position = Vec3::from_array(spot.position);
        self.placed([basis.tangent, basis.bitangent, basis.normal, position]);
        self.rgb(2, "intensity", spot.intensity);
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
            self.line(1, r#"<emitter type="constant">"#);
            self.rgb(2, "radiance", radiance);
            self.line(1, "</emitter>");
            return Some(());
        };
        let cost = u64::from(image.width) * u64::from(image.height) * 96;
        let beside = &mut self.beside;
        beside.reporter.charge(cost, beside.budget, path)?;
        let encoded = picture::environment(image, radiance).map(|bytes| (bytes, "exr"));
        let file = beside.picture(&image.name, encoded, path)?;
        // The middle of Mitsuba's map is +z.
        self.line(1, r#"<emitter type="envmap">"#);
        self.value(2, "string", "filename", &file);
        self.placed([-x, y, -z, Vec3::ZERO]);
        self.line(1, "</emitter>");
        Some(())
    }
}
