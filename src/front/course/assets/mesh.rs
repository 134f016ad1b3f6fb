//! Loads mesh files, each once, and extracts the parts that a scene uses.

use super::text_file::TextFileKind;
use super::{AssetLoader, FileCache, MissingAssetPolicy, PendingAsset};
use crate::mesh::{EXTENSIONS, MaterialUse, ParsedMesh, SpannedName, is_mesh, parse_with};
use crate::over_limit;
use rtc_diag::{Diagnostic, DiagnosticSink, Severity, clip, codes};
use rtc_ir::{LoweredScene, Mesh, MeshId, Mode, Scene, Shape};
use rtc_source::{Budget, FileId, FileKind, FoundFile, LimitExceeded, Resource, Span};
use std::collections::BTreeMap;
use std::ops::Range;

/// The file formats of meshes.
pub(super) const TEXT: TextFileKind = TextFileKind {
    entity: "mesh",
    is_not: "no OBJ, OFF, STL, PLY or XYZ",
    code: &codes::BAD_MESH_FILE,
    policy: MissingAssetPolicy::Object,
    // About two million triangles.
    max_bytes: 1 << 28,
    file: FileKind {
        extensions: EXTENSIONS,
        begins: is_mesh,
    },
};

/// The mesh files loaded so far.
#[derive(Default)]
pub(super) struct MeshFiles {
    cache: FileCache<usize>,
    pub(super) files: Vec<MeshFile>,
    /// The file of each pending mesh.
    file_of: BTreeMap<u32, usize>,
}

/// A loaded mesh file.
pub(super) struct MeshFile {
    /// The entire mesh, without a name.
    full_mesh: Mesh,
    /// The mesh of the scene that is the entire mesh, if there is one.
    pub(super) full_mesh_id: Option<MeshId>,
    pub(super) material_use: MaterialUse,
    /// The texture of all faces, if the file names one itself.
    pub(super) texture: Option<SpannedName>,
    pub(super) file: FileId,
    /// Its path relative to the searched folder.
    pub(super) path: String,
}

impl MeshFiles {
    /// Loads a mesh. A file that was loaded before, under any name, gives the same mesh. If that
    /// fails, the mesh stays empty.
    pub(super) fn load(
        &mut self,
        id: MeshId,
        pending: &PendingAsset,
        lowered: &mut LoweredScene,
        loader: &mut AssetLoader<'_>,
    ) {
        let Some(found) = loader.find(pending, MissingAssetPolicy::Object) else {
            return;
        };
        let files = &mut self.files;
        // Read the file the first time.
        let at = self.cache.get_or_load(&found, || {
            let mesh_file = read_file(&found, pending, loader)?;
            let is_traced = matches!(lowered.scene.settings.mode, Mode::Path(_));
            if !mesh_file.full_mesh.colors.is_empty() && !is_traced {
                let message = "only path tracing shows the colours of vertices";
                let diagnostic = Diagnostic::new(&codes::NOT_DRAWN, message);
                loader
                    .sink
                    .push(diagnostic.at(pending.span, "has the colour of its material"));
            }
            files.push(mesh_file);
            Some(files.len() - 1)
        });
        let Some(at) = at.copied() else { return };
        self.file_of.insert(id.0, at);
        let Some(target) = lowered.scene.meshes.get_mut(id.0 as usize) else {
            return;
        };
        // Fill the placeholder with the entire mesh or a part of it.
        let mesh_file = &mut files[at];
        match &target.part {
            None if mesh_file.full_mesh_id.is_some() => {}
            None => {
                mesh_file.full_mesh_id = Some(id);
                fill(target, mesh_file.full_mesh.clone());
            }
            Some(part) => match mesh_file.part(part, loader.map.budget()) {
                Ok(Some(mesh)) => fill(target, mesh),
                Ok(None) => {
                    let message = format!(
                        "no face of `{}` has the material `{}`",
                        found.shown.display(),
                        clip(part)
                    );
                    let diagnostic = Diagnostic::new(&codes::BAD_MESH_FILE, message);
                    loader.reject(
                        diagnostic.at(pending.span, "named here"),
                        MissingAssetPolicy::Object,
                    );
                }
                Err(fault) => loader
                    .sink
                    .push(over_limit("the mesh", &fault).at(pending.span, "named here")),
            },
        }
    }

    /// Adds a parsed file whose entire mesh is the mesh `id` of the scene.
    pub(super) fn add(&mut self, id: MeshId, mut file: MeshFile) {
        file.full_mesh_id = Some(id);
        self.file_of.insert(id.0, self.files.len());
        self.files.push(file);
    }

    /// The file of a mesh; `None` if it could not be loaded.
    pub(super) fn of(&self, id: MeshId) -> Option<usize> {
        self.file_of.get(&id.0).copied()
    }

    /// Points instances to the loaded meshes.
    pub(super) fn resolve_instances(&self, scene: &mut Scene) {
        for surface in &mut scene.surfaces {
            if let Shape::Instance(instance) = &mut surface.shape {
                let is_whole = scene
                    .meshes
                    .get(instance.mesh.0 as usize)
                    .is_some_and(|mesh| mesh.part.is_none());
                let full_mesh_id = self
                    .of(instance.mesh)
                    .and_then(|at| self.files[at].full_mesh_id);
                instance.mesh = full_mesh_id.filter(|_| is_whole).unwrap_or(instance.mesh);
            }
        }
    }
}

/// Replaces the geometry of a mesh; its name and part stay.
fn fill(target: &mut Mesh, mesh: Mesh) {
    let (name, part) = (std::mem::take(&mut target.name), target.part.take());
    *target = Mesh { name, part, ..mesh };
}

