//! Lights: points, spots, suns, the environment; area lights are part of their shapes.

use super::Lowering;
use super::parameter::Parameters;
use super::plugins::{AREA_LIGHTS, LIGHTS};
use crate::exchange::SpannedText;
use crate::exchange::spot::falling;
use crate::pixels;
use rtc_diag::codes;
use rtc_ir::{EntityKind, Environment, Image, Light, Punctual, PunctualKind};
use rtc_math::{Vec3, cos, unit};
use rtc_source::Resource;
use std::f64::consts::PI;

use super::equal_area;

/// The light of the shapes that follow.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// The radiance, without the factor of its power.
    radiance: [f64; 3],
    /// The power that all of the light emits.
    power: Option<f64>,
    is_two_sided: bool,
    text: SpannedText,
}

impl AreaLight {
    /// The radiance of a shape of this area; `None` where that counts and is not known.
    pub(super) fn radiance(&self, area: Option<f64>) -> Option<[f64; 3]> {
        let Some(power) = self.power else {
            return Some(self.radiance);
        };
        let sides = if self.is_two_sided { 2.0 } else { 1.0 };
        let area = area.filter(|area| *area > 0.0)?;
        Some(
            self.radiance
                .map(|channel| channel * power / (PI * area * sides)),
        )
    }

    pub(super) fn is_two_sided(&self) -> bool {
        self.is_two_sided
    }

    pub(super) fn text(&self) -> &SpannedText {
        &self.text
    }
}

