//! The meshes: their files found and read, each once, and the parts of them that are wanted.

use super::text::TextKind;
use super::{Known, Porter, Wanted, Without};
use crate::diag::{Diagnostic, clip, codes};
use crate::front::mesh::{MaterialUse, Parsed, ParsedMesh, is_mesh, parse};
use crate::front::over_limit;
use crate::ir::{Lowered, Mesh, MeshId, Scene, Shape};
use crate::source::{Budget, Exceeded, FileId, FileKind, Found, Resource};
use std::collections::BTreeMap;
use std::ops::Range;

/// Such files.
pub(super) const TEXT: TextKind = TextKind {
    noun: "mesh",
    is_not: "neither OBJ nor OFF",
    code: &codes::BAD_MESH_FILE,
    without: Without::Object,
    // Some two million triangles.
    max_bytes: 1 << 28,
    file: FileKind {
        extensions: &["obj", "off"],
        begins: is_mesh,
    },
};

/// The mesh files brought so far.
#[derive(Default)]
pub(super) struct MeshFiles {
    known: Known<usize>,
    pub(super) files: Vec<MeshFile>,
    /// The file that each mesh wanted is of.
    file_of: BTreeMap<u32, usize>,
}

/// What a mesh file holds.
pub(super) struct MeshFile {
    /// All of it, without a name.
    whole: Mesh,
    /// The mesh of the scene that is all of it, if there is one.
    pub(super) home: Option<MeshId>,
    pub(super) material_use: MaterialUse,
    pub(super) file: FileId,
    /// Its path from a folder that is searched.
    pub(super) path: String,
}

impl MeshFiles {
    /// Brings one mesh, or the one that the same file became before, whatever it was called;
    /// without a file it stays empty, and nothing shows of it.
    pub(super) fn bring(
        &mut self,
        id: MeshId,
        wish: &Wanted,
        lowered: &mut Lowered,
        porter: &mut Porter<'_>,
    ) {
        let Some(found) = porter.find(wish, Without::Object) else {
            return;
        };
        let files = &mut self.files;
        let at = self.known.of(&found, || {
            files.push(load(&found, wish, porter)?);
            Some(files.len() - 1)
        });
        let Some(at) = at.copied() else { return };
        self.file_of.insert(id.0, at);
        let Some(place) = lowered.scene.meshes.get_mut(id.0 as usize) else {
            return;
        };
        let own = &mut files[at];
        match &place.part {
            None if own.home.is_some() => {}
            None => {
                own.home = Some(id);
                fill(place, own.whole.clone());
            }
            Some(part) => match own.part(part, porter.map.budget()) {
                Ok(Some(mesh)) => fill(place, mesh),
                Ok(None) => {
                    let message = format!(
                        "no face of `{}` has the material `{}`",
                        found.shown.display(),
                        clip(part)
                    );
                    let finding = Diagnostic::new(&codes::BAD_MESH_FILE, message);
                    porter.refuse(finding.at(wish.span, "named here"), Without::Object);
                }
                Err(fault) => porter
                    .sink
                    .push(over_limit("the mesh", &fault).at(wish.span, "named here")),
            },
        }
    }

    /// The file that a mesh wanted is of; none if there is no sound one.
    pub(super) fn of(&self, id: MeshId) -> Option<usize> {
        self.file_of.get(&id.0).copied()
    }

    /// Has instances show the meshes that came of those they wanted.
    pub(super) fn settle(&self, scene: &mut Scene) {
        for surface in &mut scene.surfaces {
            if let Shape::Instance(instance) = &mut surface.shape {
                let is_whole = scene
                    .meshes
                    .get(instance.mesh.0 as usize)
                    .is_some_and(|mesh| mesh.part.is_none());
                let home = self.of(instance.mesh).and_then(|at| self.files[at].home);
                instance.mesh = home.filter(|_| is_whole).unwrap_or(instance.mesh);
            }
        }
    }
}

/// Puts what a mesh holds into one that keeps its name and part.
fn fill(place: &mut Mesh, mesh: Mesh) {
    let (name, part) = (std::mem::take(&mut place.name), place.part.take());
    *place = Mesh { name, part, ..mesh };
}