impl MeshFile {
    pub(super) fn new(parsed: ParsedMesh, file: FileId, path: String) -> Self {
        let ParsedMesh {
            mesh: full_mesh,
            not_drawn: _,
            repaired: _,
            remarks: _,
            is_unlit: _,
            material_use,
            texture,
        } = parsed;
        Self {
            full_mesh,
            full_mesh_id: None,
            material_use,
            texture,
            file,
            path,
        }
    }

    /// The entire mesh, without a name.
    pub(super) fn full_mesh(&self) -> Mesh {
        self.full_mesh.clone()
    }

    /// The triangles with the material `name`, if there are any.
    fn part(&self, name: &str, budget: &Budget) -> Result<Option<Mesh>, LimitExceeded> {
        let Some(at) = self.material_use.index_of(name) else {
            return Ok(None);
        };
        let mut unused = vec![UNASSIGNED; self.full_mesh.positions.len()];
        let ranges = self.material_use.parts(self.full_mesh.triangles.len());
        extract(&self.full_mesh, &ranges[at], &mut unused, budget).map(Some)
    }

    /// One mesh for the triangles of each material.
    pub(super) fn parts(&self, budget: &Budget) -> Result<Vec<Mesh>, LimitExceeded> {
        budget.has(Resource::Memory, 4 * self.full_mesh.positions.len() as u64)?;
        let mut unused = vec![UNASSIGNED; self.full_mesh.positions.len()];
        let ranges = self.material_use.parts(self.full_mesh.triangles.len());
        ranges
            .iter()
            .zip(&self.material_use.materials)
            .map(|(ranges, named)| {
                Ok(Mesh {
                    part: Some(named.text.clone()),
                    ..extract(&self.full_mesh, ranges, &mut unused, budget)?
                })
            })
            .collect()
    }
}

/// The new index of a vertex that is not in the part so far.
const UNASSIGNED: u32 = u32::MAX;

/// Extracts triangles of a mesh, with their vertices in the order of first use. `new_indices` holds
/// [`UNASSIGNED`] for every vertex, before and after.
fn extract(
    mesh: &Mesh,
    ranges: &[Range<usize>],
    new_indices: &mut [u32],
    budget: &Budget,
) -> Result<Mesh, LimitExceeded> {
    let triangles = || {
        ranges
            .iter()
            .flat_map(|range| &mesh.triangles[range.clone()])
    };
    let mut used = Vec::new();
    // Each corner adds at most one vertex.
    let corners = 3 * triangles().count().min(new_indices.len());
    budget.has(Resource::Memory, 8 * corners as u64)?;
    // Number the vertices in the order of first use.
    for corner in triangles().flatten() {
        let new_index = &mut new_indices[*corner as usize];
        if *new_index == UNASSIGNED {
            *new_index = u32::try_from(used.len()).unwrap_or(UNASSIGNED);
            used.push(*corner);
        }
    }
    // Charge the budget.
    let column = |is_empty: bool, bytes: u64| if is_empty { 0 } else { bytes };
    let vertex = 24
        + column(mesh.uvs.is_empty(), 16)
        + column(mesh.normals.is_empty(), 24)
        + column(mesh.colors.is_empty(), 32);
    budget.charge(Resource::Vertices, used.len() as u64)?;
    let memory = vertex * used.len() as u64 + 12 * triangles().count() as u64;
    budget.charge(Resource::Memory, memory)?;
    // Copy the vertices and renumber the triangles.
    let part = Mesh {
        positions: mesh.positions.pick(&used),
        normals: mesh.normals.pick(&used),
        uvs: mesh.uvs.pick(&used),
        colors: mesh.colors.pick(&used),
        triangles: triangles()
            .map(|corners| corners.map(|corner| new_indices[corner as usize]))
            .collect(),
        ..Mesh::default()
    };
    // Reset the indices for the next part.
    used.iter()
        .for_each(|corner| new_indices[*corner as usize] = UNASSIGNED);
    Ok(part)
}

/// Reads and parses a mesh file.
fn read_file(
    found: &FoundFile,
    pending: &PendingAsset,
    loader: &mut AssetLoader<'_>,
) -> Option<MeshFile> {
    let options = loader.options.mesh();
    let parse = |bytes: &[u8], budget: &Budget| parse_with(bytes, options, budget);
    let (file, parsed) = loader.read_text(found, pending, &TEXT, parse)?;
    report_losses(&parsed, file, pending.span, loader.sink);
    let path = loader.search.path_to(found).unwrap_or_default();
    Some(MeshFile::new(parsed, file, path))
}

/// Reports the elements of a file that are not drawn, and what was repaired; `named` is where a
/// scene names the file.
pub(super) fn report_losses(
    parsed: &ParsedMesh,
    file: FileId,
    named: Option<Span>,
    sink: &mut DiagnosticSink,
) {
    let not_drawn = parsed.not_drawn.as_ref().zip(parsed.loss());
    let repaired = parsed.repaired.as_ref().zip(parsed.repair());
    for remark in &parsed.remarks {
        let diagnostic = Diagnostic::new(&codes::NOT_DRAWN, remark.message.as_str());
        let diagnostic = diagnostic.at(remark.span(file), remark.label.as_str());
        sink.push(diagnostic.also(named, "the file is named here"));
    }
    let losses = [
        (&codes::NOT_DRAWN, not_drawn),
        (&codes::BAD_MESH_FILE, repaired),
    ];
    for (code, loss) in losses {
        let Some(((first, _), message)) = loss else {
            continue;
        };
        let diagnostic = Diagnostic::new(code, message).severity(Severity::Warning);
        let diagnostic = diagnostic.at(first.span(file), first.label.as_str());
        sink.push(diagnostic.also(named, "the file is named here"));
    }
}
