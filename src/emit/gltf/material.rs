//! Materials: glTF's own from the table of its parameters, Phong's by the one that comes nearest.

use super::document::{self, Index, PbrMetallicRoughness, TextureInfo};
use super::writer::{GltfWriter, extras};
use crate::nearest::nearest;
use rtc_ir::{Alpha, EntityKind, Field, Map, Material, MaterialId, MeshId, Standard, ValuePath};
use rtc_tables::{self as standard, parameters};
use serde_json::{Map as Block, Value, json};

/// A material of the scene, on meshes with or without each set of texture coordinates: without one,
/// the maps that ask for it have no effect, and are left out.
pub(super) type MaterialKey = (u32, [bool; 2]);

impl GltfWriter<'_> {
    /// The material as it shows on a mesh.
    pub(super) fn material(&mut self, id: MaterialId, mesh: MeshId) -> Index<document::Material> {
        let mesh = &self.scene.meshes[mesh.0 as usize];
        let key = (id.0, [!mesh.uvs.is_empty(), !mesh.second_uvs.is_empty()]);
        if let Some(known) = self.materials.get(&key) {
            return *known;
        }
        let place = ValuePath::new(EntityKind::Material, id.0 as usize, Field::Whole);
        let (mut standard, own) = match &self.scene.materials[id.0 as usize] {
            Material::Standard(standard) => ((**standard).clone(), Block::new()),
            Material::Phong(phong) => {
                let own = self.phong(phong, key.1[0], place);
                (nearest(phong), own)
            }
        };
        drop_maps(&mut standard, key.1);
        let material = self.standard(&standard, place);
        let material = document::Material {
            extras: extras(own),
            ..material
        };
        let index = Index::push(&mut self.root.materials, material);
        self.materials.insert(key, index);
        index
    }

    fn standard(&mut self, own: &Standard, place: ValuePath) -> document::Material {
        let pbr_metallic_roughness = self.metallic_roughness(own, place);
        let mut blocks = Block::new();
        self.blocks(own, &mut blocks, place);
        self.other_blocks(own, &mut blocks, place);
        let (alpha_mode, alpha_cutoff) = match own.alpha {
            Alpha::Opaque => ("OPAQUE", None),
            Alpha::Mask(cutoff) => ("MASK", Some(cutoff)),
            Alpha::Blend => ("BLEND", None),
        };
        let strength = strength(own.emissive);
        document::Material {
            alpha_cutoff,
            alpha_mode,
            double_sided: own.double_sided,
            name: Some(own.name.clone()).filter(|name| !name.is_empty()),
            pbr_metallic_roughness,
            normal_texture: own.normal_map.as_ref().map(|map| TextureInfo {
                scale: Some(own.normal_scale),
                ..self.texture_info(map, place)
            }),
            emissive_texture: self.info(own.emissive_map.as_ref(), place),
            emissive_factor: own.emissive.map(|channel| channel / strength),
            extensions: blocks,
            extras: None,
        }
    }

    /// The core of the material. That of `KHR_materials_pbrSpecularGlossiness` has its colour
    /// elsewhere.
    fn metallic_roughness(&mut self, own: &Standard, place: ValuePath) -> PbrMetallicRoughness {
        let is_core = own.specular_glossiness.is_none();
        let color_map = own.base_color_map.as_ref().filter(|_| is_core);
        PbrMetallicRoughness {
            base_color_factor: if is_core { own.base_color } else { [1.0; 4] },
            base_color_texture: self.info(color_map, place),
            metallic_factor: own.metallic,
            roughness_factor: own.roughness,
            metallic_roughness_texture: self.info(own.metallic_roughness_map.as_ref(), place),
        }
    }

    fn info(&mut self, map: Option<&Map>, place: ValuePath) -> Option<TextureInfo> {
        map.map(|map| self.texture_info(map, place))
    }

    /// The extensions whose properties are not parameters as they stand.
    fn other_blocks(
        &mut self,
        own: &Standard,
        blocks: &mut Block<String, Value>,
        place: ValuePath,
    ) {
        let strength = strength(own.emissive);
        if strength != 1.0 {
            let block = json!({ "emissiveStrength": strength });
            self.block("KHR_materials_emissive_strength", block, blocks);
        }
        if own.unlit {
            self.block("KHR_materials_unlit", json!({}), blocks);
        }
        if let Some([r, g, b, glossiness]) = own.specular_glossiness {
            let mut block = json!({
                "diffuseFactor": own.base_color,
                "specularFactor": [r, g, b],
                "glossinessFactor": glossiness,
            });
            let maps = [
                ("diffuseTexture", &own.base_color_map),
                ("specularGlossinessTexture", &own.specular_glossiness_map),
            ];
            self.maps(&mut block, &maps, place);
            self.block("KHR_materials_pbrSpecularGlossiness", block, blocks);
        }
        self.iridescence(own, blocks, place);
    }

    fn iridescence(&mut self, own: &Standard, blocks: &mut Block<String, Value>, place: ValuePath) {
        let default = Standard::default();
        let [least, greatest] = own.iridescence_thickness;
        let maps = [
            ("iridescenceTexture", &own.iridescence_map),
            (
                "iridescenceThicknessTexture",
                &own.iridescence_thickness_map,
            ),
        ];
        let is_default = own.iridescence == default.iridescence
            && own.iridescence_ior == default.iridescence_ior
            && own.iridescence_thickness == default.iridescence_thickness
            && maps.iter().all(|(_, map)| map.is_none());
        if is_default {
            return;
        }
        let mut block = json!({
            "iridescenceFactor": own.iridescence,
            "iridescenceIor": own.iridescence_ior,
            "iridescenceThicknessMinimum": least,
            "iridescenceThicknessMaximum": greatest,
        });
        self.maps(&mut block, &maps, place);
        self.block("KHR_materials_iridescence", block, blocks);
    }

    fn maps(&mut self, block: &mut Value, maps: &[(&str, &Option<Map>)], place: ValuePath) {
        for (key, map) in maps {
            if let Some(map) = map {
                block[*key] = json!(self.texture_info(map, place));
            }
        }
    }

    fn block(&mut self, name: &'static str, block: Value, blocks: &mut Block<String, Value>) {
        self.root.extensions_used.insert(name);
        blocks.insert(name.to_owned(), block);
    }
}