impl MeshFile {
    /// The triangles whose faces ask for the material `name`, if there are any.
    fn part(&self, name: &str, budget: &Budget) -> Result<Option<Mesh>, Exceeded> {
        let Some(at) = self.material_use.index_of(name) else {
            return Ok(None);
        };
        let mut unused = vec![UNUSED; self.whole.positions.len()];
        let ranges = self.material_use.parts(self.whole.triangles.len());
        extract(&self.whole, &ranges[at], &mut unused, budget).map(Some)
    }

    /// Each material's triangles, as meshes of their own.
    pub(super) fn parts(&self, budget: &Budget) -> Result<Vec<Mesh>, Exceeded> {
        budget.has(Resource::Memory, 4 * self.whole.positions.len() as u64)?;
        let mut unused = vec![UNUSED; self.whole.positions.len()];
        let ranges = self.material_use.parts(self.whole.triangles.len());
        ranges
            .iter()
            .zip(&self.material_use.materials)
            .map(|(ranges, named)| {
                Ok(Mesh {
                    part: Some(named.text.clone()),
                    ..extract(&self.whole, ranges, &mut unused, budget)?
                })
            })
            .collect()
    }
}

/// The number of a vertex that a part does not have so far.
const UNUSED: u32 = u32::MAX;

/// Some triangles of a mesh, with the vertices that they use in the order of their first use;
/// `numbers` holds one [`UNUSED`] for each vertex, before and after.
fn extract(
    mesh: &Mesh,
    ranges: &[Range<usize>],
    numbers: &mut [u32],
    budget: &Budget,
) -> Result<Mesh, Exceeded> {
    let triangles = || {
        ranges
            .iter()
            .flat_map(|range| &mesh.triangles[range.clone()])
    };
    let mut used = Vec::new();
    // A corner is new at most once.
    let corners = 3 * triangles().count().min(numbers.len());
    budget.has(Resource::Memory, 8 * corners as u64)?;
    for corner in triangles().flatten() {
        let number = &mut numbers[*corner as usize];
        if *number == UNUSED {
            *number = u32::try_from(used.len()).unwrap_or(UNUSED);
            used.push(*corner);
        }
    }
    let vertex =
        24 + 16 * u64::from(!mesh.uvs.is_empty()) + 24 * u64::from(!mesh.normals.is_empty());
    budget.charge(Resource::Vertices, used.len() as u64)?;
    let memory = vertex * used.len() as u64 + 12 * triangles().count() as u64;
    budget.charge(Resource::Memory, memory)?;
    let part = Mesh {
        positions: mesh.positions.pick(&used),
        normals: mesh.normals.pick(&used),
        uvs: mesh.uvs.pick(&used),
        triangles: triangles()
            .map(|corners| corners.map(|corner| numbers[corner as usize]))
            .collect(),
        ..Mesh::default()
    };
    used.iter()
        .for_each(|corner| numbers[*corner as usize] = UNUSED);
    Ok(part)
}

/// What is in a file, if it is a sound mesh.
fn load(found: &Found, wish: &Wanted, porter: &mut Porter<'_>) -> Option<MeshFile> {
    let (file, parsed) = porter.read_text(found, wish, &TEXT, parse)?;
    let Parsed {
        mesh,
        not_drawn,
        material_use,
    } = parsed;
    if let Some((first, count)) = not_drawn {
        let message = format!("{} show: {}", count_of(count), first.message);
        let finding = Diagnostic::new(&codes::NOT_DRAWN, message).at(first.span(file), first.label);
        porter
            .sink
            .push(finding.also(wish.span, "the file is named here"));
    }
    Some(MeshFile {
        whole: whole(mesh),
        home: None,
        material_use,
        file,
        path: porter.search.path_to(found).unwrap_or_default(),
    })
}

fn whole(mesh: ParsedMesh) -> Mesh {
    let ParsedMesh {
        positions,
        normals,
        uvs,
        triangles,
    } = mesh;
    Mesh {
        positions: positions.into(),
        normals: normals.into(),
        uvs: uvs.into(),
        triangles: triangles.into(),
        ..Mesh::default()
    }
}

fn count_of(count: usize) -> String {
    if count == 1 {
        "an element of this file does not".to_owned()
    } else {
        format!("{count} elements of this file don't")
    }
}
