//! Facts about a scene before any rule is applied: the surfaces of each material, their texture
//! coordinates, and the texture values there.

use super::texture::{TextureValues, UvRect};
use crate::Layer;
use crate::coverage::{self, MapPresence, UvCoverage};
use rtc_math::{IdTable, UnitInterval};
use rtc_valid::{Map, Material, Mesh, Shape, Standard, ValidScene};

/// Facts about all surfaces of one material.
#[derive(Clone, Debug)]
pub(super) struct MaterialUses {
    /// The indices of the surfaces in the scene.
    pub(super) surfaces: Vec<usize>,
    /// The texture coordinates of their parts.
    coverage: UvCoverage,
    /// For each set, the bounding rectangle of all coordinates.
    areas: [UvRect; 2],
    /// Whether any surface has vertex colours. Rounding in the interpolation may leave an alpha
    /// just below those of the vertices.
    pub(super) has_colors: bool,
}

impl MaterialUses {
    /// The facts for each material of a scene.
    pub(super) fn of(scene: &ValidScene) -> IdTable<Material, Self> {
        let unused = Self {
            surfaces: Vec::new(),
            coverage: UvCoverage::NEVER,
            areas: [UvRect::NONE; 2],
            has_colors: false,
        };
        let mut uses = IdTable::from(vec![unused; scene.materials().len()]);
        // Each mesh is scanned once, however many instances it has.
        let mut of_meshes = IdTable::<Mesh, _>::from(vec![None; scene.meshes().len()]);
        for (index, surface) in scene.surfaces().iter().enumerate() {
            let areas = || coverage::areas(&surface.shape, scene);
            let (areas, has_colors) = if let Shape::Instance(instance) = &surface.shape {
                let has_colors = !scene.meshes()[instance.mesh].colors.is_empty();
                let areas = of_meshes[instance.mesh].get_or_insert_with(areas);
                (*areas, has_colors)
            } else {
                (areas(), false)
            };
            let coverage = UvCoverage::of(&surface.shape, scene);
            for material in scene.blended(surface.material) {
                uses[material].has_colors |= has_colors;
                uses[material].add(index, coverage, areas);
            }
        }
        uses
    }

    fn add(&mut self, surface: usize, coverage: UvCoverage, areas: [UvRect; 2]) {
        self.coverage = match self.surfaces.is_empty() {
            true => coverage,
            false => self.coverage.and(coverage),
        };
        self.areas = [0, 1].map(|set| self.areas[set].around(areas[set]));
        self.surfaces.push(surface);
    }

    /// The parts of the surfaces that show a map.
    pub(super) fn presence(&self, map: &Map, textures: &TextureValues<'_>) -> MapPresence {
        let scene = textures.scene();
        self.coverage.presence(scene, map.texture, map.set)
    }

    /// The value of a channel of a map on all these surfaces, if it is constant there; colour
    /// channels are not decoded.
    pub(super) fn value(
        &self,
        map: &Map,
        channel: usize,
        textures: &TextureValues<'_>,
    ) -> Option<f64> {
        let value = || textures.value(map, self.areas[map.set.index()], channel);
        // Without texture coordinates, a map has the value 1.
        match self.presence(map, textures) {
            MapPresence::Never => Some(1.0),
            MapPresence::Everywhere(_) => value(),
            MapPresence::Somewhere => value().filter(|value| *value == 1.0),
        }
    }

    /// Whether a channel of a map has a property everywhere on these surfaces. The value 1, which a
    /// map has without texture coordinates, must have it too.
    pub(super) fn all(
        &self,
        map: &Map,
        channel: usize,
        textures: &TextureValues<'_>,
        holds: impl Fn(f64) -> bool,
    ) -> bool {
        holds(1.0) && textures.all(map, self.areas[map.set.index()], channel, holds)
    }
}

/// Whether all lobes of a material are delta lobes: it is smooth and has no diffuse base.
///
/// The lobe that compensates for multiple scattering between microfacets is never a delta lobe.
pub(super) fn is_delta(m: &Standard, multiple_scattering: bool) -> bool {
    let is_0 = |number: UnitInterval| number == UnitInterval::ZERO;
    let is_1 = |number: UnitInterval| number == UnitInterval::ONE;
    let is_smooth = is_0(m.roughness) && m.specular_glossiness.is_none();
    let is_metal = is_1(m.metallic) && m.metallic_roughness_map.is_none();
    let is_glass = is_1(m.transmission) && m.transmission_map.is_none();
    let is_black = m.base_color[..3].iter().all(|channel| is_0(*channel));
    let has_smooth_coat = is_0(m.clearcoat) || is_0(m.clearcoat_roughness);
    let has_base = !(is_metal || is_glass || is_black);
    // Clearcoat and iridescence may be smooth; all other layers scatter light.
    let spreads = |layer: Layer| !matches!(layer, Layer::Clearcoat | Layer::Iridescence);
    let mut layers = Layer::ALL.into_iter().filter(|layer| layer.is_in(m));
    let is_delta = is_smooth && has_smooth_coat && !layers.any(spreads);
    !multiple_scattering && is_delta && !has_base
}
