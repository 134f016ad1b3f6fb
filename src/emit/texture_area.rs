//! The texture coordinates at which surfaces look up textures.

use rtc_ir::{Map, Material, MaterialId, Mesh, Scene, Shape, TextureId};
use rtc_math::{Bounds, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// For each texture the box around the coordinates at which meshes look it up, in its own
/// coordinates.
pub(super) struct TextureAreas(BTreeMap<u32, Bounds>);

impl TextureAreas {
    /// Those of a scene; shapes that are no meshes are left out.
    pub(super) fn of(scene: &Scene) -> Self {
        let mut areas = Self(BTreeMap::new());
        let mut sets = BTreeMap::new();
        let mut seen = BTreeSet::new();
        for surface in &scene.surfaces {
            let Shape::Instance(instance) = &surface.shape else {
                continue;
            };
            let mesh = instance.mesh.0;
            let sets = sets.entry(mesh);
            let sets = sets.or_insert_with(|| sets_of(&scene.meshes[mesh as usize]));
            // A material, and the others of its blend.
            let mut next = Some(surface.material);
            while let Some(MaterialId(id)) = next.filter(|id| seen.insert((mesh, id.0))) {
                let material = &scene.materials[id as usize];
                areas.add(material, sets);
                next = material.blend_with();
            }
        }
        areas
    }

    /// The least coordinates of the box of a texture, and its size; the unit square if the box is
    /// empty or infinite.
    pub(super) fn of_texture(&self, TextureId(id): TextureId) -> [[f64; 2]; 2] {
        let area = self.0.get(&id).map(|bounds| {
            let size = bounds.max - bounds.min;
            [bounds.min, size].map(|corner| [corner.x, corner.y])
        });
        let is_proper = |[_, size]: &[[f64; 2]; 2]| {
            let is_proper = |side: &f64| *side > 0.0 && side.is_finite();
            size.iter().all(is_proper)
        };
        area.filter(is_proper).unwrap_or([[0.0; 2], [1.0; 2]])
    }

    /// Adds the boxes of the texture coordinates of a mesh to those of the textures of a material.
    fn add(&mut self, material: &Material, sets: &[Bounds; 2]) {
        for (_, map) in material.maps() {
            let box_of_map = mapped(&map, sets[map.set.min(1) as usize]);
            let area = self.0.entry(map.texture.0).or_insert(Bounds::EMPTY);
            *area = area.union(box_of_map);
        }
    }
}

/// The boxes of both sets of texture coordinates of a mesh.
fn sets_of(mesh: &Mesh) -> [Bounds; 2] {
    [&mesh.uvs, &mesh.second_uvs].map(|set| {
        let points = set.iter().map(|[u, v]| Vec3::new(u, v, 0.0));
        Bounds::of(points)
    })
}

/// A box of coordinates of surfaces in those of a texture.
fn mapped(map: &Map, set: Bounds) -> Bounds {
    let Some(rows) = map.texture_from_surface else {
        return set;
    };
    if set.min.x > set.max.x {
        return set;
    }
    let [x, y] = rows.map(Vec3::from_array);
    let corner = |corner: Vec3| {
        let corner = Vec3::new(corner.x, corner.y, 1.0);
        Vec3::new(x.dot(corner), y.dot(corner), 0.0)
    };
    Bounds::of(set.corners().map(corner))
}
