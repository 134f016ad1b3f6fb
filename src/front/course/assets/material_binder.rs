//! Assigns the materials of MTL files to meshes. A surface whose mesh has several materials is
//! split into one surface per material.

use super::AssetLoader;
use super::mesh::{MeshFile, MeshFiles};
use super::mtl::MtlCache;
use crate::mesh::SpannedName;
use crate::{gltf, over_limit};
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{
    EntityField, EntityKind, Instance, LoweredScene, MaterialId, Mesh, MeshId, Scene, Shape,
    ValuePath,
};
use rtc_source::{LimitExceeded, Resource, Span};
use std::collections::{BTreeMap, BTreeSet};

/// The source of a mesh's material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialSource {
    /// The scene.
    Scene,
    /// The MTL of the mesh file; grey if there is none.
    MtlOrGrey,
    /// The MTL of the mesh file, which is the input itself; the default material if there is none.
    AssetTarget,
    /// The MTL of the mesh file, as `materials: mtl` requests; the scene's material if there is
    /// none.
    Mtl,
}

/// A mesh whose material has not been assigned yet.
#[derive(Clone, Copy, Debug)]
pub struct PendingMaterial {
    /// The index of its surface, which has the fallback material.
    pub surface: usize,
    /// The source of its material.
    pub source: MaterialSource,
    /// The span of the request in the scene.
    pub span: Option<Span>,
}

/// The material for each `usemtl` of a mesh file, and the meshes of their faces once the mesh is
/// split.
struct MeshMaterials {
    materials: Vec<Option<MaterialId>>,
    parts: Vec<MeshId>,
}

/// Assigns materials to the meshes, whose files are loaded. Returns the materials with their
/// pending images.
pub(super) fn bind(
    pending_materials: &[PendingMaterial],
    meshes: &MeshFiles,
    lowered: &mut LoweredScene,
    loader: &mut AssetLoader<'_>,
) -> MtlCache {
    let scene = &lowered.scene;
    let unsplit = pending_materials
        .iter()
        .filter(|pending| pending.source == MaterialSource::Scene)
        .filter_map(|pending| Some(instance(scene, pending.surface)?.mesh.0))
        .collect();
    let mut binder = MaterialBinder {
        meshes,
        unsplit,
        cache: MtlCache::default(),
        mesh_materials: BTreeMap::new(),
        has_library: BTreeMap::new(),
        lowered,
        loader,
    };
    for pending in pending_materials {
        if let Err(fault) = binder.bind(pending) {
            let diagnostic = over_limit("the mesh", &fault).at(pending.span, "shown here");
            binder.loader.sink.push(diagnostic);
            break;
        }
    }
    binder.cache
}

/// The mesh instance of a surface.
fn instance(scene: &Scene, surface: usize) -> Option<&Instance> {
    let surface = scene.surfaces.get(surface)?;
    if let Shape::Instance(instance) = &surface.shape {
        Some(instance)
    } else {
        None
    }
}

struct MaterialBinder<'a, 'run> {
    meshes: &'a MeshFiles,
    /// The meshes that another surface shows unsplit.
    unsplit: BTreeSet<u32>,
    cache: MtlCache,
    mesh_materials: BTreeMap<usize, Option<MeshMaterials>>,
    /// Whether an MTL of a mesh file exists, for the files checked so far.
    has_library: BTreeMap<usize, bool>,
    lowered: &'a mut LoweredScene,
    loader: &'a mut AssetLoader<'run>,
}

impl MaterialBinder<'_, '_> {
    fn bind(&mut self, pending: &PendingMaterial) -> Result<(), LimitExceeded> {
        let Some(Instance { mesh, .. }) = instance(&self.lowered.scene, pending.surface).cloned()
        else {
            return Ok(());
        };
        let Some(at) = self.meshes.of(mesh) else {
            self.report_no_material(pending, "the mesh has no `material`, so it is grey");
            return Ok(());
        };
        // With a material in the scene only report unused materials.
        let file = &self.meshes.files[at];
        let is_whole = file.full_mesh_id == Some(mesh);
        if pending.source == MaterialSource::Scene {
            let (has_library, loader) = (&mut self.has_library, &*self.loader);
            let is_there = || file.has_library(loader);
            if is_whole && *has_library.entry(at).or_insert_with(is_there) {
                self.report_unused(pending, file);
            }
            return Ok(());
        }
        let Self {
            cache,
            mesh_materials,
            lowered,
            loader,
            ..
        } = self;
        // Add the materials of the file to the scene the first time.
        let mesh_materials = mesh_materials.entry(at).or_insert_with(|| {
            let materials = file.materials(cache, lowered, loader)?;
            Some(MeshMaterials {
                materials,
                parts: Vec::new(),
            })
        });
        let materials = mesh_materials
            .as_ref()
            .map(|mesh_materials| &*mesh_materials.materials);
        // Choose the material of the surface, or split it.
        let material = match materials {
            None => None,
            Some([material]) if is_whole => *material,
            Some(_) if is_whole => return self.split(pending, mesh, at),
            Some(materials) => {
                let part = lowered.scene.meshes[mesh.0 as usize].part.as_deref();
                let part_surface = part.and_then(|part| file.material_use.index_of(part));
                part_surface.and_then(|part_surface| materials[part_surface])
            }
        };
        match material {
            Some(material) => self.lowered.scene.surfaces[pending.surface].material = material,
            None => self.report_no_material(pending, "the mesh has no `material`, so it is grey"),
        }
        Ok(())
    }

