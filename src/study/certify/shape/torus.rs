//! The torus: the roots of its quartic, isolated by bisection and narrowed by Newton's method over
//! sets of numbers (Moore, Kearfott, Cloud, 2009, ch. 8).

use super::{CertifiedRay, Meeting, RayStart, SurfaceHit, Visit};
use crate::certify::number::CertifiedNumber;
use crate::certify::reason::Doubts;
use crate::certify::vector::CertifiedVector;
use rtc_ir::Torus;
use rtc_math::{Vec3, Vector};

/// A torus.
pub(super) struct CertifiedTorus<N> {
    middle: Vec3,
    center: Vector<N>,
    /// A unit vector.
    axis: Vector<N>,
    major: N,
    minor: N,
    /// More than the distance of its points from its centre.
    reach: f64,
}

impl<N: CertifiedNumber> CertifiedTorus<N> {
    pub(super) fn new(shape: &Torus) -> Self {
        let [middle, axis] = [shape.center, shape.axis].map(Vec3::from_array);
        Self {
            middle,
            center: Vector::point(middle),
            axis: Vector::point(axis).normalized(),
            major: N::point(shape.major),
            minor: N::point(shape.minor),
            reach: 1.01 * (shape.major + shape.minor),
        }
    }

    /// Visits the hits of a ray: the roots of `(|p|² + R² − r²)² = 4·R²·ρ²`, from the point nearest
    /// to the centre on.
    pub(super) fn meet(
        &self,
        ray: &CertifiedRay<N>,
        start: Option<&RayStart<N>>,
        visit: Visit<'_, N>,
    ) {
        let nearest = ray.nearest_to(self.middle);
        let from = ray.at(nearest) - self.center;
        let (h, rise) = (from.dot(self.axis), ray.direction.dot(self.axis));
        let (w, x) = (from - self.axis * h, ray.direction - self.axis * rise);
        // |p|² is s² + 2·g·s + q, with a small g: the middle of the ray is not exact.
        let (g, two, four) = (from.dot(ray.direction), N::point(2.0), N::point(4.0));
        let k = from.square() + (self.major - self.minor) * (self.major + self.minor);
        let ring = four * self.major.square();
        let quartic = [
            N::ONE,
            four * g,
            four * g.square() + two * k - ring * x.square(),
            four * g * k - two * ring * w.dot(x),
            k.square() - ring * w.square(),
        ];
        let behind = -nearest.low();
        let low = behind.max(-self.reach);
        if low >= self.reach {
            return;
        }
        // Take the root at the start out: (s − s₀)·cubic.
        let polynomial = Polynomial { quartic, degree: 4 };
        let polynomial = match start {
            None => polynomial,
            Some(start) if start.normal.dot(ray.direction).has_sign() => {
                polynomial.without(-nearest)
            }
            Some(_) => {
                let range = [0.0, 2.0 * self.reach];
                return visit(Meeting::Unclear(range, Doubts::CONTACT));
            }
        };
        polynomial.visit_roots(low, self.reach, &mut |root| reported(root, nearest, visit));
    }

    /// The outward unit normal at a hit.
    pub(super) fn normal(&self, ray: &CertifiedRay<N>, t: N) -> Vector<N> {
        let nearest = ray.nearest_to(self.middle);
        let p = ray.at(nearest) - self.center + ray.direction * (t - nearest);
        let off = p - self.axis * p.dot(self.axis);
        (p - off.normalized() * self.major) / self.minor
    }
}

/// A root, or a range that may hold some.
enum IsolatedRoot<N> {
    Root(N),
    Range([f64; 2]),
}

