//! The materials of a world, in the form that its integrator needs: defaults filled, constants
//! folded, maps resolved to their images.

use super::texture::Textures;
use super::{Material, MaterialId};
use crate::bsdf::{PlasticBoundary, dispersed};
use crate::material::phong::{PhongMaps, PhongMaterial};
use crate::material::standard::*;
use crate::shape::geometry::AttributeRequest;
use crate::texture::bilinear::Bump;
use crate::texture::sampled::{ColorSpace, UvSets};
use rtc_math::{Id, IdTable, Plastic, UnitInterval, Vec3, Weight, cos, ln, sin};
use rtc_plan::facts::material::is_pane;
use rtc_plan::{Effect, Layer, MapPresence, PathPlan, Plan, Rule, UvCoverage};
use rtc_valid::{self as valid, Maps, Phong, Standard, TextureId, UvSet, ValidScene};
use std::collections::BTreeMap;

/// The material of a world that stands for one of the scene as it is: both begin with the same
/// list.
pub(super) fn unchanged(material: valid::MaterialId) -> MaterialId {
    Id::new(material.index())
}

/// Materials of Phong's model, and after them the simplified ones: a constant map that all parts of
/// a surface show is replaced by its value.
pub(super) struct PhongList<'plan> {
    all: IdTable<Material, Phong>,
    plan: &'plan Plan,
    scene: &'plan ValidScene,
    /// The indices of the simplified forms of materials, for surfaces with these texture
    /// coordinates.
    simple: BTreeMap<(valid::MaterialId, UvCoverage), MaterialId>,
}

impl<'plan> PhongList<'plan> {
    pub(super) fn new(
        all: IdTable<Material, Phong>,
        scene: &'plan ValidScene,
        plan: &'plan Plan,
    ) -> Self {
        Self {
            simple: BTreeMap::new(),
            scene,
            all,
            plan,
        }
    }

    /// The index of the prepared material for a surface of the scene.
    pub(super) fn of(&mut self, surface: &valid::Surface) -> MaterialId {
        let original = unchanged(surface.material);
        if self.all[original].maps.is_none() {
            return original;
        }
        let coverage = UvCoverage::of(&surface.shape, self.scene);
        let key = (surface.material, coverage);
        if let Some(simple) = self.simple.get(&key) {
            return *simple;
        }
        let simple = match self.simplified(&self.all[original], coverage) {
            Some(phong) => self.all.push(phong),
            None => original,
        };
        *self.simple.entry(key).or_insert(simple)
    }

    /// The material with values instead of constant maps, and without maps that have no effect or
    /// no texture coordinates, if it has any of these.
    fn simplified(&self, material: &Phong, coverage: UvCoverage) -> Option<Phong> {
        let maps = **material.maps.as_ref()?;
        let presence = |map| coverage.presence(self.scene, map, UvSet::First);
        let is_seen = |map: &TextureId| presence(*map) != MapPresence::Never;
        let seen = Maps {
            color: maps.color.filter(is_seen),
            specular: maps.specular.filter(is_seen),
            normal: maps.normal.filter(is_seen),
            bump: maps.bump.filter(|bump| is_seen(&bump.texture)),
        };
        let value =
            |map: Option<TextureId>| map.and_then(|map| self.plan.constants.value(presence(map)));
        let (new_color, scale) = (value(seen.color), value(seen.specular));
        let (shows, bends) = (
            self.shows(Effect::Textures),
            self.shows(Effect::NormalMapping),
        );
        let rest = Maps {
            color: seen.color.filter(|_| shows && new_color.is_none()),
            specular: seen.specular.filter(|_| shows && scale.is_none()),
            normal: seen.normal.filter(|_| bends),
            bump: seen.bump.filter(|_| bends),
        };
        if rest == maps {
            return None;
        }
        Some(Phong {
            color: new_color.unwrap_or(material.color),
            ks: scale.map_or(material.ks, |scale| material.ks.times(scale.x)),
            maps: rest.has_some().then(|| Box::new(rest)),
            ..material.clone()
        })
    }

    /// Whether maps that have an effect are looked up.
    fn shows(&self, effect: Effect) -> bool {
        self.plan.needs(effect) || !self.plan.rules.contains(Rule::TextureUnseen)
    }

