//! Next-event estimation on the surface of each shape that does not consist of triangles, and the
//! density of each sample.
//!
//! A shape declares its [`Emitter`] in [`Intersect::emitter`](super::geometry::Intersect::emitter),
//! which has no default. From outside, a sphere is sampled by the cone of directions to it, and an
//! infinite cylinder by the directions that meet it; others are sampled by area. A solid is sampled
//! by the surfaces of its operands, of which a point counts where it lies on the boundary. The
//! density is a function of the point that a ray hits, so that BSDF
//! sampling can evaluate it.

use crate::bsdf::warp::direction_at_angle;
use crate::ray::OFFSET;
use crate::sampler::remapped;
use crate::shape::quad::BilinearPatch;
use rtc_math::{Bounds, OrthonormalBasis, U, Vec3, cross};
use std::f64::consts::PI;

/// A sphere is seen from outside if the square of the distance exceeds that of the radius by this
/// factor: on its surface there is no cone of directions to it.
const OUTSIDE: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A point is on an infinite cylinder if it leaves it after so small a part of its radius.
const NEAR: f64 = 1e-6;

/// A surface that can be sampled.
#[derive(Clone, Copy, Debug)]
pub enum Emitter {
    /// A sphere.
    Sphere {
        /// Its centre.
        center: Vec3,
        /// Its radius.
        radius: f64,
    },
    /// The image of the unit sphere.
    Ellipsoid {
        /// Its centre.
        center: Vec3,
        /// The images of the axes.
        axes: [Vec3; 3],
        /// The rows of the inverse map.
        inverse: [Vec3; 3],
    },
    /// Two triangles, which are the primitives 0 and 1.
    Triangles([[Vec3; 3]; 2]),
    /// The surface of revolution of a line, and its caps: a disc, a cylinder, a cone.
    Frustum {
        /// The centre of the base.
        base: Vec3,
        /// The unit vector from the base to the top.
        axis: Vec3,
        /// The distance of the top from the base.
        height: f64,
        /// The radii of the base and of the top.
        radii: [f64; 2],
        /// Whether it has caps.
        is_capped: bool,
    },
    /// A paraboloid with a cap at its base.
    Paraboloid {
        /// The centre of the base.
        base: Vec3,
        /// The unit vector from the base to the vertex.
        axis: Vec3,
        /// The distance of the vertex from the base.
        height: f64,
        /// The radius of the base.
        radius: f64,
    },
    /// A torus.
    Torus {
        /// Its centre.
        center: Vec3,
        /// The unit vector of its axis.
        axis: Vec3,
        /// The radius of the circle in the tube.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
    /// A bilinear patch.
    Patch(BilinearPatch),
    /// A cylinder without ends.
    InfiniteCylinder {
        /// A point of its axis.
        base: Vec3,
        /// The unit vector along it.
        axis: Vec3,
        /// Its radius.
        radius: f64,
    },
}

/// A face of a solid that is sampled for itself: the part of a surface on the boundary.
#[derive(Clone, Copy, Debug)]
pub struct FaceEmitter {
    /// The number of the face, as [`Intersect::face`](super::geometry::Intersect::face) has it.
    pub face: u32,
    /// The whole surface.
    pub emitter: Emitter,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EmitterPoint {
    /// The point.
    pub(crate) point: Vec3,
    /// The unit normal, outward for closed shapes.
    pub(crate) normal: Vec3,
    /// The primitive.
    pub(crate) prim_id: u32,
}

impl Emitter {
    /// Samples a point to be seen from `from` with two numbers in [0, 1).
    pub(crate) fn sample(&self, from: Vec3, u: [f64; 2]) -> EmitterPoint {
        let on = |point, normal: Vec3| EmitterPoint {
            point,
            normal,
            prim_id: 0,
        };
        match *self {
            Self::Sphere { center, radius } => {
                let normal = sphere_normal(from - center, radius, u);
                on(center + normal * radius, normal)
            }
            Self::Ellipsoid {
                center,
                axes: [x, y, z],
                inverse: [a, b, c],
            } => {
                let n = direction_at_angle(1.0 - 2.0 * u[0], u[1]);
                let normal = (a * n.x + b * n.y + c * n.z).normalize_or(n);
                on(center + (x * n.x + y * n.y + z * n.z), normal)
            }
            Self::Triangles(triangles) => triangle_point(&triangles, u),
            Self::Frustum {
                base,
                axis,
                height,
                radii,
                is_capped,
            } => {
                let areas = frustum_areas(height, radii, is_capped);
                let (face, [u, turns]) = face_of(&areas, u);
                let outward =
                    OrthonormalBasis::around(axis).to_world(direction_at_angle(0.0, turns));
                let [r0, r1] = radii;
                if face > 0 {
                    let (center, r, normal) = match face {
                        1 => (base, r0, -axis),
                        _ => (base + axis * height, r1, axis),
                    };
                    return on(center + outward * (r * u.sqrt()), normal);
                }
                // The area of a ring grows with its radius, so the square of that is uniform.
                let rho = (r0 * r0 + (r1 * r1 - r0 * r0) * u).sqrt();
                let along = u * (r0 + r1) / (r0 + rho);
                let normal = (outward * height + axis * (r0 - r1)).normalize_or(axis);
                on(base + axis * (height * along) + outward * rho, normal)
            }
            Self::Paraboloid {
                base,
                axis,
                height,
                radius,
            } => {
                let (face, [u, turns]) = face_of(&paraboloid_areas(height, radius), u);
                let outward =
                    OrthonormalBasis::around(axis).to_world(direction_at_angle(0.0, turns));
                let ring = base + outward * (radius * u.sqrt());
                if face == 1 {
                    return on(ring, -axis);
                }
                let slope = 2.0 * height * u.sqrt() / radius;
                let normal = (outward * slope + axis).normalize_or(axis);
                on(ring + axis * (height * (1.0 - u)), normal)
            }
            Self::Torus {
                center,
                axis,
                major,
                minor,
            } => {
                let outward =
                    OrthonormalBasis::around(axis).to_world(direction_at_angle(0.0, u[0]));
                let turn = direction_at_angle(0.0, u[1]);
                let normal = outward * turn.x + axis * turn.y;
                on(center + outward * major + normal * minor, normal)
            }
            Self::Patch(patch) => patch.sample(u),
            Self::InfiniteCylinder { base, axis, radius } => {
                CylinderView::new(from, base, axis).point(radius, u)
            }
        }
    }

