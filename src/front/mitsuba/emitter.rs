//! Emitters: environment maps, points, spots, suns; area lights are part of their shapes.

use super::plugins::EMITTERS;
use super::sensor::{pixel_tangent, tangent};
use super::xml::PluginNode;
use super::{AssetTarget, Lowering};
use crate::exchange::checkerboard::checkerboard;
use crate::exchange::spot::falling;
use crate::exchange::transform::AffineTransform;
use rtc_ir::{
    EntityKind, Environment, Light, Map, ProjectedTexture, Punctual, PunctualKind, Scene, Texture,
};
use rtc_math::{Vec3, unit};
use std::f64::consts::PI;

/// The rows of the identity of texture coordinates.
const IDENTITY: [[f64; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

impl<'run> Lowering<'run> {
    /// An emitter of the scene.
    pub(super) fn emitter(&mut self, node: &'run PluginNode) {
        let to_world = node.transform("to_world");
        let color = |name| self.color(node, name).unwrap_or([1.0; 3]);
        match EMITTERS.known(&node.plugin.text) {
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
            }
            "directional" => {
                let direction = node.vector("direction").map(Vec3::from_array);
                let direction = direction.unwrap_or_else(|| to_world.vector(Vec3::Z));
                let emitter = PunctualKind::Sun {
                    direction: (-direction).to_array(),
                };
                self.light(node, emitter, color("irradiance"));
            }
            "sky" | "sun" | "sunsky" => self.sky(node),
            "spot" => self.spot(node, &to_world),
            "projector" => self.projector(node, &to_world),
            _ => self.unsupported(node, "it is left out"),
        }
    }

    /// A spot. Its intensity falls linearly in the angle, from 1 at the width of the beam to 0 at
    /// the cutoff.
    fn spot(&mut self, node: &'run PluginNode, to_world: &AffineTransform) {
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
        // A texture fills the square around the cone.
        let texture = node.child("texture");
        let map = texture.and_then(|_| self.map(node, "texture", false));
        let projected = map.and_then(|map| {
            let half = tangent(cutoff.min(89.0));
            projected(map, to_world, [0.5 / half; 2])
        });
        let intensity = self.color(node, "intensity").unwrap_or([1.0; 3]);
        self.projecting_light(node, emitter, intensity, projected);
    }

    /// A projector: a texture as the irradiance on a plane at the distance 1.
    fn projector(&mut self, node: &'run PluginNode, to_world: &AffineTransform) {
        // The field of view is that of the texture, whose image is loaded later.
        let irradiance = self.channel(node, "irradiance", [1.0; 3], false);
        let scale = node.number("scale").unwrap_or(1.0);
        // Mitsuba 3.9.1 measures π times the irradiance that it documents.
        let intensity = irradiance.color.map(|channel| channel * scale * PI);
        let position = to_world.point(Vec3::ZERO).to_array();
        let emitter = PunctualKind::Point {
            position,
            range: None,
        };
        let white = || checkerboard([[1.0; 3]; 2], IDENTITY, &mut self.scene);
        let map = irradiance.map.unwrap_or_else(white);
        let projected = projected(map, to_world, [1.0; 2]).map(|projected| ProjectedTexture {
            is_irradiance: true,
            ..projected
        });
        if projected.is_some() {
            self.projectors
                .push((self.scene.lights.len(), node.clone()));
        }
        self.projecting_light(node, emitter, intensity, projected);
    }

    pub(super) fn light(&mut self, node: &PluginNode, emitter: PunctualKind, intensity: [f64; 3]) {
        self.projecting_light(node, emitter, intensity, None);
    }

    fn projecting_light(
        &mut self,
        node: &PluginNode,
        emitter: PunctualKind,
        intensity: [f64; 3],
        projected: Option<ProjectedTexture>,
    ) {
        self.record(EntityKind::Light, self.scene.lights.len(), node.span);
        self.scene.lights.push(Light::Punctual(Punctual {
            projected: projected.map(Box::new),
            ..Punctual::new(emitter, intensity)
        }));
    }

    /// The environment. The middle of Mitsuba's picture is +z, that of the IR is −z.
    fn environment(&mut self, node: &'run PluginNode, radiance: [f64; 3], has_image: bool) {
        if self.scene.environment.is_some() {
            return self.unsupported(node, "a scene has one environment: the first one");
        }
        self.record(EntityKind::Environment, 0, node.span);
        let path = has_image.then(|| node.string("filename")).flatten();
        if has_image && path.is_none() {
            self.unsupported(node, "it names no file, and white light replaces it");
        }
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
    }

    /// The area light of a shape.
    pub(super) fn area_emitter(&mut self, shape: &'run PluginNode) -> Option<&'run PluginNode> {
        let is_emitter = |child: &&'run PluginNode| match child.tag.as_str() {
            "emitter" => true,
            "ref" => self.refers_to(child, "emitter"),
            _ => false,
        };
        let node = shape.children.iter().find(is_emitter);
        let node = node.and_then(|node| self.resolve(node))?;
        if node.plugin.text != "area" {
            self.unsupported(node, "it is left out");
            return None;
        }
        // A dark one is no light.
        (self.color(node, "radiance") != Some([0.0; 3])).then_some(node)
    }
}

/// A texture around the z axis of a light: the coordinates are (0.5, 0.5) on the axis, and grow by
/// `scale` along x and y of the plane at the distance 1. `None` if the transform has no inverse.
fn projected(map: Map, to_world: &AffineTransform, scale: [f64; 2]) -> Option<ProjectedTexture> {
    let AffineTransform(columns) = to_world.inverse()?;
    let row = |axis: usize| Vec3::new(columns[0][axis], columns[1][axis], columns[2][axis]);
    let [x, y, z] = [row(0), row(1), row(2)];
    let rows = [x * scale[0] + z * 0.5, y * scale[1] + z * 0.5, z];
    Some(ProjectedTexture {
        map,
        uv_from_direction: rows.map(|row| row.to_array()),
        is_irradiance: false,
    })
}

/// Gives a projector the field of view of its texture, when the image is loaded. Its picture is
/// that of a perspective sensor: u grows to the right, which is −x, and v downwards.
pub(super) fn fit_projector(scene: &mut Scene, light: usize, node: &PluginNode) {
    let Some(Light::Punctual(Punctual {
        projected: Some(texture),
        ..
    })) = scene.lights.get_mut(light)
    else {
        return;
    };
    let image = match scene.textures.get(texture.map.texture.0 as usize) {
        Some(Texture::Sampled(sampled)) => scene.images.get(sampled.image.0 as usize),
        _ => None,
    };
    let size = image.map_or([1.0; 2], |image| [image.width, image.height].map(f64::from));
    let pixel = pixel_tangent(node, size);
    let scale = size.map(|side| -1.0 / (side * pixel));
    let to_world = node.transform("to_world");
    if let Some(fitted) = projected(texture.map.clone(), &to_world, scale) {
        texture.uv_from_direction = fitted.uv_from_direction;
    }
}
