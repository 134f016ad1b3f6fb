//! Tangents where an asset has none: those of MikkTSpace, as glTF prescribes, along the texture
//! coordinates by which the material looks up its normal map.
//!
//! Corners of one vertex may get different tangents, so vertices are split where they do.
//!
//! MikkTSpace compares all corners at a position with each other. So a position with very many
//! corners is split into several.

use crate::glyph::pick;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use rtc_ir::{Map, Mesh, Standard, VertexColumn};
use rtc_math::{Vec3, to_u32};

/// The texture coordinates that tangents follow: those of the vertices, or how a map transforms
/// them, without the offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TangentCoords {
    /// The set of the mesh, 0 or 1.
    set: u32,
    /// The bits of the linear part of the transform, by rows.
    linear: [[u64; 2]; 2],
}

/// A mesh with tangents per corner.
struct MeshCorners<'m> {
    mesh: &'m Mesh,
    coords: TangentCoords,
    tangents: Vec<[f64; 4]>,
    /// For each corner, the part of its position; empty if no position is split.
    parts: Vec<u16>,
}

/// The maximum number of corners at a position that are compared with each other.
const MOST: u32 = 512;

/// Functions that give the same bits on every machine.
struct LibmMath;

impl Ops for LibmMath {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        libm::acosf(x)
    }
}

impl TangentCoords {
    /// The first coordinates of the vertices as they are.
    pub(super) const SURFACE: Self = Self {
        set: 0,
        linear: [[1.0_f64.to_bits(), 0], [0, 1.0_f64.to_bits()]],
    };

    /// The coordinates of the first map of a material that follows tangents; `None` if the material
    /// does not use tangents.
    pub(super) fn of(material: &Standard) -> Option<Self> {
        let maps = [&material.normal_map, &material.clearcoat_normal_map];
        let is_anisotropic = material.anisotropy > 0.0;
        let stretch = material.anisotropy_map.as_ref().filter(|_| is_anisotropic);
        let map = maps.into_iter().flatten().chain(stretch).next();
        map.map(Self::of_map)
            .or(is_anisotropic.then_some(Self::SURFACE))
    }

    /// The coordinates of a map.
    fn of_map(map: &Map) -> Self {
        let [[a, b, _], [c, d, _]] = map
            .texture_from_surface
            .unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        // Tangents do not depend on lengths: of a transform along the axes only the signs count.
        let linear = match [b, c] {
            [0.0, 0.0] => [[a.signum(), 0.0], [0.0, d.signum()]],
            _ => [[a, b], [c, d]],
        };
        Self::new(map.set, linear)
    }

    fn new(set: u32, linear: [[f64; 2]; 2]) -> Self {
        Self {
            set,
            linear: linear.map(|row| row.map(f64::to_bits)),
        }
    }

    /// The column of a mesh.
    fn column(self, mesh: &Mesh) -> &VertexColumn<2> {
        match self.set {
            0 => &mesh.uvs,
            _ => &mesh.second_uvs,
        }
    }

    fn at(self, mesh: &Mesh, vertex: usize) -> [f64; 2] {
        let [u, v] = self.column(mesh).at(vertex);
        self.linear.map(|row| {
            let [a, b] = row.map(f64::from_bits);
            a * u + b * v
        })
    }
}

impl MeshCorners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "MikkTSpace computes in 32-bit floats"
)]
impl Geometry<LibmMath> for MeshCorners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        let position = self.mesh.positions.at(self.vertex(face, vert));
        let [x, y, z] = position.map(|number| number as f32);
        let part = self.parts.get(3 * face + vert).copied().unwrap_or(0);
        // The offset in the smallest steps.
        [f32::from_bits(x.to_bits().wrapping_add(part.into())), y, z]
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.mesh
            .normals
            .at(self.vertex(face, vert))
            .map(|number| number as f32)
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        let coords = self.coords.at(self.mesh, self.vertex(face, vert));
        coords.map(|number| number as f32)
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, vert: usize) {
        if let Some(tangent) = tangent {
            let [x, y, z] = tangent.tangent().map(f64::from);
            // MikkTSpace has green along growing v; in glTF v grows downwards, and green is up.
            let sign = if tangent.is_orientation_preserving() {
                -1.0
            } else {
                1.0
            };
            self.tangents[3 * face + vert] = [x, y, z, sign];
        }
    }
}

/// Gives a mesh tangents, and normals if it has none. Without texture coordinates there are none to
/// give.
pub(super) fn generate(mesh: &mut Mesh, coords: TangentCoords) {
    if coords.column(mesh).is_empty() || mesh.triangles.is_empty() {
        return;
    }
    if mesh.normals.is_empty() {
        flatten(mesh);
    }
    let mut corners = MeshCorners {
        mesh,
        coords,
        parts: parts(mesh, coords),
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3 * mesh.triangles.len()],
    };
    if generate_tangents(&mut corners).is_err() {
        return;
    }
    let tangents = corners.tangents;
    split_vertices(mesh, &tangents);
}

