//! Writes lights and the environment: spots fall off in another way, all else is exact.

use super::equal_area;
use super::{PbrtWriter, numbers, string};
use crate::export::{ExportedEnvironment, environment};
use crate::path_tracer::{PathTracerLight, SpotEdge, SpotLight, lights};
use rtc_ir::ValuePath;
use rtc_math::{Vec3, acos, cos};
use std::f64::consts::TAU;

impl PbrtWriter<'_> {
    /// Writes all lights that emit.
    pub(super) fn lights(&mut self) {
        for (light, path) in lights(self.scene, "pbrt", &mut self.beside.reporter) {
            self.shines = true;
            let parameters = match light {
                PathTracerLight::Distant {
                    to_light,
                    irradiance,
                } => {
                    let from = numbers("point3", "from", to_light.to_array());
                    let to = numbers("point3", "to", [0.0; 3]);
                    let color = numbers("rgb", "L", irradiance);
                    format!(r#""distant"{from}{to}{color}"#)
                }
                PathTracerLight::Point {
                    position,
                    intensity,
                } => {
                    let from = numbers("point3", "from", position);
                    format!(r#""point"{from}{}"#, numbers("rgb", "I", intensity))
                }
                PathTracerLight::Spot(spot) => self.spot(&spot, path),
            };
            self.line(&format!("LightSource {parameters}"));
        }
    }

    /// A spot. If its edge falls off by another formula, it emits as much light in all.
    fn spot(&mut self, spot: &SpotLight, path: ValuePath) -> String {
        let [inner, outer] = [spot.inner_angle, spot.outer_angle].map(cos);
        // The integral over the cosine; a square falls off to a third.
        let share = match spot.edge {
            SpotEdge::Squared => Some((1.0 - inner) + (inner - outer) / 3.0),
            SpotEdge::Linear => Some(spot.profile.solid_angle() / TAU),
            SpotEdge::SmoothStep => None,
        };
        if share.is_some() {
            let message = "pbrt's spots fade by a smooth step of the cosine at their edge";
            self.beside.reporter.unsupported(message, path);
        }
        let cosines = share.map_or([inner, outer], |share| smooth_step(outer, share));
        let [inner, outer] = cosines.map(|cosine| acos(cosine).to_degrees());
        let from = Vec3::from_array(spot.position);
        [
            r#""spot""#.to_owned(),
            numbers("point3", "from", from.to_array()),
            numbers("point3", "to", (from + spot.direction).to_array()),
            numbers("float", "coneangle", [outer]),
            numbers("float", "conedeltaangle", [outer - inner]),
            numbers("rgb", "I", spot.intensity),
        ]
        .concat()
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
            let color = numbers("rgb", "L", radiance);
            self.line(&format!(r#"LightSource "infinite"{color}"#));
            return Some(());
        };
        // Resample the map to a square of equal areas.
        let beside = &mut self.beside;
        beside
            .reporter
            .charge(equal_area::cost(image), beside.budget, path)?;
        let message = "the environment map is resampled: pbrt's maps are squares of equal areas";
        beside.reporter.unsupported(message, path);
        let encoded = equal_area::encode(image, radiance).map(|bytes| (bytes, "exr"));
        let file = beside.picture(&image.name, encoded, path)?;
        // The pole of pbrt's map is +z, and its middle −x.
        self.attributes(|writer| {
            writer.placed([z, x, y, Vec3::ZERO]);
            let map = string("string", "filename", &file);
            writer.line(&format!(r#"LightSource "infinite"{map}"#));
        });
        Some(())
    }
}

/// The cosines of the inner and the outer angle of a smooth step with the integral `share` over the
/// cosine: (1 − inner) + (inner − outer) / 2. The outer angle is kept if it can be.
fn smooth_step(outer: f64, share: f64) -> [f64; 2] {
    let inner = 2.0 - 2.0 * share - outer;
    match inner < 1.0 {
        true => [inner, outer],
        false => [1.0, (1.0 - 2.0 * share).max(-1.0)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_step_emits_as_much_as_the_edge_that_it_replaces() {
        // A square falls off to a third, a smooth step to a half.
        for [inner, outer] in [[0.9, 0.8], [1.0, 0.5], [0.99, 0.2]] {
            let share = (1.0 - inner) + (inner - outer) / 3.0;
            let [start, end] = smooth_step(outer, share);
            let found = (1.0 - start) + (start - end) / 2.0;
            assert!((found - share).abs() < 1e-12 && start <= 1.0 && start > end);
            assert!(end >= outer - 1e-12, "{end} {outer}");
        }
    }
}
