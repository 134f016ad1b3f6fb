//! Meshes: the attributes of a primitive as the IR has them; what is the same is made once.

use super::super::accessor::Layout;
use super::super::document::Document;
use super::super::elements::Elements;
use super::super::mesh::Primitive;
use super::super::report::Report;
use super::deform::{self, Shape};
use super::{tangent, topology};
use crate::diag::codes;
use crate::ir::{self, Field, Mesh, MeshId, Noun, Origins, Place, Scene};

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
        let Some(mesh) = read(doc, wanted) else {
            let message = "the primitive has points or lines or no positions, so it does not show".to_owned();
            report.say(&codes::GLTF_REMARK, "", wanted.primitive.at, message);
            return None;
        };
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
    let positions = elements("POSITION")?.vectors::<3>();
    let count = positions.len();
    let mut triangles = topology::triangles(doc, primitive, count)?;
    let normals = elements("NORMAL").map_or_else(Vec::new, |normals| normals.vectors::<3>());
    // Without normals tangents mean nothing (glTF 2.0, section 3.7.2.1).
    let tangents = elements("TANGENT").filter(|_| !normals.is_empty());
    let uvs = |name| elements(name).map_or_else(Vec::new, |uvs| uvs.vectors::<2>());
    let mut mesh = ir::Mesh {
        name: (*name).to_owned(),
        positions,
        normals,
        uvs: uvs("TEXCOORD_0"),
        second_uvs: uvs("TEXCOORD_1"),
        tangents: tangents.map_or_else(Vec::new, |tangents| tangents.vectors::<4>()),
        colors: elements("COLOR_0").map_or_else(Vec::new, |own| colors(&own)),
        triangles: Vec::new(),
    };
    deform::deform(doc, primitive, shape, &mut mesh);
    if let Some(kept) = topology::compact(&mut triangles, count) {
        keep(&mut mesh, &kept);
    }
    mesh.triangles = triangles;
    if *needs_tangents && mesh.tangents.is_empty() {
        tangent::generate(&mut mesh);
    }
    Some(mesh)
}

/// Colours with alpha, each channel from 0 to 1.
fn colors(elements: &Elements<'_>) -> Vec<[f64; 4]> {
    let has_alpha = Layout::components(elements.layout) == 4;
    let mut colors = elements.vectors::<4>();
    for color in &mut colors {
        color[3] = if has_alpha { color[3] } else { 1.0 };
        *color = color.map(|channel| channel.clamp(0.0, 1.0));
    }
    colors
}

fn keep(mesh: &mut Mesh, kept: &[u32]) {
    fn pick<T: Copy>(from: &mut Vec<T>, kept: &[u32]) {
        if !from.is_empty() {
            *from = kept.iter().map(|vertex| from[*vertex as usize]).collect();
        }
    }
    let Mesh { name: _, positions, normals, uvs, second_uvs, tangents, colors, triangles: _ } = mesh;
    pick(positions, kept);
    pick(normals, kept);
    pick(uvs, kept);
    pick(second_uvs, kept);
    pick(tangents, kept);
    pick(colors, kept);
}

/// A count of a scene, which is far below 2^32.
pub(super) fn to_u32(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