/// For each corner, the part of its position; empty if no position is split. Equal corners stay in
/// one part as far as possible.
fn parts(mesh: &Mesh, coords: TangentCoords) -> Vec<u16> {
    if mesh.triangles.len() <= MOST as usize {
        return Vec::new();
    }
    let corners = || mesh.triangles.iter().flatten();
    let mut counts = vec![0_u32; mesh.positions.len()];
    corners().for_each(|corner| counts[*corner as usize] += 1);
    let mut order: Vec<u32> = (0..to_u32(counts.len())).collect();
    let key = |vertex: u32| key(mesh, coords, vertex);
    order.sort_by_cached_key(|vertex| key(*vertex));
    // The first of its corners among those at its position; `None` if there are few.
    let mut next: Vec<Option<u32>> = vec![None; counts.len()];
    let is_at_one_place = |a: &u32, b: &u32| key(*a)[..3] == key(*b)[..3];
    for place in order.chunk_by(is_at_one_place) {
        let all: u32 = place.iter().map(|vertex| counts[*vertex as usize]).sum();
        let mut first = 0;
        for vertex in place.iter().filter(|_| all > MOST) {
            next[*vertex as usize] = Some(first);
            first += counts[*vertex as usize];
        }
    }
    if next.iter().all(Option::is_none) {
        return Vec::new();
    }
    let part = |corner: &u32| {
        let next = next[*corner as usize].as_mut()?;
        *next += 1;
        u16::try_from((*next - 1) / MOST).ok()
    };
    corners().map(part).map(Option::unwrap_or_default).collect()
}

/// The vertex key of MikkTSpace: position, normal, texture coordinates.
#[expect(
    clippy::cast_possible_truncation,
    reason = "MikkTSpace computes in 32-bit floats"
)]
fn key(mesh: &Mesh, coords: TangentCoords, vertex: u32) -> [u32; 8] {
    let at = vertex as usize;
    let [[x, y, z], [nx, ny, nz]] = [mesh.positions.at(at), mesh.normals.at(at)];
    let [u, v] = coords.at(mesh, at);
    // Zeros of both signs are one number.
    [x, y, z, nx, ny, nz, u, v].map(|number| (number as f32 + 0.0).to_bits())
}

/// Gives each corner a vertex of its own, with the normal of its triangle.
fn flatten(mesh: &mut Mesh) {
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    pick(mesh, &corners);
    let first = (0..to_u32(corners.len())).step_by(3);
    mesh.triangles = first
        .map(|corner| [corner, corner + 1, corner + 2])
        .collect();
    let positions = mesh
        .positions
        .iter()
        .map(Vec3::from_array)
        .collect::<Vec<_>>();
    let normals = positions.as_chunks::<3>().0.iter().flat_map(|[a, b, c]| {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        [normal.to_array(); 3]
    });
    mesh.normals = VertexColumn::rounded(normals);
}

