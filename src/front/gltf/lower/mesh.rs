//! Meshes: the attributes of a primitive as an IR mesh. Equal primitives share a mesh.

use super::super::accessor_reader::AccessorReader;
use super::super::attribute::VertexAttribute;
use super::super::document::Document;
use super::super::primitive::{Primitive, TRIANGLES};
use super::super::report::AssetReport;
use super::shape::{Deformation, ShapeId};
use super::tangent::{self, TangentCoords};
use super::uv::TexCoordSets;
use super::{deform, topology};
use crate::glyph::pick;
use rtc_ir::{
    self as ir, EntityField, EntityKind, Mesh, MeshId, Scene, SharedList, SourceSpans, ValuePath,
    VertexColumn,
};
use rtc_math::{Vec3, to_u32};
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Bytes that a corner of a triangle takes, and a triangle until it is rendered.
const CORNER: u64 = 4;
const TRIANGLE: u64 = 96;
/// Bytes that a vertex takes while morph targets or joints move it.
const MOVED: u64 = 96;
/// The number of vertices and bytes per corner with tangents.
const TANGENT: u64 = 4;
const TANGENT_BYTES: u64 = 128;

/// The meshes that were made.
pub(super) struct ImportedMeshes<'d> {
    /// The distinct sources of primitives, and the source of each primitive.
    parts: BTreeMap<PrimitiveData<'d>, usize>,
    of_primitive: BTreeMap<NodeId, usize>,
    /// The mesh of each request; `None` if it has no surface.
    made: BTreeMap<MeshKey, Option<MeshId>>,
}

/// The key by which two requested meshes are the same.
pub(super) type MeshKey = (usize, ShapeId, Option<TangentCoords>, TexCoordSets);

/// Names and accessors.
type AttributeAccessors<'d> = Vec<(&'d str, usize)>;

/// The source data of a primitive.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct PrimitiveData<'d> {
    attributes: AttributeAccessors<'d>,
    targets: Vec<AttributeAccessors<'d>>,
    indices: Option<usize>,
    mode: u64,
}

/// A requested mesh.
pub(super) struct RequestedMesh<'d, 'w> {
    pub(super) primitive: &'d Primitive,
    pub(super) name: &'d str,
    pub(super) shape: (ShapeId, Deformation<'w>),
    /// What its tangents follow, if its material needs them.
    pub(super) tangents: Option<TangentCoords>,
    pub(super) uv_sets: TexCoordSets,
}

impl<'d> ImportedMeshes<'d> {
    pub(super) fn new() -> Self {
        Self {
            parts: BTreeMap::new(),
            of_primitive: BTreeMap::new(),
            made: BTreeMap::new(),
        }
    }

    /// The mesh of a primitive of the document; `None` if it has no surface, or exceeds the budget.
    pub(super) fn make(
        &mut self,
        doc: &'d Document<'_>,
        wanted: &RequestedMesh<'d, '_>,
        scene: &mut Scene,
        source_spans: &mut SourceSpans,
        report: &mut AssetReport<'_, '_>,
    ) -> Option<MeshId> {
        let primitive = wanted.primitive;
        let key = self.key(wanted);
        let known = self.made.get(&key).copied();
        let made = known.unwrap_or_else(|| {
            let is_small = charge(doc, wanted, report);
            let mesh = is_small
                .then(|| read(doc, wanted, report.is_lenient()))
                .flatten()?;
            let id = MeshId(to_u32(scene.meshes.len()));
            source_spans.record(
                ValuePath::new(EntityKind::Mesh, scene.meshes.len(), EntityField::Whole),
                report.json.span(primitive.at),
            );
            scene.meshes.push(mesh);
            Some(id)
        });
        if known.is_none() {
            self.made.insert(key, made);
        }
        made
    }

    /// The key of a requested mesh.
    pub(super) fn key(&mut self, wanted: &RequestedMesh<'d, '_>) -> MeshKey {
        let (tangents, uv_sets) = (wanted.tangents, wanted.uv_sets);
        let parts = self.parts(wanted.primitive);
        (parts, wanted.shape.0, tangents, uv_sets)
    }

