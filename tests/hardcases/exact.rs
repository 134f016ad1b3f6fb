//! The truth about a ray and a shape, in double-double and by other formulas than those under test.
//!
//! The ray is moved near the shape without error, where every implicit function has the size of the
//! shape; all roots are candidates, those that the other conditions allow count. 106 bits leave an
//! error below (1 + κ)·2⁻⁹⁰ of t.

use rtc::internals::ir;
use rtc::internals::math::{DoubleDouble, Vec3};
use rtc::internals::render::Ray;

type Wide = [DoubleDouble; 3];

/// The first hit, if any, and the condition number of its t:
/// κ = (Σ|nₖ|(|oₖ| + |cₖ| + |t·dₖ|) + extent)/(|n·d|·|t|).
pub(crate) struct Truth {
    pub(crate) t: Option<DoubleDouble>,
    pub(crate) kappa: f64,
}

fn number(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

fn wide(v: [f64; 3]) -> Wide {
    v.map(number)
}

fn dot(a: Wide, b: Wide) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Wide, b: Wide) -> Wide {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn along(a: Wide, b: Wide, s: DoubleDouble) -> Wide {
    [0, 1, 2].map(|k| a[k] + b[k] * s)
}

fn difference(a: [f64; 3], b: [f64; 3]) -> Wide {
    [0, 1, 2].map(|k| DoubleDouble::difference(a[k], b[k]))
}

fn is_negative(x: DoubleDouble) -> bool {
    x.to_f64() < 0.0
}

/// A ray seen from a point near it: `from + d·s` with `t = shift + s`.
struct Line {
    from: Wide,
    d: Wide,
    shift: DoubleDouble,
}

impl Line {
    fn new(ray: &Ray, center: [f64; 3]) -> Self {
        let start = difference(ray.origin.to_array(), center);
        let f = Vec3::from_array(start.map(DoubleDouble::to_f64));
        let shift = number(-f.dot(ray.direction) / ray.direction.length_squared());
        let d = wide(ray.direction.to_array());
        Self {
            from: along(start, d, shift),
            d,
            shift,
        }
    }

    fn at(&self, s: DoubleDouble) -> Wide {
        along(self.from, self.d, s)
    }
}

/// The real roots of `a·s² + 2·b·s + c`.
fn roots(a: DoubleDouble, b: DoubleDouble, c: DoubleDouble) -> Vec<DoubleDouble> {
    let discriminant = b * b - a * c;
    if is_negative(discriminant) {
        return Vec::new();
    }
    let root = discriminant.sqrt();
    let q = if is_negative(b) {
        root - b
    } else {
        number(0.0) - b - root
    };
    let quotients = [(q, a), (c, q)]
        .into_iter()
        .filter(|(_, below)| below.to_f64() != 0.0);
    quotients.map(|(above, below)| above / below).collect()
}

/// The first candidate in front, with the normal there.
fn nearest(line: &Line, candidates: Vec<(DoubleDouble, Wide)>) -> Option<(DoubleDouble, Wide)> {
    let in_front = candidates
        .into_iter()
        .map(|(s, n)| (line.shift + s, n))
        .filter(|(t, _)| t.to_f64() > 0.0);
    in_front.min_by(|a, b| (a.0 - b.0).to_f64().total_cmp(&0.0))
}

/// What is true of a ray and a shape; `None` for shapes that have no truth here.
pub(crate) fn truth(shape: &ir::Shape, ray: &Ray) -> Option<Truth> {
    let (found, anchor, extent) = if let ir::Shape::Sphere(s) = shape {
        (sphere(s, ray), s.center, s.radius)
    } else if let ir::Shape::Plane(s) = shape {
        (plane(s.center, wide(s.normal), ray), s.center, 0.0)
    } else if let ir::Shape::Triangle(s) = shape {
        (triangle(s.vertices, ray), s.vertices[0], 0.0)
    } else if let ir::Shape::Cylinder(s) = shape {
        (cylinder(s, ray), s.base, s.radius)
    } else if let ir::Shape::Cone(s) = shape {
        (cone(s, ray), s.base, s.radius)
    } else if let ir::Shape::Paraboloid(s) = shape {
        (paraboloid(s, ray), s.base, s.radius)
    } else if let ir::Shape::Torus(s) = shape {
        (torus(s, ray), s.center, 2.0 * (s.major + s.minor))
    } else {
        return None;
    };
    let Some((t, normal)) = found else {
        return Some(Truth {
            t: None,
            kappa: 0.0,
        });
    };
    let n = Vec3::from_array(normal.map(DoubleDouble::to_f64)).normalize();
    let t_rounded = t.to_f64();
    let sizes =
        ray.origin.abs() + Vec3::from_array(anchor).abs() + (ray.direction * t_rounded).abs();
    let kappa = (n.abs().dot(sizes) + extent) / (n.dot(ray.direction) * t_rounded).abs();
    Some(Truth { t: Some(t), kappa })
}

fn sphere(s: &ir::Sphere, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let line = Line::new(ray, s.center);
    let (f, d, r) = (line.from, line.d, number(s.radius));
    let all = roots(dot(d, d), dot(f, d), dot(f, f) - r * r);
    nearest(&line, all.into_iter().map(|s| (s, line.at(s))).collect())
}

fn plane(center: [f64; 3], n: Wide, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let slope = dot(n, wide(ray.direction.to_array()));
    let t = dot(n, difference(center, ray.origin.to_array())) / slope;
    (slope.to_f64() != 0.0 && t.to_f64() > 0.0).then_some((t, n))
}

/// Which side of the three edges a ray passes, as volumes, each over the product of its lengths.
pub(crate) fn sides([a, b, c]: [[f64; 3]; 3], ray: &Ray) -> [f64; 3] {
    let (origin, d) = (ray.origin.to_array(), wide(ray.direction.to_array()));
    [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let (p, q) = (difference(from, origin), difference(to, origin));
        let size = |v: Wide| Vec3::from_array(v.map(DoubleDouble::to_f64)).length();
        dot(d, cross(p, q)).to_f64() / (size(p) * size(q) * size(d))
    })
}

