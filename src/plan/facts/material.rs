//! Materials as each integrator uses them: the Whitted integrator uses the Phong model, the path
//! integrator the glTF material.

use crate::layer::Layer;
use rtc_math::{IdTable, NonNegative, Positive, UnitInterval, Vec3};
use rtc_tables::{PhongTerms, fit_phong};
use rtc_valid::{Map, Material, MaterialId, Phong, Standard, TextureId, UvSet, ValidScene};
use std::num::NonZeroU32;

/// The materials of the Whitted integrator: of a blend the one of the larger weight.
#[must_use]
pub fn phongs(materials: &IdTable<Material>) -> IdTable<Material, Phong> {
    materials
        .ids()
        .map(|id| shown_phong(materials, id))
        .collect()
}

/// One of [`phongs`].
pub(crate) fn shown_phong(materials: &IdTable<Material>, mut id: MaterialId) -> Phong {
    let other = |material: &Material| match material {
        Material::Standard(standard) if standard.blend_weight.get() > 0.5 => standard.blend_with,
        Material::Standard(_) | Material::Phong(_) => None,
    };
    while let Some(next) = other(&materials[id]) {
        id = next;
    }
    phong(&materials[id])
}

/// The material of the Whitted integrator. A glTF material is converted by its colour, without
/// emission.
#[must_use]
fn phong(material: &Material) -> Phong {
    match material {
        Material::Phong(phong) => phong.clone(),
        Material::Standard(standard) => phong_of_standard(standard),
    }
}

/// The material of the path integrator. A Phong material is converted to the closest glTF material.
#[must_use]
pub fn standard(material: &Material) -> Standard {
    match material {
        Material::Phong(phong) => standard_of_phong(phong),
        Material::Standard(standard) => (**standard).clone(),
    }
}

fn phong_of_standard(standard: &Standard) -> Phong {
    let [r, g, b, _] = standard.base_color.map(UnitInterval::get);
    let roughness = standard.roughness.get();
    // The colour of a metal along its normal; that of the diffuse part is not changed by an index.
    let metal = standard.conductor.map_or(Vec3::ONE, |index| {
        Vec3::ONE.lerp(index.reflectance(1.0), standard.metallic.get())
    });
    Phong {
        color: Vec3::new(r, g, b) * metal,
        ka: NonNegative::ZERO,
        kd: standard.metallic.complement().into(),
        ks: standard.metallic.into(),
        kr: None,
        n: NonNegative::saturating(1.0 / (roughness * roughness).max(1e-4)),
        kt: NonNegative::ZERO,
        fresnel: false,
        ior: Positive::ONE,
        glossy_samples: NonZeroU32::MIN,
        maps: None,
    }
}

fn standard_of_phong(phong: &Phong) -> Standard {
    let fit = fit_phong(&PhongTerms {
        color: phong.color.to_array(),
        kd: phong.kd.get(),
        ks: phong.mirror_weight(),
        n: phong.n.get(),
        kt: phong.kt.get(),
        ior: phong.ior.get(),
    });
    let [r, g, b] = fit.base_color.map(UnitInterval::saturating);
    Standard {
        base_color: [r, g, b, UnitInterval::ONE],
        base_color_map: phong
            .maps
            .as_ref()
            .and_then(|maps| maps.color)
            .map(untransformed_map),
        normal_map: phong
            .maps
            .as_ref()
            .and_then(|maps| maps.normal)
            .map(untransformed_map),
        metallic: UnitInterval::saturating(fit.metallic),
        roughness: UnitInterval::saturating(fit.roughness),
        specular: UnitInterval::saturating(fit.specular),
        transmission: UnitInterval::saturating(fit.transmission),
        thickness: NonNegative::saturating(fit.thickness),
        ior: NonNegative::saturating(fit.ior),
        ..WHITE
    }
}

/// A map with untransformed texture coordinates.
fn untransformed_map(texture: TextureId) -> Map {
    Map {
        texture,
        set: UvSet::First,
        texture_from_surface: Map::IDENTITY,
    }
}

/// Whether a scene names a participating medium.
#[must_use]
pub fn has_media(scene: &ValidScene) -> bool {
    let has_medium = |material: &Material| match material {
        Material::Phong(_) => false,
        Material::Standard(m) => m.interior.is_some() || m.exterior.is_some(),
    };
    scene.medium().is_some() || scene.materials().iter().any(has_medium)
}

/// A white surface without reflection.
pub const WHITE: Standard = Standard {
    metallic: UnitInterval::ZERO,
    double_sided: true,
    ior: NonNegative::ONE,
    specular: UnitInterval::ZERO,
    ..Standard::DEFAULT
};

