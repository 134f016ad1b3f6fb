//! Meshes: the attributes of a primitive as the IR has them; what is the same is made once.

use super::super::document::Document;
use super::super::elements::Elements;
use super::super::mesh::Primitive;
use super::super::report::Report;
use super::deform::{self, Shape};
use super::{tangent, topology};
use crate::diag::codes;
use crate::ir::{self, Column, Field, Mesh, MeshId, Noun, Origins, Place, Scene, Shared};

/// Vertices and indices that are made for each element of the accessors, and beside that.
const MAX_RATIO: usize = 16;
const FREE: usize = 1 << 20;

/// The meshes that were made.
pub(super) struct Meshes {
    made: Vec<(Key, MeshId)>,
    /// Vertices and indices that may still be made.
    left: usize,
}

/// What a mesh is made of.
#[derive(PartialEq)]
struct Key {
    attributes: Vec<(String, usize)>,
    targets: Vec<Vec<(String, usize)>>,
    indices: Option<usize>,
    mode: u64,
    shape: Shape,
    needs_tangents: bool,
}

/// A mesh that is wanted.
pub(super) struct Wanted<'w> {
    pub(super) primitive: &'w Primitive,
    pub(super) name: &'w str,
    pub(super) shape: &'w Shape,
    pub(super) needs_tangents: bool,
}

impl Meshes {
    pub(super) fn new(doc: &Document<'_>) -> Self {
        let elements = doc.accessors.iter().filter_map(|accessor| accessor.count).fold(0, usize::saturating_add);
        Self { made: Vec::new(), left: elements.saturating_mul(MAX_RATIO).saturating_add(FREE) }
    }

    /// The mesh of a primitive; none if it has no surface.
    pub(super) fn make(
        &mut self,
        doc: &Document<'_>,
        wanted: &Wanted<'_>,
        scene: &mut Scene,
        origins: &mut Origins,
        report: &mut Report<'_, '_>,
    ) -> Option<MeshId> {
        let key = key(wanted);
        if let Some((_, id)) = self.made.iter().rev().find(|(own, _)| *own == key) {
            return Some(*id);
        }
        let mesh = read(doc, wanted)?;
        let Some(left) = self.left.checked_sub(mesh.positions.len() + 3 * mesh.triangles.len()) else {
            let message = "the primitives before this one use the accessors many times over already".to_owned();
            report.say(&codes::GLTF_HUGE, "", wanted.primitive.at, message);
            return None;
        };
        self.left = left;
        let id = MeshId(to_u32(scene.meshes.len()));
        origins.record(Place::new(Noun::Mesh, scene.meshes.len(), Field::Whole), report.json.span(wanted.primitive.at));
        scene.meshes.push(mesh);
        self.made.push((key, id));
        Some(id)
    }
}

fn key(wanted: &Wanted<'_>) -> Key {
    let Wanted { primitive, name: _, shape, needs_tangents } = wanted;
    let pairs = |attributes: &[super::super::mesh::Attribute]| {
        attributes.iter().map(|attribute| (attribute.name.clone(), attribute.accessor)).collect()
    };
    Key {
        attributes: pairs(&primitive.attributes),
        targets: primitive.targets.iter().map(|target| pairs(target)).collect(),
        indices: primitive.indices,
        mode: primitive.mode,
        shape: (*shape).clone(),
        needs_tangents: *needs_tangents,
    }
}

/// Reads a primitive, moves its vertices, and gives it tangents if it needs them.
fn read(doc: &Document<'_>, wanted: &Wanted<'_>) -> Option<Mesh> {
    let Wanted { primitive, name, shape, needs_tangents } = wanted;
    let elements = |name: &str| Elements::of(doc, doc.accessors.get(primitive.find(name)?)?);
    let positions = elements("POSITION")?.column();
    let count = positions.len();
    let mut triangles = topology::triangles(doc, primitive, count)?;
    let normals = elements("NORMAL").map_or_else(Column::default, |normals| normals.column());
    // Without normals tangents mean nothing (glTF 2.0, section 3.7.2.1).
    let tangents = elements("TANGENT").filter(|_| !normals.is_empty());
    let uvs = |name| elements(name).map_or_else(Column::default, |uvs| uvs.column());
    let mut mesh = ir::Mesh {
        name: (*name).to_owned(),
        positions,
        normals,
        uvs: uvs("TEXCOORD_0"),
        second_uvs: uvs("TEXCOORD_1"),
        tangents: tangents.map_or_else(Column::default, |tangents| tangents.column()),
        colors: elements("COLOR_0").map_or_else(Column::default, |own| colors(&own)),
        triangles: Shared::default(),
    };
    deform::deform(doc, primitive, shape, &mut mesh);
    if let Some(kept) = topology::compact(&mut triangles, count) {
        pick(&mut mesh, &kept);
    }
    mesh.triangles = triangles.into();
    if *needs_tangents && mesh.tangents.is_empty() {
        tangent::generate(&mut mesh);
    }
    Some(mesh)
}

/// Colours with alpha, each channel from 0 to 1.
fn colors(elements: &Elements<'_>) -> Column<4> {
    let has_alpha = elements.layout.components() == 4;
    let colors = elements.vectors().into_iter();
    clamped(colors.map(|[r, g, b, alpha]| [r, g, b, if has_alpha { alpha } else { 1.0 }]))
}

/// Colours, each channel kept from 0 to 1.
pub(super) fn clamped(colors: impl Iterator<Item = [f64; 4]>) -> Column<4> {
    Column::rounded(colors.map(|color| color.map(|channel| channel.clamp(0.0, 1.0))))
}

/// Makes a mesh of these vertices of it, whatever its triangles say.
pub(super) fn pick(mesh: &mut Mesh, vertices: &[u32]) {
    let Mesh { name: _, positions, normals, uvs, second_uvs, tangents, colors, triangles: _ } = mesh;
    *positions = positions.pick(vertices);
    *normals = normals.pick(vertices);
    *uvs = uvs.pick(vertices);
    *second_uvs = second_uvs.pick(vertices);
    *tangents = tangents.pick(vertices);
    *colors = colors.pick(vertices);
}

/// A count of a scene, which is far below 2^32.
pub(super) fn to_u32(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