fn triangle(vertices: [[f64; 3]; 3], ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let [a, b, c] = vertices;
    let sides = sides(vertices, ray);
    let inside = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
    inside.then(|| plane(a, cross(difference(b, a), difference(c, a)), ray))?
}

/// The candidates of a round side `a·s² + 2·b·s + c = 0`, with normals, and of the flat ends, all
/// between those ends: `low ≤ above + rise·s ≤ high`.
struct Capped {
    side: [DoubleDouble; 3],
    above: DoubleDouble,
    rise: DoubleDouble,
    ends: [DoubleDouble; 2],
}

impl Capped {
    fn candidates(
        &self,
        axis: Wide,
        normal: impl Fn(DoubleDouble) -> Wide,
    ) -> Vec<(DoubleDouble, Wide)> {
        let [a, b, c] = self.side;
        let height = |s: DoubleDouble| self.above + self.rise * s;
        let between = |s: &DoubleDouble| {
            !is_negative(height(*s) - self.ends[0]) && !is_negative(self.ends[1] - height(*s))
        };
        let side = roots(a, b, c)
            .into_iter()
            .filter(between)
            .map(|s| (s, normal(s)));
        let caps = self.ends.map(|end| (end - self.above) / self.rise);
        let inside = |s: &DoubleDouble| !is_negative(number(0.0) - ((a * *s + b + b) * *s + c));
        let level = self.rise.to_f64() == 0.0;
        let caps = caps
            .into_iter()
            .filter(|s| !level && inside(s))
            .map(|s| (s, axis));
        side.chain(caps).collect()
    }
}

fn cylinder(s: &ir::Cylinder, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let line = Line::new(ray, s.base);
    let (axis, r) = (wide(s.axis), number(s.radius));
    let (w, x, a2) = (cross(line.from, axis), cross(line.d, axis), dot(axis, axis));
    let capped = Capped {
        side: [dot(x, x), dot(w, x), dot(w, w) - r * r * a2],
        above: dot(line.from, axis),
        rise: dot(line.d, axis),
        ends: [number(0.0), number(s.height) * a2.sqrt()],
    };
    let candidates = capped.candidates(axis, |s| cross(axis, along(w, x, s)));
    nearest(&line, candidates)
}

/// With u the axis from base to apex: ‖p × u‖·‖u‖ ≤ r·(u·u − p·u) and p·u ≥ 0.
fn cone(s: &ir::Cone, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let line = Line::new(ray, s.base);
    let (up, r2) = (wide(s.up), number(s.radius) * number(s.radius));
    let (w, x, h2) = (cross(line.from, up), cross(line.d, up), dot(up, up));
    let (above, rise) = (dot(line.from, up), dot(line.d, up));
    let left = h2 - above;
    let capped = Capped {
        side: [
            h2 * dot(x, x) - r2 * rise * rise,
            h2 * dot(w, x) + r2 * left * rise,
            h2 * dot(w, w) - r2 * left * left,
        ],
        above,
        rise,
        ends: [number(0.0), h2],
    };
    // u × (p × u) is the radial part of p times u·u.
    let normal = |s: DoubleDouble| {
        let radial = cross(up, along(w, x, s));
        let length = dot(radial, radial).sqrt();
        [0, 1, 2].map(|k| {
            radial[k] / length * h2.sqrt() + up[k] * number(r2.to_f64().sqrt()) / h2.sqrt()
        })
    };
    nearest(&line, capped.candidates(up, normal))
}

