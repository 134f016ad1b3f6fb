//! The glTF material at a hit: factors times maps, the shading frame, emission and opacity.

use crate::bsdf::standard::*;
use crate::bsdf::{LAYERS, MICROFACETS, TRANSMISSION, can};
use crate::material::standard::{
    Alpha, AnisotropyLayer, BaseReflectance, BumpMap, NormalMap, StandardMaterial, shown,
};
use crate::ray::Interaction;
use crate::shape::geometry::ShadingAttributes;
use crate::texture::sampled::UvSets;
use crate::world::Material;
use rtc_math::{IdTable, OrthonormalBasis, Vec3};

/// A material at one point of a surface.
pub(crate) struct MaterialPoint<'world> {
    pub(crate) material: &'world StandardMaterial,
    /// The material of the surface, of which `material` may be a part.
    surface: &'world StandardMaterial,
    uvs: UvSets,
    /// Base colour and alpha at the point, vertex colours included.
    base: [f64; 4],
    /// The derivatives of the point by its texture coordinates, where a bump map needs them.
    pub(crate) derivatives: Option<[Vec3; 2]>,
}

/// The shading frame at a point: the shading normal and the tangents of the maps.
pub(crate) struct ShadingFrame {
    /// A right-handed basis for the BSDF.
    basis: OrthonormalBasis,
    /// The anisotropy of the highlights.
    stretch: Option<Anisotropy>,
}

impl<'world> MaterialPoint<'world> {
    pub(crate) fn new(
        material: &'world StandardMaterial,
        shading_attributes: &ShadingAttributes,
        point: Vec3,
    ) -> Self {
        let sets = [shading_attributes.uv, shading_attributes.second_uv];
        let uvs = UvSets::new(sets, point);
        Self {
            material,
            surface: material,
            base: base(material, &uvs, shading_attributes),
            uvs,
            derivatives: None,
        }
    }

    /// The set of texture coordinates of the bump map.
    pub(crate) fn bump_set(&self) -> Option<usize> {
        let bump = self.material.bump.as_ref();
        bump.map(|bump| bump.map.set)
    }

    /// Another part of the material of the surface at the point.
    fn of_part(
        self,
        material: &'world StandardMaterial,
        shading_attributes: &ShadingAttributes,
    ) -> Self {
        Self {
            material,
            base: base(material, &self.uvs, shading_attributes),
            ..self
        }
    }

    /// Whether the material is a blend.
    pub(crate) fn is_blend(&self) -> bool {
        self.material.blend.is_some()
    }

    /// The part of a blend that a number in [0, 1) chooses: each with the probability of its
    /// weight, as in pbrt (Pharr, Jakob, Humphreys, §10.5.1).
    pub(crate) fn chosen(
        mut self,
        mut u: f64,
        materials: &'world IdTable<Material, StandardMaterial>,
        shading_attributes: &ShadingAttributes,
    ) -> Self {
        while let Some(blend) = &self.material.blend {
            let weight = blend.weight.at(&self.uvs).clamp(0.0, 1.0);
            if u >= weight {
                break;
            }
            u /= weight;
            self = self.of_part(&materials[blend.other], shading_attributes);
        }
        self
    }

    /// The opacity of all parts of a blend by their weights.
    pub(crate) fn mean_opacity(
        mut self,
        materials: &'world IdTable<Material, StandardMaterial>,
        shading_attributes: &ShadingAttributes,
    ) -> f64 {
        let (mut sum, mut left) = (0.0, 1.0);
        while let Some(blend) = &self.material.blend {
            let weight = blend.weight.at(&self.uvs).clamp(0.0, 1.0);
            sum += left * (1.0 - weight) * self.opacity();
            left *= weight;
            self = self.of_part(&materials[blend.other], shading_attributes);
        }
        sum + left * self.opacity()
    }

    /// The first texture coordinates.
    pub(crate) fn uv(&self) -> Option<[f64; 2]> {
        self.uvs.first()
    }

