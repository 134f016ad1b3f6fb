//! The faces of solids as zeros of functions, for points near them.

use rtc_ir::{Cone, Cylinder, Ellipsoid, Paraboloid, Plane, Solid, Torus};
use rtc_math::{Bounds, Vec3, unit};

/// The signed distance of a point from a face to first order, above 0 outside of the solid, and the
/// outward normal there; zero where it has none.
#[derive(Clone, Copy)]
pub(super) struct FaceSample {
    pub(super) distance: f64,
    pub(super) normal: Vec3,
}

impl FaceSample {
    /// By a function that vanishes on the face, and its gradient.
    fn implicit(value: f64, gradient: Vec3) -> Self {
        Self {
            distance: value / gradient.length().max(f64::MIN_POSITIVE),
            normal: normal(gradient),
        }
    }

    /// Of a plane through a point with a unit normal.
    fn plane(from_point: Vec3, normal: Vec3) -> Self {
        Self {
            distance: from_point.dot(normal),
            normal,
        }
    }
}

fn normal(gradient: Vec3) -> Vec3 {
    unit(gradient).unwrap_or(Vec3::ZERO)
}

/// A point in the coordinates of a round solid about an axis.
struct AxialPoint {
    /// The unit vector along the axis.
    axis: Vec3,
    /// The coordinate along the axis.
    above: f64,
    /// The distance from the axis, and the unit vector away from it.
    off: f64,
    out: Vec3,
}

impl AxialPoint {
    fn new(point: Vec3, base: [f64; 3], axis: Vec3) -> Self {
        let from_base = point - Vec3::from_array(base);
        let above = from_base.dot(axis);
        let out = from_base - axis * above;
        Self {
            axis,
            above,
            off: out.length(),
            out: normal(out),
        }
    }
}

/// The number of faces of a solid.
pub(super) fn count(solid: &Solid) -> u8 {
    match solid {
        Solid::Cylinder(_) => 3,
        Solid::Cone(_) | Solid::Paraboloid(_) => 2,
        Solid::Sphere(_)
        | Solid::Plane(_)
        | Solid::Torus(_)
        | Solid::Ellipsoid(_)
        | Solid::InfiniteCylinder(_) => 1,
    }
}

/// A face of a solid near a point: face 0 is that of the kind, the others are its caps.
pub(super) fn sample(solid: &Solid, face: u8, point: Vec3) -> FaceSample {
    let up = |vector: [f64; 3]| normal(Vec3::from_array(vector));
    match solid {
        Solid::Sphere(sphere) => {
            let from_center = point - Vec3::from_array(sphere.center);
            FaceSample {
                distance: from_center.length() - sphere.radius,
                normal: normal(from_center),
            }
        }
        Solid::Plane(Plane { center, normal }) => {
            FaceSample::plane(point - Vec3::from_array(*center), up(*normal))
        }
        Solid::Cylinder(Cylinder {
            base,
            axis,
            height,
            radius,
        }) => {
            let at = AxialPoint::new(point, *base, up(*axis));
            match face {
                0 => side(&at, *radius),
                1 => cap(&at),
                _ => FaceSample {
                    distance: at.above - height,
                    normal: at.axis,
                },
            }
        }
        Solid::InfiniteCylinder(cylinder) => {
            let at = AxialPoint::new(point, cylinder.center, up(cylinder.axis));
            side(&at, cylinder.radius)
        }
        Solid::Cone(Cone { base, up, radius }) => {
            let up = Vec3::from_array(*up);
            let at = AxialPoint::new(point, *base, normal(up));
            let slope = radius / up.length();
            match face {
                0 => FaceSample::implicit(
                    at.off - radius + slope * at.above,
                    at.out + at.axis * slope,
                ),
                _ => cap(&at),
            }
        }
        Solid::Paraboloid(Paraboloid { base, up, radius }) => {
            let up = Vec3::from_array(*up);
            let at = AxialPoint::new(point, *base, normal(up));
            let (height, off) = (up.length(), at.off / radius);
            match face {
                0 => FaceSample::implicit(
                    off * off - 1.0 + at.above / height,
                    at.out * (2.0 * off / radius) + at.axis / height,
                ),
                _ => cap(&at),
            }
        }
        Solid::Torus(Torus {
            center,
            axis,
            major,
            minor,
        }) => {
            let at = AxialPoint::new(point, *center, up(*axis));
            let from_tube = at.out * (at.off - major) + at.axis * at.above;
            FaceSample {
                distance: from_tube.length() - minor,
                normal: normal(from_tube),
            }
        }
        Solid::Ellipsoid(Ellipsoid { center, axes }) => {
            let [x, y, z] = axes.map(Vec3::from_array);
            let from_center = point - Vec3::from_array(*center);
            // The rows of the inverse of the matrix of the axes.
            let rows = [y.cross(z), z.cross(x), x.cross(y)];
            let rows = rows.map(|row| row / x.dot(rows[0]));
            let local = Vec3::from_array(rows.map(|row| row.dot(from_center)));
            let gradient = rows[0] * local.x + rows[1] * local.y + rows[2] * local.z;
            let length = local.length().max(f64::MIN_POSITIVE);
            FaceSample::implicit(length - 1.0, gradient / length)
        }
    }
}

/// The side of a round cylinder.
fn side(at: &AxialPoint, radius: f64) -> FaceSample {
    FaceSample {
        distance: at.off - radius,
        normal: at.out,
    }
}

/// The cap at the base.
fn cap(at: &AxialPoint) -> FaceSample {
    FaceSample {
        distance: -at.above,
        normal: -at.axis,
    }
}

/// A box around a solid; `None` for an infinite one.
pub(super) fn bounds(solid: &Solid) -> Option<Bounds> {
    let disc = |center: Vec3, axis: Vec3, radius| Bounds::around_disc(center, axis, radius);
    Some(match solid {
        Solid::Sphere(sphere) => Bounds::around(Vec3::from_array(sphere.center), sphere.radius),
        Solid::Torus(torus) => {
            Bounds::around(Vec3::from_array(torus.center), torus.major + torus.minor)
        }
        Solid::Ellipsoid(ellipsoid) => Bounds::around_ellipsoid(
            Vec3::from_array(ellipsoid.center),
            ellipsoid.axes.map(Vec3::from_array),
        ),
        Solid::Cylinder(cylinder) => {
            let base = Vec3::from_array(cylinder.base);
            let axis = normal(Vec3::from_array(cylinder.axis));
            let top = base + axis * cylinder.height;
            [base, top]
                .map(|center| disc(center, axis, cylinder.radius))
                .into_iter()
                .fold(Bounds::EMPTY, Bounds::union)
        }
        Solid::Cone(Cone { base, up, radius })
        | Solid::Paraboloid(Paraboloid { base, up, radius }) => {
            let (base, up) = (Vec3::from_array(*base), Vec3::from_array(*up));
            let ends = [base, base + up].map(|center| disc(center, normal(up), *radius));
            ends.into_iter().fold(Bounds::EMPTY, Bounds::union)
        }
        Solid::Plane(_) | Solid::InfiniteCylinder(_) => return None,
    })
}