/// Reports a root as a meeting.
fn reported<N: CertifiedNumber>(root: IsolatedRoot<N>, nearest: N, visit: Visit<'_, N>) {
    match root {
        IsolatedRoot::Root(s) => {
            let t = nearest + s;
            let ends = [t.low().max(0.0), t.high()];
            if t.is_positive() {
                visit(Meeting::Hits(SurfaceHit::new(t, 0)));
            } else if !t.is_negative() {
                visit(Meeting::Unclear(ends, Doubts::CONTACT));
            }
        }
        IsolatedRoot::Range([low, high]) => {
            let t = nearest + N::between(low, high);
            if !t.is_negative() {
                let ends = [t.low().max(0.0), t.high()];
                visit(Meeting::Unclear(ends, Doubts::SILHOUETTE));
            }
        }
    }
}

/// A polynomial, its coefficients from the highest power on.
struct Polynomial<N> {
    quartic: [N; 5],
    /// The number of coefficients that count, less one.
    degree: usize,
}

impl<N: CertifiedNumber> Polynomial<N> {
    /// The quotient by (s − root), of a quartic.
    fn without(&self, root: N) -> Self {
        let [a, b, c, d, _] = self.quartic;
        let b = b + a * root;
        let c = c + b * root;
        let d = d + c * root;
        Self {
            quartic: [a, b, c, d, N::ZERO],
            degree: 3,
        }
    }

    /// The value and the slope.
    fn at(&self, s: N) -> [N; 2] {
        let (mut value, mut slope) = (self.quartic[0], N::ZERO);
        for coefficient in &self.quartic[1..=self.degree] {
            slope = slope * s + value;
            value = value * s + *coefficient;
        }
        [value, slope]
    }

    /// Visits the roots between two numbers.
    fn visit_roots(&self, low: f64, high: f64, visit: &mut dyn FnMut(IsolatedRoot<N>)) {
        /// Shorter intervals are not divided, relative to the whole.
        const SHORTEST: f64 = 1e-7;
        /// More intervals are not looked at.
        const MOST: usize = 1 << 12;
        let shortest = SHORTEST * (high - low);
        let mut pending = vec![[low, high]];
        let mut count = 0;
        while let Some([a, b]) = pending.pop() {
            count += 1;
            let (part, middle) = (N::between(a, b), 0.5 * a + 0.5 * b);
            let [value, slope] = self.at(part);
            // The mean value form is narrower for short intervals.
            let center = N::point(middle);
            let near = self.at(center)[0] + slope * (part - center);
            if value.has_sign() || near.has_sign() {
                continue;
            }
            // Where the polynomial is monotone, its signs at the ends tell.
            if slope.has_sign() {
                let ends = [a, b].map(|end| self.at(N::point(end))[0]);
                if ends.iter().all(|end| end.has_sign()) {
                    if ends[0].is_positive() != ends[1].is_positive() {
                        visit(IsolatedRoot::Root(self.narrowed([a, b])));
                    }
                    continue;
                }
            }
            if b - a <= shortest || count > MOST {
                visit(IsolatedRoot::Range([a, b]));
                continue;
            }
            pending.extend([[a, middle], [middle, b]]);
        }
    }

    /// The only root in an interval where the polynomial is monotone, by Newton's method: by the
    /// mean value theorem it is in every `m − p(m)/p′(set)`. Where that is not much narrower, the
    /// interval is halved.
    fn narrowed(&self, [mut a, mut b]: [f64; 2]) -> N {
        const MOST: usize = 64;
        let rises = self.at(N::point(b))[0].is_positive();
        let mut set = N::between(a, b);
        let mut is_bracket = true;
        for _ in 0..MOST {
            let center = if is_bracket {
                N::point(0.5 * a + 0.5 * b)
            } else {
                set.center()
            };
            let value = self.at(center)[0];
            let next = center - value / self.at(set)[1];
            if next.width() < 0.5 * set.width() {
                (set, is_bracket) = (next, false);
            } else if is_bracket && value.has_sign() {
                let middle = center.low();
                if value.is_positive() == rises {
                    b = middle;
                } else {
                    a = middle;
                }
                set = N::between(a, b);
            } else {
                break;
            }
        }
        set
    }
}