impl Lowering<'_> {
    pub(super) fn light_source(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        match LIGHTS.known(&plugin.text) {
            "point" => self.point(plugin, parameters),
            "spot" => self.spot(plugin, parameters),
            "distant" => self.distant(plugin, parameters),
            "infinite" | "exinfinite" => self.infinite(plugin, parameters),
            "goniometric" | "projection" => {
                let instead = "a point light without its image replaces it";
                self.unsupported("light", plugin, &LIGHTS, instead);
                parameters.skip(&["mapname", "filename", "fov"]);
                self.point(plugin, parameters);
            }
            _ => self.unsupported("light", plugin, &LIGHTS, "it is left out"),
        }
        // How often a light is sampled is `rtc`'s own affair.
        parameters.skip(&["samples", "nsamples"]);
        self.ignored("light", &plugin.text, (&LIGHTS, parameters));
    }

    /// The factor of a light: that of the film, and its own.
    fn factor(&mut self, parameters: &Parameters) -> [f64; 3] {
        let scale = self.color(parameters, "scale").unwrap_or([1.0; 3]);
        let exposure = self.exposure;
        scale.map(|channel| channel * exposure)
    }

    /// The intensity of a light without extent; `unit_power` is the power of the intensity 1.
    fn intensity(&mut self, parameters: &Parameters, unit_power: f64) -> [f64; 3] {
        let factor = self.factor(parameters);
        let power = parameters.number("power").filter(|power| *power > 0.0);
        let power = power.map_or(1.0, |power| power / unit_power);
        let color = self.light_color(parameters, "I");
        std::array::from_fn(|c| color[c] * factor[c] * power)
    }

    fn punctual(&mut self, plugin: &SpannedText, emitter: PunctualKind, intensity: [f64; 3]) {
        if self.charge(Resource::Surfaces, 1, plugin.span).is_none() {
            return;
        }
        self.record(EntityKind::Light, self.scene.lights.len(), plugin.span);
        let intensity = intensity.map(|channel| channel.max(0.0));
        self.scene
            .lights
            .push(Light::Punctual(Punctual::new(emitter, intensity)));
    }

    fn point(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        let from = parameters.vector("from").unwrap_or([0.0; 3]);
        let position = self
            .state
            .transform
            .point(Vec3::from_array(from))
            .to_array();
        let intensity = self.intensity(parameters, 4.0 * PI);
        let emitter = PunctualKind::Point {
            position,
            range: None,
        };
        self.punctual(plugin, emitter, intensity);
    }

    /// A spot. Its intensity falls off by a smooth step of the cosine.
    fn spot(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        let point = |name, default| Vec3::from_array(parameters.vector(name).unwrap_or(default));
        let transform = self.state.transform;
        let from = transform.point(point("from", [0.0; 3]));
        let to = transform.point(point("to", [0.0, 0.0, 1.0]));
        let Some(direction) = unit(to - from) else {
            return self.mistake(plugin.span, "a spot shines from a point to itself");
        };
        let cone = parameters.number("coneangle").unwrap_or(30.0);
        let edge = parameters.number("conedeltaangle").unwrap_or(5.0);
        let outer_angle = cone.clamp(1e-3, 90.0).to_radians();
        let inner_angle = (cone - edge)
            .to_radians()
            .clamp(0.0, outer_angle * 0.999_999);
        // The power of a smooth step of the cosine.
        let (start, end) = (cos(inner_angle), cos(outer_angle));
        let unit_power = 2.0 * PI * ((1.0 - start) + (start - end) / 2.0);
        let intensity = self.intensity(parameters, unit_power);
        let emitter = falling(from, direction, &smooth_step(inner_angle, outer_angle));
        self.punctual(plugin, emitter, intensity);
    }

    fn distant(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        let point = |name, default| Vec3::from_array(parameters.vector(name).unwrap_or(default));
        let along = point("from", [0.0; 3]) - point("to", [0.0, 0.0, 1.0]);
        let Some(direction) = unit(self.state.transform.vector(along)) else {
            return self.mistake(plugin.span, "a distant light shines from a point to itself");
        };
        let factor = self.factor(parameters);
        let illuminance = parameters.number("illuminance").filter(|lux| *lux > 0.0);
        let color = self.light_color(parameters, "L");
        let irradiance = std::array::from_fn(|c| color[c] * factor[c] * illuminance.unwrap_or(1.0));
        let emitter = PunctualKind::Sun {
            direction: direction.to_array(),
        };
        self.punctual(plugin, emitter, irradiance);
    }

    /// Light from all around, constant or by a map.
    fn infinite(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        let factor = self.factor(parameters);
        let color = self.light_color(parameters, "L");
        // Version 3 has pictures of longitude and latitude, version 4 those of equal areas.
        let old = parameters.string("mapname").cloned();
        let is_equal_area = old.is_none() && !self.is_version_3;
        let path = old.or_else(|| parameters.string("filename").cloned());
        if parameters.get("portal").is_some() {
            self.approximate(plugin.span, "light comes from outside of the portal, too");
        }
        let illuminance = parameters.number("illuminance").filter(|lux| *lux > 0.0);
        let illuminance = match (illuminance, &path) {
            (Some(_), Some(_)) => {
                let message = "the `illuminance` of a map is left out";
                self.approximate(plugin.span, message);
                1.0
            }
            (lux, _) => lux.map_or(1.0, |lux| lux / PI),
        };
        let radiance: [f64; 3] =
            std::array::from_fn(|c| (color[c] * factor[c] * illuminance).max(0.0));
        let is_lit = self.scene.environment.is_some();
        match (self.scene.environment.as_mut(), &path) {
            // The light of two constants is that of their sum.
            (Some(known), None) if known.image.is_none() => {
                for (channel, more) in known.radiance.iter_mut().zip(radiance) {
                    *channel += more;
                }
            }
            _ if is_lit => {
                let message = "a scene has one environment with a map: the first one is shown";
                self.report(&codes::PBRT_PLUGIN, plugin.span, message);
            }
            _ => {
                self.record(EntityKind::Environment, 0, plugin.span);
                self.scene.environment = Some(Environment {
                    radiance,
                    image: None,
                    image_from_world: None,
                });
                if let Some(path) = path {
                    self.environment_map(&path, is_equal_area);
                }
            }
        }
    }

    /// Adds the picture of the environment; without it the environment is constant.
    fn environment_map(&mut self, path: &SpannedText, is_equal_area: bool) {
        const INSTEAD: &str = "light of one colour replaces it";
        let Some(bytes) = self.file(path, &pixels::TEXTURES, INSTEAD) else {
            return;
        };
        let image = match pixels::environment(&path.text, &bytes, self.map.budget()) {
            Ok(image) => image,
            Err(fault) => return self.reject(&fault, path, INSTEAD),
        };
        // The rows of the turn from the light, whose pole is +z, to the picture, whose pole is +y.
        let pole = [Vec3::Y, Vec3::Z, Vec3::X];
        let [x, y, z] = self
            .state
            .transform
            .orthonormal()
            .unwrap_or([Vec3::X, Vec3::Y, Vec3::Z]);
        let is_mirrored = x.cross(y).dot(z) < 0.0;
        // Of a mirrored light the picture is mirrored.
        let y = if is_mirrored { -y } else { y };
        let axes = [x, y, z];
        let rows = pole.map(|row| {
            let world = axes[0] * row.x + axes[1] * row.y + axes[2] * row.z;
            world.to_array()
        });
        let image = match is_equal_area && image.width == image.height {
            true => {
                let pixels = u64::from(image.width) * u64::from(image.height) * 2;
                let charged = self.charge(Resource::Memory, 12 * pixels, path.span);
                let charged =
                    charged.and_then(|()| self.charge(Resource::Pixels, pixels, path.span));
                if charged.is_none() {
                    return;
                }
                equal_area::to_equirectangular(&image, is_mirrored)
            }
            false => {
                if is_equal_area {
                    let message = "the picture is no square, so it is read as an equirectangular \
                    one";
                    self.approximate(path.span, message);
                }
                // pbrt's longitude runs against that of the IR.
                mirrored(image, !is_mirrored)
            }
        };
        let id = self.add_image(image, path.span);
        if let Some(environment) = &mut self.scene.environment {
            environment.image = Some(id);
            environment.image_from_world = Some(rows);
        }
    }

    /// Gives the environment its record.
    pub(super) fn finish_environment(&mut self) {
        let is_dark = |environment: &Environment| environment.radiance == [0.0; 3];
        if self.scene.environment.as_ref().is_some_and(is_dark) {
            self.scene.environment = None;
        }
    }

    pub(super) fn area_light_source(&mut self, plugin: &SpannedText, parameters: &Parameters) {
        if AREA_LIGHTS.find(&plugin.text).is_none() {
            let instead = "a diffuse light replaces it";
            self.unsupported("area light", plugin, &AREA_LIGHTS, instead);
        }
        if parameters.get("filename").is_some() {
            self.approximate(plugin.span, "the picture of an area light is left out");
        }
        let factor = self.factor(parameters);
        let color = self.light_color(parameters, "L");
        let radiance = std::array::from_fn(|c| (color[c] * factor[c]).max(0.0));
        let light = AreaLight {
            radiance,
            power: parameters.number("power").filter(|power| *power > 0.0),
            is_two_sided: parameters.flag("twosided") == Some(true),
            text: plugin.clone(),
        };
        parameters.skip(&["samples", "nsamples"]);
        self.ignored("area light", &plugin.text, (&AREA_LIGHTS, parameters));
        self.state.area_light = Some(std::rc::Rc::new(light));
    }
}

