//! Writes materials: the glTF material from the table of its parameters, the Phong model by an
//! approximation.

use super::document::{self, GltfIndex, PbrMetallicRoughness, TextureInfo};
use super::writer::{GltfWriter, extras};
use crate::approximation::{approximate_phong, without_index};
use crate::picture::ColorCoding;
use rtc_diag::codes;
use rtc_ir::{
    Alpha, Bump, Conductor, EntityField, EntityKind, Map, Material, MaterialId, MeshId, Mode,
    Phong, Standard, ValuePath,
};
use rtc_tables::{ExtensionProperty, MATERIAL_EXTENSIONS, PropertyKind};
use serde::Serialize;
use serde_json::{Map as JsonObject, Value, json};
use std::any::Any;

/// A material of the scene, on meshes with or without each set of texture coordinates, and whether
/// it says that tangents follow the surface. Maps of a missing set have no effect and are dropped.
pub(super) type GltfMaterialKey = (u32, [bool; 2], bool);

impl GltfWriter<'_> {
    /// The material for a mesh.
    pub(super) fn material(
        &mut self,
        id: MaterialId,
        mesh_id: MeshId,
    ) -> GltfIndex<document::Material> {
        let mesh = &self.scene.meshes[mesh_id.0 as usize];
        let material = &self.scene.materials[id.0 as usize];
        let keeps_tangents = mesh.tangents.is_empty() && turns_tangents(material);
        let parts = [!mesh.uvs.is_empty(), !mesh.second_uvs.is_empty()];
        let key = (id.0, parts, keeps_tangents);
        if let Some(known) = self.materials.get(&key) {
            return *known;
        }
        let path = ValuePath::new(EntityKind::Material, id.0 as usize, EntityField::Whole);
        let (mut standard, base_coding, mut rtc_extras) = match material {
            Material::Standard(standard) => {
                let mut rtc_extras = self.conductor(standard, path);
                self.facets(standard, &mut rtc_extras, path);
                if keeps_tangents {
                    let what = "that tangents follow the surface, not the normal map";
                    self.reporter.in_extras(what, path);
                    rtc_extras.insert("surfaceTangents".to_owned(), json!(true));
                }
                (without_index(standard), ColorCoding::Srgb, rtc_extras)
            }
            Material::Phong(phong) => {
                let coding = match self.scene.settings.mode {
                    Mode::Path(_) => ColorCoding::Srgb,
                    // Phong's model has the values of a display.
                    Mode::Phong | Mode::Depth | Mode::Normal | Mode::Gooch(_) => {
                        ColorCoding::Linear
                    }
                };
                let rtc_extras = self.phong(phong, key.1[0], coding, path);
                (approximate_phong(phong), coding, rtc_extras)
            }
        };
        self.patterns(material, &mut rtc_extras, path);
        standard.retain_maps(|map| key.1[map.set.min(1) as usize]);
        self.extra_maps(&standard, &mut rtc_extras, path);
        if let Some(other) = standard.blend_with {
            self.reporter
                .in_extras("the other material of a blend", path);
            let other = self.material(other, mesh_id).value();
            rtc_extras.insert("blendWith".to_owned(), json!(other));
            rtc_extras.insert("blendWeight".to_owned(), json!(standard.blend_weight));
        }
        let material = self.standard(&standard, base_coding, path);
        let material = document::Material {
            extras: extras(rtc_extras),
            ..material
        };
        let index = GltfIndex::push(&mut self.root.materials, material);
        self.materials.insert(key, index);
        index
    }

    fn standard(
        &mut self,
        standard: &Standard,
        base_coding: ColorCoding,
        path: ValuePath,
    ) -> document::Material {
        let pbr_metallic_roughness = self.metallic_roughness(standard, base_coding, path);
        let mut blocks = JsonObject::new();
        self.blocks(standard, &mut blocks, path);
        self.other_blocks(standard, &mut blocks, path);
        let (alpha_mode, alpha_cutoff) = match standard.alpha {
            Alpha::Opaque => ("OPAQUE", None),
            Alpha::Mask(cutoff) => ("MASK", Some(cutoff)),
            Alpha::Blend => ("BLEND", None),
        };
        let strength = strength(standard.emissive);
        document::Material {
            alpha_cutoff,
            alpha_mode,
            double_sided: standard.double_sided,
            name: Some(standard.name.clone()).filter(|name| !name.is_empty()),
            pbr_metallic_roughness,
            normal_texture: standard.normal_map.as_ref().map(|map| TextureInfo {
                scale: Some(standard.normal_scale),
                ..self.texture_info(map, ColorCoding::Linear, path)
            }),
            emissive_texture: self.info(standard.emissive_map.as_ref(), ColorCoding::Srgb, path),
            emissive_factor: standard.emissive.map(|channel| channel / strength),
            extensions: blocks,
            extras: None,
        }
    }

    /// The metallic-roughness parameters. With `KHR_materials_pbrSpecularGlossiness` the colour is
    /// written there.
    fn metallic_roughness(
        &mut self,
        standard: &Standard,
        base_coding: ColorCoding,
        path: ValuePath,
    ) -> PbrMetallicRoughness {
        let is_core = standard.specular_glossiness.is_none();
        let color_map = standard.base_color_map.as_ref().filter(|_| is_core);
        PbrMetallicRoughness {
            base_color_factor: if is_core {
                standard.base_color
            } else {
                [1.0; 4]
            },
            base_color_texture: self.info(color_map, base_coding, path),
            metallic_factor: standard.metallic,
            roughness_factor: standard.roughness,
            metallic_roughness_texture: self.info(
                standard.metallic_roughness_map.as_ref(),
                ColorCoding::Linear,
                path,
            ),
        }
    }

    fn info(
        &mut self,
        map: Option<&Map>,
        coding: ColorCoding,
        path: ValuePath,
    ) -> Option<TextureInfo> {
        map.map(|map| self.texture_info(map, coding, path))
    }

    /// Extensions whose properties are not direct copies of parameters.
    fn other_blocks(
        &mut self,
        standard: &Standard,
        blocks: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let strength = strength(standard.emissive);
        if strength != 1.0 {
            let block = json!({ "emissiveStrength": strength });
            self.block("KHR_materials_emissive_strength", block, blocks);
        }
        if standard.unlit {
            self.block("KHR_materials_unlit", json!({}), blocks);
        }
        if let Some([r, g, b, glossiness]) = standard.specular_glossiness {
            let mut block = json!({
                "diffuseFactor": standard.base_color,
                "specularFactor": [r, g, b],
                "glossinessFactor": glossiness,
            });
            let maps = [
                ("diffuseTexture", &standard.base_color_map),
                (
                    "specularGlossinessTexture",
                    &standard.specular_glossiness_map,
                ),
            ];
            self.maps(&mut block, &maps, path);
            self.block("KHR_materials_pbrSpecularGlossiness", block, blocks);
        }
        self.iridescence(standard, blocks, path);
    }

    fn iridescence(
        &mut self,
        standard: &Standard,
        blocks: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let default = Standard::default();
        let [least, greatest] = standard.iridescence_thickness;
        let maps = [
            ("iridescenceTexture", &standard.iridescence_map),
            (
                "iridescenceThicknessTexture",
                &standard.iridescence_thickness_map,
            ),
        ];
        let is_default = standard.iridescence == default.iridescence
            && standard.iridescence_ior == default.iridescence_ior
            && standard.iridescence_thickness == default.iridescence_thickness
            && maps.iter().all(|(_, map)| map.is_none());
        if is_default {
            return;
        }
        let mut block = json!({
            "iridescenceFactor": standard.iridescence,
            "iridescenceIor": standard.iridescence_ior,
            "iridescenceThicknessMinimum": least,
            "iridescenceThicknessMaximum": greatest,
        });
        self.maps(&mut block, &maps, path);
        self.block("KHR_materials_iridescence", block, blocks);
    }

    fn maps(&mut self, block: &mut Value, maps: &[(&str, &Option<Map>)], path: ValuePath) {
        for (key, map) in maps {
            if let Some(map) = map {
                block[*key] = json!(self.texture_info(map, coding_of(key), path));
            }
        }
    }

    fn block(&mut self, name: &'static str, block: Value, blocks: &mut JsonObject<String, Value>) {
        self.root.extensions_used.insert(name);
        blocks.insert(name.to_owned(), block);
    }
}