/// With u the way from base to vertex and q = p·(u·u) − u·(p·u), the radial part of p times u·u:
/// q·q ≤ r²·(u·u)·(u·u − p·u) and p·u ≥ 0.
fn paraboloid(s: &ir::Paraboloid, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let line = Line::new(ray, s.base);
    let (up, r2) = (wide(s.up), number(s.radius) * number(s.radius));
    let (h2, zero) = (dot(up, up), number(0.0));
    let (above, rise) = (dot(line.from, up), dot(line.d, up));
    let radial = |v: Wide, along: DoubleDouble| [0, 1, 2].map(|k| v[k] * h2 - up[k] * along);
    let (w, x) = (radial(line.from, above), radial(line.d, rise));
    let capped = Capped {
        side: [
            dot(x, x),
            dot(w, x) + r2 * h2 * rise * number(0.5),
            dot(w, w) - r2 * h2 * (h2 - above),
        ],
        above,
        rise,
        ends: [zero, h2],
    };
    // The gradient: twice the radial part, and r²/h along the axis.
    let normal = |s: DoubleDouble| {
        let q = along(w, x, s);
        [0, 1, 2].map(|k| (q[k] + q[k] + up[k] * r2) / h2)
    };
    nearest(&line, capped.candidates(up, normal))
}

/// The roots of ‖p‖² + R² − r² = 2R·ρ, squared: between two roots of a derivative there is at most
/// one of the function.
fn torus(s: &ir::Torus, ray: &Ray) -> Option<(DoubleDouble, Wide)> {
    let line = Line::new(ray, s.center);
    let (axis, major, minor) = (wide(s.axis), number(s.major), number(s.minor));
    let [two, four, six] = [2.0, 4.0, 6.0].map(number);
    let (w, x, a2) = (cross(line.from, axis), cross(line.d, axis), dot(axis, axis));
    let (b, c) = (dot(line.from, line.d), dot(line.d, line.d));
    let k0 = dot(line.from, line.from) + (major - minor) * (major + minor);
    let r4 = four * major * major;
    let k = |s: DoubleDouble| (c * s + two * b) * s + k0;
    let value = |s: DoubleDouble| {
        let from_axis = along(w, x, s);
        k(s) * k(s) * a2 - r4 * dot(from_axis, from_axis)
    };
    // Half of the derivative, and of the second.
    let slope = |s: DoubleDouble| k(s) * (b + c * s) * two * a2 - r4 * (dot(w, x) + dot(x, x) * s);
    let bend = [
        six * c * c * a2,
        six * b * c * a2,
        (four * b * b + two * c * k0) * a2 - r4 * dot(x, x),
    ];
    let reach = number(1.01 * (s.major + s.minor) / ray.direction.length());
    let ends = |mut inner: Vec<DoubleDouble>| {
        inner.retain(|s| is_negative(*s - reach) && is_negative(number(0.0) - reach - *s));
        inner.extend([number(0.0) - reach, reach]);
        inner.sort_by(|a, b| (*a - *b).to_f64().total_cmp(&0.0));
        inner
    };
    let critical = changes(&ends(roots(bend[0], bend[1], bend[2])), slope);
    let normal = |s: DoubleDouble| {
        let p = line.at(s);
        let radial = cross(axis, cross(p, axis));
        let length = dot(radial, radial).sqrt();
        [0, 1, 2].map(|k| p[k] - radial[k] * major / length)
    };
    nearest(
        &line,
        changes(&ends(critical), value)
            .into_iter()
            .map(|s| (s, normal(s)))
            .collect(),
    )
}

/// Where a function changes its sign between neighbours of the borders, by bisection.
fn changes(
    borders: &[DoubleDouble],
    value: impl Fn(DoubleDouble) -> DoubleDouble,
) -> Vec<DoubleDouble> {
    let sign = |s: DoubleDouble| is_negative(value(s));
    let changing = borders
        .windows(2)
        .filter(|pair| sign(pair[0]) != sign(pair[1]));
    let bisect = |pair: &[DoubleDouble]| {
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..110 {
            let middle = (low + high) * number(0.5);
            if sign(middle) == sign(pair[0]) {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    changing.map(bisect).collect()
}