/// The falloff of a spot: a cubic of the cosine from 1 at the inner to 0 at the outer angle, in
/// pairs of an angle in degrees and a factor (pbrt-v4, `SmoothStep`).
fn smooth_step(inner_angle: f64, outer_angle: f64) -> Vec<(f64, f64)> {
    /// The steps of the edge: between them the error is below 1e-3.
    const STEPS: u32 = 32;
    let (start, end) = (cos(inner_angle), cos(outer_angle));
    let mut falloff = match inner_angle > 0.0 {
        true => vec![(0.0, 1.0)],
        false => Vec::new(),
    };
    falloff.extend((0..=STEPS).map(|step| {
        let share = f64::from(step) / f64::from(STEPS);
        let angle = inner_angle + (outer_angle - inner_angle) * share;
        let x = ((cos(angle) - end) / (start - end)).clamp(0.0, 1.0);
        (angle.to_degrees(), x * x * (3.0 - 2.0 * x))
    }));
    falloff
}

/// An image with its columns reversed, if requested.
fn mirrored(mut image: Image, is_asked: bool) -> Image {
    if is_asked {
        let bytes = image.kind.bytes();
        let row = bytes * image.width as usize;
        let mut pixels = image.pixels.to_vec();
        for line in pixels.chunks_exact_mut(row.max(1)) {
            let copy = line.to_vec();
            for (to, from) in line.chunks_exact_mut(bytes).zip(copy.rchunks_exact(bytes)) {
                to.copy_from_slice(from);
            }
        }
        image.pixels = pixels.into();
    }
    image
}