impl GltfWriter<'_> {
    /// Writes the extensions whose properties are parameters unchanged.
    fn blocks(
        &mut self,
        standard: &Standard,
        blocks: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let default = Standard::default();
        for (name, properties) in MATERIAL_EXTENSIONS {
            let mut block = JsonObject::new();
            for property in *properties {
                let value = self.property([standard, &default], property, path);
                block.extend(value.map(|value| (property.0.to_owned(), value)));
            }
            if !block.is_empty() {
                self.block(name, block.into(), blocks);
            }
        }
    }

    /// The value of a property; `None` for that of the default material.
    fn property(
        &mut self,
        [standard, default]: [&Standard; 2],
        (key, kind, parameter): &ExtensionProperty,
        path: ValuePath,
    ) -> Option<Value> {
        let value = standard.parameter(parameter)?;
        if let Some(map) = value.downcast_ref::<Option<Map>>() {
            let mut info = json!(self.texture_info(map.as_ref()?, coding_of(key), path));
            if *kind == PropertyKind::NormalMap {
                info["scale"] = standard.clearcoat_normal_scale.into();
            }
            return Some(info);
        }
        let default = default.parameter(parameter)?;
        changed::<f64>(value, default)
            .or_else(|| changed::<[f64; 3]>(value, default))
            .or_else(|| changed::<Option<f64>>(value, default))
    }
}

