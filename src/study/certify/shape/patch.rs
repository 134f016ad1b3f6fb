//! The curved quadrilateral: a ray meets a line of constant u where a quadratic in u vanishes
//! (Reshetov, "Cool patches", Ray Tracing Gems, 2019, ch. 8).

use super::{CertifiedRay, Meeting, SurfaceHit, Visit};
use crate::certify::number::CertifiedNumber;
use crate::certify::reason::Doubts;
use crate::certify::vector::CertifiedVector;
use rtc_math::{Vec3, Vector};

/// The corners at (0, 0), (1, 0), (1, 1) and (0, 1).
pub(super) struct CertifiedPatch(pub(super) [Vec3; 4]);

impl CertifiedPatch {
    /// The derivatives along u and v.
    fn tangents<N: CertifiedNumber>(&self, [u, v]: [N; 2]) -> [Vector<N>; 2] {
        let [q00, q10, q11, q01] = self.0.map(Vector::point);
        let between = |a: Vector<N>, b: Vector<N>, s: N| a + (b - a) * s;
        [
            between(q10 - q00, q11 - q01, v),
            between(q01 - q00, q11 - q10, u),
        ]
    }

    /// The normal at a point, of any length.
    pub(super) fn raw_normal<N: CertifiedNumber>(&self, place: [N; 2]) -> Vector<N> {
        let [across, upward] = self.tangents(place);
        across.cross(upward)
    }

    /// Visits the hits; a ray that starts here has one at its start, which is none.
    pub(super) fn meet<N: CertifiedNumber>(
        &self,
        ray: &CertifiedRay<N>,
        range: [f64; 2],
        is_start: bool,
        visit: Visit<'_, N>,
    ) {
        let Some(roots) = self.roots(ray) else {
            return visit(Meeting::Unclear(range, Doubts::SILHOUETTE));
        };
        let hits = roots.map(|u| u.map(|u| self.along(ray, u)));
        // The start is a root for certain: it is that which may be 0, if only one may.
        let near = |hit: &Option<(N, [N; 2])>| hit.is_some_and(|(t, _)| !t.has_sign());
        let near_count = hits.iter().filter(|hit| near(hit)).count();
        for hit in hits {
            if is_start && near_count == 1 && near(&hit) {
                continue;
            }
            let Some((t, place)) = hit else { continue };
            let is_outside = |x: N| x.is_negative() || N::ONE.is_below(x);
            let is_inside = |x: N| x.is_positive() && x.is_below(N::ONE);
            if t.is_negative() || place.into_iter().any(is_outside) {
                continue;
            }
            let hit = SurfaceHit {
                t,
                part: 0,
                patch: Some(place),
            };
            let ends = [t.low().max(0.0), t.high()];
            if !place.into_iter().all(is_inside) {
                visit(Meeting::Unclear(ends, Doubts::SILHOUETTE));
            } else if t.is_positive() {
                visit(Meeting::Hits(hit));
            } else {
                visit(Meeting::Unclear(ends, Doubts::CONTACT));
            }
        }
    }

    /// The roots of a + b·u + c·u²; `None` if it is not clear how many there are.
    fn roots<N: CertifiedNumber>(&self, ray: &CertifiedRay<N>) -> Option<[Option<N>; 2]> {
        let d = ray.direction;
        let [q00, q10, q11, q01] = self.0.map(|v| Vector::point(v) - ray.origin);
        let a = q00.cross(d).dot(q01 - q00);
        let c = (q10 - q00).cross(q01 - q11).dot(d);
        let b = q10.cross(d).dot(q11 - q10) - a - c;
        let two = N::point(2.0);
        if c.is_zero() {
            return b.has_sign().then(|| [Some(-a / b), None]);
        }
        let discriminant = b.square() - N::point(4.0) * a * c;
        if discriminant.is_negative() {
            return Some([None; 2]);
        }
        let root = discriminant.sqrt();
        let q = if b.is_negative() {
            root - b
        } else {
            -(b + root)
        } / two;
        let is_clear = discriminant.is_positive() && c.has_sign() && q.has_sign();
        is_clear.then(|| [Some(q / c), Some(a / q)])
    }

    /// The point of the ray on the line at u: its t, and its place.
    fn along<N: CertifiedNumber>(&self, ray: &CertifiedRay<N>, u: N) -> (N, [N; 2]) {
        let d = ray.direction;
        let [q00, q10, q11, q01] = self.0.map(|v| Vector::point(v) - ray.origin);
        let start = q00 + (q10 - q00) * u;
        let left = q01 - q00;
        let line = left + (q11 - q10 - left) * u;
        let normal = d.cross(line);
        let v = normal.cross(start).dot(d) / normal.square();
        let t = (start + line * v).dot(d);
        (t, [u, v])
    }
}
