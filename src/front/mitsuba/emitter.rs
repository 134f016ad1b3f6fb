//! Emitters: environment maps, points, spots, suns; area lights are part of their shapes.

use super::xml::PluginNode;
use super::{AssetTarget, Lowering};
use crate::exchange::spot::falling;
use crate::exchange::transform::AffineTransform;
use rtc_ir::{EntityKind, Environment, Light, Punctual, PunctualKind};
use rtc_math::{Vec3, unit};

impl<'run> Lowering<'run> {
    /// An emitter of the scene.
    pub(super) fn emitter(&mut self, node: &'run PluginNode) {
        let to_world = node.transform("to_world");
        let color = |name: &str| node.color(name).unwrap_or([1.0; 3]);
        match node.plugin.text.as_str() {
            "constant" => self.environment(node, color("radiance"), false),
            "envmap" => {
                let scale = node.number("scale").unwrap_or(1.0);
                self.environment(node, [scale; 3], true);
            }
            "point" => {
                let position = match (node.get("position"), node.get("to_world")) {
                    (None, Some(_)) => to_world.point(Vec3::ZERO).to_array(),
                    _ => node.vector("position").unwrap_or([0.0; 3]),
                };
                let emitter = PunctualKind::Point {
                    position,
                    range: None,
                };
                self.light(node, emitter, color("intensity"));
                self.ignored(node, &["position", "to_world", "intensity"]);
            }
            "directional" => {
                let direction = node.vector("direction").map(Vec3::from_array);
                let direction = direction.unwrap_or_else(|| to_world.vector(Vec3::Z));
                let emitter = PunctualKind::Sun {
                    direction: (-direction).to_array(),
                };
                self.light(node, emitter, color("irradiance"));
                self.ignored(node, &["direction", "to_world", "irradiance"]);
            }
            "spot" => self.spot(node, &to_world),
            _ => self.unsupported(node, "it is left out"),
        }
    }

    /// A spot. Its intensity falls linearly in the angle, from 1 at the width of the beam to 0 at
    /// the cutoff.
    fn spot(&mut self, node: &PluginNode, to_world: &AffineTransform) {
        if node.child("texture").is_some() {
            self.approximate(node.span, "the texture of a spot is left out");
        }
        // A beam without an edge, or wider than its cutoff, ends at the cutoff.
        const LEAST_EDGE: f64 = 1e-6;
        let cutoff = node.number("cutoff_angle").unwrap_or(20.0);
        let cutoff = cutoff.clamp(2.0 * LEAST_EDGE, 180.0);
        let beam = node.number("beam_width").unwrap_or(cutoff * 3.0 / 4.0);
        let beam = beam.clamp(LEAST_EDGE, cutoff - LEAST_EDGE);
        let axis = unit(to_world.vector(Vec3::Z)).unwrap_or(Vec3::Z);
        let falloff = [(0.0, 1.0), (beam, 1.0), (cutoff, 0.0)];
        let position = to_world.point(Vec3::ZERO);
        let emitter = falling(position, axis, &falloff);
        self.light(node, emitter, node.color("intensity").unwrap_or([1.0; 3]));
        self.ignored(
            node,
            &["to_world", "intensity", "cutoff_angle", "beam_width"],
        );
    }

    fn light(&mut self, node: &PluginNode, emitter: PunctualKind, intensity: [f64; 3]) {
        self.record(EntityKind::Light, self.scene.lights.len(), node.span);
        self.scene
            .lights
            .push(Light::Punctual(Punctual { emitter, intensity }));
    }

    /// The environment. The middle of Mitsuba's picture is +z, that of the IR is −z.
    fn environment(&mut self, node: &'run PluginNode, radiance: [f64; 3], has_image: bool) {
        if self.scene.environment.is_some() {
            return self.unsupported(node, "a scene has one environment: the first one");
        }
        self.record(EntityKind::Environment, 0, node.span);
        let path = has_image.then(|| node.string("filename")).flatten();
        let image = path.map(|path| self.image(path, AssetTarget::Environment));
        let to_world = node.transform("to_world");
        let [x, y, z] = to_world
            .orthonormal()
            .unwrap_or([Vec3::X, Vec3::Y, Vec3::Z]);
        if has_image && x.cross(y).dot(z) < 0.0 {
            self.approximate(node.span, "a mirrored environment map is shown as it is");
        }
        let x = y.cross(z);
        // The rows of the inverse of a rotation are its columns; then half a turn about y.
        let rows = [-x, y, -z].map(|row| row.to_array());
        self.scene.environment = Some(Environment {
            radiance,
            image,
            image_from_world: image.map(|_| rows),
        });
        self.ignored(node, &["to_world", "radiance", "filename", "scale"]);
    }

    /// The radiance that a shape emits.
    pub(super) fn radiance(&mut self, shape: &'run PluginNode) -> [f64; 3] {
        let is_emitter = |child: &&'run PluginNode| match child.tag.as_str() {
            "emitter" => true,
            "ref" => self.refers_to(child, "emitter"),
            _ => false,
        };
        let node = shape.children.iter().find(is_emitter);
        let Some(node) = node.and_then(|node| self.resolve(node)) else {
            return [0.0; 3];
        };
        if node.plugin.text != "area" {
            self.unsupported(node, "it is left out");
            return [0.0; 3];
        }
        if node.child("radiance").is_some() {
            self.approximate(node.span, "a texture of `radiance` is shown as a constant");
        }
        node.color("radiance").unwrap_or([1.0; 3])
    }
}