    pub(super) fn prepared(self, textures: &Textures) -> IdTable<Material, PhongMaterial> {
        self.all
            .into_iter()
            .map(|material| phong(material, textures))
            .collect()
    }
}

fn phong(material: Phong, textures: &Textures) -> PhongMaterial {
    let Phong {
        color,
        ka,
        kd,
        ks,
        kr,
        n,
        kt,
        fresnel,
        ior: eta,
        glossy_samples,
        maps,
    } = material;
    PhongMaterial {
        color,
        ka,
        kd,
        ks,
        kr,
        n,
        kt,
        fresnel,
        eta,
        glossy_samples,
        maps: maps.map(|maps| Box::new(phong_maps(&maps, textures))),
    }
}

fn phong_maps(maps: &Maps, textures: &Textures) -> PhongMaps {
    let Maps {
        color,
        specular,
        normal,
        bump,
    } = *maps;
    let texture = |index: Option<TextureId>| index.map(|index| textures.texture(index));
    PhongMaps {
        color: texture(color),
        specular: texture(specular),
        normal: texture(normal),
        bump: bump.map(|valid::Bump { texture, height }| Bump {
            texture: textures.texture(texture),
            height,
        }),
    }
}

/// Material `index` of a scene, as the plan of paths left it, prepared.
pub(super) fn standard(
    index: valid::MaterialId,
    material: &Standard,
    textures: &Textures,
    plan: &PathPlan,
) -> StandardMaterial {
    let m = material;
    // Resolve each factor and its map to a texture slot.
    let slots = MappedParameters {
        index,
        textures,
        plan,
    };
    let emission = if m.emissive == Vec3::ZERO {
        MappedColor {
            factor: Vec3::ZERO,
            map: None,
        }
    } else {
        slots.tint(m.emissive, m.emissive_map.as_ref())
    };
    // Absent layers have no slots.
    StandardMaterial {
        request: slots.request(m),
        has_shading_map: shading_maps(m).any(|map| slots.is_looked_up(map)),
        alpha: match m.alpha {
            valid::Alpha::Opaque => Alpha::Opaque,
            valid::Alpha::Mask(cutoff) => Alpha::Mask(cutoff.get()),
            valid::Alpha::Blend => Alpha::Blend,
        },
        opacity: slots.number(UnitInterval::ONE, m.opacity_map.as_ref(), 0),
        blend: m.blend_with.map(|other| BlendPart {
            other: unchanged(other),
            weight: slots.number(m.blend_weight, m.blend_map.as_ref(), 0),
        }),
        is_seen_from_one_side: m.is_seen_from_one_side(),
        is_unlit: m.unlit,
        base_color: slots.rgba(m.base_color, m.base_color_map.as_ref()),
        emission,
        reflection: slots.reflection(m),
        transmission: slots.number(m.transmission, m.transmission_map.as_ref(), 0),
        refracts: m.transmission > UnitInterval::ZERO,
        conductor: m.conductor,
        facets: m.microfacets,
        plastic: plastic(m),
        is_black_behind: m.black_back,
        ior: m.ior.get(),
        dispersed: (m.dispersion.get() > 0.0).then(|| dispersed(m.ior.get(), m.dispersion.get())),
        is_thin_dielectric: m.thin_dielectric,
        is_pane: is_pane(m),
        bounds_a_volume: m.thickness.get() > 0.0,
        absorption: absorption(m),
        media: None,
        normal: slots.normal(m.normal_map.as_ref(), m.normal_scale),
        bump: m.bump_map.as_ref().map(|map| BumpMap {
            map: slots.textures.map(map, ColorSpace::Linear),
            scale: m.bump_scale,
        }),
        sheen: m.sheen_color.is_nonzero().then(|| slots.sheen(m)),
        diffuse_transmission: (m.diffuse_transmission.is_nonzero())
            .then(|| slots.diffuse_transmission(m)),
        clearcoat: (m.clearcoat > UnitInterval::ZERO).then(|| slots.clearcoat(m)),
        anisotropy: (m.anisotropy > UnitInterval::ZERO).then(|| slots.anisotropy(m)),
        iridescence: (m.iridescence > UnitInterval::ZERO).then(|| slots.iridescence(m)),
    }
}

