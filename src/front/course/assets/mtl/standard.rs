//! Converts an MTL material to the `standard` material, for path tracing.

use super::bake::{BakedMap, PendingTextureBake};
use super::cache::{MapPlacement, MtlCache};
use super::phong::{is_glass, opacity, weight};
use super::{LoadedLibrary, phong};
use crate::mesh::WordSpan;
use crate::mesh::mtl::{MtlMap, MtlMaterial, MtlValue};
use rtc_ir::{Alpha, ImageId, LoweredScene, MaterialId, Standard};
use rtc_tables::{PhongTerms, fit_phong};
use std::f64::consts::TAU;

/// The default index of refraction.
const IOR: f64 = 1.5;
/// The roughness of the sheen, which an MTL does not specify.
const SHEEN: f64 = 0.5;

/// The statements of a material that have no effect in path tracing, and why. Ambient terms are not
/// reported: path tracing has none.
pub(super) fn unsupported(material: &MtlMaterial) -> Vec<(WordSpan, String)> {
    let m = material;
    let filter = m.filter.as_ref().filter(|filter| filter.value != [1.0; 3]);
    let filter = filter.filter(|_| !is_glass(m));
    let filter =
        filter.map(|statement| (statement.at, "`Tf` needs refraction (`illum` 4, 6, 7, 9)"));
    let bump = m.bump.as_ref().filter(|_| m.normal_map.is_some());
    let bump = bump.map(|statement| (statement.at, "`norm` replaces `map_Bump`"));
    let invisible = m
        .opacity
        .as_ref()
        .filter(|_| opacity(m) == 0.0 && !is_glass(m));
    let invisible =
        invisible.map(|statement| (statement.at, "a material of this opacity is invisible"));
    let parts = [filter, bump, invisible].into_iter().flatten();
    parts.map(|(at, reason)| (at, reason.to_owned())).collect()
}

/// Converts a material without its textures.
///
/// The diffuse colour is the base colour; a mirror without one becomes a metal. The exponent of the
/// highlight becomes the roughness by the fit that is used for Phong materials. `Ks` is the
/// strength of the highlight: programs write 0.5 for an index of 1.5. A refractive material has the
/// colour of `Tf`.
pub(super) fn standard(material: &MtlMaterial) -> Standard {
    let m = material;
    let color = phong::phong(m);
    let is_pbr = is_physical(m);
    // Fit roughness and metallic to Phong's model.
    let fit = fit_phong(&PhongTerms {
        color: color.color,
        kd: if opacity(m) > 0.0 {
            color.kd / opacity(m)
        } else {
            color.kd
        },
        ks: color.ks,
        n: color.n,
        kt: 0.0,
        ior: color.ior,
    });
    // The base colour is that of `Tf` for glass.
    let glass = is_glass(m) && opacity(m) < 1.0;
    let fraction = |channel: f64| channel.clamp(0.0, 1.0);
    let [r, g, b] = match (glass, &m.filter) {
        (true, Some(filter)) => filter.value.map(fraction),
        (true, None) => [1.0; 3],
        (false, _) => base(m, fit.metallic > 0.0),
    };
    let value =
        |statement: &Option<MtlValue<f64>>| statement.as_ref().map(|statement| statement.value);
    let ior = value(&m.index).filter(|index| *index > 1.0).unwrap_or(IOR);
    let alpha = if glass { 1.0 } else { opacity(m) };
    let is_mapped = |map: &Option<MtlValue<MtlMap>>| map.is_some();
    // Explicit PBR statements take precedence over the fit.
    let base = Standard {
        base_color: [r, g, b, alpha],
        metallic: match value(&m.metallic) {
            Some(metallic) => metallic,
            None if is_mapped(&m.metallic_map) => 1.0,
            None if is_pbr || glass => 0.0,
            None => fit.metallic,
        },
        roughness: match value(&m.roughness) {
            Some(roughness) => roughness,
            None if is_mapped(&m.roughness_map) => 1.0,
            None if glass => 0.0,
            None => fit.roughness,
        },
        specular: match is_pbr || glass || fit.metallic > 0.0 {
            true => 1.0,
            false => fraction(2.0 * weight(m)),
        },
        ior,
        transmission: if glass { 1.0 - opacity(m) } else { 0.0 },
        thickness: if glass { 1.0 } else { 0.0 },
        alpha: match alpha < 1.0 || is_mapped(&m.opacity_map) {
            true => Alpha::Blend,
            false => Alpha::Opaque,
        },
        double_sided: true,
        ..Standard::default()
    };
    with_layers(base, m)
}

