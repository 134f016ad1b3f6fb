//! Summaries of Phong materials, with maps and constant textures taken into account.

use super::shape::shape_facts;
use rtc_math::{IdTable, NonNegative, Vec3};
use rtc_valid::{Mesh, Phong, Shape, Surface, Texture, TextureId, ValidScene};

/// A summary of the material of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct MaterialSummary {
    /// ka·C is not 0 everywhere.
    pub(super) ambient: bool,
    /// kd·C is not 0 everywhere.
    pub(super) diffuse: bool,
    /// ks is not 0 everywhere.
    pub(super) is_specular: bool,
    /// The weight of the reflected ray is not 0 everywhere.
    pub(super) mirrors: bool,
    /// The maximum of the weights of the reflected and the refracted ray.
    pub(super) weight: f64,
    /// The maximum of its direct terms for a light of colour 1.
    pub(super) max_direct: f64,
    /// kt is above 0.
    pub(super) refracts: bool,
    /// It has several reflected rays.
    pub(super) glossy: bool,
    /// Its shading normals come from mesh vertices.
    pub(super) has_vertex_normals: bool,
    /// A map changes its shading normals.
    pub(super) has_normal_map: bool,
    /// The texture that gives its colour.
    pub(super) color_map: Option<TextureId>,
    /// The texture that scales its ks.
    pub(super) specular_map: Option<TextureId>,
}

impl MaterialSummary {
    pub(super) fn of(
        surface: &Surface,
        material: &Phong,
        scene: &ValidScene,
        constants: &IdTable<Texture, Option<Vec3>>,
    ) -> Self {
        // Find the maps that the surface can use.
        let Phong {
            color,
            ka,
            kd,
            ks,
            kr,
            kt,
            fresnel,
            glossy_samples,
            ..
        } = material;
        let has_uv = shape_facts(&surface.shape).has_uv(scene);
        let is_seen = |map: &TextureId| has_uv || !scene.textures()[*map].needs_uv();
        let maps = material.maps.as_deref();
        let (color_map, specular_map) = (
            maps.and_then(|maps| maps.color).filter(is_seen),
            maps.and_then(|maps| maps.specular).filter(is_seen),
        );
        // Fold constant textures into the factors.
        let color = color_map.map_or(Some(*color), |map| constants[map]);
        let scale = specular_map.map_or(Some(1.0), |map| constants[map].map(|value| value.x));
        // Bound the terms.
        let most_ks = ks.get() * scale.unwrap_or_else(|| largest(scene, specular_map).x);
        let colored = color != Some(Vec3::ZERO);
        let is_specular = ks.get() > 0.0 && scale != Some(0.0);
        let most_kr = kr.map_or(most_ks, NonNegative::get);
        Self {
            ambient: ka.get() > 0.0 && colored,
            diffuse: kd.get() > 0.0 && colored,
            is_specular,
            mirrors: kr.map_or(is_specular, |kr| kr.get() > 0.0) || (*fresnel && kt.get() > 0.0),
            weight: most_kr + kt.get(),
            max_direct: (ka.get() + kd.get())
                * color
                    .unwrap_or_else(|| largest(scene, color_map))
                    .max_element()
                + most_ks,
            refracts: kt.get() > 0.0,
            glossy: glossy_samples.get() > 1,
            has_vertex_normals: has_normals(&surface.shape, scene),
            has_normal_map: maps
                .into_iter()
                .flat_map(|maps| [maps.normal, maps.bump.map(|bump| bump.texture)])
                .flatten()
                .any(|map| is_seen(&map)),
            color_map,
            specular_map,
        }
    }

    /// Whether a light contributes more than its ambient term.
    pub(super) fn is_illuminated(&self) -> bool {
        self.diffuse || self.is_specular
    }

    /// Whether a reflected or refracted ray has a nonzero weight.
    pub(super) fn has_bounce(&self) -> bool {
        self.mirrors || self.refracts
    }

    /// Whether the shading normal may differ from the geometric one.
    pub(super) fn has_shading_normals(&self) -> bool {
        self.has_vertex_normals || self.has_normal_map
    }
}

/// The maximum of each channel of a texture.
fn largest(scene: &ValidScene, texture: Option<TextureId>) -> Vec3 {
    match texture.map(|texture| &scene.textures()[texture]) {
        // Texels may be floats of any size.
        Some(Texture::Uv | Texture::Sampled(_)) => Vec3::INFINITY,
        Some(Texture::Procedural(texture)) => {
            let [first, second] = texture.colors;
            first.max(second)
        }
        Some(Texture::Image(_)) | None => Vec3::ONE,
    }
}

fn has_normals(shape: &Shape, scene: &ValidScene) -> bool {
    matches!(shape, Shape::Instance(instance) if !scene.meshes()[instance.mesh].normals.is_empty())
}

/// The value of each constant texture.
pub(super) fn constants(scene: &ValidScene) -> IdTable<Texture, Option<Vec3>> {
    let value = |texture: &Texture| match texture {
        Texture::Uv | Texture::Sampled(_) => None,
        Texture::Procedural(texture) => {
            let [first, second] = texture.colors;
            (first == second).then_some(first)
        }
        Texture::Image(image) => {
            let image = &scene.images()[*image];
            image
                .texels
                .are_even()
                .then(|| image.texels.at(0).color() / 255.0)
        }
    };
    scene.textures().iter().map(value).collect()
}

/// Whether the three normals of every triangle of a mesh are equal.
pub(super) fn is_even(mesh: &Mesh) -> bool {
    let same = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| mesh.normal(corner));
        a == b && a == c
    };
    mesh.normals.is_empty() || mesh.triangles.iter().all(same)
}
