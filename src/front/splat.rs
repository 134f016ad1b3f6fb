//! Gaussian splats (Kerbl et al., "3D Gaussian splatting for real-time radiance field rendering",
//! 2023), drawn as ellipsoids of one colour.

use crate::glyph::{OCTAHEDRON, StrokeShape};
use glam::{DMat3, DQuat};
use rtc_color::srgb_decoded;
use rtc_ir::{Mesh, VertexColumn};
use rtc_math::{Vec3, exp, ln, to_u32};
use std::collections::BTreeMap;

/// The first spherical harmonic, 1/(2·√π).
const HARMONIC: f64 = 0.282_094_791_773_878_14;
/// An ellipsoid ends where the opacity of its splat falls below this.
const EDGE: f64 = 0.25;
/// The numbers of splats from which on they are icosahedra, and octahedra.
const SIMPLIFIED_FROM: [usize; 2] = [1 << 12, 1 << 15];

/// The coordinates of an icosahedron of radius 1.
const A: f64 = 0.525_731_112_119_133_6;
const B: f64 = 0.850_650_808_352_039_9;

/// A solid about the origin, of radius 1.
struct Solid {
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

static ICOSAHEDRON: StrokeShape = StrokeShape {
    corners: &[
        (0, [-A, B, 0.0]),
        (0, [A, B, 0.0]),
        (0, [-A, -B, 0.0]),
        (0, [A, -B, 0.0]),
        (0, [0.0, -A, B]),
        (0, [0.0, A, B]),
        (0, [0.0, -A, -B]),
        (0, [0.0, A, -B]),
        (0, [B, 0.0, -A]),
        (0, [B, 0.0, A]),
        (0, [-B, 0.0, -A]),
        (0, [-B, 0.0, A]),
    ],
    triangles: &[
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ],
};

impl Solid {
    /// The solid for so many splats: a ball of 80 triangles for few.
    fn of(count: usize) -> Self {
        let [icosahedra, octahedra] = SIMPLIFIED_FROM;
        match count {
            _ if count < icosahedra => Self::stored(&ICOSAHEDRON).subdivided(),
            _ if count < octahedra => Self::stored(&ICOSAHEDRON),
            _ => Self::stored(&OCTAHEDRON),
        }
    }

    fn stored(of: &StrokeShape) -> Self {
        let corners = of.corners.iter();
        Self {
            corners: corners
                .map(|(_, corner)| Vec3::from_array(*corner))
                .collect(),
            triangles: of.triangles.to_vec(),
        }
    }

    /// Each triangle becomes four, whose corners are on the ball.
    fn subdivided(mut self) -> Self {
        let mut middles = BTreeMap::new();
        let mut triangles = Vec::new();
        for [a, b, c] in std::mem::take(&mut self.triangles) {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                *middles
                    .entry((from.min(to), from.max(to)))
                    .or_insert_with(|| {
                        let [from, to] = [from, to].map(|corner| self.corners[corner as usize]);
                        self.corners.push((from + to).normalize());
                        to_u32(self.corners.len() - 1)
                    })
            });
            triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        Self { triangles, ..self }
    }
}

/// What is told of a file of splats.
pub(crate) const APPROXIMATION: &str = "Gaussian splats are drawn as opaque ellipsoids of one \
    colour, without their soft edges and the colours that depend on the view";

/// The most memory that a splat takes while its mesh is made, in bytes.
pub(crate) const MEMORY: u64 = 2048;

/// A splat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Splat {
    pub(crate) center: Vec3,
    /// x, y, z and w of a quaternion of any length.
    pub(crate) rotation: [f64; 4],
    /// The natural logarithms of the standard deviations along its axes.
    pub(crate) log_scale: [f64; 3],
    /// The opacity in the centre, 0 to 1.
    pub(crate) opacity: f64,
    /// The colour as sRGB codes it, 0 to 1.
    pub(crate) color: [f64; 3],
}

/// The colour, as sRGB codes it, of the coefficients of the first spherical harmonic.
pub(crate) fn harmonic_color(coefficients: [f64; 3]) -> [f64; 3] {
    coefficients.map(|coefficient| (0.5 + HARMONIC * coefficient).clamp(0.0, 1.0))
}

/// The logistic function, which turns a logit into an opacity.
pub(crate) fn logistic(logit: f64) -> f64 {
    1.0 / (1.0 + exp(-logit))
}