    /// The density per solid angle with which [`Self::sample`] samples the direction `wi` from
    /// `from` to a point at a squared distance; 0 if it cannot.
    pub(crate) fn pdf(&self, from: Vec3, wi: Vec3, at: &EmitterPoint, square: f64) -> f64 {
        if let Self::Sphere { center, radius } = self
            && let Some(width) = cone_width(from - *center, *radius)
        {
            // The cone samples the front of the sphere alone.
            return if wi.dot(at.normal) < 0.0 {
                1.0 / (2.0 * PI * width)
            } else {
                0.0
            };
        }
        if let Self::InfiniteCylinder { base, axis, radius } = *self {
            return CylinderView::new(from, base, axis).density(radius, wi, at.normal);
        }
        // Convert from area to solid angle.
        let cosine = wi.dot(at.normal).abs();
        let pdf = self.density(at) * square / cosine;
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// The density per area at a point.
    pub(crate) fn density(&self, at: &EmitterPoint) -> f64 {
        match *self {
            Self::Ellipsoid {
                center,
                axes: [x, y, z],
                inverse,
            } => {
                // The unit sphere grows here by the volume times the length of the mapped normal.
                let [n_x, n_y, n_z] = inverse.map(|row| row.dot(at.point - center));
                let [a, b, c] = inverse;
                let normal = a * n_x + b * n_y + c * n_z;
                let volume = cross(x, y).dot(z).abs();
                1.0 / (4.0 * PI * volume * normal.length())
            }
            Self::Paraboloid {
                axis,
                height,
                radius,
                ..
            } => {
                // The side is sampled by its projection along the axis.
                let [side, base] = paraboloid_areas(height, radius);
                let cosine = at.normal.dot(axis);
                let share = if cosine < 0.0 { base } else { side * cosine };
                share / ((side + base) * PI * radius * radius)
            }
            Self::Torus {
                center,
                axis,
                minor,
                ..
            } => {
                // Both angles are uniform: a point moves by its distance from the axis.
                let rho = cross(at.point - center, axis).length();
                1.0 / (4.0 * PI * PI * minor * rho)
            }
            Self::Patch(patch) => 1.0 / patch.stretch_at(at.point, at.normal),
            Self::Sphere { .. }
            | Self::Triangles(_)
            | Self::Frustum { .. }
            | Self::InfiniteCylinder { .. } => 1.0 / self.area(),
        }
    }

    /// The area; that of an ellipsoid, of a paraboloid and of a patch is approximate.
    pub(crate) fn area(&self) -> f64 {
        match *self {
            Self::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            Self::Ellipsoid {
                axes: [x, y, z], ..
            } => {
                let squares = [cross(x, y), cross(y, z), cross(z, x)].map(Vec3::length_squared);
                4.0 * PI * (squares.iter().sum::<f64>() / 3.0).sqrt()
            }
            Self::Triangles(triangles) => triangles.iter().map(triangle_area).sum(),
            Self::Frustum {
                height,
                radii,
                is_capped,
                ..
            } => frustum_areas(height, radii, is_capped).iter().sum(),
            Self::Paraboloid { height, radius, .. } => {
                paraboloid_areas(height, radius).iter().sum()
            }
            Self::Torus { major, minor, .. } => 4.0 * PI * PI * major * minor,
            Self::Patch(patch) => patch.area(),
            Self::InfiniteCylinder { .. } => f64::INFINITY,
        }
    }

    /// Whether both sides of it are seen: it encloses nothing.
    pub(crate) fn is_open(&self) -> bool {
        self.flat_normal().is_some() || matches!(self, Self::Patch(_))
    }

    /// The normal of a flat shape, which shines from both of its sides.
    pub(crate) fn flat_normal(&self) -> Option<Vec3> {
        match *self {
            Self::Triangles([[a, b, c], _]) => (b - a).cross(c - a).try_normalize(),
            Self::Frustum {
                axis, is_capped, ..
            } => (!is_capped).then_some(axis),
            Self::Sphere { .. }
            | Self::Ellipsoid { .. }
            | Self::Paraboloid { .. }
            | Self::Torus { .. }
            | Self::Patch(_)
            | Self::InfiniteCylinder { .. } => None,
        }
    }

    /// The same surface, sampled alike from everywhere: where a solid has cut it, its back may be
    /// seen. One without ends is sampled within a box.
    pub(crate) fn by_area(self, within: Option<Bounds>) -> Option<Self> {
        match self {
            Self::Sphere { center, radius } => Some(Self::Ellipsoid {
                center,
                axes: Vec3::AXES.map(|axis| axis * radius),
                inverse: Vec3::AXES.map(|axis| axis / radius),
            }),
            Self::InfiniteCylinder { base, axis, radius } => {
                let Bounds { min, max } = within?;
                let half = 0.5 * (max - min).length();
                let middle = base + axis * axis.dot((min + max) * 0.5 - base);
                Some(Self::Frustum {
                    base: middle - axis * half,
                    axis,
                    height: 2.0 * half,
                    radii: [radius; 2],
                    is_capped: false,
                })
            }
            Self::Ellipsoid { .. }
            | Self::Triangles(_)
            | Self::Frustum { .. }
            | Self::Paraboloid { .. }
            | Self::Torus { .. }
            | Self::Patch(_) => Some(self),
        }
    }

    /// A square of a plane that covers what a box cuts out of it.
    pub(crate) fn of_plane(anchor: Vec3, normal: Vec3, within: Bounds) -> Self {
        let Bounds { min, max } = within;
        let middle = (min + max) * 0.5;
        let center = middle - normal * normal.dot(middle - anchor);
        let OrthonormalBasis {
            tangent, bitangent, ..
        } = OrthonormalBasis::around(normal);
        let half = 0.5 * (max - min).length();
        let corner = |x: f64, y: f64| center + (tangent * x + bitangent * y) * half;
        let [a, b, c, d] = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        Self::Triangles([[a, b, c], [a, c, d]])
    }

    /// The end of a shadow ray to a sampled point: off the surface by its rounding error, on the
    /// side of `from`, so that the surface does not hide it.
    pub(crate) fn end(at: &EmitterPoint, bounds: &Bounds, from: Vec3) -> Vec3 {
        let size = (bounds.min.abs().max(bounds.max.abs()) * 4.0).element_sum();
        let side = (from - at.point).dot(at.normal);
        at.point + at.normal * (OFFSET * U * size).copysign(side)
    }
}

/// 1 − cos of half the angle of the cone of directions to a sphere, which is `to` away from its
/// centre; `None` from inside.
fn cone_width(to: Vec3, radius: f64) -> Option<f64> {
    let sine_squared = radius * radius / to.length_squared();
    // Without cancellation where the sphere is small.
    (sine_squared * OUTSIDE < 1.0).then(|| sine_squared / (1.0 + (1.0 - sine_squared).sqrt()))
}

/// Samples a normal of a sphere: the first hit of a direction in the cone from outside (pbrt, 4th
/// ed., §6.2.4), or uniformly from inside.
fn sphere_normal(to: Vec3, radius: f64, [u, v]: [f64; 2]) -> Vec3 {
    let Some(width) = cone_width(to, radius) else {
        return direction_at_angle(1.0 - 2.0 * u, v);
    };
    // Sample the angle θ to the axis of the cone.
    let versine = u * width;
    let (cosine, sine_squared) = (1.0 - versine, versine * (2.0 - versine));
    // Find the angle α at the centre.
    let most = radius / to.length();
    let across = (1.0 - sine_squared / (most * most)).max(0.0).sqrt();
    let at_center = (sine_squared / most + cosine * across).min(1.0);
    OrthonormalBasis::around(to.normalize()).to_world(direction_at_angle(at_center, v))
}

/// An infinite cylinder as seen from a point, in the plane across its axis.
#[derive(Clone, Copy)]
struct CylinderView {
    from: Vec3,
    axis: Vec3,
    /// The unit vector to the axis, and across it.
    towards: Vec3,
    across: Vec3,
    /// The distance to the axis.
    distance: f64,
}

impl CylinderView {
    fn new(from: Vec3, base: Vec3, axis: Vec3) -> Self {
        let to = base - from;
        let to = to - axis * axis.dot(to);
        let distance = to.length();
        let basis = OrthonormalBasis::around(axis);
        let towards = to.normalize_or(basis.tangent);
        Self {
            from,
            axis,
            towards,
            across: axis.cross(towards),
            distance,
        }
    }