    /// Splits a surface with an entire mesh into one surface per material.
    fn split(
        &mut self,
        pending: &PendingMaterial,
        mesh: MeshId,
        at: usize,
    ) -> Result<(), LimitExceeded> {
        let (file, budget) = (&self.meshes.files[at], self.loader.map.budget());
        let Some(Some(mesh_materials)) = self.mesh_materials.get_mut(&at) else {
            return Ok(());
        };
        let LoweredScene {
            scene,
            source_spans,
        } = &mut *self.lowered;
        // Split the mesh the first time; its first part replaces it.
        if mesh_materials.parts.is_empty() {
            let path = |mesh: usize| ValuePath::new(EntityKind::Mesh, mesh, EntityField::Whole);
            let (mesh_index, span) = (mesh.0 as usize, source_spans.span(path(mesh.0 as usize)));
            let name = scene.meshes[mesh_index].name.clone();
            for (first, part) in file.parts(budget)?.into_iter().enumerate() {
                let part = Mesh {
                    name: name.clone(),
                    ..part
                };
                if first == 0 && !self.unsplit.contains(&mesh.0) {
                    scene.meshes[mesh_index] = part;
                    mesh_materials.parts.push(mesh);
                } else {
                    source_spans.record(path(scene.meshes.len()), span);
                    mesh_materials.parts.push(MeshId(index(scene.meshes.len())));
                    scene.meshes.push(part);
                }
            }
        }
        // Charge the surfaces that are added.
        let more = mesh_materials.parts.len().saturating_sub(1) as u64;
        budget.charge(Resource::Surfaces, more)?;
        budget.charge(Resource::Memory, more * gltf::SURFACE)?;
        let surface = scene.surfaces[pending.surface].clone();
        let path = |surface| ValuePath::new(EntityKind::Surface, surface, EntityField::Whole);
        let span = source_spans.span(path(pending.surface));
        // Add one surface per part; the first replaces the surface.
        let parts = mesh_materials.parts.iter().zip(&mesh_materials.materials);
        for (first, (part, material)) in parts.enumerate() {
            let mut part_surface = surface.clone();
            if let Shape::Instance(instance) = &mut part_surface.shape {
                instance.mesh = *part;
            }
            part_surface.material = material.unwrap_or(part_surface.material);
            if first == 0 {
                scene.surfaces[pending.surface] = part_surface;
            } else {
                source_spans.record(path(scene.surfaces.len()), span);
                scene.surfaces.push(part_surface);
            }
        }
        if !scene.names.is_empty() {
            scene.names.resize(scene.surfaces.len(), String::new());
        }
        let is_nameless = |named: &SpannedName| named.text.is_empty();
        if file.material_use.materials.iter().any(is_nameless) {
            self.report_no_material(pending, "some faces have no material, so they are grey");
        }
        Ok(())
    }

    /// Reports a mesh without a material in its file, if the scene relies on the file.
    fn report_no_material(&mut self, pending: &PendingMaterial, grey: &str) {
        let diagnostic = match pending.source {
            MaterialSource::Scene | MaterialSource::AssetTarget => return,
            MaterialSource::Mtl => {
                let message =
                    "some faces have no material in the mesh file: they keep that of the scene";
                Diagnostic::new(&codes::ASSUMED, message).at(pending.span, "not found there")
            }
            MaterialSource::MtlOrGrey => Diagnostic::new(&codes::ASSUMED, grey)
                .at(pending.span, "the mesh")
                .hint(
                    "write `material: {color: [0.7, 0.7, 0.7], ka: 0.2, kd: 0.8, ks: 0, n: 1}`, \
                         or its own",
                ),
        };
        self.loader.sink.push(diagnostic);
    }

    /// Reports that the materials of a mesh file are unused.
    fn report_unused(&mut self, pending: &PendingMaterial, file: &MeshFile) {
        let materials = &file.material_use.materials;
        let count = materials.iter().filter(|named| !named.text.is_empty());
        let message = match count.count() {
            _ if file.texture.is_some() => {
                "the texture of the mesh file is unused: the mesh has the material of the scene"
                    .to_owned()
            }
            1 => "the material of its MTL is unused: the mesh has that of the scene".to_owned(),
            count => {
                format!("{count} materials of its MTL are unused: the mesh has that of the scene")
            }
        };
        let note = Diagnostic::new(&codes::MTL_UNUSED, message).at(pending.span, "the mesh");
        self.loader
            .sink
            .push(note.hint("`materials: mtl` shows them"));
    }
}

fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
