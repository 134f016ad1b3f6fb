//! Where a ray of enclosures meets a shape, by the textbook formulas in real numbers: the hit is
//! certain, or there certainly is none, or the enclosures do not tell.

use super::enclosure::{Enclosure, EnclosureVector};
use super::reason::Doubts;
use rtc_ir::{Scene, Shape, Surface};
use rtc_math::Vec3;

/// A ray of enclosures.
pub(super) struct CertifiedRay {
    pub(super) origin: EnclosureVector,
    /// A unit vector.
    pub(super) direction: EnclosureVector,
    /// The surface on which the origin lies exactly, with its geometric normal there.
    from: Option<(usize, EnclosureVector)>,
    /// A ray about in the middle, with bounds on the distances of the other origins and of the
    /// other directions.
    middle: [(Vec3, f64); 2],
}

impl CertifiedRay {
    /// A ray from a point, which may lie on a surface.
    pub(super) fn new(
        origin: EnclosureVector,
        direction: EnclosureVector,
        from: Option<(usize, EnclosureVector)>,
    ) -> Self {
        Self {
            origin,
            direction,
            from,
            middle: [origin.middle(), direction.middle()],
        }
    }

    /// The point at `t`.
    pub(super) fn at(&self, t: Enclosure) -> EnclosureVector {
        self.origin + self.direction * t
    }

    /// A range of t that holds all its points inside a ball; `None` if there certainly are none.
    ///
    /// The foot of the perpendicular from the centre to the ray in the middle is computed; the feet
    /// of all rays lie within `slack` of it, with plenty left for the rounding of this test itself.
    fn range_in(&self, ball: &Ball) -> Option<[f64; 2]> {
        const ROUNDING: f64 = 1e-12;
        const WIDEST: f64 = 0.1;
        let [(origin, origin_radius), (direction, direction_radius)] = self.middle;
        let f = origin - ball.center;
        let distance = f.length();
        let nearest = -f.dot(direction);
        let foot = (f + direction * nearest).length();
        let size = distance + origin.length() + ball.center.length();
        let slack = 4.0 * (origin_radius + distance * direction_radius) + ROUNDING * size;
        // Far from a single ray there is no bound.
        if direction_radius > WIDEST || !slack.is_finite() {
            return Some([0.0, f64::INFINITY]);
        }
        let reach = ball.radius * (1.0 + ROUNDING) + slack;
        let range = [nearest - reach, nearest + reach];
        let misses = foot > reach || range[1] < 0.0;
        (!misses).then_some(range)
    }
}

/// A sphere that contains a shape.
#[derive(Clone, Copy, Debug)]
struct Ball {
    center: Vec3,
    radius: f64,
}

impl Ball {
    /// A ball around points; `None` without points.
    fn around(points: &[Vec3]) -> Option<Self> {
        let min = points.iter().copied().reduce(Vec3::min)?;
        let max = points.iter().copied().reduce(Vec3::max)?;
        let center = 0.5 * min + 0.5 * max;
        let distance = |point: &Vec3| (*point - center).length();
        let radius = points.iter().map(distance).fold(0.0, f64::max);
        // The bounds of some shapes are rounded.
        let radius = radius + 1e-9 * (radius + center.length());
        Some(Self { center, radius })
    }
}

