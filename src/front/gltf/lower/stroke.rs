//! Points and lines: meshes of one radius in world space, since glTF does not define their width.
//!
//! The radius is that of a pixel in the default picture of an asset without cameras. It is chosen
//! once, so size, crop and camera of a picture leave the scene unchanged.

use super::super::document::Document;
use super::super::primitive::{Primitive, TRIANGLES};
use super::super::report::AssetReport;
use super::mesh::{self, MeshKey, RequestedMesh};
use super::topology;
use super::transform::InstanceTransforms;
use crate::glyph::{StrokeShape, point_radius, radius, spacing, thin_glyphs};
use glam::DAffine3;
use rtc_ir::{
    BoundingSphere, EntityField, EntityKind, Mesh, MeshId, Scene, SourceSpans, ValuePath,
    VertexColumn,
};
use rtc_math::{Vec3, to_u32};
use rtc_source::Resource;
use std::collections::BTreeMap;

/// Bytes of the offset of a corner, and of a triangle until it is rendered.
const OFFSET: u64 = 12;
const TRIANGLE: u64 = 108;

/// The meshes of points and lines that were made.
#[derive(Default)]
pub(super) struct StrokeMeshes {
    /// Each with the offsets of its corners at radius 1, and the number of points; 0 of lines.
    made: Vec<(MeshId, VertexColumn<3>, usize)>,
    /// For each request, by the linear part of its transform, the mesh and the position of its
    /// first vertex; `None` where it is invisible.
    known: BTreeMap<(MeshKey, LinearPartBits), Option<(MeshId, Vec3)>>,
}

/// The bits of the linear part of a transform.
type LinearPartBits = [u64; 9];

/// True if the primitive has points or lines.
pub(super) fn is_stroked(primitive: &Primitive) -> bool {
    primitive.mode < TRIANGLES
}

impl StrokeMeshes {
    /// The meshes of a primitive of points or lines at its transforms, still without a radius, and
    /// their positions; `None` where it is invisible or exceeds the budget. Transforms that differ
    /// only in translation share a mesh.
    pub(super) fn make(
        &mut self,
        doc: &Document<'_>,
        (wanted, key): (&RequestedMesh<'_, '_>, MeshKey),
        places: &InstanceTransforms<'_>,
        (scene, source_spans): (&mut Scene, &mut SourceSpans),
        report: &mut AssetReport<'_, '_>,
    ) -> Vec<(MeshId, DAffine3)> {
        let (mut shown, mut source) = (Vec::new(), None);
        for at in 0..places.count() {
            let world = places.at(at);
            // Instances of one linear part share a mesh, as glyphs have a fixed size.
            let turn = world.matrix3.to_cols_array().map(f64::to_bits);
            let known = self.known.get(&(key, turn)).copied();
            let made = match known {
                Some(known) => known,
                None => {
                    // Charge before the vertices are read.
                    let Some(solid) = charge(doc, wanted, source.is_some(), report) else {
                        return shown;
                    };
                    let source = source.get_or_insert_with(|| StrokeSource::read(doc, wanted));
                    let made = source.as_ref().and_then(|source| {
                        // Build a thin solid for each point or line.
                        let (mesh, offsets, _) =
                            thin_glyphs(&source.mesh, &source.ends, world, solid)?;
                        let place = ValuePath::new(
                            EntityKind::Mesh,
                            scene.meshes.len(),
                            EntityField::Whole,
                        );
                        source_spans.record(place, report.json.span(wanted.primitive.at));
                        let id = MeshId(to_u32(scene.meshes.len()));
                        scene.meshes.push(mesh);
                        let points = match wanted.primitive.mode {
                            0 => source.ends.len(),
                            _ => 0,
                        };
                        self.made.push((id, offsets, points));
                        Some((id, source.first()?))
                    });
                    self.known.insert((key, turn), made);
                    made
                }
            };
            // Place the mesh by the translation of its first vertex.
            shown.extend(made.map(|(id, first)| {
                let anchor = world.transform_point3(first);
                (id, DAffine3::from_translation(anchor))
            }));
        }
        shown
    }

    /// Gives all points and lines their radius, once the scene is known.
    pub(super) fn set_radius(&self, scene: &mut Scene, point_size: Option<f64>) {
        if self.made.is_empty() {
            return;
        }
        let one = BoundingSphere {
            center: Vec3::ZERO,
            radius: 1.0,
        };
        let ball = scene.bounding_sphere().unwrap_or(one);
        for (id, offsets, points) in &self.made {
            let Some(mesh) = scene.meshes.get_mut(id.0 as usize) else {
                continue;
            };
            let radius = match mesh.positions.len().checked_div(*points) {
                Some(corners) => {
                    let point = |at: usize| Vec3::from_array(mesh.positions.at(at * corners));
                    point_radius(ball, point_size, spacing(*points, point))
                }
                None => radius(ball),
            };
            let corners = mesh.positions.iter().zip(offsets.iter());
            let animated = corners.map(|(p, offset)| {
                (Vec3::from_array(p) + radius * Vec3::from_array(offset)).to_array()
            });
            mesh.positions = VertexColumn::rounded(animated.collect::<Vec<_>>());
        }
    }
}

/// The vertices of a primitive, and between which of them it has points or lines.
struct StrokeSource {
    mesh: Mesh,
    ends: Vec<[u32; 2]>,
}

impl StrokeSource {
    fn read(doc: &Document<'_>, wanted: &RequestedMesh<'_, '_>) -> Option<Self> {
        let mesh = mesh::vertices(doc, wanted)?;
        let ends = topology::strokes(doc, wanted.primitive, mesh.positions.len())?;
        Some(Self { mesh, ends })
    }

    /// The position of the first vertex, the origin of a mesh of strokes.
    fn first(&self) -> Option<Vec3> {
        let [from, _] = self.ends.first()?;
        Some(Vec3::from_array(self.mesh.positions.at(*from as usize)))
    }
}

/// Charges the points or lines of a primitive, turned in one way; the solid that they get comes
/// back, none if that is too much.
fn charge(
    doc: &Document<'_>,
    wanted: &RequestedMesh<'_, '_>,
    is_read: bool,
    report: &mut AssetReport<'_, '_>,
) -> Option<&'static StrokeShape> {
    const POINTS: u64 = 0;
    const LINES: u64 = 1;
    let primitive = wanted.primitive;
    let corners = mesh::corners(doc, primitive);
    let has_normals = primitive.find("NORMAL").is_some();
    let solid = StrokeShape::of(primitive.mode == POINTS, has_normals, corners);
    let count = match primitive.mode {
        LINES => corners / 2,
        _ => corners,
    };
    let vertices = count.saturating_mul(solid.corners.len() as u64);
    let triangles = count.saturating_mul(solid.triangles.len() as u64);
    let vertex = OFFSET + mesh::vertex(primitive, wanted.uv_sets);
    let memory = vertices
        .saturating_mul(vertex)
        .saturating_add(triangles.saturating_mul(TRIANGLE));
    let (at, what) = (primitive.at, "the primitive");
    let is_small = (is_read || mesh::charge(doc, wanted, report))
        && report.charge(Resource::Vertices, vertices, at, what)
        && report.charge(Resource::Memory, memory, at, what);
    is_small.then_some(solid)
}