/// Whether a material transmits light.
pub(crate) fn is_transmissive(m: &Standard) -> bool {
    let mut layers = Layer::ALL.into_iter();
    let by_layer = layers.any(|layer| layer.transmits() && layer.is_in(m));
    by_layer || m.transmission > UnitInterval::ZERO
}

/// Whether a material is a pane, which light crosses without a bounce in a scene that names media:
/// a thin dielectric that transmits light.
#[must_use]
pub fn is_pane(m: &Standard) -> bool {
    m.thin_dielectric && !m.unlit && is_transmissive(m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_math::Id;
    use rtc_valid::Maps;

    fn diffuse_material() -> Phong {
        phong_of_standard(&WHITE)
    }

    fn number(value: f64) -> NonNegative {
        NonNegative::saturating(value)
    }

    #[test]
    fn a_white_wall_is_one_in_both_models() {
        let wall = diffuse_material();
        assert_eq!(
            (wall.color, wall.kd.get(), wall.ks.get()),
            (Vec3::ONE, 1.0, 0.0)
        );
        let back = standard_of_phong(&wall);
        assert_eq!(back.base_color.map(UnitInterval::get), [1.0; 4]);
        assert_eq!((back.metallic.get(), back.specular.get()), (0.0, 0.0));
        assert_eq!((WHITE.specular.get(), WHITE.ior.get()), (0.0, 1.0));
        assert!(!back.is_seen_from_one_side());
    }

    #[test]
    fn a_rough_highlight_is_wide_and_the_smoothest_has_an_end() {
        let exponent = |roughness| {
            let roughness = UnitInterval::saturating(roughness);
            let standard = Standard { roughness, ..WHITE };
            phong_of_standard(&standard).n.get()
        };
        assert_eq!([0.5, 1.0, 0.0].map(exponent), [4.0, 1.0, 1e4]);
    }

    #[test]
    fn a_highlight_is_the_roughness_of_a_colour_that_is_whole_where_it_outshines_the_diffuse_term()
    {
        let seen = |kd: f64, ks: f64| {
            standard_of_phong(&Phong {
                kd: number(kd),
                ks: number(ks),
                n: number(30.0),
                ior: Positive::new(1.75).unwrap(),
                ..diffuse_material()
            })
        };
        let weights = [(0.5, 0.5), (0.5, 0.25), (0.5, 0.75)];
        let colors = weights.map(|(kd, ks)| seen(kd, ks).base_color[0].get());
        assert_eq!(colors, [0.5, 0.5, 1.0]);
        // √√(2/(30 + 2))
        let shiny = seen(0.5, 0.5);
        assert_eq!((shiny.roughness.get(), shiny.ior.get()), (0.5, 1.75));
    }

    #[test]
    fn a_material_without_kd_and_ks_is_black() {
        let kd = NonNegative::ZERO;
        let black = standard_of_phong(&Phong {
            kd,
            ..diffuse_material()
        });
        assert_eq!(
            black.base_color.map(UnitInterval::get),
            [0.0, 0.0, 0.0, 1.0]
        );
        assert_eq!((black.metallic.get(), black.specular.get()), (0.0, 0.0));
    }

    #[test]
    fn a_mirror_is_a_smooth_metal_of_its_weight() {
        let mirror = Phong {
            color: Vec3::new(0.3, 0.2, 0.1),
            kd: NonNegative::ZERO,
            ks: number(0.75),
            ..diffuse_material()
        };
        let metal = standard_of_phong(&mirror);
        let [r, g, b, alpha] = metal.base_color.map(UnitInterval::get);
        assert_eq!([r, g, b, alpha], [0.75, 0.75, 0.75, 1.0]);
        assert_eq!((metal.metallic.get(), metal.roughness.get()), (1.0, 0.0));
        assert_eq!(metal.specular.get(), 1.0);
    }

    #[test]
    fn a_refractive_material_bounds_a_volume_and_keeps_its_colour_map() {
        let glass = Phong {
            color: Vec3::new(2.0, 0.5, 0.0),
            kd: number(0.5),
            kt: number(3.0),
            ior: Positive::new(0.7).unwrap(),
            maps: Some(Box::new(Maps {
                color: Some(Id::new(4)),
                specular: Some(Id::new(5)),
                normal: None,
                bump: None,
            })),
            ..diffuse_material()
        };
        let seen = standard_of_phong(&glass);
        assert_eq!((seen.transmission.get(), seen.thickness.get()), (1.0, 1.0));
        assert_eq!((seen.ior.get(), seen.roughness.get()), (1.0, 0.0));
        assert_eq!(seen.specular.get(), 1.0);
        assert_eq!(
            seen.base_color.map(UnitInterval::get),
            [0.5, 0.25, 0.0, 1.0]
        );
        assert_eq!(seen.base_color_map.map(|map| map.texture), Some(Id::new(4)));
    }
}
