//! Facts of a scene before any rule: the surfaces of each material, their texture coordinates, and
//! the values of their textures there.

use super::texture::{Area, show};
use crate::math::{UnitInterval, Vec3};
use crate::valid::{Map, Proof, Shape, Standard};

/// Facts of all surfaces of one material.
#[derive(Clone, Debug)]
pub(super) struct Uses {
    /// The surfaces, as indices into those of the scene.
    pub(super) surfaces: Vec<usize>,
    /// Per set of texture coordinates, the surfaces that have it.
    pub(super) sets: [Presence; 2],
    /// Per set, the bounding rectangle of all coordinates.
    areas: [Area; 2],
    /// Whether any surface has vertex colours. Rounding of their interpolation may leave an alpha
    /// just below those of the corners.
    pub(super) has_colors: bool,
}

/// Whether all, some or none of a material's surfaces have a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Presence {
    Never,
    Somewhere,
    Everywhere,
}

impl Presence {
    fn and(self, exists: bool, is_first: bool) -> Self {
        match (self, exists) {
            (_, true) if is_first => Self::Everywhere,
            (_, false) if is_first => Self::Never,
            (Self::Everywhere, true) => Self::Everywhere,
            (Self::Never, false) => Self::Never,
            (Self::Never | Self::Somewhere | Self::Everywhere, _) => Self::Somewhere,
        }
    }
}

impl Uses {
    /// The uses of each material of a scene.
    pub(super) fn of(scene: &Proof) -> Vec<Self> {
        let unused = Self {
            surfaces: Vec::new(),
            sets: [Presence::Never; 2],
            areas: [Area::NONE; 2],
            has_colors: false,
        };
        let mut uses = vec![unused; scene.materials().len()];
        for (index, surface) in scene.surfaces().iter().enumerate() {
            uses[surface.material].add(index, &surface.shape, scene);
        }
        uses
    }

    fn add(&mut self, surface: usize, shape: &Shape, scene: &Proof) {
        let is_first = self.surfaces.is_empty();
        for (set, area) in areas(shape, scene).into_iter().enumerate() {
            self.sets[set] = self.sets[set].and(area.is_some(), is_first);
            self.areas[set] = self.areas[set].around(area.unwrap_or(Area::NONE));
        }
        if let Shape::Instance(instance) = shape {
            self.has_colors |= !scene.meshes()[instance.mesh].colors.is_empty();
        }
        self.surfaces.push(surface);
    }

    /// The least and the largest that a map shows on these surfaces, channel by channel, each
    /// colour channel as it is stored.
    pub(super) fn range(&self, map: &Map, scene: &Proof) -> [[f64; 2]; 4] {
        let set = map.set.index();
        let mut range = show(map, self.areas[set], scene);
        if self.sets[set] != Presence::Everywhere {
            // Without texture coordinates, a map is 1.
            range = range.map(|[min, max]| [min.min(1.0), max.max(1.0)]);
        }
        range
    }
}

/// The bounds of the texture coordinates of a shape, for both sets.
fn areas(shape: &Shape, scene: &Proof) -> [Option<Area>; 2] {
    match shape {
        Shape::Sphere(_) | Shape::Quad(_) => [Some(Area::UNIT), None],
        Shape::Triangle(triangle) => {
            let corners = triangle
                .uvs
                .as_ref()
                .map(|uvs| Area::of(uvs.iter().copied()));
            [corners, None]
        }
        Shape::Instance(instance) => {
            let mesh = &scene.meshes()[instance.mesh];
            [&mesh.uvs, &mesh.second_uvs].map(|uvs| {
                let places = uvs.iter();
                (!uvs.is_empty()).then(|| Area::of(places))
            })
        }
        Shape::Plane(_)
        | Shape::Disc(_)
        | Shape::Cylinder(_)
        | Shape::Cone(_)
        | Shape::Torus(_) => [None; 2],
    }
}

/// Whether all lobes of a material are delta lobes: it is smooth and has no diffuse base.
///
/// The compensation for multiple bounces between microfacets is never a delta lobe.
pub(super) fn is_delta(m: &Standard, multiple_scattering: bool) -> bool {
    let is_0 = |number: UnitInterval| number == UnitInterval::ZERO;
    let is_1 = |number: UnitInterval| number == UnitInterval::ONE;
    let is_smooth = is_0(m.roughness) && is_0(m.anisotropy) && m.specular_glossiness.is_none();
    let is_metal = is_1(m.metallic) && m.metallic_roughness_map.is_none();
    let is_glass = is_1(m.transmission) && m.transmission_map.is_none();
    let is_black = m.base_color[..3].iter().all(|channel| is_0(*channel));
    let has_smooth_coat = is_0(m.clearcoat) || is_0(m.clearcoat_roughness);
    let has_base = !(is_metal || is_glass || is_black);
    !multiple_scattering && is_smooth && !has_base && has_smooth_coat && m.sheen_color == Vec3::ZERO
}