/// The coding of the colours of a texture, by its key in an extension.
fn coding_of(key: &str) -> ColorCoding {
    let is_color = key.ends_with("ColorTexture")
        || matches!(key, "diffuseTexture" | "specularGlossinessTexture");
    match is_color {
        true => ColorCoding::Srgb,
        false => ColorCoding::Linear,
    }
}

/// The JSON of a value of this type that is not the default.
fn changed<T: PartialEq + Serialize + 'static>(
    value: &dyn Any,
    default: &dyn Any,
) -> Option<Value> {
    let (value, default) = (value.downcast_ref::<T>()?, default.downcast_ref::<T>()?);
    (value != default).then(|| json!(value))
}

/// The power of two by which a colour is divided so that no channel exceeds 1, as glTF requires.
pub(super) fn strength(color: [f64; 3]) -> f64 {
    let greatest = color.into_iter().fold(0.0, f64::max);
    std::iter::successors(Some(1.0), |strength| Some(strength * 2.0))
        .find(|strength| greatest <= *strength)
        .unwrap_or(f64::MAX)
}

impl GltfWriter<'_> {
    /// The index of a metal and its colour for `extras.rtc`.
    fn conductor(&mut self, standard: &Standard, path: ValuePath) -> JsonObject<String, Value> {
        let Some(Conductor { eta, k }) = standard.conductor else {
            return JsonObject::new();
        };
        self.reporter
            .in_extras("the complex index of a metal", path);
        let [r, g, b, _] = standard.base_color;
        let conductor = json!({ "eta": eta, "k": k, "baseColor": [r, g, b] });
        JsonObject::from_iter([("conductor".to_owned(), conductor)])
    }

    /// The distribution of facets, the kind of plastic, the sides and the media for `extras.rtc`.
    fn facets(
        &mut self,
        standard: &Standard,
        rtc_extras: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let default = Standard::default();
        let mut write = |key: &str, what: &str, value: Value| {
            self.reporter.in_extras(what, path);
            rtc_extras.insert(key.to_owned(), value);
        };
        if standard.microfacets != default.microfacets {
            let value = json!(standard.microfacets);
            write("microfacets", "the distribution of facets", value);
        }
        if standard.plastic != default.plastic {
            write("plastic", "the kind of plastic", json!(standard.plastic));
        }
        if standard.black_back {
            write("blackBack", "a back that reflects nothing", json!(true));
        }
        if standard.bump_scale != default.bump_scale {
            write(
                "bumpScale",
                "the scale of a bump map",
                json!(standard.bump_scale),
            );
        }
        if standard.thin_dielectric {
            write("thinDielectric", "the two faces of a pane", json!(true));
        }
        for (key, medium) in [
            ("interior", &standard.interior),
            ("exterior", &standard.exterior),
        ] {
            if let Some(medium) = medium {
                write(key, "a participating medium", json!(medium));
            }
        }
    }

    /// The maps for `extras.rtc`.
    fn extra_maps(
        &mut self,
        standard: &Standard,
        rtc_extras: &mut JsonObject<String, Value>,
        path: ValuePath,
    ) {
        let maps = [
            ("opacityTexture", "an opacity map", &standard.opacity_map),
            ("bumpTexture", "a bump map", &standard.bump_map),
            ("blendTexture", "the map of a blend", &standard.blend_map),
        ];
        for (key, what, map) in maps {
            if let Some(map) = map {
                self.reporter.in_extras(what, path);
                let info = json!(self.texture_info(map, ColorCoding::Linear, path));
                rtc_extras.insert(key.to_owned(), info);
            }
        }
    }

    /// The weights and maps of the Phong model for `extras.rtc`.
    pub(super) fn phong(
        &mut self,
        phong: &Phong,
        has_uvs: bool,
        color_coding: ColorCoding,
        path: ValuePath,
    ) -> JsonObject<String, Value> {
        let Phong {
            color,
            ka,
            kd,
            ks,
            kr,
            n,
            kt,
            fresnel,
            ior,
            glossy_samples,
            color_map,
            specular_map,
            normal_map,
            bump,
        } = phong;
        // Report the approximation; the extras keep the exact parameters.
        let message = "Phong's model becomes the metallic-roughness material that comes nearest";
        self.reporter
            .report(&codes::GLTF_APPROXIMATED, message, path);
        self.reporter
            .in_extras("the Phong parameters of a material", path);
        // Write the parameters.
        let mut rtc_extras = json!({
            "color": color,
            "ka": ka,
            "kd": kd,
            "ks": ks,
            "n": n,
            "kt": kt,
            "eta": ior,
            "glossySamples": glossy_samples,
        });
        if let Some(kr) = kr {
            rtc_extras["kr"] = json!(kr);
        }
        if *fresnel {
            rtc_extras["fresnel"] = json!(true);
        }
        // Write the textures if the mesh has coordinates.
        let bump_map = bump.as_ref().map(|Bump { texture, .. }| *texture);
        let maps = [
            ("colorMap", color_map),
            ("specularMap", specular_map),
            ("normalMap", normal_map),
            ("bumpMap", &bump_map),
        ];
        for (key, texture) in maps {
            let Some(texture) = texture else { continue };
            if has_uvs && !self.is_pattern(*texture) {
                let coding = match key {
                    "colorMap" => color_coding,
                    _ => ColorCoding::Linear,
                };
                rtc_extras[key] = self.texture(*texture, coding, path).value().into();
            }
        }
        let is_shown = |bump: &&Bump| has_uvs || self.is_pattern(bump.texture);
        if let Some(Bump { height, .. }) = bump.as_ref().filter(is_shown) {
            rtc_extras["bumpHeight"] = (*height).into();
        }
        JsonObject::from_iter([("phong".to_owned(), rtc_extras)])
    }
}

/// Whether tangents along the coordinates of a map that follows them may differ from those along
/// the surface, which a mesh without tangents has.
fn turns_tangents(material: &Material) -> bool {
    let Material::Standard(standard) = material else {
        return false;
    };
    let maps = [
        &standard.normal_map,
        &standard.clearcoat_normal_map,
        &standard.anisotropy_map,
    ];
    maps.into_iter().flatten().any(Map::turns_tangents)
}
