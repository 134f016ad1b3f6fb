//! Glyphs: the triangles that represent points and lines. Files give them no size, so the radius is
//! chosen later.

use crate::gltf;
use glam::{DAffine3, DMat3};
use rtc_ir::{BoundingSphere, Mesh, VertexColumn};
use rtc_math::{Vec3, mix, unit};
use std::f64::consts::PI;

/// The number of points or lines from which on they have the simplest glyph.
const SIMPLIFIED_FROM: u64 = 1 << 15;

/// The shape of a point or a line. With normals it is a disc or a ribbon that faces the normal, so
/// that shading uses it; without, a polyhedron.
pub(crate) struct StrokeShape {
    /// The corners: the end of the line, and the offset from it for a radius of 1. z is along the
    /// line and y along its normal; for a point z is along its normal.
    pub(crate) corners: &'static [(usize, [f64; 3])],
    pub(crate) triangles: &'static [[u32; 3]],
}

/// 1/√3.
const EDGE: f64 = 0.577_350_269_189_625_8;

static TETRAHEDRON: StrokeShape = StrokeShape {
    corners: &[
        (0, [EDGE, EDGE, EDGE]),
        (0, [EDGE, -EDGE, -EDGE]),
        (0, [-EDGE, EDGE, -EDGE]),
        (0, [-EDGE, -EDGE, EDGE]),
    ],
    triangles: &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
};

pub(crate) static OCTAHEDRON: StrokeShape = StrokeShape {
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

/// A prism with four sides and without caps, which are too small to be visible.
static PRISM: StrokeShape = StrokeShape {
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

static DISC: StrokeShape = StrokeShape {
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

static RIBBON: StrokeShape = StrokeShape {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (1, [-1.0, 0.0, 0.0]),
        (1, [1.0, 0.0, 0.0]),
    ],
    triangles: &[[0, 1, 2], [0, 2, 3]],
};

/// The glyph of one of many lines: a tetrahedron with an edge across each end, visible from all
/// sides.
static WEDGE: StrokeShape = StrokeShape {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [-1.0, 0.0, 0.0]),
        (1, [0.0, 1.0, 0.0]),
        (1, [0.0, -1.0, 0.0]),
    ],
    triangles: &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
};

/// The glyph of one of many points with normals.
static TRIANGLE: StrokeShape = StrokeShape {
    corners: &[
        (0, [1.0, 0.0, 0.0]),
        (0, [-0.5, HEIGHT, 0.0]),
        (0, [-0.5, -HEIGHT, 0.0]),
    ],
    triangles: &[[0, 1, 2]],
};

/// The radius in pixels of the default view of an asset without cameras.
const RADIUS: f64 = 1.0;

/// The radius of points, as a fraction of the distance of neighbours, so that those of a surface
/// hide most of what is behind it, and its limit as a fraction of the radius of the scene.
const CLOSED: f64 = 0.7;
const LARGEST: f64 = 1.0 / 64.0;
/// The largest diameter of points that is obeyed, in pixels.
const MOST_PIXELS: f64 = 4096.0;

/// The most points whose neighbours are looked for, and which neighbour counts.
const SAMPLE: usize = 512;
const NEIGHBOURS: usize = 6;

/// The radius of the lines of a scene with this bounding sphere.
pub(crate) fn radius(ball: BoundingSphere) -> f64 {
    RADIUS * gltf::pixel(ball)
}

/// The radius of the points of a scene with this bounding sphere: of half a diameter of so many
/// pixels, or by their density, but at least that of lines.
pub(crate) fn point_radius(ball: BoundingSphere, size: Option<f64>, spacing: f64) -> f64 {
    match size {
        Some(size) => size.min(MOST_PIXELS) / 2.0 * gltf::pixel(ball),
        None => radius(ball).max((CLOSED * spacing).min(LARGEST * ball.radius)),
    }
}

/// The typical distance of neighbours among points on a surface, as in a grid of their density: the
/// disc to the k-th neighbour holds k points. It is found from a sample: among n times as many
/// points it is √n times as small. 0 for fewer than two points.
pub(crate) fn spacing(count: usize, at: impl Fn(usize) -> Vec3) -> f64 {
    let pick = |k: usize| match count <= SAMPLE {
        true => at(k),
        false => at(usize::try_from(mix(k as u64) % count as u64).unwrap_or(0)),
    };
    let sample: Vec<Vec3> = (0..count.min(SAMPLE)).map(pick).collect();
    // The area of the surface for each point.
    let area = |point: &Vec3| {
        let squares = sample.iter().map(|other| point.distance_squared(*other));
        let mut squares: Vec<f64> = squares.filter(|square| *square > 0.0).collect();
        let k = NEIGHBOURS.min(squares.len());
        let last = k.checked_sub(1)?;
        let (_, square, _) = squares.select_nth_unstable_by(last, f64::total_cmp);
        Some(PI * *square / k as f64)
    };
    let mut areas: Vec<f64> = sample.iter().filter_map(area).collect();
    areas.sort_unstable_by(f64::total_cmp);
    let middle = areas.get(areas.len() / 2);
    middle.map_or(0.0, |area| {
        (area * sample.len() as f64 / count as f64).sqrt()
    })
}

impl StrokeShape {
    /// The glyph for `count` points or lines, with or without normals.
    pub(crate) fn of(are_points: bool, have_normals: bool, count: u64) -> &'static Self {
        match (are_points, have_normals) {
            (true, true) if count < SIMPLIFIED_FROM => &DISC,
            (true, true) => &TRIANGLE,
            (true, false) if count < SIMPLIFIED_FROM => &OCTAHEDRON,
            (true, false) => &TETRAHEDRON,
            (false, true) => &RIBBON,
            (false, false) if count < SIMPLIFIED_FROM => &PRISM,
            (false, false) => &WEDGE,
        }
    }
}