impl Splat {
    /// The axes of its ellipsoid; `None` where it is nowhere opaque enough to be drawn.
    fn axes(&self) -> Option<DMat3> {
        let ratio = (self.opacity / EDGE).min(1.0 / EDGE);
        let radius = (ratio > 1.0).then(|| (2.0 * ln(ratio)).sqrt())?;
        let rotation = DQuat::from_array(self.rotation);
        let rotation = match rotation.length_squared() > 0.0 {
            true => rotation.normalize(),
            false => DQuat::IDENTITY,
        };
        let scale = Vec3::from_array(self.log_scale.map(exp)) * radius;
        let axes = DMat3::from_quat(rotation) * DMat3::from_diagonal(scale);
        (axes.is_finite() && self.center.is_finite()).then_some(axes)
    }
}

/// The mesh of the ellipsoids of splats, with the colours of its vertices, which are radiance.
pub(crate) fn mesh(splats: &[Splat]) -> Mesh {
    let solid = Solid::of(splats.len());
    let (mut positions, mut colors, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for splat in splats {
        let Some(axes) = splat.axes() else {
            continue;
        };
        let first = to_u32(positions.len());
        let [r, g, b] = splat.color.map(srgb_decoded);
        for corner in &solid.corners {
            let corner = splat.center + axes * *corner;
            positions.push(corner.to_array());
            colors.push([r, g, b, 1.0]);
        }
        let corners = solid.triangles.iter();
        triangles.extend(corners.map(|corners| corners.map(|corner| first + corner)));
    }
    Mesh {
        positions: VertexColumn::rounded(positions),
        colors: VertexColumn::rounded(colors),
        triangles: triangles.into(),
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Splat = Splat {
        center: Vec3::new(1.0, 2.0, 3.0),
        rotation: [0.0, 0.0, 0.0, 1.0],
        log_scale: [0.0; 3],
        opacity: 1.0,
        color: [1.0, 0.5, 0.0],
    };

    #[test]
    fn solids_are_closed_and_turn_outward() {
        for (count, triangles, volume) in [
            (1, 80, 3.66),
            (SIMPLIFIED_FROM[0], 20, 2.536_15),
            (SIMPLIFIED_FROM[1], 8, 4.0 / 3.0),
        ] {
            let solid = Solid::of(count);
            let parts = solid.triangles.iter().map(|triangle| {
                let [a, b, c] = triangle.map(|corner| solid.corners[corner as usize]);
                a.dot(b.cross(c)) / 6.0
            });
            let found = parts.sum::<f64>();
            assert!((found - volume).abs() < 0.01, "{found}");
            assert_eq!(solid.triangles.len(), triangles);
        }
    }

    #[test]
    fn an_ellipsoid_ends_where_the_splat_fades() {
        // exp(−r²/2) = 1/4.
        let reach = |splat: Splat| {
            let mesh = mesh(&[splat]);
            let offset = |at: [f64; 3]| (Vec3::from_array(at) - splat.center).abs();
            mesh.positions
                .iter()
                .map(offset)
                .fold(Vec3::ZERO, Vec3::max)
        };
        let radius = (2.0 * ln(4.0)).sqrt();
        assert!((reach(BALL) - Vec3::splat(radius)).length() < 1e-6);
        // Twice as long along x, which is turned to y.
        let turned = Splat {
            rotation: [0.0, 0.0, 2.0, 2.0],
            log_scale: [ln(2.0), 0.0, 0.0],
            ..BALL
        };
        assert!((reach(turned) - radius * Vec3::new(1.0, 2.0, 1.0)).length() < 1e-6);
        let faint = Splat {
            opacity: 0.2,
            ..BALL
        };
        assert!(mesh(&[faint]).positions.is_empty());
    }

    #[test]
    fn colours_are_those_of_the_first_harmonic() {
        let [r, g, b] = harmonic_color([0.5 / HARMONIC, 0.0, -9.0]);
        assert!((r - 1.0).abs() < 1e-12 && (g, b) == (0.5, 0.0));
        let color = mesh(&[BALL]).colors.at(0);
        assert!((color[1] - 0.214_041).abs() < 1e-5, "{color:?}");
        assert_eq!(logistic(0.0), 0.5);
    }
}
