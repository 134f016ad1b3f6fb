//! The texture maps that surfaces do not show, for want of texture coordinates.

use crate::coverage::{MapPresence, UvCoverage};
use rtc_ir::EntityField;
use rtc_valid::{Maps, Material, MaterialId, Shape, Texture, TextureId, UvSet, ValidScene};
use std::collections::BTreeSet;

/// A map that a surface does not show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HiddenMap {
    /// The first surface without texture coordinates, as an IR index.
    pub surface: usize,
    /// Whether other parts of the surface show the map.
    pub is_partial: bool,
    /// Whether the surface is a mesh.
    pub is_mesh: bool,
    /// Its material.
    pub material: MaterialId,
    /// The map.
    pub field: EntityField,
}

/// The maps that some surface does not show, one of each material.
#[must_use]
pub fn hidden_maps(scene: &ValidScene) -> Vec<HiddenMap> {
    if scene.textures().is_empty() {
        return Vec::new();
    }
    let mut seen = BTreeSet::new();
    let mut hidden = Vec::new();
    for surface in scene.surfaces() {
        let material = surface.material;
        if seen.contains(&material) {
            continue;
        }
        if let Some((field, is_partial)) = hidden_map(&surface.shape, material, scene) {
            seen.insert(material);
            hidden.push(HiddenMap {
                surface: surface.index,
                is_partial,
                is_mesh: matches!(surface.shape, Shape::Instance(_)),
                material,
                field,
            });
        }
    }
    hidden
}

/// A map of a material that a shape does not show, and whether other parts of it do.
fn hidden_map(
    shape: &Shape,
    material: MaterialId,
    scene: &ValidScene,
) -> Option<(EntityField, bool)> {
    let coverage = UvCoverage::of(shape, scene);
    let hides = |texture: TextureId, set: UvSet| match coverage.presence(scene, texture, set) {
        // The texture of texture coordinates is no picture that could be missing.
        _ if matches!(scene.textures()[texture], Texture::Uv) => None,
        MapPresence::Never => Some(false),
        MapPresence::Somewhere => Some(true),
        MapPresence::Everywhere(_) => None,
    };
    match &scene.materials()[material] {
        Material::Phong(phong) => {
            let Maps {
                color,
                specular,
                normal,
                bump,
            } = **phong.maps.as_ref()?;
            let maps = [
                (EntityField::ColorMap, color),
                (EntityField::SpecularMap, specular),
                (EntityField::NormalMap, normal),
                (EntityField::Bump, bump.map(|bump| bump.texture)),
            ];
            let mut maps = maps.into_iter();
            maps.find_map(|(field, map)| Some((field, hides(map?, UvSet::First)?)))
        }
        Material::Standard(standard) => {
            let mut maps = standard.maps();
            let hidden = maps.find_map(|map| hides(map.texture, map.set));
            hidden.map(|is_partial| (EntityField::Whole, is_partial))
        }
    }
}
