//! The subdivision of Loop 1987, "Smooth subdivision surfaces based on triangles", with the rules
//! for boundaries and the limit surface of Hoppe et al. 1994.

use rtc_ir::{Mesh, VertexColumn};
use rtc_math::Vec3;

/// An edge: its ends, and the corners across it, one at a boundary.
struct Edge {
    ends: [u32; 2],
    across: [Option<u32>; 2],
}

/// The edges of a mesh.
struct Edges {
    list: Vec<Edge>,
    /// The edge of each side of each triangle.
    of_sides: Vec<u32>,
}

/// Subdivides a mesh the given number of times, moves its vertices to the limit surface, and
/// computes normals. Indices are in range.
pub(super) fn subdivide(
    mut positions: Vec<Vec3>,
    mut triangles: Vec<[u32; 3]>,
    levels: u32,
) -> Mesh {
    for _ in 0..levels {
        let edges = Edges::of(&triangles);
        let first = index(positions.len());
        let mut refined = moved(&positions, &edges, inner_weight);
        refined.extend(edges.list.iter().map(|edge| midpoint(edge, &positions)));
        triangles = split(&triangles, &edges, first);
        positions = refined;
    }
    let edges = Edges::of(&triangles);
    let limit = moved(&positions, &edges, limit_weight);
    let normals = normals(&limit, &triangles);
    Mesh {
        positions: VertexColumn::rounded(limit.iter().map(|p| p.to_array())),
        normals: VertexColumn::rounded(normals.iter().map(|n| n.to_array())),
        triangles: triangles.into(),
        ..Mesh::default()
    }
}

fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

impl Edges {
    fn of(triangles: &[[u32; 3]]) -> Self {
        let corners = triangles.as_flattened();
        // The corners of the side that begins at this one, and of the corner across it.
        let around = |side: usize| {
            let (face, first) = (side - side % 3, side % 3);
            [0, 1, 2].map(|next| corners[face + (first + next) % 3])
        };
        let mut sides: Vec<(u64, u32)> = (0..corners.len())
            .map(|side| {
                let [p, q, _] = around(side);
                (u64::from(p.min(q)) << 32 | u64::from(p.max(q)), index(side))
            })
            .collect();
        sides.sort_unstable();
        let mut edges = Self {
            list: Vec::new(),
            of_sides: vec![0; sides.len()],
        };
        let mut last = None;
        for (key, side) in sides {
            let [p, q, across] = around(side as usize);
            match edges.list.last_mut() {
                // The rules do not define a third triangle at an edge.
                Some(edge) if last == Some(key) => edge.across[1] = Some(across),
                _ => edges.list.push(Edge {
                    ends: [p.min(q), p.max(q)],
                    across: [Some(across), None],
                }),
            }
            last = Some(key);
            edges.of_sides[side as usize] = index(edges.list.len() - 1);
        }
        edges
    }
}

/// The share of the neighbours of an inner vertex of this valence in its next position.
fn inner_weight(valence: f64) -> f64 {
    match valence == 3.0 {
        true => 3.0 * 3.0 / 16.0,
        false => 3.0 / 8.0,
    }
}

/// The share of the neighbours in the position on the limit surface: with the share β of each
/// before, n over n + 3/(8β).
fn limit_weight(valence: f64) -> f64 {
    let beta = inner_weight(valence) / valence;
    valence / (valence + 3.0 / (8.0 * beta))
}