/// The glyphs of points (lines from a vertex to itself) or lines, at radius 0: a mesh relative to
/// its first vertex, the offsets of its corners for a radius of 1, and the transform.
pub(crate) fn thin_glyphs(
    source: &Mesh,
    ends: &[[u32; 2]],
    world: DAffine3,
    glyph: &StrokeShape,
) -> Option<(Mesh, VertexColumn<3>, DAffine3)> {
    let position = |vertex: u32| {
        let point = Vec3::from_array(source.positions.at(vertex as usize));
        world.transform_point3(point)
    };
    // Normals are transformed by the inverse transpose.
    let normal_matrix = world.matrix3.inverse().transpose();
    let normal = |vertex: u32| {
        let has_normals = !source.normals.is_empty();
        let point = has_normals.then(|| Vec3::from_array(source.normals.at(vertex as usize)));
        point.and_then(|point| unit(normal_matrix * point))
    };
    let (mut vertices, mut offsets, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for ends in ends {
        let frame = frame(ends.map(position), normal(ends[0]));
        let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        for (end, offset) in glyph.corners {
            vertices.push(ends[*end]);
            offsets.push((frame * Vec3::from_array(*offset)).to_array());
        }
        let point = glyph.triangles.iter();
        triangles.extend(point.map(|corners| corners.map(|corner| first + corner)));
    }
    let anchor = position(*vertices.first()?);
    let mut mesh = Mesh {
        tangents: VertexColumn::default(),
        ..source.clone()
    };
    pick(&mut mesh, &vertices);
    mesh.positions = VertexColumn::rounded(
        vertices
            .iter()
            .map(|at| (position(*at) - anchor).to_array()),
    );
    if !mesh.normals.is_empty() {
        let normals = vertices.iter().map(|at| normal(*at).unwrap_or(Vec3::Z));
        mesh.normals = VertexColumn::rounded(normals.map(|normal| normal.to_array()));
    }
    mesh.triangles = triangles.into();
    let is_sound = anchor.is_finite() && mesh.is_finite();
    let world = DAffine3::from_translation(anchor);
    is_sound.then(|| (mesh, VertexColumn::rounded(offsets), world))
}

/// The axes of the glyph of a point or a line.
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

/// Replaces the vertices of a mesh by a selection of them; its triangles are unchanged.
pub(crate) fn pick(mesh: &mut Mesh, vertices: &[u32]) {
    let Mesh {
        name: _,
        part: _,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles: _,
    } = mesh;
    *positions = positions.pick(vertices);
    *normals = normals.pick(vertices);
    *uvs = uvs.pick(vertices);
    *second_uvs = second_uvs.pick(vertices);
    *tangents = tangents.pick(vertices);
    *colors = colors.pick(vertices);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_a_surface_are_as_far_apart_as_a_sample_says() {
        for side in [10, 30, 100] {
            let at = |k: usize| Vec3::new((k % side) as f64, (k / side) as f64, 0.0);
            let found = spacing(side * side, at);
            // Some points of a sample are the same.
            assert!((0.8..1.4).contains(&found), "{side}: {found}");
        }
        assert_eq!(
            [spacing(0, |_| Vec3::ONE), spacing(9, |_| Vec3::ONE)],
            [0.0; 2]
        );
    }

    #[test]
    fn points_are_as_large_as_their_density_needs_within_limits() {
        let ball = BoundingSphere {
            center: Vec3::ZERO,
            radius: 2.0,
        };
        let pixel = radius(ball);
        let of = |spacing| point_radius(ball, None, spacing);
        assert_eq!([of(0.0), of(pixel), of(9.0)], [pixel, pixel, 2.0 / 64.0]);
        assert_eq!(of(2.0 * pixel), CLOSED * 2.0 * pixel);
        assert_eq!(point_radius(ball, Some(6.0), 9.0), 3.0 * pixel);
    }

    #[test]
    fn discs_and_ribbons_face_their_normals() {
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let cases = [
            (&DISC, [Vec3::ONE; 2]),
            (&TRIANGLE, [Vec3::ONE; 2]),
            (&RIBBON, [Vec3::ZERO, Vec3::Y]),
        ];
        for (glyph, ends) in cases {
            let frame = frame(ends, Some(normal));
            let corner = |at: u32| {
                let (end, offset) = glyph.corners[at as usize];
                ends[end] + frame * Vec3::from_array(offset)
            };
            for triangle in glyph.triangles {
                let [a, b, c] = triangle.map(corner);
                let point = (b - a).cross(c - a).normalize();
                assert!((point - normal).length() < 1e-12, "{point}");
            }
        }
    }

    /// The volume by the divergence theorem; for a prism of height 1 the contribution of its sides.
    fn volume(glyph: &StrokeShape) -> f64 {
        let corner = |at: u32| {
            let (end, offset) = glyph.corners[at as usize];
            Vec3::from_array(offset) + Vec3::Z * if end == 1 { 1.0 } else { 0.0 }
        };
        let parts = glyph.triangles.iter().map(|triangle| {
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
        // The sides of a prism contribute two thirds, the caps the rest.
        assert!((volume(&PRISM) - 2.0 * 2.0 / 3.0).abs() < 1e-12);
        assert!((volume(&WEDGE) - 2.0 / 3.0).abs() < 1e-12);
    }
}
