//! How a world is made of a proof: all that a hit would ask again and again is asked once, here.

use super::alpha::AlphaTested;
use super::flattened::{Flattened, flattened_surfaces};
use super::material::{PhongList, standard};
use super::settings::{camera, settings};
use super::shape::Prepare;
use super::texture::Textures;
use super::{Surface, World, light};
use crate::plan::Plan;
use crate::plan::facts::material;
use crate::render::accel::bvh::Bvh;
use crate::render::shape::geometry::Geometry;
use crate::valid::{self, Proof};
use std::sync::Arc;

impl<S: Prepare> World<S> {
    /// Prepares a scene as planned: materials and lights as its integrator sees them, shapes, and
    /// the hierarchies of those.
    #[must_use]
    pub fn prepare(scene: &Proof, plan: &Plan) -> Self {
        let textures = Textures::new(scene);
        let lights = light::lights_for(scene, plan, &textures);
        let (surfaces, phongs, standards) = match &plan.paths {
            None => {
                let materials = scene.materials().iter().map(material::phong).collect();
                let mut list = PhongList::new(materials, plan);
                let surfaces = surfaces(scene, plan, |material, has_uv| list.of(material, has_uv));
                (surfaces, list.prepared(&textures), Vec::new())
            }
            Some(paths) => {
                let materials = paths.materials.iter().enumerate();
                let prepared =
                    materials.map(|(index, material)| standard(index, material, &textures, paths));
                let surfaces = surfaces(scene, plan, |material, _| material);
                (surfaces, Vec::new(), prepared.collect())
            }
        };
        let Lookup {
            unbounded,
            bounded,
            bvh,
            flattened,
        } = Lookup::of(scene, &surfaces);
        Self {
            scene: scene.clone(),
            camera: camera(scene.camera()),
            settings: settings(scene),
            plan: plan.clone(),
            phongs,
            standards,
            lights,
            surfaces,
            verify: None,
            alpha_tested: match plan.paths {
                Some(_) => AlphaTested::of::<S>(scene),
                None => AlphaTested::None,
            },
            unbounded,
            bounded,
            bvh,
            flattened,
        }
    }
}

/// The surfaces that are planned and that rays can hit; `material_of` says which of the world's
/// materials stands for one of the scene on a surface with or without texture coordinates.
fn surfaces<S: Prepare>(
    scene: &Proof,
    plan: &Plan,
    mut material_of: impl FnMut(usize, bool) -> usize,
) -> Vec<Surface<S>> {
    let meshes = scene
        .meshes()
        .iter()
        .map(|mesh| Arc::new(S::prepare_mesh(mesh)))
        .collect::<Vec<_>>();
    let prepared = |(index, surface): (usize, &valid::Surface)| {
        let shape = S::prepare(&surface.shape, &meshes)?;
        Some(Surface {
            material: material_of(surface.material, shape.has_uv()),
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
struct Lookup {
    unbounded: Vec<u32>,
    bounded: Vec<u32>,
    bvh: Bvh,
    flattened: Option<Flattened>,
}

impl Lookup {
    fn of<S: Geometry>(scene: &Proof, surfaces: &[Surface<S>]) -> Self {
        let (mut unbounded, mut bounded) = (Vec::new(), Vec::new());
        let (mut boxes, mut apart) = (Vec::new(), Vec::new());
        let flattens = flattened_surfaces(scene);
        for (index, surface) in (0_u32..).zip(surfaces) {
            match surface.shape.bounds() {
                _ if flattens[surface.index] && surface.shape.triangles() > 0 => apart.push(index),
                Some(bounds) => {
                    bounded.push(index);
                    boxes.push(bounds);
                }
                None => unbounded.push(index),
            }
        }
        Self {
            unbounded,
            bounded,
            bvh: Bvh::build(&boxes),
            flattened: Flattened::new(surfaces, &apart),
        }
    }
}
