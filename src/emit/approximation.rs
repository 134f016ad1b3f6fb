//! The approximation of the Phong model by the glTF material, and of the metals of that material by
//! Schlick's approximation.

use rtc_ir::{Map, Phong, Standard, TextureId};
use rtc_math::{ComplexIndex, Vec3};
use rtc_tables::{PhongTerms, fit_phong};

/// The glTF material with which path tracing approximates a Phong material. The index of refraction
/// applies to refractive materials only; others get the default of glTF, because with the Phong
/// default of 1 they would have no highlights.
pub(super) fn approximate_phong(phong: &Phong) -> Standard {
    let fit = fit_phong(&PhongTerms {
        color: phong.color,
        kd: phong.kd,
        ks: phong.mirror_weight(),
        n: phong.n,
        kt: phong.kt,
        ior: phong.ior,
    });
    let [r, g, b] = fit.base_color;
    let map = |texture: Option<TextureId>| {
        texture.map(|texture| Map {
            texture,
            set: 0,
            texture_from_surface: None,
        })
    };
    let default = Standard::default();
    let refracts = fit.transmission > 0.0;
    Standard {
        base_color: [r, g, b, 1.0],
        base_color_map: map(phong.color_map),
        normal_map: map(phong.normal_map),
        metallic: fit.metallic,
        roughness: fit.roughness,
        specular: fit.specular,
        transmission: fit.transmission,
        thickness: fit.thickness,
        ior: if refracts { fit.ior } else { default.ior },
        // A refractive solid is one-sided; everything else is two-sided.
        double_sided: !refracts,
        ..default
    }
}

/// A material whose metal has no index, but its reflectance along the normal as base colour: for
/// targets that have Schlick's approximation only.
pub(super) fn without_index(standard: &Standard) -> Standard {
    let Some(conductor) = standard.conductor else {
        return standard.clone();
    };
    let reflectance = ComplexIndex::from(conductor).reflectance(1.0);
    // The diffuse part has the base colour itself.
    let metal = Vec3::ONE.lerp(reflectance, standard.metallic);
    let [r, g, b, alpha] = standard.base_color;
    Standard {
        base_color: [r * metal.x, g * metal.y, b * metal.z, alpha],
        conductor: None,
        ..standard.clone()
    }
}
