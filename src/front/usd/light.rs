//! Lights (`UsdLux`): the radiance of a light is its colour, times its intensity, times 2 to the
//! power of its exposure; if it is normalized, over its area.

use super::shape::{SolidGeometry, StageShape};
use super::stage::ComposedPrim;
use super::{Lowering, PrimState};
use crate::exchange::SpannedText;
use crate::exchange::color::{emitted, of_unit_luminance, planck};
use crate::exchange::tessellate;
use crate::exchange::transform::AffineTransform;
use crate::pixels;
use rtc_diag::codes;
use rtc_ir::{EntityKind, Environment, Light, Punctual, PunctualKind, Standard};
use rtc_math::{Vec3, pow, sin, unit};
use std::f64::consts::PI;

pub(super) const KINDS: [&str; 7] = [
    "DistantLight",
    "SphereLight",
    "DiskLight",
    "RectLight",
    "CylinderLight",
    "DomeLight",
    "DomeLight_1",
];

/// Numbers of lights that are not read: the name, the number that says nothing, and what is shown.
const UNREAD: [(&str, f64, &str); 8] = [
    ("diffuse", 1.0, "matte surfaces get all of its light"),
    ("specular", 1.0, "glossy surfaces get all of its light"),
    (
        "shaping:focus",
        0.0,
        "it shines to all sides of its cone alike",
    ),
    ("treatAsLine", 0.0, "it is as thick as it says"),
    ("shadow:enable", 1.0, "it casts shadows"),
    ("shadow:color", 0.0, "its shadows are without light"),
    (
        "shadow:distance",
        -1.0,
        "its shadows reach as far as they do",
    ),
    ("shadow:falloff", -1.0, "its shadows end where they do"),
];

/// Which prims a light shines on, and which cast its shadows.
const LINKS: [(&str, &str); 2] = [
    ("collection:lightLink", "it shines on all that it reaches"),
    ("collection:shadowLink", "all that it reaches casts shadows"),
];

/// What is behind a flat light, over its extent.
const BEHIND: f64 = 1e-5;
/// A distant light is shown without its angle; up to so many degrees nothing is said of that.
const SEEN_ANGLE: f64 = 2.0;