/// Whether it has metallic or roughness statements.
fn is_physical(m: &MtlMaterial) -> bool {
    let numbers = m.roughness.is_some() || m.metallic.is_some();
    numbers || m.roughness_map.is_some() || m.metallic_map.is_some()
}

/// Adds emission, clearcoat, sheen and anisotropy to a material.
fn with_layers(base: Standard, m: &MtlMaterial) -> Standard {
    let value = |statement: &Option<MtlValue<f64>>| {
        statement.as_ref().map_or(0.0, |statement| statement.value)
    };
    let emissive = m
        .emissive
        .as_ref()
        .map_or([0.0; 3], |statement| statement.value);
    let is_mapped = emissive == [0.0; 3] && m.emissive_map.is_some();
    let sheen = value(&m.sheen);
    Standard {
        emissive: if is_mapped { [1.0; 3] } else { emissive },
        clearcoat: value(&m.clearcoat),
        clearcoat_roughness: value(&m.clearcoat_roughness),
        sheen_color: [sheen; 3],
        sheen_roughness: if sheen > 0.0 { SHEEN } else { 0.0 },
        anisotropy: value(&m.anisotropy),
        anisotropy_rotation: TAU * value(&m.anisotropy_rotation),
        ..base
    }
}

/// The base colour: `Ks` for a metal, else `Kd`.
fn base(m: &MtlMaterial, is_mirror: bool) -> [f64; 3] {
    let color = match is_mirror {
        true => m.specular.as_ref(),
        false => m.diffuse.as_ref(),
    };
    let color = color.map_or([phong::DIFFUSE; 3], |statement| statement.value);
    let is_black = color == [0.0; 3];
    // A black factor would make the texture invisible.
    let color = if is_black && m.color_map.is_some() {
        [1.0; 3]
    } else {
        color
    };
    color.map(|channel| channel.clamp(0.0, 1.0))
}

impl MtlCache {
    /// Adds the textures of a material; those that combine several images are scheduled for baking.
    pub(super) fn with_maps(
        &mut self,
        mut standard: Standard,
        loaded: &LoadedLibrary,
        m: &MtlMaterial,
        material: MaterialId,
        lowered: &mut LoweredScene,
    ) -> Standard {
        // Add the images.
        let mut image = |map: &Option<MtlValue<MtlMap>>, has_opacity: bool| -> Option<ImageId> {
            Some(self.image(&loaded.map(map.as_ref()?), has_opacity, lowered))
        };
        let color = image(&m.color_map, false);
        let mask = image(&m.opacity_map, true);
        let [rough, metal] = [&m.roughness_map, &m.metallic_map].map(|map| image(map, false));
        let heights = image(&m.bump, false).filter(|_| m.normal_map.is_none());
        let direct = [&m.specular_map, &m.normal_map, &m.emissive_map].map(|map| image(map, false));
        // Textures of one image.
        let mut placement = |map: &Option<MtlValue<MtlMap>>, image: Option<ImageId>| {
            Some(self.placement(&loaded.map(map.as_ref()?), image?, lowered))
        };
        standard.base_color_map = placement(&m.color_map, color);
        standard.specular_color_map = placement(&m.specular_map, direct[0]);
        standard.normal_map = placement(&m.normal_map, direct[1]);
        standard.emissive_map = placement(&m.emissive_map, direct[2]);
        // Textures that combine several images.
        let mut bake = |map: &Option<MtlValue<MtlMap>>, baked: BakedMap| {
            let Some(map) = map else { return };
            self.bakes.push(PendingTextureBake {
                material,
                baked,
                placement: MapPlacement::of(&map.value),
                span: map.at.span(loaded.file),
            });
        };
        if let Some(mask) = mask {
            let placement = m.color_map.as_ref().or(m.opacity_map.as_ref()).cloned();
            bake(&placement, BakedMap::Opacity { color, mask });
        }
        if rough.is_some() || metal.is_some() {
            let first = m
                .roughness_map
                .as_ref()
                .or(m.metallic_map.as_ref())
                .cloned();
            bake(&first, BakedMap::MetalRough { rough, metal });
        }
        if let Some(heights) = heights {
            let height = m.bump.as_ref().map_or(1.0, |map| map.value.height);
            bake(&m.bump, BakedMap::Normals { heights, height });
        }
        standard
    }
}