/// Puts the tangents of corners to the vertices; a vertex with several is tangents_of.
fn split_vertices(mesh: &mut Mesh, tangents: &[[f64; 4]]) {
    let count = mesh.positions.len();
    let mut tangents_of: Vec<Option<[f64; 4]>> = vec![None; count];
    // The copies of each vertex: the next one, from the vertex itself on.
    let mut next: Vec<Option<u32>> = vec![None; count];
    let mut origin: Vec<u32> = (0..to_u32(count)).collect();
    for (triangle, tangents) in mesh.triangles.iter_mut().zip(tangents.as_chunks::<3>().0) {
        for (corner, tangent) in triangle.iter_mut().zip(tangents) {
            let mut at = *corner as usize;
            loop {
                match (tangents_of[at], next[at]) {
                    (None, _) => tangents_of[at] = Some(*tangent),
                    (Some(known), _) if known == *tangent => break,
                    (Some(_), Some(copy)) => at = copy as usize,
                    (Some(_), None) => {
                        next[at] = Some(to_u32(tangents_of.len()));
                        origin.push(*corner);
                        tangents_of.push(None);
                        next.push(None);
                        at = tangents_of.len() - 1;
                    }
                }
            }
            *corner = to_u32(at);
        }
    }
    pick(mesh, &origin);
    mesh.tangents = VertexColumn::rounded(
        tangents_of
            .into_iter()
            .map(|tangent| tangent.unwrap_or([1.0, 0.0, 0.0, 1.0])),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::TextureId;

    const PLAIN: TangentCoords = TangentCoords::SURFACE;

    /// Triangles about a point: with one vertex for it, one each that are alike, or that differ.
    fn fan(count: u32, hub: usize) -> Mesh {
        let around = |k: u32| {
            let angle = f64::from(k) / f64::from(count) * 6.0;
            [libm::cos(angle), libm::sin(angle), 0.0]
        };
        let first = if hub == 0 { 1 } else { count };
        let hubs = (0..first).map(|_| [0.0; 3]);
        let positions: Vec<[f64; 3]> = hubs.chain((0..=count).map(around)).collect();
        let lean = |at: u32| if hub == 2 { 1e-6 * f64::from(at) } else { 0.0 };
        let normals = (0..to_u32(positions.len())).map(|at| [lean(at), 0.0, 1.0]);
        Mesh {
            uvs: positions.iter().map(|[x, y, _]| [*x, *y]).collect(),
            normals: normals.collect(),
            positions: positions.into_iter().collect(),
            triangles: (0..count)
                .map(|k| [k.min(first - 1), first + k, first + k + 1])
                .collect(),
            ..Mesh::default()
        }
    }

    /// The number of pairs of corners at one position.
    fn pairs(mesh: &Mesh) -> usize {
        let parts = parts(mesh, PLAIN);
        let mut counts = std::collections::BTreeMap::new();
        for (at, corner) in mesh.triangles.iter().flatten().enumerate() {
            let part = parts.get(at).copied().unwrap_or(0);
            let place = mesh.positions.at(*corner as usize).map(f64::to_bits);
            *counts.entry((place, part)).or_insert(0) += 1;
        }
        counts.values().map(|count: &usize| count * count).sum()
    }

    #[test]
    fn the_work_of_a_fan_grows_as_its_triangles_do() {
        for hub in 0..3 {
            let [once, twice, four] = [4096, 8192, 16_384].map(|n| pairs(&fan(n, hub)));
            assert!(twice <= 2 * once + 4096 && four <= 2 * twice + 4096);
            assert_eq!(
                parts(&fan(512, hub), PLAIN),
                Vec::<u16>::new(),
                "few are whole"
            );
            let mut mesh = fan(5000, hub);
            generate(&mut mesh, PLAIN);
            let near = |tangent: [f64; 4]| (tangent[0] - 1.0).abs() < 1e-3 && tangent[3] == -1.0;
            assert!((0..mesh.tangents.len()).all(|at| near(mesh.tangents.at(at))));
        }
    }

    #[test]
    fn tangents_follow_u_and_vertices_split_where_it_is_mirrored() {
        let corner = |x: f32, y: f32| [x, y, 0.0];
        let mut mesh = Mesh {
            positions: vec![
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(0.0, 1.0),
                corner(-1.0, 0.0),
            ]
            .into(),
            uvs: vec![[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0_f32, 1.0]].into(),
            normals: vec![[0.0_f32, 0.0, 1.0]; 4].into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
            ..Mesh::default()
        };
        generate(&mut mesh, PLAIN);
        assert_eq!(
            (mesh.positions.len(), mesh.tangents.len()),
            (6, 6),
            "two corners are shared and differ"
        );
        let tangent = |triangle: usize| mesh.tangents.at(mesh.triangles[triangle][0] as usize);
        assert_eq!([tangent(0)[0], tangent(1)[0]], [1.0, -1.0]);
        // Green is up in the picture, against v: w·(n × t) points there.
        assert_eq!([tangent(0)[3], tangent(1)[3]], [1.0, -1.0]);
    }

    #[test]
    fn tangents_follow_the_coordinates_of_the_map() {
        let map = |set, [u, v]: [f64; 2], angle: f64| {
            let (c, s) = (libm::cos(angle), libm::sin(angle));
            TangentCoords::of_map(&Map {
                texture: TextureId(0),
                set,
                texture_from_surface: Some([[c * u, s * v, 0.3], [-s * u, c * v, 0.7]]),
            })
        };
        assert_eq!(map(0, [3.0, 0.5], 0.0), PLAIN, "lengths do not count");
        // The first set along x and y, the second one along y and x.
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0_f32, 0.0]];
        let tangent = |coords| {
            let mut mesh = Mesh {
                positions: square.to_vec().into(),
                uvs: square.map(|[x, y, _]| [x, y]).to_vec().into(),
                second_uvs: square.map(|[x, y, _]| [y, x]).to_vec().into(),
                normals: vec![[0.0_f32, 0.0, 1.0]; 3].into(),
                triangles: vec![[0, 1, 2]].into(),
                ..Mesh::default()
            };
            generate(&mut mesh, coords);
            let [x, y, _, side] = mesh.tangents.at(0);
            [x, y, side].map(libm::round)
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        for (coords, expected) in [
            (PLAIN, [1.0, 0.0, -1.0]),
            (map(0, [-1.0, 1.0], 0.0), [-1.0, 0.0, 1.0]),
            (map(0, [1.0, -1.0], 0.0), [1.0, 0.0, 1.0]),
            // u of the picture is v of the surface, v of the picture is −u.
            (map(0, [1.0, 1.0], quarter), [0.0, 1.0, -1.0]),
            (map(1, [1.0, 1.0], 0.0), [0.0, 1.0, 1.0]),
        ] {
            assert_eq!(tangent(coords), expected, "{coords:?}");
        }
    }
}
