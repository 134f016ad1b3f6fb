//! Points and lines: meshes about them of one radius in the world, since glTF says nothing of how
//! thick they are.
//!
//! The radius is that of a pixel in the picture that is made of an asset without cameras. It is
//! chosen once, so size, crop and camera of a picture leave the scene as it is.

use super::super::document::Document;
use super::super::primitive::{Primitive, TRIANGLES};
use super::super::report::AssetReport;
use super::mesh::{self, WantedMesh, to_u32};
use super::place::Places;
use super::{camera, topology};
use glam::{DAffine3, DMat3};
use rtc_ir::{Ball, Column, Field, Mesh, MeshId, Noun, Origins, Place, Scene};
use rtc_math::{Vec3, unit};
use rtc_source::Resource;

/// The radius, in pixels.
const RADIUS: f64 = 1.0;
/// From so many on, points have the simplest solid.
const MANY: u64 = 1 << 15;
/// Bytes of the offset of a corner, and of a triangle until it is rendered.
const OFFSET: u64 = 12;
const TRIANGLE: u64 = 108;

/// What a point or a line becomes: with normals a disc or a ribbon that faces them, so that it is lit
/// as they say, else a solid.
struct Solid {
    /// From the point, or one end of a line: which end, and the offset at radius 1. Along a line lies
    /// z, and y towards its normal; along the normal of a point lies z.
    corners: &'static [(usize, [f64; 3])],
    triangles: &'static [[u32; 3]],
}

/// 1/√3.
const EDGE: f64 = 0.577_350_269_189_625_8;

static TETRAHEDRON: Solid = Solid {
    corners: &[
        (0, [EDGE, EDGE, EDGE]),
        (0, [EDGE, -EDGE, -EDGE]),
        (0, [-EDGE, EDGE, -EDGE]),
        (0, [-EDGE, -EDGE, EDGE]),
    ],
    triangles: &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
};

static OCTAHEDRON: Solid = Solid {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [0.0, 1.0, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (0, [0.0, -1.0, 0.0]),
        (0, [0.0, 0.0, 1.0]),
        (0, [0.0, 0.0, -1.0]),
    ],
    triangles: &[
        [0, 1, 4],
        [1, 2, 4],
        [2, 3, 4],
        [3, 0, 4],
        [1, 0, 5],
        [2, 1, 5],
        [3, 2, 5],
        [0, 3, 5],
    ],
};

/// A prism with four sides and no ends, which at this width are not seen.
static PRISM: Solid = Solid {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [0.0, 1.0, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (0, [0.0, -1.0, 0.0]),
        (1, [1.0, 0.0, 0.0]),
        (1, [0.0, 1.0, 0.0]),
        (1, [-1.0, 0.0, 0.0]),
        (1, [0.0, -1.0, 0.0]),
    ],
    triangles: &[
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ],
};

/// √3/2.
const HEIGHT: f64 = 0.866_025_403_784_438_6;

static DISC: Solid = Solid {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [0.5, HEIGHT, 0.0]),
        (0, [-0.5, HEIGHT, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (0, [-0.5, -HEIGHT, 0.0]),
        (0, [0.5, -HEIGHT, 0.0]),
    ],
    triangles: &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]],
};

static RIBBON: Solid = Solid {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (1, [-1.0, 0.0, 0.0]),
        (1, [1.0, 0.0, 0.0]),
    ],
    triangles: &[[0, 1, 2], [0, 2, 3]],
};

/// The meshes of points and lines that were made, each with the offsets of its corners at radius 1.
#[derive(Default)]
pub(super) struct Strokes(Vec<(MeshId, Column<3>)>);

/// True if the primitive has points or lines.
pub(super) fn is_stroked(primitive: &Primitive) -> bool {
    primitive.mode < TRIANGLES
}

