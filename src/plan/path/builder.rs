//! The builder of the path plan: it starts with everything the scene requires, and each rule
//! removes what provably contributes zero.

use super::caustics::CausticMaterials;
use super::dark::{DarkLight, KeptLights};
use super::facts::MaterialUses;
use super::rules::PathRule;
use super::texture::TextureValues;
use crate::coverage::{MapPresence, ShownMap};
use crate::effect::Effect;
use crate::facts::material::{has_media, is_pane, is_transmissive};
use crate::projection::ScreenRect;
use crate::rules::Rule;
use crate::surface_bounds::SurfaceBounds;
use crate::unseen::{Unseen, WorldSurfaces};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_math::{IdTable, Medium, Plastic, UnitInterval, Vec3};
use rtc_valid::{
    Alpha, Map, Material, MaterialId, Mesh, PathSettings, Punctual, Shape, Standard, Surface,
    ValidScene,
};
use std::ops::Range;

/// The part of a scene that remains in the plan.
#[derive(Clone)]
pub(crate) struct PathPlanBuilder<'scene> {
    pub(super) scene: &'scene ValidScene,
    pub(super) path: PathSettings,
    /// The punctual lights.
    pub(super) punctual: &'scene IdTable<Punctual>,
    /// The surfaces of each material.
    pub(super) uses: &'scene IdTable<Material, MaterialUses>,
    /// The values of the textures.
    pub(super) textures: &'scene TextureValues<'scene>,
    /// The bounds of each surface.
    pub(crate) surface_bounds: &'scene [SurfaceBounds],
    /// The screen rectangle of each surface.
    pub(crate) screen_rects: &'scene [ScreenRect],
    /// The simplified material for each material of the scene.
    pub(super) materials: IdTable<Material, Standard>,
    /// The materials of caustics.
    pub(super) caustics: &'scene CausticMaterials,
    /// For each material, the maps that are folded into factors.
    pub(super) folded: IdTable<Material, Vec<ShownMap>>,
    /// The use of each punctual light.
    pub(super) lights: KeptLights,
    pub(super) environment: RemainingEnvironment,
    /// The medium around the camera.
    pub(super) medium: Option<Medium>,
    /// For each surface, whether it is in the world.
    pub(crate) surfaces: WorldSurfaces,
    /// The maximum number of bounces.
    pub(super) max_depth: u32,
    /// Whether the last ray of a path may hit an emitter.
    pub(super) last_ray: bool,
    /// Whether lights are sampled.
    pub(super) nee: bool,
    /// Whether any surface may cast a shadow.
    pub(super) shadows: bool,
}

/// The part of a light that remains in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemainingLight {
    /// Nothing: the light is removed.
    Nothing,
    /// Only its index in the light distribution; it illuminates no surface.
    OnlyIndex,
    /// All of it.
    All,
}

/// The part of the environment that remains in the plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RemainingEnvironment {
    /// Nothing: it emits no light.
    Nothing,
    /// The constant value of its image, and its direction sampling.
    Constant,
    /// All of it.
    All,
}

/// A rule that was applied.
pub(super) struct AppliedRule {
    pub(super) rule: Rule,
    pub(super) item: &'static PathRule,
    /// The effects that are no longer required after this rule.
    pub(super) removed_effects: Vec<Effect>,
    /// The scene values that decide it.
    pub(super) places: Vec<ValuePath>,
}

