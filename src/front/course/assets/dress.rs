//! MeshFiles dressed by the materials that their files ask for: one surface becomes one for each
//! material, where those count.

use super::Porter;
use super::mesh::{MeshFile, MeshFiles};
use super::mtl::MtlCache;
use crate::mesh::Named;
use crate::{gltf, over_limit};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{
    EntityKind, Field, Instance, Lowered, MaterialId, Mesh, MeshId, Scene, Shape, ValuePath,
};
use rtc_source::{Exceeded, Resource, Span};
use std::collections::{BTreeMap, BTreeSet};

/// Where the material of a mesh comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dress {
    /// From the scene.
    Scene,
    /// From its file; without any there it keeps its own, which is grey.
    MtlOrGrey,
    /// From its file, which is the scene; without any there it keeps its own.
    Asset,
    /// From its file, as the scene asks for; without any there it keeps its own.
    Mtl,
}

/// A mesh in want of a material.
#[derive(Clone, Copy, Debug)]
pub struct Dressing {
    /// The index of its surface, which has the material that counts where the file has none.
    pub surface: usize,
    /// Where its material comes from.
    pub dress: Dress,
    /// Where the scene says so.
    pub span: Option<Span>,
}

/// The materials of a mesh file, for each that its faces ask for, and the meshes of their faces once
/// there are any.
struct Wardrobe {
    materials: Vec<Option<MaterialId>>,
    parts: Vec<MeshId>,
}

/// Dresses meshes whose files were brought; returns the materials, with the images that they wait
/// for.
pub(super) fn dress(
    dressings: &[Dressing],
    meshes: &MeshFiles,
    lowered: &mut Lowered,
    porter: &mut Porter<'_>,
) -> MtlCache {
    let scene = &lowered.scene;
    let kept = dressings
        .iter()
        .filter(|dressing| dressing.dress == Dress::Scene)
        .filter_map(|dressing| Some(instance(scene, dressing.surface)?.mesh.0))
        .collect();
    let mut dresser = Dresser {
        meshes,
        kept,
        cache: MtlCache::default(),
        wardrobes: BTreeMap::new(),
        has_library: BTreeMap::new(),
        lowered,
        porter,
    };
    for dressing in dressings {
        if let Err(fault) = dresser.dress(dressing) {
            let finding = over_limit("the mesh", &fault).at(dressing.span, "shown here");
            dresser.porter.sink.push(finding);
            break;
        }
    }
    dresser.cache
}

/// The mesh in its place that a surface is.
fn instance(scene: &Scene, surface: usize) -> Option<&Instance> {
    let surface = scene.surfaces.get(surface)?;
    if let Shape::Instance(instance) = &surface.shape {
        Some(instance)
    } else {
        None
    }
}

struct Dresser<'a, 'run> {
    meshes: &'a MeshFiles,
    /// The meshes that are shown in one piece too.
    kept: BTreeSet<u32>,
    cache: MtlCache,
    wardrobes: BTreeMap<usize, Option<Wardrobe>>,
    /// Whether a file has materials that can be found, of those of which that was asked.
    has_library: BTreeMap<usize, bool>,
    lowered: &'a mut Lowered,
    porter: &'a mut Porter<'run>,
}

impl Dresser<'_, '_> {
    fn dress(&mut self, dressing: &Dressing) -> Result<(), Exceeded> {
        let Some(Instance { mesh, .. }) = instance(&self.lowered.scene, dressing.surface).cloned()
        else {
            return Ok(());
        };
        let Some(at) = self.meshes.of(mesh) else {
            self.bare(dressing, "the mesh has no `material`, so it is grey");
            return Ok(());
        };
        let file = &self.meshes.files[at];
        let is_whole = file.home == Some(mesh);
        if dressing.dress == Dress::Scene {
            let (has_library, porter) = (&mut self.has_library, &*self.porter);
            let is_there = || file.has_library(porter);
            if is_whole && *has_library.entry(at).or_insert_with(is_there) {
                self.note_unused(dressing, file);
            }
            return Ok(());
        }
        let Self {
            cache,
            wardrobes,
            lowered,
            porter,
            ..
        } = self;
        let wardrobe = wardrobes.entry(at).or_insert_with(|| {
            let materials = file.materials(cache, lowered, porter)?;
            Some(Wardrobe {
                materials,
                parts: Vec::new(),
            })
        });
        let materials = wardrobe.as_ref().map(|wardrobe| &*wardrobe.materials);
        let material = match materials {
            None => None,
            Some([material]) if is_whole => *material,
            Some(_) if is_whole => return self.split(dressing, mesh, at),
            Some(materials) => {
                let part = lowered.scene.meshes[mesh.0 as usize].part.as_deref();
                let own = part.and_then(|part| file.material_use.index_of(part));
                own.and_then(|own| materials[own])
            }
        };
        match material {
            Some(material) => self.lowered.scene.surfaces[dressing.surface].material = material,
            None => self.bare(dressing, "the mesh has no `material`, so it is grey"),
        }
        Ok(())
    }