impl Strokes {
    /// The meshes of a primitive of points or lines at its places, still without a radius, and where
    /// each stands; none where it shows nothing or asks for too much.
    pub(super) fn make(
        &mut self,
        doc: &Document<'_>,
        wanted: &WantedMesh<'_, '_>,
        places: &Places<'_>,
        (scene, origins): (&mut Scene, &mut Origins),
        report: &mut AssetReport<'_, '_>,
    ) -> Vec<(MeshId, DAffine3)> {
        let primitive = wanted.primitive;
        let Some(solid) = charge(doc, wanted, places.count() as u64, report) else {
            return Vec::new();
        };
        let source = mesh::vertices(doc, wanted);
        let ends = source
            .as_ref()
            .and_then(|source| topology::strokes(doc, primitive, source.positions.len()));
        let (Some(source), Some(ends)) = (source, ends) else {
            return Vec::new();
        };
        let mut made = Vec::new();
        for at in 0..places.count() {
            let Some((mesh, offsets, world)) = thin(&source, &ends, places.at(at), solid) else {
                continue;
            };
            let place = Place::new(Noun::Mesh, scene.meshes.len(), Field::Whole);
            origins.record(place, report.json.span(primitive.at));
            let id = MeshId(to_u32(scene.meshes.len()));
            scene.meshes.push(mesh);
            self.0.push((id, offsets));
            made.push((id, world));
        }
        made
    }

    /// Gives all points and lines their radius, once the scene is known.
    pub(super) fn thicken(&self, scene: &mut Scene) {
        if self.0.is_empty() {
            return;
        }
        let one = Ball {
            center: Vec3::ZERO,
            radius: 1.0,
        };
        let radius = RADIUS * camera::pixel(scene.ball().unwrap_or(one));
        for (id, offsets) in &self.0 {
            let Some(mesh) = scene.meshes.get_mut(id.0 as usize) else {
                continue;
            };
            let corners = mesh.positions.iter().zip(offsets.iter());
            let moved = corners.map(|(p, offset)| {
                (Vec3::from_array(p) + radius * Vec3::from_array(offset)).to_array()
            });
            mesh.positions = Column::rounded(moved.collect::<Vec<_>>());
        }
    }
}

/// Charges the points or lines of a primitive at so many places; the solid that they get comes back,
/// none if that is too much.
fn charge(
    doc: &Document<'_>,
    wanted: &WantedMesh<'_, '_>,
    places: u64,
    report: &mut AssetReport<'_, '_>,
) -> Option<&'static Solid> {
    const POINTS: u64 = 0;
    const LINES: u64 = 1;
    let primitive = wanted.primitive;
    let corners = mesh::corners(doc, primitive);
    let solid = match (primitive.mode, primitive.find("NORMAL").is_some()) {
        (POINTS, true) => &DISC,
        (POINTS, false) if corners < MANY => &OCTAHEDRON,
        (POINTS, false) => &TETRAHEDRON,
        (_, true) => &RIBBON,
        (_, false) => &PRISM,
    };
    let count = match primitive.mode {
        LINES => corners / 2,
        _ => corners,
    };
    let count = count.saturating_mul(places);
    let vertices = count.saturating_mul(solid.corners.len() as u64);
    let triangles = count.saturating_mul(solid.triangles.len() as u64);
    let vertex = OFFSET + mesh::vertex(primitive, wanted.uv_sets);
    let memory = vertices
        .saturating_mul(vertex)
        .saturating_add(triangles.saturating_mul(TRIANGLE));
    let (at, what) = (primitive.at, "the primitive");
    let is_small = mesh::charge(doc, wanted, report)
        && report.charge(Resource::Vertices, vertices, at, what)
        && report.charge(Resource::Memory, memory, at, what);
    is_small.then_some(solid)
}

