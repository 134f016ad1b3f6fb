//! Spheres and discs under affine maps.

use super::transform::AffineTransform;
use rtc_ir::{Disc, Ellipsoid, Shape, Sphere};
use rtc_math::{Vec3, unit};

/// A sphere, or the ellipsoid that it becomes.
pub(crate) fn sphere(radius: f64, to_world: &AffineTransform) -> Shape {
    let AffineTransform([x, y, z, center]) = to_world;
    match to_world.similarity() {
        Some(scale) => {
            // The rows of a turn are the axes; of a mirrored one the texture is mirrored.
            let rows = [*x, *y, *z].map(|axis| (axis / scale).to_array());
            let is_turned = rows != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let is_rotation = to_world.determinant() > 0.0;
            Shape::Sphere(Sphere {
                center: center.to_array(),
                radius: radius * scale,
                texture_from_world: (is_turned && is_rotation)
                    .then(|| to_world.orthonormal())
                    .flatten()
                    .map(|axes| axes.map(|axis| axis.to_array())),
            })
        }
        None => Shape::Ellipsoid(Ellipsoid {
            center: center.to_array(),
            axes: [*x, *y, *z].map(|axis| (axis * radius).to_array()),
        }),
    }
}

/// The disc that a transform makes; `None` if it is an ellipse.
pub(crate) fn disc(height: f64, radius: f64, to_world: &AffineTransform) -> Option<Disc> {
    let AffineTransform([x, y, ..]) = to_world;
    let (a, b) = (x.length(), y.length());
    let is_round = (a - b).abs() <= 1e-6 * a.max(b) && x.dot(*y).abs() <= 1e-6 * a * b;
    let normal = unit(x.cross(*y)).filter(|_| is_round)?;
    Some(Disc {
        center: to_world.point(Vec3::Z * height).to_array(),
        normal: normal.to_array(),
        radius: radius * a,
    })
}
