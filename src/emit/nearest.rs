//! The material of glTF that stands for Phong's model.

use rtc_ir::{Map, Phong, Standard, TextureId};
use rtc_tables::{PhongTerms, fit_phong};

/// The material of glTF that comes nearest, as traced paths show Phong's model. But for what
/// refracts, its index of refraction is that of glTF's dielectric: Phong's speaks of rays that go
/// through, and where none do it would be a surface without highlights.
pub(super) fn nearest(phong: &Phong) -> Standard {
    let fit = fit_phong(&PhongTerms {
        color: phong.color,
        kd: phong.kd,
        ks: phong.ks,
        n: phong.n,
        kt: phong.kt,
        eta: phong.eta,
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
        // A volume has one side, and both of anything else are seen.
        double_sided: !refracts,
        ..default
    }
}
