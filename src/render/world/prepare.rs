//! Builds a world from a validated scene. Everything that does not depend on the ray is computed
//! here.

use super::alpha::AlphaTested;
use super::flattened::{FlattenedInstances, flattened_surfaces};
use super::light::LightList;
use super::material::{PhongList, standard, unchanged, with_requests};
use super::panes::panes;
use super::settings::{camera, settings};
use super::shape::Prepare;
use super::small_scene::SmallScene;
use super::texture::Textures;
use super::{Material, MaterialId, ObjectBvh, Surface, SurfaceId, World, light};
use crate::accel::bvh::Bvh;
use crate::accel::simd::SimdLevel;
use crate::material::standard::{MediumInterface, StandardMaterial};
use crate::medium::HomogeneousMedium;
use crate::shape::geometry::Intersect;
use rtc_math::{IdTable, Medium, StoredTree};
use rtc_plan::facts::material;
use rtc_plan::{PixelClassGrid, Plan, RuleSet};
use rtc_valid::{self as valid, ValidScene};
use std::sync::Arc;

impl<S: Prepare> World<S> {
    /// Prepares a scene as planned: materials and lights as its integrator sees them, shapes, and
    /// the BVHs of those.
    #[must_use]
    pub fn prepare(scene: &ValidScene, plan: &Plan) -> Self {
        Self::prepare_at(scene, plan, SimdLevel::best())
    }

    /// As [`World::prepare`], for rays traced with the SIMD instructions of a level: the hits are
    /// the same.
    #[must_use]
    pub fn prepare_at(scene: &ValidScene, plan: &Plan, simd: SimdLevel) -> Self {
        let (textures, meshes) = (Textures::new(scene), scene.meshes().iter());
        let assets = PreparedAssets {
            lights: light::lights_for(scene, plan, &textures),
            standards: standards(plan, &textures),
            textures,
            meshes: meshes
                .map(|mesh| Arc::new(S::prepare_mesh(mesh, simd)))
                .collect(),
        };
        let mut world = Self::of_assets(scene, plan, &assets, simd);
        if plan.moments > 1 {
            // A scene that moves has no classes of pixels.
            let plan = Plan {
                pixel_classes: PixelClassGrid::default(),
                ..plan.clone()
            };
            let moment = |k: u32| (f64::from(k) + 0.5) / f64::from(plan.moments);
            let at = |k| Self::of_assets(&scene.at(moment(k)), &plan, &assets, simd);
            world.moments = (0..plan.moments).map(at).collect();
        }
        world
    }

    /// Prepares a scene at one moment.
    fn of_assets(
        scene: &ValidScene,
        plan: &Plan,
        assets: &PreparedAssets<S>,
        simd: SimdLevel,
    ) -> Self {
        let PreparedAssets {
            textures,
            lights,
            meshes,
            standards: (standards, media),
        } = assets;
        // Select the materials that the surfaces need.
        let (standards, mut media) = (standards.iter().cloned().collect(), media.clone());
        let (surfaces, phongs) = match &plan.paths {
            None => {
                let materials = material::phongs(scene.materials());
                let materials = materials.into_iter().collect();
                let mut list = PhongList::new(materials, scene, plan);
                let surfaces = surfaces(scene, plan, meshes, |surface| list.of(surface));
                (surfaces, list.prepared(textures))
            }
            Some(_) => {
                let surfaces = surfaces(scene, plan, meshes, |surface| unchanged(surface.material));
                (surfaces, IdTable::default())
            }
        };
        // Build the hierarchies over the surfaces.
        let SurfaceLookup {
            objects,
            casters,
            flattened,
            small_scene,
        } = SurfaceLookup::of(scene, plan, &surfaces, simd);
        let (panes, has_panes) = match plan.paths {
            Some(_) => panes(scene),
            None => (IdTable::default(), false),
        };
        let camera_medium = plan.paths.as_ref().and_then(|paths| paths.medium);
        let camera_medium = camera_medium.map(|medium| media.push(medium.into()));
        Self {
            scene: scene.clone(),
            camera: camera(scene.camera()),
            settings: settings(scene),
            plan: plan.clone(),
            phongs,
            standards,
            media,
            camera_medium,
            has_free_panes: material::has_media(scene),
            panes: panes.into_iter().collect(),
            has_panes,
            lights: lights.clone(),
            surfaces,
            verify: None,
            alpha_tested: match plan.paths {
                Some(_) => AlphaTested::of::<S>(scene),
                None => AlphaTested::None,
            },
            objects,
            casters,
            flattened,
            simd,
            moments: Vec::new(),
            small_scene,
        }
    }

    /// The hierarchy over its flattened surfaces, to be stored with the scene.
    #[must_use]
    pub fn tree_to_store(&self) -> Option<StoredTree> {
        self.flattened.as_ref()?.to_store(&self.surfaces)
    }
}