impl PathPlanBuilder<'_> {
    /// Applies a rule; `None` if it changes nothing.
    pub(super) fn apply(&mut self, rule: Rule, item: &'static PathRule) -> Option<AppliedRule> {
        let before = Effect::OF_PATHS.map(|effect| self.requires(effect));
        let places = (item.apply)(self);
        if places.is_empty() {
            return None;
        }
        let no_longer_required =
            |(effect, before): (Effect, bool)| (before && !self.requires(effect)).then_some(effect);
        let removed_effects = Effect::OF_PATHS
            .into_iter()
            .zip(before)
            .filter_map(no_longer_required)
            .collect();
        Some(AppliedRule {
            rule,
            item,
            removed_effects,
            places,
        })
    }

    /// Drops surfaces from the world; returns their paths.
    pub(super) fn drop_surfaces(&mut self, unseen: Vec<Unseen>) -> Vec<ValuePath> {
        let drop = |unseen: Unseen| {
            let index = self.scene.surfaces()[unseen.surface()].index;
            self.surfaces.drop_surface(unseen);
            ValuePath::new(EntityKind::Surface, index, EntityField::Whole)
        };
        unseen.into_iter().map(drop).collect()
    }

    /// Drops lights, or all but their indices; returns their paths.
    pub(super) fn drop_lights(&mut self, dark: Vec<DarkLight>) -> Vec<ValuePath> {
        let drop = |dark: DarkLight| {
            let index = dark.light().index();
            self.lights.drop_light(dark);
            ValuePath::new(EntityKind::Light, index, EntityField::Whole)
        };
        dark.into_iter().map(drop).collect()
    }

    /// The punctual lights whose remaining part satisfies a condition.
    pub(crate) fn lights_left(
        &self,
        is_such: impl Fn(RemainingLight) -> bool,
    ) -> impl Iterator<Item = &Punctual> {
        let lights = self.punctual.iter().zip(&*self.lights);
        lights.filter_map(move |(light, left)| is_such(*left).then_some(light))
    }

    /// Simplifies the used materials; returns the paths of the changed ones.
    pub(super) fn simplify(
        &mut self,
        simplified: impl Fn(&Self, MaterialId, &Standard) -> Standard,
    ) -> Vec<ValuePath> {
        let new = |(index, material)| (index, simplified(self, index, material));
        let is_new = |(index, new): &(MaterialId, Standard)| *new != self.materials[*index];
        let changed: Vec<_> = self.used_materials().map(new).filter(is_new).collect();
        let put = |(index, new): (MaterialId, Standard)| {
            self.materials[index] = new;
            ValuePath::new(EntityKind::Material, index.index(), EntityField::Whole)
        };
        changed.into_iter().map(put).collect()
    }

    /// The materials of surfaces in the world, each with its index.
    pub(super) fn used_materials(&self) -> impl Iterator<Item = (MaterialId, &Standard)> {
        let is_used = |material: &MaterialId| {
            self.uses[*material]
                .surfaces
                .iter()
                .any(|surface| self.surfaces[*surface])
        };
        self.materials
            .ids()
            .filter(is_used)
            .map(|index| (index, &self.materials[index]))
    }

    /// Whether light crosses panes without a bounce, as it does in a scene that names media.
    fn has_free_panes(&self) -> bool {
        has_media(self.scene) && self.used_materials().any(|(_, material)| is_pane(material))
    }

    /// Whether a path may go on after its first hit.
    pub(super) fn goes_on(&self) -> bool {
        self.max_depth > 0 || self.has_free_panes()
    }

    /// Whether any material that scatters light has a property.
    fn any(&self, has: impl Fn(&Standard) -> bool) -> bool {
        self.goes_on()
            && self
                .used_materials()
                .any(|(_, material)| !material.unlit && has(material))
    }

    /// Whether a path may continue after the first hit, or scattering in a medium.
    pub(crate) fn bounces(&self) -> bool {
        let mut used = self.used_materials();
        let has_bounces = self.max_depth > u32::from(!self.last_ray);
        (has_bounces || self.has_free_panes()) && (used.next().is_some() || self.medium.is_some())
    }

    /// The participating media of the world.
    pub(super) fn media(&self) -> impl Iterator<Item = Medium> {
        let of_materials = self.used_materials();
        let of_materials =
            of_materials.flat_map(|(_, material)| [material.interior, material.exterior]);
        of_materials.flatten().chain(self.medium)
    }

    /// Whether a path may be in a participating medium.
    pub(crate) fn has_media(&self) -> bool {
        self.media().next().is_some()
    }

    /// Whether any surface transmits light, of a continued path or of a light behind it.
    pub(super) fn transmits(&self) -> bool {
        self.any(|material| material_requires(material, Effect::Refraction))
    }

    /// Whether an effect is still required.
    pub(crate) fn requires(&self, effect: Effect) -> bool {
        // An effect is required if the remaining scene can show it.
        match effect {
            Effect::Surfaces => self.surfaces.contains(&true),
            Effect::Supersampling => self.path.samples.get() > 1,
            Effect::Lens => self.scene.camera().lens.radius.get() > 0.0,
            Effect::MotionBlur => self.scene.moves(),
            Effect::Environment => self.environment != RemainingEnvironment::Nothing,
            Effect::EnvironmentMap => {
                self.environment == RemainingEnvironment::All && self.has_environment_image()
            }
            Effect::Emission | Effect::Unlit | Effect::Alpha | Effect::Blend => self
                .used_materials()
                .any(|(_, material)| material_requires(material, effect)),
            Effect::DirectLight => self.samples_lights(),
            Effect::Shadows => self.shadows && self.samples_lights(),
            Effect::Mis => self.samples_lights() && self.has_extended_light(),
            Effect::Caustics => self.has_caustics(),
            Effect::Depth => self.bounces(),
            Effect::Media => self.has_media(),
            Effect::Refraction | Effect::Volume => {
                self.bounces() && self.any(|material| material_requires(material, effect))
            }
            Effect::Dispersion | Effect::Microfacets | Effect::Layer(_) => {
                self.any(|material| material_requires(material, effect))
            }
            Effect::Compensation => {
                self.path.multiple_scattering
                    && self.any(|material| material_requires(material, Effect::Microfacets))
            }
            Effect::Textures => self.any_map(false),
            Effect::NormalMapping => self.any_map(true),
            Effect::NormalInterpolation => {
                let is_shaded = |material: &Standard| self.goes_on() && !material.unlit;
                self.used_meshes()
                    .any(|(material, mesh)| is_shaded(material) && !mesh.normals.is_empty())
            }
            Effect::VertexColors => self.used_meshes().any(|(_, mesh)| !mesh.colors.is_empty()),
            Effect::DepthBuffer
            | Effect::NormalBuffer
            | Effect::SoftLight
            | Effect::Highlight
            | Effect::Mirror
            | Effect::GlossyReflection => false,
        }
    }

    /// The surfaces in the world.
    fn used_surfaces(&self) -> impl Iterator<Item = &Surface> {
        let surfaces = self.scene.surfaces().iter().zip(&*self.surfaces);
        surfaces.filter_map(|(surface, is_in_world)| is_in_world.then_some(surface))
    }

    /// The meshes in the world, each with its material.
    fn used_meshes(&self) -> impl Iterator<Item = (&Standard, &Mesh)> {
        self.used_surfaces().filter_map(|surface| {
            if let Shape::Instance(instance) = &surface.shape {
                let mesh = &*self.scene.meshes()[instance.mesh];
                Some((&self.materials[surface.material], mesh))
            } else {
                None
            }
        })
    }

    /// Whether any normal map is looked up, or else any other map.
    fn any_map(&self, of_normals: bool) -> bool {
        let is_of_normals = |material: &Standard, map: &Map| {
            let normals = [
                &material.normal_map,
                &material.bump_map,
                &material.clearcoat_normal_map,
            ];
            normals
                .into_iter()
                .flatten()
                .any(|normal| std::ptr::eq(normal, map))
        };
        // A constant normal map still changes the normals.
        let is_looked_up = |index: MaterialId, map: &Map| of_normals || !self.is_folded(index, map);
        self.used_materials().any(|(index, material)| {
            let mut maps = material.maps();
            maps.any(|map| is_of_normals(material, map) == of_normals && is_looked_up(index, map))
        })
    }

    /// Whether a map of a material is folded into a constant.
    pub(super) fn is_folded(&self, material: MaterialId, map: &Map) -> bool {
        is_among(&self.folded[material], map)
    }

    /// A map that has one value on all surfaces of its material.
    pub(super) fn constant(&self, material: MaterialId, map: &Map) -> Option<ShownMap> {
        match self.presence(material, map) {
            MapPresence::Everywhere(shown) => self.textures.is_constant(map).then_some(shown),
            MapPresence::Never | MapPresence::Somewhere => None,
        }
    }

    /// Folds a map of a material into a factor.
    pub(super) fn fold(&mut self, material: MaterialId, map: ShownMap) -> ValuePath {
        self.folded[material].push(map);
        ValuePath::new(EntityKind::Material, material.index(), EntityField::Whole)
    }

    /// Whether any surface of a material has the texture coordinates of a map.
    pub(super) fn has_places(&self, material: MaterialId, map: &Map) -> bool {
        self.presence(material, map) != MapPresence::Never
    }

    fn presence(&self, material: MaterialId, map: &Map) -> MapPresence {
        self.uses[material].presence(map, self.textures)
    }

    /// Whether a map is 0 in some channels on all surfaces of a material; false without a map.
    pub(super) fn is_zero(
        &self,
        material: MaterialId,
        map: Option<&Map>,
        channels: Range<usize>,
    ) -> bool {
        map.is_some_and(|map| {
            let value = |channel| self.uses[material].value(map, channel, self.textures);
            channels
                .into_iter()
                .all(|channel| value(channel) == Some(0.0))
        })
    }

    /// Whether there is a light to sample and a surface with a non-delta lobe.
    fn samples_lights(&self) -> bool {
        let has_receiver = || self.any(|_| true) || (self.max_depth > 0 && self.has_media());
        self.nee && has_receiver() && self.has_sampled_light()
    }

    /// Whether caustics are estimated: a smooth surface may lead light from a sampled light to
    /// another surface.
    fn has_caustics(&self) -> bool {
        let is_lit = || self.lights.contains(&RemainingLight::All) || self.has_emissive_surface();
        let mut used = self.used_materials();
        self.path.caustics
            && !has_media(self.scene)
            && self.max_depth > 1
            && self.samples_lights()
            && is_lit()
            && used.any(|(material, _)| self.caustics.casters[material])
    }

    /// Whether the light distribution has a light that may illuminate a surface.
    fn has_sampled_light(&self) -> bool {
        self.lights.contains(&RemainingLight::All) || self.has_extended_light()
    }

    /// Whether there is a light that both light sampling and BSDF sampling can hit: an environment
    /// image or an emissive surface.
    pub(super) fn has_extended_light(&self) -> bool {
        let shines = self.environment != RemainingEnvironment::Nothing;
        (shines && self.has_environment_image()) || self.has_emissive_surface()
    }

    fn has_environment_image(&self) -> bool {
        self.scene.environment().image.is_some()
    }

    /// Whether a surface that lights are sampled on has an emissive material.
    fn has_emissive_surface(&self) -> bool {
        let shines = |material: MaterialId| {
            let material = &self.materials[material];
            !material.unlit && material.emissive != Vec3::ZERO
        };
        self.used_surfaces()
            .any(|surface| shines(surface.material) && is_sampled(&surface.shape))
    }
}

