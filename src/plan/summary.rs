//! Summaries of Phong materials, with maps and constant textures taken into account.

use super::coverage::{MapPresence, UvCoverage};
use rtc_math::{IdTable, NonNegative, Vec3};
use rtc_valid::{Mesh, Phong, Shape, Surface, Texture, TextureId, UvSet, ValidScene};
use std::fmt::{self, Debug, Formatter};

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
    pub(super) color_map: MapUse,
    /// The texture that scales its ks.
    pub(super) specular_map: MapUse,
}

/// What a surface shows of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MapUse {
    /// Nothing, or there is no map.
    Nothing,
    /// One value, on all its parts.
    Constant,
    /// Several values, or one on some parts alone.
    Varying,
}

impl MaterialSummary {
    pub(super) fn of(
        surface: &Surface,
        material: &Phong,
        scene: &ValidScene,
        constants: &ConstantTextures,
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
        let coverage = UvCoverage::of(&surface.shape, scene);
        let presence = |map| coverage.presence(scene, map, UvSet::First);
        let is_seen = |map: &TextureId| presence(*map) != MapPresence::Never;
        let maps = material.maps.as_deref();
        // Fold constant textures into the factors, and bound the terms.
        let value = |map: Option<TextureId>, bare: Vec3| {
            let Some(map) = map.filter(is_seen) else {
                return (MapUse::Nothing, Some(bare), bare);
            };
            match (constants.value(presence(map)), presence(map)) {
                (Some(value), _) => (MapUse::Constant, Some(value), value),
                (None, MapPresence::Somewhere) => {
                    (MapUse::Varying, None, largest(scene, map).max(bare))
                }
                (None, _) => (MapUse::Varying, None, largest(scene, map)),
            }
        };
        let (color_map, color, most_color) = value(maps.and_then(|maps| maps.color), *color);
        let (specular_map, scale, most_scale) =
            value(maps.and_then(|maps| maps.specular), Vec3::ONE);
        let scale = scale.map(|scale| scale.x);
        let most_ks = ks.get() * most_scale.x;
        let colored = color != Some(Vec3::ZERO);
        let is_specular = ks.get() > 0.0 && scale != Some(0.0);
        let most_kr = kr.map_or(most_ks, NonNegative::get);
        Self {
            ambient: ka.get() > 0.0 && colored,
            diffuse: kd.get() > 0.0 && colored,
            is_specular,
            mirrors: kr.map_or(is_specular, |kr| kr.get() > 0.0) || (*fresnel && kt.get() > 0.0),
            weight: most_kr + kt.get(),
            max_direct: (ka.get() + kd.get()) * most_color.max_element() + most_ks,
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

    /// Whether the surface shows a texture.
    pub(super) fn has_map(&self) -> bool {
        [self.color_map, self.specular_map] != [MapUse::Nothing; 2]
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
fn largest(scene: &ValidScene, texture: TextureId) -> Vec3 {
    match &scene.textures()[texture] {
        // Texels may be floats of any size.
        Texture::Uv | Texture::Sampled(_) => Vec3::INFINITY,
        Texture::Procedural(texture) => {
            let [first, second] = texture.colors;
            first.max(second)
        }
        Texture::Image(_) => Vec3::ONE,
    }
}

fn has_normals(shape: &Shape, scene: &ValidScene) -> bool {
    matches!(shape, Shape::Instance(instance) if !scene.meshes()[instance.mesh].normals.is_empty())
}

/// The values of the textures of a scene that are constant, for surfaces that show them on all
/// parts.
#[derive(Clone, PartialEq)]
pub struct ConstantTextures(IdTable<Texture, Option<Vec3>>);

impl Debug for ConstantTextures {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl ConstantTextures {
    pub(super) fn of(scene: &ValidScene) -> Self {
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
        Self(scene.textures().iter().map(value).collect())
    }

    /// Without any value.
    pub(super) fn none(scene: &ValidScene) -> Self {
        Self(vec![None; scene.textures().len()].into())
    }

    /// The value of a map that is shown so, if it is one on all parts.
    #[must_use]
    pub fn value(&self, presence: MapPresence) -> Option<Vec3> {
        match presence {
            MapPresence::Everywhere(map) => self.0[map.texture()],
            MapPresence::Never | MapPresence::Somewhere => None,
        }
    }
}

/// Whether the three normals of every triangle of a mesh are equal.
pub(super) fn is_even(mesh: &Mesh) -> bool {
    let same = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| mesh.normal(corner));
        a == b && a == c
    };
    mesh.normals.is_empty() || mesh.triangles.iter().all(same)
}
