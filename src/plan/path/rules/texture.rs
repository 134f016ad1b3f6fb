//! Rules on maps: maps without texture coordinates, maps that multiply 0, and constant maps.

use super::PathRule;
use crate::Layer;
use crate::path::builder::PathPlanBuilder;
use rtc_math::{UnitInterval, Vec3};
use rtc_valid::{Alpha, Map, MaterialId, Standard};

pub(crate) const UNSEEN: PathRule = PathRule {
    name: "P-TEX-UNSEEN",
    text: "A map has the value 1 on surfaces without its texture coordinates, and a map that \
           scales a factor of 0 has no effect: neither is looked up. If no path continues, maps \
           that only illumination needs are not looked up either.",
    reason: "its maps scale a factor of 0, or no surface has their texture coordinates",
    apply: |builder| builder.simplify(without_unused_maps),
};

fn without_unused_maps(builder: &PathPlanBuilder<'_>, index: MaterialId, m: &Standard) -> Standard {
    let mut new = m.clone();
    let is_nonzero = |weight: UnitInterval| weight > UnitInterval::ZERO;
    let is_shaded = builder.goes_on() && !m.unlit;
    let is_clear = !is_nonzero(m.transmission);
    let is_metal_or_rough = is_shaded && (is_nonzero(m.metallic) || is_nonzero(m.roughness));
    let conditions = [
        (&mut new.base_color_map, true),
        (&mut new.opacity_map, m.alpha != Alpha::Opaque),
        (&mut new.blend_map, m.blend_with.is_some()),
        (
            &mut new.metallic_roughness_map,
            is_metal_or_rough && m.specular_glossiness.is_none(),
        ),
        (
            &mut new.specular_glossiness_map,
            is_shaded && m.specular_glossiness.is_some(),
        ),
        (&mut new.emissive_map, m.emissive != Vec3::ZERO),
        (&mut new.normal_map, is_shaded),
        (&mut new.bump_map, is_shaded && m.bump_scale != 0.0),
        (&mut new.specular_map, is_shaded && is_nonzero(m.specular)),
        (
            &mut new.specular_color_map,
            is_shaded && m.specular_color != Vec3::ZERO,
        ),
        (&mut new.transmission_map, is_shaded && !is_clear),
        // No integrator reads the thickness of a volume: it is the distance between the hits of a
        // ray.
        (&mut new.thickness_map, false),
        (
            &mut new.clearcoat_normal_map,
            is_shaded && is_nonzero(m.clearcoat),
        ),
    ];
    let keep = |map: &mut Option<Map>, shows: bool| {
        let has_places = |map: &Map| builder.has_places(index, map);
        *map = map.filter(|map| shows && has_places(map));
    };
    for (map, shows) in conditions {
        keep(map, shows);
    }
    for layer in Layer::ALL {
        layer.each_map(&mut new, |map, shows| keep(map, is_shaded && shows));
    }
    new
}

pub(crate) const CONSTANT: PathRule = PathRule {
    name: "P-TEX-CONST",
    text: "A texture whose texels are all equal has this value everywhere: its maps become \
           factors, and a normal map becomes one normal, when the scene is prepared.",
    reason: "all texels of each of its textures are equal",
    apply: |builder| {
        let foldable = |(index, material): (MaterialId, &Standard)| {
            let new = material.maps().filter(|map| !builder.is_folded(index, map));
            let constant = new.filter_map(|map| builder.constant(index, map));
            constant.map(|map| (index, map)).collect::<Vec<_>>()
        };
        let new: Vec<_> = builder.used_materials().flat_map(foldable).collect();
        let folded = new.into_iter().map(|(index, map)| builder.fold(index, map));
        let mut changed: Vec<_> = folded.collect();
        changed.dedup();
        changed
    },
};
