//! Converts an MTL material to Phong's model.

use crate::mesh::mtl::MtlMaterial;
use rtc_ir::Phong;

/// The largest ambient weight. Programs write a `Ka` of 1 for an ambient light that scenes of the
/// course don't have.
const MAX_AMBIENT: f64 = 0.2;

/// The default diffuse reflectance.
pub(super) const DIFFUSE: f64 = 0.8;

/// The default exponent of the highlight.
const EXPONENT: f64 = 10.0;

/// The mean of three channels; exact for grey.
fn mean([r, g, b]: [f64; 3]) -> f64 {
    if r == g && g == b {
        r
    } else {
        (r + g + b) / 3.0
    }
}

/// The weight of the highlight.
pub(super) fn weight(material: &MtlMaterial) -> f64 {
    let is_matt = material.model.as_ref().is_some_and(|model| model.value < 2);
    let specular = material.specular.as_ref().filter(|_| !is_matt);
    specular.map_or(0.0, |specular| mean(specular.value))
}

/// Whether the material refracts light.
pub(super) fn is_glass(material: &MtlMaterial) -> bool {
    let model = material.model.as_ref();
    model.is_some_and(|model| matches!(model.value, 4 | 6 | 7 | 9))
}

/// The opacity of a material, 0 to 1. `Tr 1` is read as opaque, as most programs write it.
pub(super) fn opacity(material: &MtlMaterial) -> f64 {
    let default_opacity = if is_glass(material) { 0.0 } else { 1.0 };
    let opacity = material.opacity.as_ref();
    let opacity = opacity.filter(|_| !material.is_transparency_1 || is_glass(material));
    opacity.map_or(default_opacity, |opacity| opacity.value)
}

/// Converts a material without its textures.
pub(super) fn phong(material: &MtlMaterial) -> Phong {
    let diffuse = material.diffuse.as_ref().map(|diffuse| diffuse.value);
    let largest = diffuse.map_or(1.0, |[r, g, b]| r.max(g).max(b));
    let color = diffuse.unwrap_or([DIFFUSE; 3]);
    let kd = match material.color_map {
        // A black `Kd` would make the texture invisible.
        Some(_) if largest > 0.0 => largest,
        _ => 1.0,
    };
    let ambient = material.ambient.as_ref();
    let ka = ambient.map_or(MAX_AMBIENT, |ambient| mean(ambient.value));
    let (is_glass, opacity) = (is_glass(material), opacity(material));
    let index = material.index.as_ref().map_or(1.0, |index| index.value);
    Phong {
        color,
        ka: opacity * ka.min(MAX_AMBIENT),
        kd: opacity * kd,
        ks: weight(material),
        n: material
            .exponent
            .as_ref()
            .map_or(EXPONENT, |exponent| exponent.value),
        kt: 1.0 - opacity,
        ior: if is_glass && opacity < 1.0 && index > 0.0 {
            index
        } else {
            1.0
        },
        ..Phong::MATT
    }
}