/// Whether a map is one of those that are folded.
pub(super) fn is_among(folded: &[ShownMap], map: &Map) -> bool {
    let mut folded = folded.iter();
    folded.any(|shown| (shown.texture(), shown.set()) == (map.texture, map.set))
}

/// Whether light sampling supports an emissive shape: all but a plane, which paths find best.
fn is_sampled(shape: &Shape) -> bool {
    match shape {
        Shape::Plane(_) => false,
        Shape::Sphere(_)
        | Shape::Triangle(_)
        | Shape::Quad(_)
        | Shape::InfiniteCylinder(_)
        | Shape::Csg(_)
        | Shape::Disc(_)
        | Shape::Cylinder(_)
        | Shape::Cone(_)
        | Shape::Paraboloid(_)
        | Shape::Torus(_)
        | Shape::Instance(_)
        | Shape::Ellipsoid(_) => true,
    }
}

/// Whether a material requires an effect; false for effects that do not depend on materials.
pub(super) fn material_requires(m: &Standard, effect: Effect) -> bool {
    let is_nonzero = |weight: UnitInterval| weight > UnitInterval::ZERO;
    // A material shows an effect if its weight is not zero.
    match effect {
        Effect::Emission => !m.unlit && m.emissive != Vec3::ZERO,
        Effect::Unlit => m.unlit,
        Effect::Alpha => m.alpha != Alpha::Opaque,
        Effect::Blend => m.blend_with.is_some(),
        Effect::Microfacets => {
            let is_dielectric = is_nonzero(m.specular) || m.specular_glossiness.is_some();
            is_dielectric
                || is_nonzero(m.metallic)
                || is_nonzero(m.iridescence)
                || is_nonzero(m.transmission)
                || m.plastic != Plastic::None
        }
        Effect::Refraction => is_transmissive(m),
        Effect::Volume => {
            let absorbs = m.attenuation_distance.is_some() && m.attenuation_color != Vec3::ONE;
            is_transmissive(m) && m.thickness.get() > 0.0 && absorbs
        }
        Effect::Media => m.interior.is_some() || m.exterior.is_some(),
        Effect::Dispersion => m.dispersion.get() > 0.0 && is_nonzero(m.transmission),
        Effect::Layer(layer) => layer.is_in(m),
        Effect::DepthBuffer
        | Effect::NormalBuffer
        | Effect::Surfaces
        | Effect::DirectLight
        | Effect::Shadows
        | Effect::SoftLight
        | Effect::Highlight
        | Effect::Mirror
        | Effect::GlossyReflection
        | Effect::Depth
        | Effect::Textures
        | Effect::NormalInterpolation
        | Effect::NormalMapping
        | Effect::Lens
        | Effect::MotionBlur
        | Effect::Supersampling
        | Effect::Environment
        | Effect::EnvironmentMap
        | Effect::Mis
        | Effect::Caustics
        | Effect::Compensation
        | Effect::VertexColors => false,
    }
}