    /// Makes one surface a material of the one that is a whole mesh.
    fn split(&mut self, dressing: &Dressing, mesh: MeshId, at: usize) -> Result<(), Exceeded> {
        let (file, budget) = (&self.meshes.files[at], self.porter.map.budget());
        let Some(Some(wardrobe)) = self.wardrobes.get_mut(&at) else {
            return Ok(());
        };
        let Lowered {
            scene,
            source_spans,
        } = &mut *self.lowered;
        if wardrobe.parts.is_empty() {
            let place = |mesh: usize| ValuePath::new(EntityKind::Mesh, mesh, Field::Whole);
            let (whole, span) = (mesh.0 as usize, source_spans.span(place(mesh.0 as usize)));
            let name = scene.meshes[whole].name.clone();
            for (first, part) in file.parts(budget)?.into_iter().enumerate() {
                let part = Mesh {
                    name: name.clone(),
                    ..part
                };
                if first == 0 && !self.kept.contains(&mesh.0) {
                    scene.meshes[whole] = part;
                    wardrobe.parts.push(mesh);
                } else {
                    source_spans.record(place(scene.meshes.len()), span);
                    wardrobe.parts.push(MeshId(index(scene.meshes.len())));
                    scene.meshes.push(part);
                }
            }
        }
        let more = wardrobe.parts.len().saturating_sub(1) as u64;
        budget.charge(Resource::Surfaces, more)?;
        budget.charge(Resource::Memory, more * gltf::SURFACE)?;
        let surface = scene.surfaces[dressing.surface].clone();
        let place = |surface| ValuePath::new(EntityKind::Surface, surface, Field::Whole);
        let span = source_spans.span(place(dressing.surface));
        let parts = wardrobe.parts.iter().zip(&wardrobe.materials);
        for (first, (part, material)) in parts.enumerate() {
            let mut own = surface.clone();
            if let Shape::Instance(instance) = &mut own.shape {
                instance.mesh = *part;
            }
            own.material = material.unwrap_or(own.material);
            if first == 0 {
                scene.surfaces[dressing.surface] = own;
            } else {
                source_spans.record(place(scene.surfaces.len()), span);
                scene.surfaces.push(own);
            }
        }
        if !scene.names.is_empty() {
            scene.names.resize(scene.surfaces.len(), String::new());
        }
        let is_nameless = |named: &Named| named.text.is_empty();
        if file.material_use.materials.iter().any(is_nameless) {
            self.bare(dressing, "some faces have no material, so they are grey");
        }
        Ok(())
    }

    /// Says that nothing gives a mesh its material, where the scene leaves it to the file.
    fn bare(&mut self, dressing: &Dressing, grey: &str) {
        let finding = match dressing.dress {
            Dress::Scene | Dress::Asset => return,
            Dress::Mtl => {
                let message = "the file of the mesh has no material for all its faces, so those have \
                               that of the scene";
                Diagnostic::new(&codes::ASSUMED, message).at(dressing.span, "not found there")
            }
            Dress::MtlOrGrey => Diagnostic::new(&codes::ASSUMED, grey)
                .at(dressing.span, "this mesh")
                .hint(
                    "write `material: {color: [0.7, 0.7, 0.7], ka: 0.2, kd: 0.8, ks: 0, n: 1}`, \
                         or its own",
                ),
        };
        self.porter.sink.push(finding);
    }

    /// Says that the materials of a file are not shown.
    fn note_unused(&mut self, dressing: &Dressing, file: &MeshFile) {
        let materials = &file.material_use.materials;
        let count = materials.iter().filter(|named| !named.text.is_empty());
        let message = match count.count() {
            _ if file.texture.is_some() => {
                "the picture of the mesh file is unused: the mesh has the material of the scene"
                    .to_owned()
            }
            1 => "the material of its MTL is unused: the mesh has that of the scene".to_owned(),
            count => {
                format!("{count} materials of its MTL are unused: the mesh has that of the scene")
            }
        };
        let note = Diagnostic::new(&codes::MTL_UNUSED, message).at(dressing.span, "this mesh");
        self.porter
            .sink
            .push(note.hint("`materials: mtl` shows them"));
    }
}

fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
