//! Covers for the backs of flat shapes that have one side only.

use super::transform::AffineTransform;
use rtc_ir::Mesh;
use rtc_math::{Vec3, unit};
use std::collections::BTreeMap;

/// The distance of a cover from its shape, over the extent of the shape.
const DISTANCE: f64 = 1e-5;

/// The vector from a flat shape to the cover of its back: the unit normal and the extent of the
/// shape are in its own coordinates. `None` if the map flattens it.
pub(crate) fn behind(normal: Vec3, extent: f64, to_world: &AffineTransform) -> Option<Vec3> {
    let AffineTransform([x, y, z, _]) = to_world;
    // The inverse transpose of the transform, up to a factor above 0.
    let rows = [y.cross(*z), z.cross(*x), x.cross(*y)];
    let turned = rows[0] * normal.x + rows[1] * normal.y + rows[2] * normal.z;
    let normal = unit(turned * to_world.determinant())?;
    let scale = x.length().max(y.length()).max(z.length());
    Some(-normal * (DISTANCE * extent * scale))
}

/// [`flat`] of the triangles of a mesh.
pub(crate) fn flat_mesh(mesh: &Mesh) -> Option<(Vec3, f64)> {
    let corner = |index: u32| Vec3::from_array(mesh.positions.at(index as usize));
    flat(mesh.triangles.iter().map(|triangle| triangle.map(corner)))
}

/// The normal of triangles that lie in one plane and face one way, and how far they reach.
pub(crate) fn flat(triangles: impl Iterator<Item = [Vec3; 3]> + Clone) -> Option<(Vec3, f64)> {
    const ROUNDING: f64 = 1e-4;
    let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
    let sum: Vec3 = triangles.clone().map(normal).sum();
    let common = unit(sum)?;
    let [first, ..] = triangles.clone().next()?;
    let corners = || triangles.clone().flatten().map(|corner| corner - first);
    let extent = corners().map(|corner| corner.length()).fold(0.0, f64::max);
    let is_level = |corner: Vec3| corner.dot(common).abs() <= ROUNDING * extent;
    let faces = |triangle: [Vec3; 3]| normal(triangle).dot(common) >= 0.0;
    (corners().all(is_level) && triangles.clone().all(faces)).then_some((common, extent))
}

/// Whether each edge of a mesh has two triangles, which run along it in opposite directions.
/// Vertices at one place are one.
pub(crate) fn is_closed(mesh: &Mesh) -> bool {
    let mut edges: BTreeMap<[[u64; 3]; 2], i64> = BTreeMap::new();
    // −0 is at the place of 0.
    let place = |index: u32| {
        let position = mesh.positions.at(index as usize);
        position.map(|coordinate| (coordinate + 0.0).to_bits())
    };
    for triangle in mesh.triangles.iter() {
        let [a, b, c] = triangle.map(place);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            // An edge between equal places is none.
            match from.cmp(&to) {
                std::cmp::Ordering::Less => *edges.entry([from, to]).or_default() += 1,
                std::cmp::Ordering::Equal => {}
                std::cmp::Ordering::Greater => *edges.entry([to, from]).or_default() -= 1,
            }
        }
    }
    edges.values().all(|sum| *sum == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::tessellate;

    #[test]
    fn a_cube_and_a_sphere_are_closed_and_a_cylinder_without_ends_is_not() {
        assert!(is_closed(&tessellate::cube()));
        assert!(is_closed(&Mesh::default()));
        assert!(!is_closed(&tessellate::cylinder()));
        assert!(!is_closed(&tessellate::rectangle()));
    }

    #[test]
    fn a_cover_is_behind_a_mirrored_shape_too() {
        let (normal, extent) = flat_mesh(&tessellate::rectangle()).unwrap();
        let mirror = AffineTransform::scale([-1.0, 1.0, 1.0]);
        for map in [AffineTransform::IDENTITY, mirror] {
            let back = behind(normal, extent, &map).unwrap();
            assert!(back.z < 0.0 && back.z > -1e-4, "{back:?}");
        }
        assert_eq!(flat_mesh(&tessellate::cube()), None);
    }
}