/// Adds to the request of each blend those of its other materials, which come before it.
pub(super) fn with_requests(
    mut materials: IdTable<Material, StandardMaterial>,
) -> IdTable<Material, StandardMaterial> {
    for index in materials.ids() {
        let other = materials[index].blend.as_ref().map(|blend| blend.other);
        if let Some(other) = other {
            let AttributeRequest { uv, tangent } = materials[other].request;
            let request = &mut materials[index].request;
            (request.uv, request.tangent) = (request.uv | uv, request.tangent | tangent);
        }
    }
    materials
}

/// The boundary of a plastic; its roughness has no map.
fn plastic(m: &Standard) -> Option<PlasticBoundary> {
    let new = || {
        let ior = m.ior.get().max(1.0);
        PlasticBoundary::new(m.plastic, ior, m.roughness.get(), m.microfacets)
    };
    (m.plastic != Plastic::None).then(new)
}

/// The maps of scattering parameters, without normal maps.
fn shading_maps(m: &Standard) -> impl Iterator<Item = &valid::Map> {
    let reflection = match m.specular_glossiness {
        Some(_) => [m.specular_glossiness_map.as_ref(), None, None],
        None => [
            m.metallic_roughness_map.as_ref(),
            m.specular_map.as_ref(),
            m.specular_color_map.as_ref(),
        ],
    };
    let base = reflection.into_iter().flatten().chain(&m.transmission_map);
    base.chain(Layer::maps(m))
}

/// The coefficient of absorption of the medium inside, per unit of length.
fn absorption(m: &Standard) -> Vec3 {
    let Some(distance) = m.attenuation_distance else {
        return Vec3::ZERO;
    };
    // Black would be infinite: −ln of the least positive number replaces it.
    m.attenuation_color
        .map(|c| -ln(c.max(f64::MIN_POSITIVE)) / distance.get())
}

/// Makes the parameters of a material that may have maps.
struct MappedParameters<'world> {
    /// Which material of the scene.
    index: valid::MaterialId,
    textures: &'world Textures,
    plan: &'world PathPlan,
}