/// A shape with its formula.
#[derive(Clone, Debug)]
enum Formula {
    Sphere {
        center: Vec3,
        radius: f64,
    },
    Plane {
        center: Vec3,
        normal: Vec3,
    },
    Triangle([Vec3; 3]),
    Disc {
        center: Vec3,
        normal: Vec3,
        radius: f64,
    },
    /// A shape whose formula is not here, by its name.
    Unsupported(&'static str),
}

/// A surface, or half of a quadrilateral, as rays of enclosures see it.
#[derive(Clone, Debug)]
pub(super) struct CertifiedSurface {
    formula: Formula,
    /// `None` for an infinite shape.
    ball: Option<Ball>,
    /// The index of its material.
    pub(super) material: usize,
    pub(super) casts_no_shadow: bool,
}

/// A ray and a surface.
pub(super) enum Meeting {
    /// There is no hit.
    Misses,
    /// The hit.
    Hits(SurfaceHit),
    /// There may be a hit with t in this range.
    Unclear([f64; 2], Doubts),
}

/// A certain hit.
#[derive(Clone, Copy)]
pub(super) struct SurfaceHit {
    /// The distance.
    pub(super) t: Enclosure,
    /// The geometric unit normal: outward for a sphere, else as declared.
    pub(super) normal: EnclosureVector,
}

/// The surfaces of a scene.
pub(super) fn surfaces(scene: &Scene) -> Vec<CertifiedSurface> {
    let meshes = scene.mesh_boxes();
    let mut surfaces = Vec::with_capacity(scene.surfaces.len());
    for surface in &scene.surfaces {
        let mut points = Vec::new();
        surface
            .shape
            .corners_around(&meshes, &mut |corner| points.push(corner));
        for formula in formulas(&surface.shape) {
            surfaces.push(certified(surface, formula, &points));
        }
    }
    surfaces
}

/// A surface with one of its formulas, inside the hull of points.
fn certified(surface: &Surface, formula: Formula, points: &[Vec3]) -> CertifiedSurface {
    let ball = match &formula {
        Formula::Sphere { center, radius } | Formula::Disc { center, radius, .. } => Some(Ball {
            center: *center,
            radius: *radius,
        }),
        Formula::Triangle(vertices) => Ball::around(vertices),
        Formula::Plane { .. } => None,
        Formula::Unsupported(_) => Ball::around(points),
    };
    CertifiedSurface {
        formula,
        ball,
        material: surface.material.0 as usize,
        casts_no_shadow: surface.casts_no_shadow,
    }
}

/// The formulas of a shape: one, or two for the halves of a flat quadrilateral.
fn formulas(shape: &Shape) -> Vec<Formula> {
    let vector = Vec3::from_array;
    let unsupported = || vec![Formula::Unsupported(shape.kind().name())];
    match shape {
        Shape::Sphere(sphere) => vec![Formula::Sphere {
            center: vector(sphere.center),
            radius: sphere.radius,
        }],
        Shape::Plane(plane) => vec![Formula::Plane {
            center: vector(plane.center),
            normal: vector(plane.normal),
        }],
        Shape::Triangle(triangle) => match proper(triangle.vertices.map(vector)) {
            Some(triangle) => vec![triangle],
            None => unsupported(),
        },
        Shape::Quad(quad) => halves(quad.vertices.map(vector)).map_or_else(unsupported, Vec::from),
        Shape::Disc(disc) => vec![Formula::Disc {
            center: vector(disc.center),
            normal: vector(disc.normal),
            radius: disc.radius,
        }],
        Shape::Cylinder(_)
        | Shape::Cone(_)
        | Shape::Paraboloid(_)
        | Shape::Torus(_)
        | Shape::Instance(_)
        | Shape::Ellipsoid(_)
        | Shape::InfiniteCylinder(_)
        | Shape::Csg(_) => unsupported(),
    }
}

/// A triangle whose normal certainly has a length.
fn proper(vertices: [Vec3; 3]) -> Option<Formula> {
    let length = raw_normal(vertices).length();
    length.is_positive().then_some(Formula::Triangle(vertices))
}

/// The halves of a quadrilateral that the renderer sees as flat, split along the inner diagonal.
fn halves(vertices: [Vec3; 4]) -> Option<[Formula; 2]> {
    if !rtc_math::is_flat(vertices) {
        return None;
    }
    let pick = |t: [usize; 3]| t.map(|k| vertices[k]);
    // Only the certain choice of the diagonal will do.
    let along = |[a, b]: [[usize; 3]; 2]| raw_normal(pick(a)).dot(raw_normal(pick(b)));
    let splits = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let first = along(splits[0]);
    let split = if first.is_positive() {
        splits[0]
    } else if first.is_negative() && along(splits[1]).is_positive() {
        splits[1]
    } else {
        return None;
    };
    let [a, b] = split.map(|half| proper(pick(half)));
    Some([a?, b?])
}

/// (v1 − v0) × (v2 − v0).
fn raw_normal(vertices: [Vec3; 3]) -> EnclosureVector {
    let [a, b, c] = vertices.map(EnclosureVector::point);
    (b - a).cross(c - a)
}

impl CertifiedSurface {
    /// Whether and where the ray meets the surface in front of its origin; `index` is its own.
    pub(super) fn meet(&self, index: usize, ray: &CertifiedRay) -> Meeting {
        // Skip what is certainly far off.
        let all = [0.0, f64::INFINITY];
        let Some(range) = self.ball.map_or(Some(all), |ball| ray.range_in(&ball)) else {
            return Meeting::Misses;
        };
        let [low, high] = range;
        let range = [low.max(0.0), high];
        // Apply the formula.
        let left = ray.from.filter(|(from, _)| *from == index);
        match &self.formula {
            Formula::Sphere { center, radius } => match left {
                Some((_, normal)) => leave_sphere([*center], *radius, ray, normal),
                None => meet_sphere(*center, *radius, ray, range),
            },
            // A ray from a plane does not meet it again.
            Formula::Plane { .. } | Formula::Triangle(_) | Formula::Disc { .. }
                if left.is_some() =>
            {
                Meeting::Misses
            }
            Formula::Plane { center, normal } => {
                let normal = EnclosureVector::point(*normal);
                meet_plane(*center, normal, ray, range)
            }
            Formula::Triangle(vertices) => meet_triangle(*vertices, ray, range),
            Formula::Disc {
                center,
                normal,
                radius,
            } => meet_disc((*center, *normal, *radius), ray, range),
            Formula::Unsupported(name) => Meeting::Unclear(range, Doubts::unsupported(name)),
        }
    }
}

/// The first root of |o + t·d − c|² = r² above 0, of a ray that starts anywhere else:
/// `t = b ± √(r² − |f + b·d|²)` with `f = o − c` and `b = −f·d`, as |d| = 1.
fn meet_sphere(center: Vec3, radius: f64, ray: &CertifiedRay, range: [f64; 2]) -> Meeting {
    let center = EnclosureVector::point(center);
    let f = ray.origin - center;
    let b = -f.dot(ray.direction);
    let foot = f + ray.direction * b;
    let radius = Enclosure::point(radius);
    let discriminant = radius.square() - foot.square();
    if discriminant.is_negative() {
        return Meeting::Misses;
    }
    let root = discriminant.sqrt();
    let [first, second] = [b - root, b + root];
    if second.is_negative() {
        return Meeting::Misses;
    }
    let t = if !discriminant.is_positive() {
        return Meeting::Unclear(range, Doubts::SILHOUETTE);
    } else if first.is_positive() {
        first
    } else if first.is_negative() && second.is_positive() {
        second
    } else {
        return Meeting::Unclear(range, Doubts::CONTACT);
    };
    let local = f + ray.direction * t;
    let normal = EnclosureVector(local.0.map(|x| x / radius));
    Meeting::Hits(SurfaceHit { t, normal })
}

/// The other root of a ray that starts on the sphere, where the outward normal is `normal`:
/// `t = −2·r·(n·d)`.
fn leave_sphere(
    [center]: [Vec3; 1],
    radius: f64,
    ray: &CertifiedRay,
    normal: EnclosureVector,
) -> Meeting {
    let slope = normal.dot(ray.direction);
    if slope.is_positive() {
        return Meeting::Misses;
    }
    if !slope.is_negative() {
        let far = (Enclosure::point(2.0 * radius) * -slope).high();
        return Meeting::Unclear([0.0, far.max(0.0)], Doubts::CONTACT);
    }
    let radius = Enclosure::point(radius);
    let t = Enclosure::point(-2.0) * radius * slope;
    let local = ray.origin - EnclosureVector::point(center) + ray.direction * t;
    let normal = EnclosureVector(local.0.map(|x| x / radius));
    Meeting::Hits(SurfaceHit { t, normal })
}

/// `t = N·(a − o) / N·d`.
fn meet_plane(
    center: Vec3,
    normal: EnclosureVector,
    ray: &CertifiedRay,
    range: [f64; 2],
) -> Meeting {
    let slope = normal.dot(ray.direction);
    if slope.is_zero() {
        return Meeting::Misses;
    }
    let distance = normal.dot(EnclosureVector::point(center) - ray.origin);
    if !(slope.is_positive() || slope.is_negative()) {
        return Meeting::Unclear(range, Doubts::SILHOUETTE);
    }
    let t = distance / slope;
    if t.is_positive() {
        let normal = normal.normalized();
        Meeting::Hits(SurfaceHit { t, normal })
    } else if t.is_negative() {
        Meeting::Misses
    } else {
        Meeting::Unclear([0.0, t.high().max(0.0)], Doubts::CONTACT)
    }
}

/// The hit of the plane, if the volumes spanned by the direction and each edge have one sign
/// (Plücker coordinates; Segura, Feito, "Algorithms to test ray-triangle intersection", WSCG 2001).
fn meet_triangle(vertices: [Vec3; 3], ray: &CertifiedRay, range: [f64; 2]) -> Meeting {
    let [a, b, c] = vertices.map(|v| EnclosureVector::point(v) - ray.origin);
    let volume = |p: EnclosureVector, q: EnclosureVector| ray.direction.dot(p.cross(q));
    let volumes = [volume(a, b), volume(b, c), volume(c, a)];
    let some = |sign: fn(Enclosure) -> bool| volumes.into_iter().any(sign);
    if some(Enclosure::is_positive) && some(Enclosure::is_negative) {
        return Meeting::Misses;
    }
    let hit = meet_plane(vertices[0], raw_normal(vertices), ray, range);
    let inside = |sign: fn(Enclosure) -> bool| volumes.into_iter().all(sign);
    bounded(
        hit,
        inside(Enclosure::is_positive) || inside(Enclosure::is_negative),
    )
}

/// The hit of the plane, if it lies within the radius.
fn meet_disc(
    (center, normal, radius): (Vec3, Vec3, f64),
    ray: &CertifiedRay,
    range: [f64; 2],
) -> Meeting {
    let hit = meet_plane(center, EnclosureVector::point(normal), ray, range);
    let Meeting::Hits(SurfaceHit { t, .. }) = hit else {
        return hit;
    };
    let local = ray.origin - EnclosureVector::point(center) + ray.direction * t;
    let (square, limit) = (local.square(), Enclosure::point(radius).square());
    if limit.is_below(square) {
        return Meeting::Misses;
    }
    bounded(hit, square.is_below(limit))
}

/// A hit of the plane of a bounded surface that may lie outside of it, unless it is certainly
/// `inside`.
fn bounded(hit: Meeting, inside: bool) -> Meeting {
    match hit {
        Meeting::Hits(SurfaceHit { t, .. }) if !inside => {
            Meeting::Unclear([t.low(), t.high()], Doubts::SILHOUETTE)
        }
        Meeting::Hits(_) | Meeting::Misses | Meeting::Unclear(..) => hit,
    }
}