/// What the worlds of all moments share.
struct PreparedAssets<S: Prepare> {
    textures: Textures,
    lights: LightList,
    meshes: IdTable<valid::Mesh, Arc<S::Mesh>>,
    standards: StandardList,
}

/// The materials of path tracing, and the media that they separate.
type StandardList = (
    IdTable<Material, StandardMaterial>,
    IdTable<HomogeneousMedium>,
);

/// The materials of a plan of paths, prepared.
fn standards(plan: &Plan, textures: &Textures) -> StandardList {
    let mut media = IdTable::default();
    let Some(paths) = &plan.paths else {
        return (IdTable::default(), media);
    };
    let materials = paths.materials.entries();
    let prepared = materials.map(|(index, material)| StandardMaterial {
        media: interface(material, &mut media),
        ..standard(index, material, textures, paths)
    });
    (with_requests(prepared.collect()), media)
}

/// The media that the surfaces of a material separate; they come into the list.
fn interface(
    material: &valid::Standard,
    media: &mut IdTable<HomogeneousMedium>,
) -> Option<MediumInterface> {
    let mut add = |medium: Option<Medium>| medium.map(|medium| media.push(medium.into()));
    let interior = add(material.interior);
    let exterior = add(material.exterior);
    (interior.is_some() || exterior.is_some()).then_some(MediumInterface { interior, exterior })
}

/// The planned surfaces that rays can hit; `material_of` selects the world's material for one of
/// the scene.
fn surfaces<S: Prepare>(
    scene: &ValidScene,
    plan: &Plan,
    meshes: &IdTable<valid::Mesh, Arc<S::Mesh>>,
    mut material_of: impl FnMut(&valid::Surface) -> MaterialId,
) -> IdTable<Surface, Surface<S>> {
    let prepared = |(index, surface): (usize, &valid::Surface)| {
        let shape = S::prepare(&surface.shape, meshes)?;
        Some(Surface {
            material: material_of(surface),
            shape,
            index,
        })
    };
    let planned = scene
        .surfaces()
        .iter()
        .enumerate()
        .filter(|(index, _)| plan.surfaces[*index]);
    planned.filter_map(prepared).collect()
}

/// Where rays look for the surfaces of a world.
struct SurfaceLookup {
    objects: ObjectBvh,
    casters: Option<ObjectBvh>,
    flattened: Option<FlattenedInstances>,
    small_scene: Option<SmallScene>,
}

impl SurfaceLookup {
    fn of<S: Intersect>(
        scene: &ValidScene,
        plan: &Plan,
        surfaces: &IdTable<Surface, Surface<S>>,
        simd: SimdLevel,
    ) -> Self {
        let flattens = flattened_surfaces(scene);
        let is_path = matches!(scene.settings().mode, valid::Mode::Path(_));
        // Shadow rays of paths hit the same surfaces as other rays: light counts once with either
        // strategy.
        let casts = |surface: &Surface<S>| is_path || scene.surfaces()[surface.index].casts_shadow;
        // Shadow rays hit all flattened surfaces, so one without a shadow is not flattened.
        let is_flattened = |surface: &Surface<S>| {
            let is_mesh = S::FLATTENS && surface.shape.triangles() > 0;
            is_mesh && flattens[surface.index] && casts(surface)
        };
        let (flattened, objects): (Vec<SurfaceId>, Vec<SurfaceId>) =
            surfaces.ids().partition(|id| is_flattened(&surfaces[*id]));
        let casters = objects.iter().copied();
        let casters: Vec<SurfaceId> = casters.filter(|id| casts(&surfaces[*id])).collect();
        // A world without pruning tests all surfaces, so validation finds a hit that a cone missed.
        // The cones of rays are those of one moment.
        let bundled = !is_path && plan.rules != RuleSet::NONE && !scene.moves();
        let small_scene = || {
            let mut small_scene = SmallScene::new(surfaces, &objects, &casters)?;
            small_scene.follow(surfaces, plan);
            Some(small_scene)
        };
        Self {
            small_scene: bundled.then(small_scene).flatten(),
            casters: (casters.len() < objects.len()).then(|| ObjectBvh::of(surfaces, &casters)),
            objects: ObjectBvh::of(surfaces, &objects),
            flattened: FlattenedInstances::new(surfaces, &flattened, scene.trees(), simd),
        }
    }
}

impl ObjectBvh {
    fn of<S: Intersect>(surfaces: &IdTable<Surface, Surface<S>>, ids: &[SurfaceId]) -> Self {
        let (mut unbounded, mut bounded, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for id in ids {
            match surfaces[*id].shape.bounds() {
                Some(bounds) => {
                    bounded.push(*id);
                    boxes.push(bounds);
                }
                None => unbounded.push(*id),
            }
        }
        Self {
            unbounded,
            bounded,
            bvh: Bvh::build(&boxes),
        }
    }
}