    /// The opacity: the probability that the alpha test keeps the hit.
    pub(crate) fn opacity(&self) -> f64 {
        match self.material.alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask(cutoff) => f64::from(u8::from(self.alpha() >= cutoff)),
            Alpha::Blend => self.alpha().clamp(0.0, 1.0),
        }
    }

    fn alpha(&self) -> f64 {
        self.base[3] * self.material.opacity.at(&self.uvs)
    }

    /// The colour, each channel at most 1.
    pub(crate) fn base_color(&self) -> Vec3 {
        let [r, g, b, _] = self.base;
        Vec3::new(r, g, b).min(Vec3::ONE)
    }

    /// The radiance that the surface emits.
    pub(crate) fn emission(&self) -> Vec3 {
        if self.surface.is_unlit {
            return Vec3::ZERO;
        }
        self.surface.emission.at(&self.uvs)
    }

    /// Whether the emission is looked up.
    pub(crate) fn has_emission_map(&self) -> bool {
        self.surface.emission.map.is_some()
    }

    /// The parameters of the BSDF that the [`PathFeatures`](rtc_plan::PathFeatures) `F` need;
    /// `channel` is the wavelength that a dispersed path picked.
    #[inline]
    pub(crate) fn standard<const F: u32>(
        &self,
        frame: &ShadingFrame,
        clearcoat: Vec3,
        channel: Option<usize>,
        multiple: bool,
    ) -> StandardParameters<'world> {
        // Start with a diffuse surface that may transmit.
        let m = self.material;
        let mut standard = StandardParameters {
            base_color: self.base_color(),
            metallic: 0.0,
            roughness: 0.0,
            ior: 0.0,
            conductor: self.material.conductor,
            facets: self.material.facets,
            plastic: self.material.plastic.as_ref(),
            specular: 1.0,
            specular_color: Vec3::ONE,
            transmission: if can::<F>(TRANSMISSION) {
                m.transmission.at(&self.uvs)
            } else {
                0.0
            },
            thin_walled: !m.bounds_a_volume,
            has_two_faces: m.is_thin_dielectric,
            anisotropy: None,
            clearcoat: None,
            sheen: None,
            iridescence: None,
            diffuse_transmission: None,
            multiple_scattering: multiple,
        };
        // Add microfacets and layers if the plan keeps them.
        if can::<F>(MICROFACETS) {
            self.reflect(&mut standard, channel);
        }
        if can::<F>(LAYERS) {
            self.add_layers(&mut standard, frame, clearcoat);
        }
        standard
    }

    fn reflect(&self, standard: &mut StandardParameters<'_>, channel: Option<usize>) {
        let m = self.material;
        match &m.reflection {
            BaseReflectance::Metallic {
                roughness,
                metallic,
                map,
                specular,
                specular_color,
            } => {
                let [_, g, b, _] = map.as_ref().map_or([1.0; 4], |map| shown(map, &self.uvs));
                (standard.metallic, standard.roughness) = (metallic * b, roughness * g);
                standard.ior = m.ior_at(channel);
                standard.specular = specular.at(&self.uvs);
                standard.specular_color = specular_color.at(&self.uvs);
            }
            // An infinite index reflects the specular colour.
            BaseReflectance::Specular(factor) => {
                let [red, green, blue, glossiness] = factor.at(&self.uvs);
                standard.specular_color = Vec3::new(red, green, blue);
                standard.roughness = (1.0 - glossiness).clamp(0.0, 1.0);
            }
        }
    }

    fn add_layers(
        &self,
        standard: &mut StandardParameters<'_>,
        frame: &ShadingFrame,
        clearcoat: Vec3,
    ) {
        let (m, uvs) = (self.material, &self.uvs);
        standard.sheen = m.sheen.as_ref().and_then(|layer| layer.at(uvs));
        let transmission = m.diffuse_transmission.as_ref();
        standard.diffuse_transmission = transmission.and_then(|layer| layer.at(uvs));
        // Omit layers whose maps are 0 here.
        let coat = m.clearcoat.as_ref().map(|layer| Clearcoat {
            factor: layer.factor.at(uvs),
            roughness: layer.roughness.at(uvs),
            normal: frame.to_local(clearcoat),
        });
        let film = m.iridescence.as_ref().map(|layer| Iridescence {
            factor: layer.factor.at(uvs),
            ior: layer.ior,
            thickness: layer.min + layer.spread.at(uvs),
        });
        standard.clearcoat = coat.filter(|coat| coat.factor > 0.0);
        standard.iridescence = film.filter(|film| film.factor > 0.0);
        standard.anisotropy = frame.stretch;
    }

    fn stretch(&self, layer: &AnisotropyLayer, side: f64) -> Anisotropy {
        let map = layer.map.as_ref().and_then(|map| map.look_up(&self.uvs));
        let [r, g, fraction, _] = map.unwrap_or([1.0, 0.5, 1.0, 1.0]);
        let along = Vec3::new(r * 2.0 - 1.0, g * 2.0 - 1.0, 0.0).normalize_or(Vec3::X);
        let [c, s] = layer.turn;
        let direction = [
            c * along.x - s * along.y,
            (s * along.x + c * along.y) * side,
        ];
        Anisotropy {
            strength: layer.strength * fraction,
            direction,
        }
    }

    /// Whether the material has a normal map.
    pub(crate) fn has_normal_map(&self) -> bool {
        let coat = self.material.clearcoat.as_ref();
        let is_bent = self.material.normal.is_some() || self.material.bump.is_some();
        is_bent || coat.is_some_and(|coat| coat.normal.is_some())
    }

    /// Whether the material transmits light at the point.
    pub(crate) fn transmits(&self) -> bool {
        self.material.transmission.at(&self.uvs) > 0.0
    }

    /// The shading frame with the normal map applied, and the shading normal of the clearcoat.
    #[inline]
    pub(crate) fn frame<const F: u32>(
        &self,
        at: &Interaction,
        shading_attributes: &ShadingAttributes,
        wo: Vec3,
    ) -> (ShadingFrame, Vec3) {
        // Flip the vertex normal to the side of the geometric normal: the winding decides which
        // side is outside, and some meshes have normals against it.
        let normal = shading_attributes
            .normal
            .map_or(at.normal, |n| if n.dot(at.normal) < 0.0 { -n } else { n });
        let m = self.material;
        let normal = match &m.bump {
            Some(bump) => self.bumped(bump, normal),
            None => normal,
        };
        let mapped = |map: &Option<NormalMap>| {
            let normal = map
                .as_ref()
                .map_or(normal, |map| self.mapped(map, normal, shading_attributes));
            clamped_shading_normal(normal, at.normal, wo)
        };
        let shading = mapped(&m.normal);
        if !can::<F>(LAYERS) {
            let basis = OrthonormalBasis::around(shading);
            let stretch = None;
            return (ShadingFrame { basis, stretch }, shading);
        }
        let coat = m
            .clearcoat
            .as_ref()
            .map_or(shading, |layer| mapped(&layer.normal));
        // Build the tangents only for anisotropy.
        let stretch = m
            .anisotropy
            .as_ref()
            .map(|layer| self.stretch(layer, shading_attributes.side));
        let stretch = stretch.filter(|stretch| stretch.strength > 0.0);
        let tangent = shading_attributes.tangent.filter(|_| stretch.is_some());
        let basis = basis(shading, tangent, 1.0);
        (ShadingFrame { basis, stretch }, coat)
    }

    /// The normal of a height field h over a surface (Blinn, "Simulation of wrinkled surfaces",
    /// SIGGRAPH 1978): that of the tangents `∂p/∂u + n·∂h/∂u` and `∂p/∂v + n·∂h/∂v`.
    fn bumped(&self, bump: &BumpMap, normal: Vec3) -> Vec3 {
        if bump.map.is_in_space() {
            let gradient = bump.map.gradient_in_space(&self.uvs) * bump.scale;
            if gradient == Vec3::ZERO {
                return normal;
            }
            let along = gradient - normal * normal.dot(gradient);
            return (normal - along).normalize_or(normal);
        }
        let Some((derivatives, slopes)) = self.derivatives.zip(bump.map.gradient(&self.uvs)) else {
            return normal;
        };
        let slopes = slopes.map(|slope| slope * bump.scale);
        if slopes == [0.0; 2] {
            return normal;
        }
        let [u, v] = [0, 1].map(|axis: usize| {
            let along = derivatives[axis] - normal * normal.dot(derivatives[axis]);
            along + normal * slopes[axis]
        });
        let bent = u.cross(v).normalize_or(normal);
        if bent.dot(normal) < 0.0 { -bent } else { bent }
    }

    /// The normal of a normal map.
    fn mapped(
        &self,
        map: &NormalMap,
        normal: Vec3,
        shading_attributes: &ShadingAttributes,
    ) -> Vec3 {
        let Some([x, y, z, _]) = map.map.look_up(&self.uvs) else {
            return normal;
        };
        let local = Vec3::new(
            (x * 2.0 - 1.0) * map.scale,
            (y * 2.0 - 1.0) * map.scale,
            z * 2.0 - 1.0,
        );
        basis(normal, shading_attributes.tangent, shading_attributes.side)
            .to_world(local)
            .normalize_or(normal)
    }
}