/// Solids without a radius about points, which are lines from a vertex to itself, or lines: a mesh
/// about its first vertex, the offsets of its corners, and where it stands.
fn thin(
    source: &Mesh,
    ends: &[[u32; 2]],
    world: DAffine3,
    solid: &Solid,
) -> Option<(Mesh, Column<3>, DAffine3)> {
    let place = |vertex: u32| {
        let own = Vec3::from_array(source.positions.at(vertex as usize));
        world.transform_point3(own)
    };
    // Normals turn with the inverse transpose.
    let turned = world.matrix3.inverse().transpose();
    let normal = |vertex: u32| {
        let has_normals = !source.normals.is_empty();
        let own = has_normals.then(|| Vec3::from_array(source.normals.at(vertex as usize)));
        own.and_then(|own| unit(turned * own))
    };
    let (mut vertices, mut offsets, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for ends in ends {
        let frame = frame(ends.map(place), normal(ends[0]));
        let first = to_u32(vertices.len());
        for (end, offset) in solid.corners {
            vertices.push(ends[*end]);
            offsets.push((frame * Vec3::from_array(*offset)).to_array());
        }
        let own = solid.triangles.iter();
        triangles.extend(own.map(|corners| corners.map(|corner| first + corner)));
    }
    let anchor = place(*vertices.first()?);
    let mut mesh = Mesh {
        tangents: Column::default(),
        ..source.clone()
    };
    mesh::pick(&mut mesh, &vertices);
    mesh.positions = Column::rounded(vertices.iter().map(|at| (place(*at) - anchor).to_array()));
    if !mesh.normals.is_empty() {
        let normals = vertices.iter().map(|at| normal(*at).unwrap_or(Vec3::Z));
        mesh.normals = Column::rounded(normals.map(|normal| normal.to_array()));
    }
    mesh.triangles = triangles.into();
    let is_sound = anchor.is_finite() && mesh::is_finite(&mesh);
    let world = DAffine3::from_translation(anchor);
    is_sound.then(|| (mesh, Column::rounded(offsets), world))
}

/// The axes of the solid of a point or a line.
fn frame([from, to]: [Vec3; 2], normal: Option<Vec3>) -> DMat3 {
    let along = unit(to - from);
    let z = along.or(normal).unwrap_or(Vec3::Z);
    let across = along.and_then(|along| unit(normal?.cross(along)));
    match across {
        Some(x) => DMat3::from_cols(x, z.cross(x), z),
        None => {
            let (x, y) = z.any_orthonormal_pair();
            DMat3::from_cols(x, y, z)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn discs_and_ribbons_face_their_normals() {
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let cases = [(&DISC, [Vec3::ONE; 2]), (&RIBBON, [Vec3::ZERO, Vec3::Y])];
        for (solid, ends) in cases {
            let frame = frame(ends, Some(normal));
            let corner = |at: u32| {
                let (end, offset) = solid.corners[at as usize];
                ends[end] + frame * Vec3::from_array(offset)
            };
            for triangle in solid.triangles {
                let [a, b, c] = triangle.map(corner);
                let own = (b - a).cross(c - a).normalize();
                assert!((own - normal).length() < 1e-12, "{own}");
            }
        }
    }

    /// The volume by the divergence theorem, of a prism of height 1 its part of the sides.
    fn volume(solid: &Solid) -> f64 {
        let corner = |at: u32| {
            let (end, offset) = solid.corners[at as usize];
            Vec3::from_array(offset) + Vec3::Z * if end == 1 { 1.0 } else { 0.0 }
        };
        let parts = solid.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(corner);
            a.dot(b.cross(c)) / 6.0
        });
        parts.sum()
    }

    #[test]
    fn solids_turn_outward() {
        assert!((volume(&OCTAHEDRON) - 4.0 / 3.0).abs() < 1e-12);
        let edge = 2.0 * 2.0_f64.sqrt() * EDGE;
        let tetrahedron = edge * edge * edge / (6.0 * 2.0_f64.sqrt());
        assert!((volume(&TETRAHEDRON) - tetrahedron).abs() < 1e-12);
        // The sides of a prism are two thirds of the flux, its ends the rest.
        assert!((volume(&PRISM) - 2.0 * 2.0 / 3.0).abs() < 1e-12);
    }
}
