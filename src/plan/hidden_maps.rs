//! The texture maps that surfaces do not show, for want of texture coordinates.

use crate::shape::shape_facts;
use rtc_ir::EntityField;
use rtc_valid::{Maps, Material, MaterialId, Shape, Texture, TextureId, ValidScene};
use std::collections::BTreeSet;

/// A map that a surface does not show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HiddenMap {
    /// The first surface without texture coordinates, as an IR index.
    pub surface: usize,
    /// Its material.
    pub material: MaterialId,
    /// The map.
    pub field: EntityField,
}

/// The maps that some surface does not show, one of each material. Maps of `standard` materials on
/// meshes are left out: the reader of glTF reports them.
#[must_use]
pub fn hidden_maps(scene: &ValidScene) -> Vec<HiddenMap> {
    if scene.textures().is_empty() {
        return Vec::new();
    }
    let mut seen = BTreeSet::new();
    let mut hidden = Vec::new();
    for surface in scene.surfaces() {
        let material = surface.material;
        if seen.contains(&material) || shape_facts(&surface.shape).has_uv(scene) {
            continue;
        }
        let is_mesh = matches!(surface.shape, Shape::Instance(_));
        if let Some(field) = map_of(&scene.materials()[material], is_mesh, scene) {
            seen.insert(material);
            hidden.push(HiddenMap {
                surface: surface.index,
                material,
                field,
            });
        }
    }
    hidden
}

/// A map of a material that needs texture coordinates.
fn map_of(material: &Material, is_mesh: bool, scene: &ValidScene) -> Option<EntityField> {
    // The texture of texture coordinates is no picture that could be missing.
    let needs_uv = |texture: TextureId| {
        let texture = &scene.textures()[texture];
        texture.needs_uv() && !matches!(texture, Texture::Uv)
    };
    match material {
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
            maps.find(|(_, map)| map.is_some_and(needs_uv))
                .map(|(field, _)| field)
        }
        Material::Standard(standard) => {
            let mut maps = standard.maps();
            let is_hidden = !is_mesh && maps.any(|map| needs_uv(map.texture));
            is_hidden.then_some(EntityField::Whole)
        }
    }
}