/// The vertices moved towards the mean of their neighbours. At a boundary only those along it
/// count: with 1/4 for a level, and with 2/5 for the limit.
fn moved(positions: &[Vec3], edges: &Edges, weight: fn(f64) -> f64) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0); positions.len()];
    let mut bounds = vec![(Vec3::ZERO, 0.0); positions.len()];
    for Edge {
        ends: [a, b],
        across,
    } in &edges.list
    {
        let (a, b) = (*a as usize, *b as usize);
        for (from, to) in [(a, b), (b, a)] {
            let add = |sums: &mut Vec<(Vec3, f64)>| {
                sums[to].0 += positions[from];
                sums[to].1 += 1.0;
            };
            add(&mut sums);
            if across[1].is_none() {
                add(&mut bounds);
            }
        }
    }
    // At a regular boundary the weights of both rules.
    let along_boundary = if weight(6.0) == inner_weight(6.0) {
        0.25
    } else {
        0.4
    };
    let vertices = positions.iter().zip(sums).zip(bounds);
    let next = vertices.map(|((own, (sum, count)), (bound, of_bound))| {
        let (sum, count, share) = match of_bound > 0.0 {
            true => (bound, of_bound, along_boundary),
            false if count > 0.0 => (sum, count, weight(count)),
            false => return *own,
        };
        *own * (1.0 - share) + sum / count * share
    });
    next.collect()
}

/// The new vertex of an edge.
fn midpoint(edge: &Edge, positions: &[Vec3]) -> Vec3 {
    let at = |vertex: u32| positions[vertex as usize];
    let [a, b] = edge.ends.map(at);
    match edge.across {
        [Some(c), Some(d)] => (a + b) * 0.375 + (at(c) + at(d)) * 0.125,
        _ => (a + b) * 0.5,
    }
}

/// Four triangles for each one. The vertices of edges begin at `first`.
fn split(triangles: &[[u32; 3]], edges: &Edges, first: u32) -> Vec<[u32; 3]> {
    let sides = edges.of_sides.as_chunks::<3>().0;
    let parts = triangles.iter().zip(sides).flat_map(|([a, b, c], sides)| {
        let [ab, bc, ca] = sides.map(|edge| first + edge);
        [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
    });
    parts.collect()
}

/// The mean normals of the triangles at each vertex, weighted by their areas.
fn normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        for corner in corners {
            normals[*corner as usize] += (b - a).cross(c - a);
        }
    }
    let unit = |normal: Vec3| rtc_math::unit(normal).unwrap_or(Vec3::Z);
    normals.into_iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The octahedron of radius 1.
    fn octahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let vertices = [
            Vec3::X,
            Vec3::NEG_X,
            Vec3::Y,
            Vec3::NEG_Y,
            Vec3::Z,
            Vec3::NEG_Z,
        ];
        let mut triangles = Vec::new();
        for [x, y, z] in [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]] {
            triangles.extend([[x, y, z], [y, x, 5]]);
        }
        (vertices.to_vec(), triangles)
    }

    #[test]
    fn a_closed_mesh_has_four_times_the_triangles_and_stays_symmetric() {
        let (positions, triangles) = octahedron();
        let mesh = subdivide(positions, triangles, 3);
        assert_eq!((mesh.triangles.len(), mesh.positions.len()), (8 << 6, 258));
        // The limit of a vertex of valence 4: β = 3/32, so it keeps 1 − 4/(4 + 4) = 1/2 of the
        // distance from the mean of its ring, which is the centre.
        let [x, y, z] = mesh.positions.at(0);
        assert!(
            (x - 0.5).abs() < 1e-6 && y.abs() < 1e-6 && z.abs() < 1e-6,
            "{x} {y} {z}"
        );
        let [x, y, z] = mesh.normals.at(0);
        assert!(
            (x - 1.0).abs() < 1e-6 && y.abs() < 1e-6 && z.abs() < 1e-6,
            "{x} {y} {z}"
        );
    }

    #[test]
    fn a_flat_square_stays_flat_and_its_sides_straight() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let positions = corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        let mesh = subdivide(positions, vec![[0, 1, 2], [0, 2, 3]], 2);
        assert_eq!(mesh.triangles.len(), 32);
        assert!(
            mesh.positions.iter().all(|[x, y, z]| {
                z == 0.0 && (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y)
            })
        );
        assert!(mesh.normals.iter().all(|normal| normal == [0.0, 0.0, 1.0]));
    }
}
