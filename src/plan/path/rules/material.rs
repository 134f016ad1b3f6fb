//! Rules on materials: layers of weight 0, alpha of 1, what an unlit material ignores.

use super::PathRule;
use crate::ir::{Field, Noun, Place};
use crate::math::{NonNegative, UnitInterval, Vec3};
use crate::plan::facts;
use crate::plan::path::draft::Draft;
use crate::plan::rules::Rule;
use crate::valid::{Alpha, Standard};

fn place(material: usize) -> Place {
    Place::new(Noun::Material, material, Field::Whole)
}

/// Simplifies the materials that are in use; returns the places of the changed ones.
fn simplify(
    draft: &mut Draft<'_>,
    simplified: impl Fn(&Draft<'_>, usize, &Standard) -> Standard,
) -> Vec<Place> {
    let used: Vec<_> = draft.used().map(|(index, _)| index).collect();
    let mut changed = Vec::new();
    for index in used {
        let new = simplified(draft, index, &draft.materials[index]);
        if new != draft.materials[index] {
            draft.materials[index] = new;
            changed.push(place(index));
        }
    }
    changed
}

pub(super) const ZERO: PathRule = PathRule {
    rule: Rule::PathZero,
    name: "P-WEIGHT-ZERO",
    text: "A layer whose weight is 0 adds nothing: transmission, clearcoat, sheen, anisotropy, \
           iridescence, specular reflection or emission whose factor is 0, or whose texture is 0 in \
           the channel that counts, wherever a surface lies on it.",
    because: "its textures are 0 wherever a surface lies on them",
    apply: |draft| simplify(draft, without_zeros),
};

fn without_zeros(draft: &Draft<'_>, index: usize, material: &Standard) -> Standard {
    let mut new = material.clone();
    let is_zero = |map, channel| draft.channel(index, map, channel)[1] == 0.0;
    let are_zero = |map| (0..3).all(|channel| is_zero(map, channel));
    if is_zero(material.transmission_map.as_ref(), 0) {
        // Only the factor decides whether the camera sees back faces.
        new.double_sided = !material.is_seen_from_one_side();
        new.transmission = UnitInterval::ZERO;
    }
    if is_zero(material.clearcoat_map.as_ref(), 0) {
        new.clearcoat = UnitInterval::ZERO;
    }
    if are_zero(material.sheen_color_map.as_ref()) {
        new.sheen_color = Vec3::ZERO;
    }
    if is_zero(material.anisotropy_map.as_ref(), 2) {
        new.anisotropy = UnitInterval::ZERO;
    }
    if is_zero(material.iridescence_map.as_ref(), 0)
        || material.iridescence_thickness == [NonNegative::ZERO; 2]
    {
        new.iridescence = UnitInterval::ZERO;
    }
    if is_zero(material.specular_map.as_ref(), 3) {
        new.specular = UnitInterval::ZERO;
    }
    if are_zero(material.emissive_map.as_ref()) {
        new.emissive = Vec3::ZERO;
    }
    new
}

pub(super) const UNLIT: PathRule = PathRule {
    rule: Rule::PathUnlitMaterial,
    name: "P-UNLIT-MATERIAL",
    text: "An unlit material shows its base colour and ends the path: nothing else of it counts.",
    because: "the materials that have it are unlit",
    apply: |draft| {
        simplify(draft, |_, _, material| {
            if !material.unlit {
                return material.clone();
            }
            Standard {
                base_color: material.base_color,
                base_color_map: material.base_color_map,
                alpha: material.alpha,
                double_sided: !material.is_seen_from_one_side(),
                unlit: true,
                ..facts::material::WHITE.clone()
            }
        })
    },
};

pub(super) const OPAQUE: PathRule = PathRule {
    rule: Rule::PathOpaque,
    name: "P-ALPHA",
    text: "A material whose alpha is 1 wherever a surface lies on its texture, or that is masked and \
           whose alpha is above the cutoff there, covers what is behind it: it is opaque. Not where \
           surfaces have colours at their corners, whose alpha is interpolated.",
    because: "alpha is 1, or above the cutoff, wherever a surface lies",
    apply: |draft| {
        simplify(draft, |draft, index, material| {
            let is_opaque = covers(draft, index, material);
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

/// Whether a material is opaque.
fn covers(draft: &Draft<'_>, index: usize, material: &Standard) -> bool {
    /// A margin above the rounding error of filtered values.
    const MARGIN: f64 = 1e-6;
    let [min, max] = draft.channel(index, material.base_color_map.as_ref(), 3);
    let alpha = material.base_color[3].get() * min;
    let is_exact = min == max;
    match material.alpha {
        Alpha::Opaque => true,
        Alpha::Mask(_) | Alpha::Blend if draft.uses[index].has_colors => false,
        Alpha::Mask(cutoff) => alpha > cutoff.get() + MARGIN || (is_exact && alpha >= cutoff.get()),
        Alpha::Blend => is_exact && alpha >= 1.0,
    }
}
