//! Planes, discs and triangles.

use super::placed::PlacedMesh;
use super::{CertifiedRay, Meeting, SurfaceHit};
use crate::certify::number::CertifiedNumber;
use crate::certify::reason::Doubts;
use crate::certify::vector::CertifiedVector;
use rtc_ir::Mesh;
use rtc_math::{Vec3, Vector};

/// A triangle of its own, or one of a placed mesh.
pub(super) enum CertifiedTriangle<'scene> {
    /// In world coordinates, with its texture coordinates.
    Own([Vec3; 3], Option<[[f64; 2]; 3]>),
    /// The mesh, the corners, and the index of the placed mesh.
    Placed(&'scene Mesh, [u32; 3], usize),
}

impl CertifiedTriangle<'_> {
    /// The corners in world coordinates.
    pub(super) fn vertices<N: CertifiedNumber>(&self, placed: &[PlacedMesh<N>]) -> [Vector<N>; 3] {
        match self {
            Self::Own(vertices, _) => vertices.map(Vector::point),
            Self::Placed(mesh, corners, index) => corners.map(|corner| {
                let position = Vec3::from_array(mesh.positions.at(corner as usize));
                placed[*index].point(position)
            }),
        }
    }

    /// The geometric normal as declared, of any length.
    pub(super) fn raw_normal<N: CertifiedNumber>(&self, placed: &[PlacedMesh<N>]) -> Vector<N> {
        let normal = raw_normal(self.vertices(placed));
        match self {
            Self::Placed(_, _, index) if placed[*index].mirrors => -normal,
            Self::Own(..) | Self::Placed(..) => normal,
        }
    }

    /// The texture coordinates of a point, if it has any.
    pub(super) fn uv<N: CertifiedNumber>(
        &self,
        placed: &[PlacedMesh<N>],
        point: Vector<N>,
    ) -> Option<[N; 2]> {
        let uvs = match self {
            Self::Own(_, uvs) => (*uvs)?,
            Self::Placed(mesh, corners, _) => {
                if mesh.uvs.is_empty() {
                    return None;
                }
                corners.map(|corner| mesh.uvs.at(corner as usize))
            }
        };
        let weights = weights(self.vertices(placed), point);
        let sum = |axis: usize| {
            let term = |k: usize| weights[k] * N::point(uvs[k][axis]);
            term(0) + term(1) + term(2)
        };
        Some([sum(0), sum(1)])
    }

    /// The shading normal of a point, if it differs from the geometric one.
    pub(super) fn shading_normal<N: CertifiedNumber>(
        &self,
        placed: &[PlacedMesh<N>],
        point: Vector<N>,
    ) -> Option<Vector<N>> {
        let Self::Placed(mesh, corners, index) = self else {
            return None;
        };
        if mesh.normals.is_empty() {
            return None;
        }
        let normals = corners.map(|corner| {
            let normal = Vec3::from_array(mesh.normals.at(corner as usize));
            Vector::point(normal).normalized()
        });
        let weights = weights(self.vertices(placed), point);
        let mean = Vector::from(weights).combined(normals);
        Some(placed[*index].normal(mean).normalized())
    }
}

/// (v1 − v0) × (v2 − v0).
pub(super) fn raw_normal<N: CertifiedNumber>([a, b, c]: [Vector<N>; 3]) -> Vector<N> {
    (b - a).cross(c - a)
}

/// The barycentric weights of a point of a triangle: the areas of its parts.
fn weights<N: CertifiedNumber>(vertices: [Vector<N>; 3], p: Vector<N>) -> [N; 3] {
    let [a, b, c] = vertices;
    let normal = raw_normal(vertices);
    let area = normal.square();
    let second = (p - a).cross(c - a).dot(normal) / area;
    let third = (b - a).cross(p - a).dot(normal) / area;
    [N::ONE - second - third, second, third]
}

/// `t = N·(a − o) / N·d`; `None` without a hit in front.
pub(super) fn meet_plane<N: CertifiedNumber>(
    center: Vector<N>,
    normal: Vector<N>,
    ray: &CertifiedRay<N>,
    range: [f64; 2],
) -> Option<Meeting<N>> {
    let slope = normal.dot(ray.direction);
    if slope.is_zero() {
        return None;
    }
    let distance = normal.dot(center - ray.origin);
    if !slope.has_sign() {
        return Some(Meeting::Unclear(range, Doubts::SILHOUETTE));
    }
    let t = distance / slope;
    if t.is_positive() {
        Some(Meeting::Hits(SurfaceHit::new(t, 0)))
    } else if t.is_negative() {
        None
    } else {
        Some(Meeting::Unclear([0.0, t.high().max(0.0)], Doubts::CONTACT))
    }
}

/// The hit of the plane, if the volumes spanned by the direction and each edge have one sign
/// (Plücker coordinates; Segura, Feito, "Algorithms to test ray-triangle intersection", WSCG 2001).
pub(super) fn meet_triangle<N: CertifiedNumber>(
    vertices: [Vector<N>; 3],
    ray: &CertifiedRay<N>,
    range: [f64; 2],
) -> Option<Meeting<N>> {
    let [a, b, c] = vertices.map(|v| v - ray.origin);
    let volume = |p: Vector<N>, q: Vector<N>| ray.direction.dot(p.cross(q));
    let volumes = [volume(a, b), volume(b, c), volume(c, a)];
    let some = |sign: fn(N) -> bool| volumes.into_iter().any(sign);
    if some(N::is_positive) && some(N::is_negative) {
        return None;
    }
    let hit = meet_plane(vertices[0], raw_normal(vertices), ray, range)?;
    let inside = |sign: fn(N) -> bool| volumes.into_iter().all(sign);
    Some(bounded(
        hit,
        inside(N::is_positive) || inside(N::is_negative),
    ))
}

/// The hit of the plane, if it lies within the radius.
pub(super) fn meet_disc<N: CertifiedNumber>(
    [center, normal]: [Vector<N>; 2],
    radius: N,
    ray: &CertifiedRay<N>,
    range: [f64; 2],
) -> Option<Meeting<N>> {
    let hit = meet_plane(center, normal, ray, range)?;
    let Meeting::Hits(SurfaceHit { t, .. }) = hit else {
        return Some(hit);
    };
    let local = ray.origin - center + ray.direction * t;
    let (square, limit) = (local.square(), radius.square());
    if limit.is_below(square) {
        return None;
    }
    Some(bounded(hit, square.is_below(limit)))
}

/// A hit of the plane of a bounded surface that may lie outside of it, unless it is certainly
/// `inside`.
fn bounded<N: CertifiedNumber>(hit: Meeting<N>, inside: bool) -> Meeting<N> {
    match hit {
        Meeting::Hits(SurfaceHit { t, .. }) if !inside => {
            Meeting::Unclear([t.low(), t.high()], Doubts::SILHOUETTE)
        }
        Meeting::Hits(_) | Meeting::Unclear(..) => hit,
    }
}