/// What a parameter of a kind of the table is as JSON; none for the default.
macro_rules! written {
    (map, $own:ident.$field:ident, $writer:ident, $place:ident) => {
        $own.$field
            .as_ref()
            .map(|map| json!($writer.texture_info(map, $place)))
    };
    (normal_map, $own:ident.$field:ident, $writer:ident, $place:ident) => {
        $own.$field.as_ref().map(|map| {
            let mut info = json!($writer.texture_info(map, $place));
            info["scale"] = $own.clearcoat_normal_scale.into();
            info
        })
    };
    ($kind:ident, $own:ident.$field:ident, $writer:ident, $place:ident) => {
        ($own.$field != Standard::default().$field).then(|| json!($own.$field))
    };
}

/// Writes all extensions of the table.
macro_rules! extensions {
    ($($name:literal { $($field:ident: $kind:ident $key:literal;)* })*) => {
        impl GltfWriter<'_> {
            fn blocks(&mut self, own: &Standard, blocks: &mut Block<String, Value>, place: ValuePath) {
                $(
                    let mut block = Block::new();
                    $(if let Some(value) = written!($kind, own.$field, self, place) {
                        block.insert($key.to_owned(), value);
                    })*
                    if !block.is_empty() {
                        self.block($name, block.into(), blocks);
                    }
                )*
            }
        }
    };
}

standard::extensions!(extensions);

/// Drops a map that asks for texture coordinates which the mesh has not.
macro_rules! drop_map {
    (map, $map:expr, $sets:ident) => {
        if $map
            .as_ref()
            .is_some_and(|map| !$sets[map.set.min(1) as usize])
        {
            $map = None;
        }
    };
    ($kind:ident, $value:expr, $sets:ident) => {};
}

/// Drops such maps among all parameters.
macro_rules! drop_all {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        fn drop_maps(own: &mut Standard, sets: [bool; 2]) {
            $(drop_map!($kind, own.$field, sets);)*
        }
    };
}

parameters!(drop_all);

/// The power of two by which a colour is divided so that no channel is above 1, as glTF demands it.
pub(super) fn strength(color: [f64; 3]) -> f64 {
    let greatest = color.into_iter().fold(0.0, f64::max);
    std::iter::successors(Some(1.0), |strength| Some(strength * 2.0))
        .find(|strength| greatest <= *strength)
        .unwrap_or(f64::MAX)
}