impl MappedParameters<'_> {
    /// The surface details that the material needs.
    fn request(&self, m: &Standard) -> AttributeRequest {
        let others = [
            &m.base_color_map,
            &m.opacity_map,
            &m.blend_map,
            &m.emissive_map,
            &m.normal_map,
            &m.bump_map,
            &m.clearcoat_normal_map,
        ];
        let mut maps = shading_maps(m).chain(others.into_iter().flatten());
        AttributeRequest {
            uv: maps.any(|map| self.is_looked_up(map)),
            tangent: m.anisotropy > UnitInterval::ZERO
                || m.normal_map.is_some()
                || m.clearcoat_normal_map.is_some(),
        }
    }

    /// Whether a map is looked up at each hit.
    fn is_looked_up(&self, map: &valid::Map) -> bool {
        !self.plan.is_folded(self.index, map)
    }

    /// The values of a map.
    fn source(&self, map: Option<&valid::Map>, color_space: ColorSpace) -> Option<MapSource> {
        let map = map?;
        let prepared = self.textures.map(map, color_space);
        if self.is_looked_up(map) {
            return Some(MapSource::Map(prepared));
        }
        // Any coordinates will do: a folded map is constant.
        let anywhere = UvSets::new([Some([0.5; 2]); 2], Vec3::ZERO);
        prepared.look_up(&anywhere).map(MapSource::Value)
    }

    fn number(
        &self,
        factor: UnitInterval,
        map: Option<&valid::Map>,
        channel: usize,
    ) -> MappedNumber {
        self.scaled(factor.get(), map, channel)
    }

    fn scaled(&self, factor: f64, map: Option<&valid::Map>, channel: usize) -> MappedNumber {
        let (factor, map) = match self.source(map, ColorSpace::Linear) {
            None => (factor, None),
            Some(MapSource::Value(value)) => (factor * value[channel], None),
            Some(MapSource::Map(map)) => (factor, Some((map, channel))),
        };
        MappedNumber { factor, map }
    }

    fn tint(&self, factor: Vec3, map: Option<&valid::Map>) -> MappedColor {
        let (factor, map) = match self.source(map, ColorSpace::Srgb) {
            None => (factor, None),
            Some(MapSource::Value([r, g, b, _])) => (factor * Vec3::new(r, g, b), None),
            Some(MapSource::Map(map)) => (factor, Some(map)),
        };
        MappedColor { factor, map }
    }

    fn rgba(&self, factor: [UnitInterval; 4], map: Option<&valid::Map>) -> Rgba {
        let factor = factor.map(UnitInterval::get);
        let (factor, map) = match self.source(map, ColorSpace::Srgb) {
            None => (factor, None),
            Some(MapSource::Value(value)) => ([0, 1, 2, 3].map(|k| factor[k] * value[k]), None),
            Some(MapSource::Map(map)) => (factor, Some(map)),
        };
        Rgba { factor, map }
    }

    fn normal(&self, map: Option<&valid::Map>, scale: f64) -> Option<NormalMap> {
        let map = self.source(map, ColorSpace::Linear)?;
        Some(NormalMap { map, scale })
    }

    fn reflection(&self, m: &Standard) -> BaseReflectance {
        if let Some(factor) = m.specular_glossiness {
            return BaseReflectance::Specular(
                self.rgba(factor, m.specular_glossiness_map.as_ref()),
            );
        }
        let (roughness, metallic) = (m.roughness.get(), m.metallic.get());
        let source = self.source(m.metallic_roughness_map.as_ref(), ColorSpace::Linear);
        let (roughness, metallic, map) = match source {
            None => (roughness, metallic, None),
            Some(MapSource::Value([_, g, b, _])) => (roughness * g, metallic * b, None),
            Some(MapSource::Map(map)) => (roughness, metallic, Some(map)),
        };
        BaseReflectance::Metallic {
            roughness,
            metallic,
            map,
            specular: self.number(m.specular, m.specular_map.as_ref(), 3),
            specular_color: self.tint(m.specular_color, m.specular_color_map.as_ref()),
        }
    }

    fn clearcoat(&self, m: &Standard) -> ClearcoatLayer {
        let roughness_map = m.clearcoat_roughness_map.as_ref();
        ClearcoatLayer {
            factor: self.number(m.clearcoat, m.clearcoat_map.as_ref(), 0),
            roughness: self.number(m.clearcoat_roughness, roughness_map, 1),
            normal: self.normal(m.clearcoat_normal_map.as_ref(), m.clearcoat_normal_scale),
        }
    }

    fn anisotropy(&self, m: &Standard) -> AnisotropyLayer {
        AnisotropyLayer {
            strength: m.anisotropy.get(),
            turn: [cos(m.anisotropy_rotation), sin(m.anisotropy_rotation)],
            map: self.source(m.anisotropy_map.as_ref(), ColorSpace::Linear),
        }
    }

    fn iridescence(&self, m: &Standard) -> IridescenceLayer {
        let [min, max] = m.iridescence_thickness.map(|thickness| thickness.get());
        let map = m.iridescence_thickness_map.as_ref();
        IridescenceLayer {
            factor: self.number(m.iridescence, m.iridescence_map.as_ref(), 0),
            ior: m.iridescence_ior.get(),
            min,
            spread: self.scaled(max - min, map, 1),
        }
    }

    fn sheen(&self, m: &Standard) -> SheenLayer {
        SheenLayer {
            color: self.tint(m.sheen_color, m.sheen_color_map.as_ref()),
            roughness: self.number(m.sheen_roughness, m.sheen_roughness_map.as_ref(), 3),
        }
    }

    fn diffuse_transmission(&self, m: &Standard) -> DiffuseTransmissionLayer {
        let (map, color_map) = (
            &m.diffuse_transmission_map,
            &m.diffuse_transmission_color_map,
        );
        DiffuseTransmissionLayer {
            factor: self.number(m.diffuse_transmission, map.as_ref(), 3),
            color: self.tint(m.diffuse_transmission_color, color_map.as_ref()),
        }
    }
}