impl Lowering<'_> {
    pub(super) fn light(&mut self, prim: &ComposedPrim, kind: &str, state: &PrimState) {
        if !state.is_shown {
            return;
        }
        if self.prototype.is_some() {
            return self.unsupported(prim, "the light in a prototype", "it is left out");
        }
        let span = self.span_of(prim);
        if self.charge_surface(span).is_none() {
            return;
        }
        self.report_unread(prim);
        let color = self.light_color(prim);
        match kind {
            "DistantLight" => self.distant(prim, color, state),
            "DomeLight" | "DomeLight_1" => self.dome(prim, kind, color, state),
            _ => self.area_light(prim, kind, color, state),
        }
    }

    /// Warns of what a light asks for and is not shown.
    fn report_unread(&mut self, prim: &ComposedPrim) {
        for (name, neutral, instead) in UNREAD {
            let names = [format!("inputs:{name}"), name.to_owned()];
            let mut read = names
                .iter()
                .filter_map(|name| Some((name, self.numbers(prim, name)?)));
            if let Some((name, numbers)) = read.next()
                && numbers.iter().any(|number| *number != neutral)
            {
                self.unsupported(prim, &format!("`{name}`"), instead);
            }
        }
        let profile = self.light_file(prim, "shaping:ies:file");
        if profile.is_some_and(|(path, _)| !path.text.is_empty()) {
            let instead = "it shines to all sides alike";
            self.unsupported(prim, "the profile `inputs:shaping:ies:file`", instead);
        }
        for (name, instead) in LINKS {
            let excludes = self.targets(prim, &format!("{name}:excludes"));
            let has_root = self.flag(prim, &format!("{name}:includeRoot"));
            let expression = self.text(prim, &format!("{name}:membershipExpression"));
            let is_all = |expression: &String| matches!(expression.as_str(), "" | "//");
            if !excludes.is_empty() || has_root == Some(false) || !expression.iter().all(is_all) {
                self.unsupported(prim, &format!("`{name}`"), instead);
            }
        }
        if !self.targets(prim, "light:filters").is_empty() {
            self.unsupported(prim, "the filter", "the light is shown without it");
        }
    }

    /// A number of a light; files before 2021 have the names without `inputs:`.
    fn light_number(&self, prim: &ComposedPrim, name: &str, default: f64) -> f64 {
        let number = self.number(prim, &format!("inputs:{name}"));
        number
            .or_else(|| self.number(prim, name))
            .unwrap_or(default)
    }

    fn light_file(&self, prim: &ComposedPrim, name: &str) -> Option<(SpannedText, usize)> {
        let file = self.asset(prim, &format!("inputs:{name}"));
        file.or_else(|| self.asset(prim, name))
    }

    fn light_flag(&self, prim: &ComposedPrim, name: &str) -> bool {
        let flag = self.flag(prim, &format!("inputs:{name}"));
        flag.or_else(|| self.flag(prim, name)).unwrap_or(false)
    }

    /// The colour of a light, with its intensity and exposure.
    fn light_color(&self, prim: &ComposedPrim) -> [f64; 3] {
        let is_distant = self.type_name(prim) == "DistantLight";
        let intensity =
            self.light_number(prim, "intensity", if is_distant { 50_000.0 } else { 1.0 });
        let exposure = self.light_number(prim, "exposure", 0.0);
        let color = self.vector::<3>(prim, "inputs:color");
        let mut color = color
            .or_else(|| self.vector::<3>(prim, "color"))
            .unwrap_or([1.0; 3]);
        if self.light_flag(prim, "enableColorTemperature") {
            let kelvin = self
                .light_number(prim, "colorTemperature", 6500.0)
                .clamp(1000.0, 10_000.0);
            let body = of_unit_luminance(emitted(|nm| planck(nm, kelvin)));
            color = std::array::from_fn(|channel| color[channel] * body[channel]);
        }
        color.map(|channel| (channel * intensity * pow(2.0, exposure)).max(0.0))
    }

    fn punctual(&mut self, prim: &ComposedPrim, emitter: PunctualKind, intensity: [f64; 3]) {
        let span = self.span_of(prim);
        self.record(EntityKind::Light, self.scene.lights.len(), span);
        self.scene
            .lights
            .push(Light::Punctual(Punctual::new(emitter, intensity)));
    }

    /// The radiance of a distant light fills its angle.
    fn distant(&mut self, prim: &ComposedPrim, color: [f64; 3], state: &PrimState) {
        let angle = self.light_number(prim, "angle", 0.53).clamp(0.0, 180.0);
        let Some(direction) = unit(state.to_world.vector(Vec3::Z)) else {
            return;
        };
        if angle > SEEN_ANGLE {
            self.approximate(
                prim,
                "the shadows of a distant light are sharp, whatever its angle",
            );
        }
        let sine = sin(angle.to_radians() / 2.0);
        let factor = match self.light_flag(prim, "normalize") || angle == 0.0 {
            true => 1.0,
            false => PI * sine * sine,
        };
        let emitter = PunctualKind::Sun {
            direction: direction.to_array(),
        };
        self.punctual(prim, emitter, color.map(|channel| channel * factor));
    }

    /// A light with an area: a shape that emits, or a point or spot in its place.
    fn area_light(&mut self, prim: &ComposedPrim, kind: &str, color: [f64; 3], state: &PrimState) {
        let number = |name: &str, default: f64| self.light_number(prim, name, default).abs();
        let radius = number("radius", 0.5);
        let (width, height) = (number("width", 1.0), number("height", 1.0));
        let length = number("length", 1.0);
        let AffineTransform([x, y, z, _]) = state.to_world;
        let (sx, sy, sz) = (x.length(), y.length(), z.length());
        // The area that is seen from the front, and how many times that it all is.
        let (front, times) = match kind {
            "SphereLight" => (PI * radius * radius * sx * sx, 4.0),
            "DiskLight" => (PI * radius * radius * sx * sy, 1.0),
            "RectLight" => (width * height * sx * sy, 1.0),
            _ => (2.0 * radius * length * sx * sy.max(sz), PI),
        };
        // Areas are those of the stage, whose unit may be no metre.
        let unit_area = self.unit * self.unit;
        let per_area = match self.light_flag(prim, "normalize") {
            true => unit_area / (front * times),
            false => 1.0,
        };
        let cone = self.light_number(prim, "shaping:cone:angle", 90.0);
        let cone = Some(cone.clamp(0.0, 180.0)).filter(|cone| *cone < 90.0);
        if cone.is_some() || self.light_flag(prim, "treatAsPoint") || front == 0.0 {
            let share = match front == 0.0 {
                true => unit_area / times,
                false => per_area * front,
            };
            return self.point_light(prim, state, cone, color.map(|channel| channel * share));
        }
        if self.light_file(prim, "texture:file").is_some() {
            let message = "the picture of a light is left out: it has one colour";
            self.approximate(prim, message);
        }
        let radiance = color.map(|channel| channel * per_area);
        if !radiance.iter().all(|channel| channel.is_finite()) {
            return;
        }
        let span = self.span_of(prim);
        let (geometry, local) = match kind {
            "SphereLight" => (SolidGeometry::Sphere(radius), AffineTransform::IDENTITY),
            "DiskLight" => (SolidGeometry::Disc(radius), AffineTransform::IDENTITY),
            "RectLight" => (
                SolidGeometry::Rectangle(width, height),
                AffineTransform::IDENTITY,
            ),
            _ => {
                let half = Vec3::X * (length / 2.0);
                let mesh = self.charged_mesh(tessellate::cylinder(), span);
                let local = tessellate::along(-half, half, radius);
                let Some((mesh, local)) = mesh.zip(local) else {
                    return;
                };
                (SolidGeometry::Mesh(mesh), local)
            }
        };
        // A black shape hides the back of a flat one, which faces −z.
        let extent = match &geometry {
            SolidGeometry::Disc(radius) => Some(2.0 * radius),
            SolidGeometry::Rectangle(width, height) => Some(width.max(*height)),
            SolidGeometry::Sphere(_) | SolidGeometry::Mesh(_) => None,
        };
        let behind = extent.map(|extent| AffineTransform::translation([0.0, 0.0, BEHIND * extent]));
        for (local, radiance) in [(Some(local), radiance), (behind, [0.0; 3])] {
            let Some(local) = local else { continue };
            let material = self.emitting(radiance, span);
            self.add(StageShape {
                geometry: geometry.clone(),
                to_world: state.to_world.after(&local),
                material,
                span,
            });
        }
    }

    fn emitting(&mut self, radiance: [f64; 3], span: rtc_source::Span) -> rtc_ir::MaterialId {
        let standard = Standard {
            emissive: radiance,
            ..crate::exchange::material::matte([0.0; 3])
        };
        self.add_material(standard, span)
    }

    fn point_light(
        &mut self,
        prim: &ComposedPrim,
        state: &PrimState,
        cone: Option<f64>,
        intensity: [f64; 3],
    ) {
        // Without a cone the light is a point.
        let position = state.to_world.point(Vec3::ZERO).to_array();
        let Some(cone) = cone else {
            return self.punctual(
                prim,
                PunctualKind::Point {
                    position,
                    range: None,
                },
                intensity,
            );
        };
        // With one it is a spot along the local -z axis.
        self.approximate(
            prim,
            "a spot of no extent takes the place of a light with a cone",
        );
        let Some(direction) = unit(state.to_world.vector(Vec3::NEG_Z)) else {
            return;
        };
        // The softness widens the falloff inwards from the cone.
        let softness = self
            .light_number(prim, "shaping:cone:softness", 0.0)
            .clamp(0.0, 1.0);
        let outer_angle = cone.max(1e-3).to_radians();
        let emitter = PunctualKind::Spot {
            position,
            direction: direction.to_array(),
            inner_angle: outer_angle * (1.0 - softness).min(0.999_999),
            outer_angle,
            range: None,
        };
        self.punctual(prim, emitter, intensity);
    }

    /// Light from all around, constant or by a picture of longitude and latitude.
    fn dome(&mut self, prim: &ComposedPrim, kind: &str, radiance: [f64; 3], state: &PrimState) {
        let span = self.span_of(prim);
        let file = self.light_file(prim, "texture:file");
        let file = file.filter(|(path, _)| !path.text.is_empty());
        match (self.scene.environment.as_mut(), &file) {
            // The light of two constants is that of their sum.
            (Some(known), None) if known.image.is_none() => {
                for (channel, more) in known.radiance.iter_mut().zip(radiance) {
                    *channel += more;
                }
                return;
            }
            (Some(_), _) => {
                return self.unsupported(prim, "a second dome light", "the first one is shown");
            }
            (None, _) => {}
        }
        if radiance == [0.0; 3] {
            return;
        }
        self.record(EntityKind::Environment, 0, span);
        self.scene.environment = Some(Environment {
            radiance,
            image: None,
            image_from_world: None,
        });
        let Some((path, layer)) = file else { return };
        const INSTEAD: &str = "light of one colour takes its place";
        let format = self.text(prim, "inputs:texture:format");
        if format.is_some_and(|format| format != "latlong" && format != "automatic") {
            return self.unsupported(prim, "the format of the picture", INSTEAD);
        }
        let Some(bytes) = self.file(&path, layer, &pixels::TEXTURES, INSTEAD) else {
            return;
        };
        let image = match pixels::environment(&path.text, &bytes, self.map.budget()) {
            Ok(image) => image,
            Err(fault) => {
                let what = format!("the picture `{}`", rtc_diag::clip_path(&path.text));
                let diagnostic = pixels::rejection(
                    &fault,
                    &what,
                    "domes are OpenEXR, Radiance HDR, PNG, JPEG or WebP",
                );
                return self.without(diagnostic, path.span, INSTEAD);
            }
        };
        let id = self.scene.add_image(image);
        self.record(EntityKind::Image, id.0 as usize, path.span);
        let [mut x, mut y, mut z] = state.to_world.orthonormal().unwrap_or(Vec3::AXES);
        if x.cross(y).dot(z) < 0.0 {
            self.report(
                &codes::USD_APPROXIMATE,
                path.span,
                "the picture of a mirrored dome is not mirrored",
            );
            x = -x;
        }
        // The pole of the newer dome is that of the stage, which is z where z is up.
        let is_z_up = self.layers[0]
            .metadata
            .up_axis
            .as_ref()
            .is_some_and(|up| up.text == "Z");
        let pole = self
            .text(prim, "poleAxis")
            .unwrap_or_else(|| "scene".to_owned());
        if kind == "DomeLight_1" && (pole == "Z" || pole == "scene" && is_z_up) {
            (y, z) = (z, -y);
        }
        // The middle of the picture is +z of the light, and −z of the environment.
        if let Some(environment) = &mut self.scene.environment {
            environment.image = Some(id);
            environment.image_from_world = Some([-x, y, -z].map(|axis| axis.to_array()));
        }
    }
}