impl ShadingFrame {
    pub(crate) fn to_local(&self, w: Vec3) -> Vec3 {
        self.basis.to_local(w)
    }

    pub(crate) fn to_world(&self, w: Vec3) -> Vec3 {
        self.basis.to_world(w)
    }
}

/// The base colour and alpha of a material at a point, vertex colours included.
fn base(
    material: &StandardMaterial,
    uvs: &UvSets,
    shading_attributes: &ShadingAttributes,
) -> [f64; 4] {
    let own = material.base_color.at(uvs);
    let corners = shading_attributes.color.unwrap_or([1.0; 4]);
    [0, 1, 2, 3].map(|k: usize| own[k] * corners[k])
}

/// A basis around a normal, with the surface's tangent if there is one.
fn basis(normal: Vec3, tangent: Option<Vec3>, side: f64) -> OrthonormalBasis {
    let tangent = tangent
        .map(|t| t - normal * normal.dot(t))
        .and_then(Vec3::try_normalize);
    tangent.map_or_else(
        || OrthonormalBasis::around(normal),
        |tangent| OrthonormalBasis {
            tangent,
            bitangent: normal.cross(tangent) * side,
            normal,
        },
    )
}

/// Clamps a shading normal so that the mirror direction of the viewer stays above the surface.
/// Otherwise shiny surfaces turn black at grazing angles (a similar rule: Keller et al., "The Iray
/// light transport simulation and rendering system", 2017).
fn clamped_shading_normal(shading: Vec3, geometric: Vec3, wo: Vec3) -> Vec3 {
    /// The minimum elevation, as a sine and as a fraction of the geometric normal's.
    const LEAST: f64 = 0.01;
    const SHARE: f64 = 0.9;
    let side = 1.0_f64.copysign(wo.dot(geometric));
    let (n, above) = (shading * side, geometric * side);
    // Mirror the viewer at the shading normal.
    let mirrored = n * (2.0 * n.dot(wo)) - wo;
    let (height, min) = (mirrored.dot(above), LEAST.min(SHARE * wo.dot(above)));
    if height >= min {
        return shading;
    }
    // Raise the mirror direction, and take the half vector.
    let raised = (mirrored + above * (min - height)).normalize_or_zero();
    (wo + raised).normalize_or(above) * side
}