    /// Whether the point is outside of a cylinder of this radius.
    fn is_outside(&self, radius: f64) -> bool {
        self.distance * self.distance > radius * radius * OUTSIDE
    }

    /// The point of a cylinder of a radius that a direction meets first, by two numbers.
    ///
    /// The sine of the elevation over the plane across is uniform, so dω = dψ d(sin θ) has the
    /// density of the angle ψ in that plane over 2. From outside sin ψ is uniform between ±r/d;
    /// from inside ψ is, all around.
    fn point(&self, radius: f64, [u, v]: [f64; 2]) -> EmitterPoint {
        let is_outside = self.is_outside(radius);
        // The angle ψ in the plane across.
        let (cosine, sine) = if is_outside {
            let sine = (2.0 * u - 1.0) * (radius / self.distance);
            ((1.0 - sine * sine).sqrt(), sine)
        } else {
            let turn = direction_at_angle(0.0, u);
            (turn.x, turn.y)
        };
        let (nearest, off) = (self.distance * cosine, self.distance * sine);
        let half = ((radius - off) * (radius + off)).max(0.0).sqrt();
        let flat = if is_outside {
            nearest - half
        } else {
            nearest + half
        };
        let step = self.towards * (flat * cosine) + self.across * (flat * sine);
        let normal = (step - self.towards * self.distance).normalize_or(-self.towards);
        // The elevation over that plane. From the surface itself, half of the directions lead away
        // from it.
        let rise = 2.0 * v - 1.0;
        let slope = rise / ((1.0 - rise) * (1.0 + rise)).sqrt();
        let point = match flat > NEAR * radius {
            true => self.from + step + self.axis * (flat * slope),
            false => self.from,
        };
        EmitterPoint {
            point,
            normal,
            prim_id: 0,
        }
    }

