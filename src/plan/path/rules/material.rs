//! Rules on materials: layers of weight 0, opaque alpha, the ignored parameters of unlit materials.

use super::PathRule;
use crate::Layer;
use crate::facts;
use crate::path::builder::PathPlanBuilder;
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{NonNegative, UnitInterval, Vec3};
use rtc_valid::{Alpha, Map, MaterialId, Standard};

pub(crate) const ZERO: PathRule = PathRule {
    name: "P-WEIGHT-ZERO",
    text: "Transmission, specular reflection, emission and layers of weight 0 contribute nothing, \
           nor does the index of a metal where none is, nor the other material of a blend, nor a \
           bump map of one height. \
           The weight is 0 if the factor is 0, or if the texture is 0 in the used channel \
           everywhere on the surfaces.",
    reason: "its textures are 0 everywhere on the surfaces",
    apply: |builder| builder.simplify(without_zeros),
};

fn without_zeros(builder: &PathPlanBuilder<'_>, index: MaterialId, m: &Standard) -> Standard {
    let mut new = m.clone();
    let is_nonzero = |weight: UnitInterval| weight > UnitInterval::ZERO;
    let is_zero =
        |map: &Option<Map>, channel| builder.is_zero(index, map.as_ref(), channel..channel + 1);
    let are_zero = |map: &Option<Map>| builder.is_zero(index, map.as_ref(), 0..3);
    if is_nonzero(m.transmission) && is_zero(&m.transmission_map, 0) {
        // The factor alone decides whether the camera sees back faces.
        new.double_sided = true;
        new.transmission = UnitInterval::ZERO;
    }
    for layer in Layer::ALL.into_iter().filter(|layer| layer.is_in(m)) {
        let (map, channels) = layer.weight_map(m);
        if builder.is_zero(index, map, channels) {
            layer.remove(&mut new);
        }
    }
    if m.iridescence_thickness == [NonNegative::ZERO; 2] {
        new.iridescence = UnitInterval::ZERO;
    }
    if is_nonzero(m.specular) && is_zero(&m.specular_map, 3) {
        new.specular = UnitInterval::ZERO;
    }
    let metals = m.metallic_roughness_map.as_ref();
    if m.metallic == UnitInterval::ZERO || builder.is_zero(index, metals, 2..3) {
        new.conductor = None;
    }
    let is_even = |map: &Map| builder.constant(index, map).is_some();
    new.bump_map = m.bump_map.filter(|map| !is_even(map));
    if m.blend_weight == UnitInterval::ZERO || is_zero(&m.blend_map, 0) {
        new.blend_with = None;
    }
    if m.emissive != Vec3::ZERO && are_zero(&m.emissive_map) {
        new.emissive = Vec3::ZERO;
    }
    new
}

pub(crate) const UNLIT: PathRule = PathRule {
    name: "P-UNLIT-MATERIAL",
    text: "An unlit material has its base colour as radiance and ends the path: its other \
           parameters are not used.",
    reason: "the materials that have it are unlit",
    apply: |builder| {
        builder.simplify(|_, _, material| {
            if !material.unlit {
                return material.clone();
            }
            Standard {
                base_color: material.base_color,
                base_color_map: material.base_color_map,
                alpha: material.alpha,
                opacity_map: material.opacity_map,
                blend_with: material.blend_with,
                blend_weight: material.blend_weight,
                blend_map: material.blend_map,
                double_sided: !material.is_seen_from_one_side(),
                unlit: true,
                interior: material.interior,
                exterior: material.exterior,
                ..facts::material::WHITE.clone()
            }
        })
    },
};

pub(crate) const CLEAR_MEDIA: PathRule = PathRule {
    name: "P-MEDIUM-CLEAR",
    text: "A medium whose coefficients are 0 neither absorbs nor scatters light. If all media are \
           such, no path needs to know in which one it is.",
    reason: "the coefficients of all media are 0",
    apply: |builder| {
        let mut media = builder.media();
        if !media.all(|medium| medium.is_clear()) {
            return Vec::new();
        }
        drop(media);
        let around = builder.medium.take();
        let around = around.map(|_| ValuePath::new(EntityKind::Medium, 0, EntityField::Whole));
        let mut places = builder.simplify(|_, _, material| Standard {
            interior: None,
            exterior: None,
            ..material.clone()
        });
        places.extend(around);
        places
    },
};

pub(crate) const OPAQUE: PathRule = PathRule {
    name: "P-ALPHA",
    text: "A material is opaque if its alpha is 1 everywhere on its surfaces, or if it has an \
           alpha mask and its alpha is above the cutoff everywhere. The rule does not apply to \
           surfaces with vertex colours, whose alpha is interpolated.",
    reason: "alpha is 1, or above the cutoff, everywhere on the surfaces",
    apply: |builder| {
        builder.simplify(|builder, index, material| {
            let is_opaque = covers(builder, index, material);
            let alpha = if is_opaque {
                Alpha::Opaque
            } else {
                material.alpha
            };
            Standard {
                alpha,
                ..material.clone()
            }
        })
    },
};

/// Whether a material is opaque. Its texture is read only where the factor does not decide it.
fn covers(builder: &PathPlanBuilder<'_>, index: MaterialId, material: &Standard) -> bool {
    /// A bound above the rounding error of filtered values.
    const MARGIN: f64 = 1e-6;
    let uses = &builder.uses[index];
    let factor = material.base_color[3].get();
    let (map, textures) = (material.base_color_map.as_ref(), builder.textures);
    let only_value = || map.map_or(Some(1.0), |map| uses.value(map, 3, textures));
    let is_covered = |map: &Map| uses.value(map, 0, textures) == Some(1.0);
    match material.alpha {
        Alpha::Opaque => true,
        Alpha::Mask(_) | Alpha::Blend if uses.has_colors => false,
        Alpha::Mask(_) | Alpha::Blend if !material.opacity_map.as_ref().is_none_or(is_covered) => {
            false
        }
        Alpha::Blend => factor >= 1.0 && only_value() == Some(1.0),
        Alpha::Mask(cutoff) => {
            let cutoff = cutoff.get();
            let is_above = |alpha: f64| factor * alpha > cutoff + MARGIN;
            factor >= cutoff
                && (only_value().is_some_and(|alpha| factor * alpha >= cutoff)
                    || map.is_some_and(|map| uses.all(map, 3, textures, is_above)))
        }
    }
}
