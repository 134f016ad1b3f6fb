//! Whether a scene has light: a light, an environment, or sufficiently bright emissive surfaces.

use super::SceneKind;
use glam::DAffine3;
use rtc_color::srgb_decoded;
use rtc_ir::{Image, Light, Material, Pixels, Scene, Shape, Surface, Texture};
use rtc_math::Vec3;
use std::f64::consts::TAU;

/// The minimum brightness that emissive surfaces give a white surface: below it, the surface would
/// look black.
const MIN_BRIGHTNESS: f64 = 0.05;

/// Whether the scene has light: a light, an environment (also a black one), or emissive surfaces;
/// those of an asset count only if they are bright enough.
///
/// Surfaces of radiance L and area A inside a sphere of radius R emit a power of about π·L·A, so a
/// white surface on it has a radiance of about L·A/(4·π·R²). Below [`MIN_BRIGHTNESS`] they are
/// labels, dashboard lamps or eyes: they illuminate nothing, and the scene needs the studio. Unlit
/// materials do not emit light.
pub(super) fn has_light(scene: &Scene, kind: SceneKind) -> bool {
    let is_emissive = || match kind {
        SceneKind::Text => emissive_surfaces(scene).contains(&true),
        SceneKind::Asset | SceneKind::BareAsset => emissive_brightness(scene) >= MIN_BRIGHTNESS,
    };
    scene.environment.is_some() || scene.lights.iter().any(Light::emits) || is_emissive()
}

/// For each surface, whether it is emissive.
#[must_use]
pub fn emissive_surfaces(scene: &Scene) -> Vec<bool> {
    let materials = scene.materials.iter();
    let is_emissive: Vec<bool> = materials
        .map(|material| emission(scene, material) > 0.0)
        .collect();
    let surfaces = scene.surfaces.iter();
    surfaces
        .map(|surface| is_emissive.get(surface.material.0 as usize) == Some(&true))
        .collect()
}

/// The radiance of a white surface in the light of the emissive surfaces, by the strongest channel.
fn emissive_brightness(scene: &Scene) -> f64 {
    let emissions: Vec<f64> = scene
        .materials
        .iter()
        .map(|material| emission(scene, material))
        .collect();
    let emission = |surface: &Surface| {
        emissions
            .get(surface.material.0 as usize)
            .copied()
            .unwrap_or(0.0)
    };
    let emissive_surfaces = scene
        .surfaces
        .iter()
        .map(|surface| (surface, emission(surface)));
    let emissive_surfaces: Vec<_> = emissive_surfaces
        .filter(|(_, emission)| *emission > 0.0)
        .collect();
    let Some(sphere) = scene
        .bounding_sphere()
        .filter(|_| !emissive_surfaces.is_empty())
    else {
        return 0.0;
    };
    let power: f64 = emissive_surfaces
        .iter()
        .map(|(surface, emission)| emission * area(scene, &surface.shape))
        .sum();
    power / (2.0 * TAU * sphere.radius * sphere.radius)
}

/// The mean emitted radiance of a material, by the strongest channel.
fn emission(scene: &Scene, material: &Material) -> f64 {
    let Material::Standard(standard) = material else {
        return 0.0;
    };
    let factor = standard
        .emissive
        .iter()
        .fold(0.0, |most: f64, channel| most.max(*channel));
    if standard.unlit || factor <= 0.0 {
        return 0.0;
    }
    let map = standard
        .emissive_map
        .as_ref()
        .and_then(|map| scene.textures.get(map.texture.0 as usize));
    let image = match map {
        Some(Texture::Sampled(sampled)) => scene.images.get(sampled.image.0 as usize),
        Some(Texture::Image(image)) => scene.images.get(image.0 as usize),
        Some(Texture::Procedural(procedural)) => {
            let mean = procedural
                .solid()
                .map(|texture| texture.mean().max_element());
            return factor * mean.unwrap_or(0.0);
        }
        Some(Texture::Uv) | None => None,
    };
    factor * image.map_or(1.0, brightness)
}

/// The area of a surface; 0 for other shapes than triangles, quads and meshes.
fn area(scene: &Scene, shape: &Shape) -> f64 {
    let triangle = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).length() / 2.0;
    if let Shape::Triangle(shape) = shape {
        triangle(shape.vertices.map(Vec3::from_array))
    } else if let Shape::Quad(shape) = shape {
        let [a, b, c, d] = shape.vertices.map(Vec3::from_array);
        triangle([a, b, c]) + triangle([a, c, d])
    } else if let Shape::Instance(instance) = shape {
        let world = DAffine3::from_cols_array_2d(&instance.world_from_object);
        let Some(mesh) = scene.meshes.get(instance.mesh.0 as usize) else {
            return 0.0;
        };
        let is_in_range = |index: &u32| (*index as usize) < mesh.positions.len();
        let corner = |index: u32| Vec3::from_array(mesh.positions.at(index as usize));
        let valid = mesh
            .triangles
            .iter()
            .filter(|indices| indices.iter().all(is_in_range));
        let in_world =
            valid.map(|indices| indices.map(|index| world.transform_point3(corner(index))));
        in_world.map(triangle).sum()
    } else {
        0.0
    }
}

/// The mean linear value of an sRGB image, by the strongest channel of each pixel.
fn brightness(image: &Image) -> f64 {
    let size = image.kind.bytes();
    let bytes: &[u8] = &image.pixels;
    if image.kind == Pixels::Rgb32f || bytes.len() < size {
        return 1.0;
    }
    let decoded: Vec<f64> = (0..=u8::MAX)
        .map(|code| srgb_decoded(f64::from(code) / 255.0))
        .collect();
    let strongest = |pixel: &[u8]| pixel[0].max(pixel[1]).max(pixel[2]);
    let sum: f64 = bytes
        .chunks_exact(size)
        .map(|pixel| decoded[usize::from(strongest(pixel))])
        .sum();
    sum / (bytes.len() / size) as f64
}