    /// The id of the source data of a primitive.
    fn parts(&mut self, primitive: &'d Primitive) -> usize {
        let Self {
            parts,
            of_primitive,
            made: _,
        } = self;
        *of_primitive.entry(primitive.at).or_insert_with(|| {
            let next = parts.len();
            *parts.entry(PrimitiveData::of(primitive)).or_insert(next)
        })
    }
}

impl<'d> PrimitiveData<'d> {
    fn of(primitive: &'d Primitive) -> Self {
        let pairs = |attributes: &'d [VertexAttribute]| -> AttributeAccessors<'d> {
            attributes
                .iter()
                .map(|attribute| (attribute.name.as_str(), attribute.accessor))
                .collect()
        };
        Self {
            attributes: pairs(&primitive.attributes),
            targets: primitive
                .targets
                .iter()
                .map(|target| pairs(target))
                .collect(),
            indices: primitive.indices,
            mode: primitive.mode,
        }
    }
}

/// The number of elements of an accessor.
fn count(doc: &Document<'_>, accessor: usize) -> u64 {
    let accessor = doc
        .accessors
        .get(accessor)
        .and_then(|accessor| accessor.count);
    accessor.unwrap_or(0) as u64
}

/// The number of vertices of a primitive.
pub(super) fn vertices_of(doc: &Document<'_>, primitive: &Primitive) -> u64 {
    primitive
        .find("POSITION")
        .map_or(0, |accessor| count(doc, accessor))
}

/// The number of corners of the parts of a primitive.
pub(super) fn corners(doc: &Document<'_>, primitive: &Primitive) -> u64 {
    let accessor = primitive.indices.map(|indices| count(doc, indices));
    accessor.unwrap_or_else(|| vertices_of(doc, primitive))
}

/// Charges a mesh: the vertices once for themselves and once for each attribute of a morph target
/// and set of joints that moves them. False if that is too much.
pub(super) fn charge(
    doc: &Document<'_>,
    wanted: &RequestedMesh<'_, '_>,
    report: &mut AssetReport<'_, '_>,
) -> bool {
    let RequestedMesh {
        primitive,
        name,
        shape: (_, shape),
        tangents,
        uv_sets,
    } = wanted;
    let (vertices, corners) = (vertices_of(doc, primitive), corners(doc, primitive));
    // Strips and fans have one triangle per corner at most.
    let triangles = match primitive.mode.cmp(&TRIANGLES) {
        Ordering::Less => 0,
        Ordering::Equal => corners / 3,
        Ordering::Greater => corners,
    };
    // Missing tangents are generated for each corner.
    let tangents = if tangents.is_some() && primitive.find("TANGENT").is_none() {
        3 * triangles
    } else {
        0
    };
    // Morph targets and joints move every vertex once each.
    let targets = primitive
        .targets
        .iter()
        .zip(shape.weights)
        .filter(|(_, weight)| **weight != 0.0);
    let targets: u64 = targets.map(|(target, _)| target.len() as u64).sum();
    let sets = shape
        .joints
        .map_or(0, |_| primitive.influences().count() as u64);
    let is_moved = targets + sets > 0;
    let vertex = vertex(primitive, *uv_sets) + if is_moved { MOVED } else { 0 };
    // Charge work and memory before the mesh is built.
    let work = vertices
        .saturating_mul(1 + targets + sets)
        .saturating_add(corners + TANGENT * tangents);
    let memory = [
        vertices * vertex,
        corners * CORNER,
        triangles * TRIANGLE,
        tangents * TANGENT_BYTES,
        name.len() as u64,
    ];
    let memory = memory.into_iter().fold(0, u64::saturating_add);
    report.charge(Resource::Vertices, work, primitive.at, "the mesh")
        && report.charge(Resource::Memory, memory, primitive.at, "the mesh")
}

/// Bytes of the attributes of a vertex.
pub(super) fn vertex(primitive: &Primitive, sets: TexCoordSets) -> u64 {
    let [first, second] = &sets.names();
    let columns = [
        ("POSITION", 12),
        ("NORMAL", 12),
        ("TANGENT", 16),
        (first, 8),
        (second, 8),
        ("COLOR_0", 16),
    ];
    let columns = columns.into_iter();
    let accessor = columns.filter(|(name, _)| primitive.find(name).is_some());
    accessor.map(|(_, size)| size).sum()
}

/// Reads a primitive, moves its vertices, and gives it tangents if it needs them. Lenient, vertices
/// that no triangle uses may be anything.
fn read(doc: &Document<'_>, wanted: &RequestedMesh<'_, '_>, is_lenient: bool) -> Option<Mesh> {
    let count = usize::try_from(vertices_of(doc, wanted.primitive)).ok()?;
    let mut triangles = topology::triangles(doc, wanted.primitive, count)?;
    let mut mesh = vertices(doc, wanted)?;
    let is_finite = !is_lenient || mesh.is_finite();
    if let Some(kept) = topology::compact(&mut triangles, count, !is_finite) {
        pick(&mut mesh, &kept);
    }
    mesh.triangles = triangles.into();
    if let Some(coords) = wanted.tangents
        && mesh.tangents.is_empty()
    {
        tangent::generate(&mut mesh, coords);
    }
    Some(mesh)
}

/// The positions of the vertices of a primitive that it shows, moved.
pub(super) fn used_points(
    doc: &Document<'_>,
    wanted: &RequestedMesh<'_, '_>,
    is_lenient: bool,
) -> Option<Vec<Vec3>> {
    let mesh = match wanted.primitive.mode.cmp(&TRIANGLES) {
        Ordering::Less => vertices(doc, wanted)?,
        Ordering::Equal | Ordering::Greater => read(doc, wanted, is_lenient)?,
    };
    Some(mesh.positions.iter().map(Vec3::from_array).collect())
}

/// Reads the vertices of a primitive, and moves them.
pub(super) fn vertices(doc: &Document<'_>, wanted: &RequestedMesh<'_, '_>) -> Option<Mesh> {
    let RequestedMesh {
        primitive,
        name,
        shape: (_, shape),
        tangents: _,
        uv_sets,
    } = wanted;
    let elements = |name: &str| AccessorReader::of(doc, doc.accessors.get(primitive.find(name)?)?);
    let positions = elements("POSITION")?.column();
    let normals = elements("NORMAL").map_or_else(VertexColumn::default, |normals| normals.column());
    // Tangents without normals are ignored (glTF 2.0, section 3.7.2.1).
    let tangents = elements("TANGENT").filter(|_| !normals.is_empty());
    let [first, second] = &uv_sets.names();
    let uvs = |name: &str| elements(name).map_or_else(VertexColumn::default, |uvs| uvs.column());
    let mut mesh = ir::Mesh {
        name: (*name).to_owned(),
        part: None,
        positions,
        normals,
        uvs: uvs(first),
        second_uvs: Some(second)
            .filter(|second| *second != first)
            .map_or_else(VertexColumn::default, |second| uvs(second)),
        tangents: tangents.map_or_else(VertexColumn::default, |tangents| tangents.column()),
        colors: elements("COLOR_0")
            .map_or_else(VertexColumn::default, |accessor| colors(&accessor)),
        triangles: SharedList::default(),
    };
    deform::deform(doc, primitive, (*shape, *uv_sets), &mut mesh);
    Some(mesh)
}

/// Colours with alpha, each channel from 0 to 1.
fn colors(elements: &AccessorReader<'_>) -> VertexColumn<4> {
    let has_alpha = elements.layout.components() == 4;
    let colors = elements.vectors().into_iter();
    clamped(colors.map(|[r, g, b, alpha]| [r, g, b, if has_alpha { alpha } else { 1.0 }]))
}

/// Colours, each channel kept from 0 to 1.
pub(super) fn clamped(colors: impl Iterator<Item = [f64; 4]>) -> VertexColumn<4> {
    VertexColumn::rounded(colors.map(|color| color.map(|channel| channel.clamp(0.0, 1.0))))
}