    /// The density per solid angle of [`Self::point`] in a direction to a point with an outward
    /// normal.
    fn density(&self, radius: f64, wi: Vec3, normal: Vec3) -> f64 {
        if !self.is_outside(radius) {
            return 1.0 / (4.0 * PI);
        }
        // The sides that face away are hidden by the others.
        if wi.dot(normal) >= 0.0 {
            return 0.0;
        }
        let flat = wi - self.axis * self.axis.dot(wi);
        let cosine = flat.normalize_or(self.towards).dot(self.towards);
        0.25 * cosine * self.distance / radius
    }
}

/// The areas of the side, of the base and of the top.
fn frustum_areas(height: f64, [r0, r1]: [f64; 2], is_capped: bool) -> [f64; 3] {
    let slant = ((r0 - r1) * (r0 - r1) + height * height).sqrt();
    let cap = |r: f64| if is_capped { PI * r * r } else { 0.0 };
    [PI * (r0 + r1) * slant, cap(r0), cap(r1)]
}

/// The approximate area of the side, that of a cone, and the area of the base.
fn paraboloid_areas(height: f64, radius: f64) -> [f64; 2] {
    let [side, base, _] = frustum_areas(height, [radius, 0.0], true);
    [side, base]
}

fn triangle_area([a, b, c]: &[Vec3; 3]) -> f64 {
    0.5 * (*b - *a).cross(*c - *a).length()
}

/// Chooses a face in proportion to its area, and remaps the number.
fn face_of<const N: usize>(areas: &[f64; N], [u, v]: [f64; 2]) -> (usize, [f64; 2]) {
    let mut above = u * areas.iter().sum::<f64>();
    let last = areas.iter().rposition(|area| *area > 0.0).unwrap_or(0);
    for (face, area) in areas.iter().enumerate() {
        if face == last || above < *area {
            return (face, [remapped(above, *area), v]);
        }
        above -= area;
    }
    (0, [u, v])
}

/// Samples a point of two triangles by area. Halves of a parallelogram continue each other.
fn triangle_point(triangles: &[[Vec3; 3]; 2], u: [f64; 2]) -> EmitterPoint {
    let (half, [u, v]) = face_of(&triangles.each_ref().map(triangle_area), u);
    let [a, b, c] = triangles[half];
    let root = u.sqrt();
    let [along, across] = [root * (1.0 - v), root * v];
    EmitterPoint {
        point: a + (b - a) * along + (c - a) * across,
        normal: (b - a).cross(c - a).normalize_or(Vec3::Z),
        prim_id: u32::from(half == 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: Vec3 = Vec3::new(0.3, -0.2, 0.5);
    const AXIS: Vec3 = Vec3::new(0.6, 0.0, 0.8);

    /// Closed emitters, with their volumes.
    fn closed() -> Vec<(Emitter, f64)> {
        let frustum = |radii, volume| {
            let emitter = Emitter::Frustum {
                base: BASE,
                axis: AXIS,
                height: 1.5,
                radii,
                is_capped: true,
            };
            (emitter, volume)
        };
        let axes = [Vec3::X * 2.0, Vec3::new(0.5, 0.7, 0.0), Vec3::Z * 0.3];
        let [x, y, z] = axes;
        let volume = cross(x, y).dot(z);
        let inverse = [cross(y, z), cross(z, x), cross(x, y)].map(|row| row / volume);
        let (center, axis) = (BASE, AXIS);
        vec![
            frustum([0.7, 0.7], PI * 0.49 * 1.5),
            frustum([0.7, 0.0], PI * 0.49 * 0.5),
            (
                Emitter::Paraboloid {
                    base: BASE,
                    axis,
                    height: 1.5,
                    radius: 0.7,
                },
                PI * 0.49 * 0.75,
            ),
            (
                Emitter::Torus {
                    center,
                    axis,
                    major: 1.2,
                    minor: 0.4,
                },
                2.0 * PI * PI * 1.2 * 0.16,
            ),
            (
                Emitter::Ellipsoid {
                    center,
                    axes,
                    inverse,
                },
                4.0 / 3.0 * PI * volume.abs(),
            ),
            (
                Emitter::Sphere {
                    center,
                    radius: 0.6,
                },
                4.0 / 3.0 * PI * 0.216,
            ),
        ]
    }

    /// The mean of a function of points sampled from `from`, over a grid of numbers.
    fn mean(emitter: &Emitter, from: Vec3, of: impl Fn(&EmitterPoint) -> Vec3) -> Vec3 {
        const CELLS: u32 = 512;
        let middle = |cell: u32| (f64::from(cell) + 0.5) / f64::from(CELLS);
        let cells = (0..CELLS * CELLS).map(|k| [middle(k % CELLS), middle(k / CELLS)]);
        let sum = cells.map(|u| of(&emitter.sample(from, u))).sum::<Vec3>();
        sum / f64::from(CELLS * CELLS)
    }

    #[test]
    fn samples_weighted_by_their_density_enclose_the_volume() {
        // By Gauss, ∫ n dA = 0 and ∫ p·n dA = 3 V.
        for (emitter, volume) in closed() {
            let weight = |at: &EmitterPoint| 1.0 / emitter.density(at);
            let vector = mean(&emitter, BASE, |at| at.normal * weight(at));
            assert!(
                vector.length() < 4e-3 * emitter.area(),
                "{emitter:?}: {vector}"
            );
            let moment = mean(&emitter, BASE, |at| {
                Vec3::splat((at.point - BASE).dot(at.normal) * weight(at))
            });
            let error = (moment.x / (3.0 * volume) - 1.0).abs();
            assert!(error < 1e-2, "{emitter:?}: {} of {volume}", moment.x / 3.0);
        }
    }

    #[test]
    fn a_cone_of_directions_fits_spheres_of_all_sizes_and_distances() {
        for (radius, distance) in [
            (1.0, 1.001),
            (1.0, 2.0),
            (1e-4, 1.0),
            (1e6, 1e6 + 1.0),
            (1e-9, 1e3),
        ] {
            let from = BASE + AXIS * distance;
            let emitter = Emitter::Sphere {
                center: BASE,
                radius,
            };
            // The irradiance of a plane that faces the sphere is π (r/d)².
            let irradiance = mean(&emitter, from, |at| {
                let to = at.point - from;
                let wi = to.normalize();
                assert!(wi.dot(at.normal) <= 1e-6, "{radius} {distance}");
                Vec3::splat(-wi.dot(AXIS) / emitter.pdf(from, wi, at, to.length_squared()))
            });
            let expected = PI * (radius / distance) * (radius / distance);
            let error = (irradiance.x / expected - 1.0).abs();
            assert!(
                error < 1e-3,
                "{radius} {distance}: {} of {expected}",
                irradiance.x
            );
        }
    }
}
