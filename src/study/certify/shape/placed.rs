//! Meshes placed by affine maps.

use crate::certify::number::CertifiedNumber;
use crate::certify::vector::CertifiedVector;
use rtc_ir::Instance;
use rtc_math::{Vec3, Vector};

/// The map of an instance.
pub(super) struct PlacedMesh<N> {
    /// The images of the axes.
    axes: [Vector<N>; 3],
    origin: Vector<N>,
    /// The rows of the inverse of the axes.
    inverse: [Vector<N>; 3],
    /// Whether the map is a reflection.
    pub(super) mirrors: bool,
}

impl<N: CertifiedNumber> PlacedMesh<N> {
    /// The map of an instance; `None` if it may be singular.
    pub(super) fn new(instance: &Instance) -> Option<Self> {
        let columns = instance.world_from_object;
        let [x, y, z, origin] = columns.map(|column| Vector::point(Vec3::from_array(column)));
        let inverse = inverse([x, y, z])?;
        Some(Self {
            axes: [x, y, z],
            origin,
            inverse,
            mirrors: x.cross(y).dot(z).is_negative(),
        })
    }

    /// A point in world coordinates.
    pub(super) fn point(&self, local: Vec3) -> Vector<N> {
        Vector::point(local).combined(self.axes) + self.origin
    }

    /// A normal in world coordinates, of any length.
    pub(super) fn normal(&self, local: Vector<N>) -> Vector<N> {
        local.combined(self.inverse)
    }
}

/// The rows of the inverse of a map with these columns; `None` if it may be singular.
pub(super) fn inverse<N: CertifiedNumber>([x, y, z]: [Vector<N>; 3]) -> Option<[Vector<N>; 3]> {
    let volume = x.cross(y).dot(z);
    let rows = [y.cross(z), z.cross(x), x.cross(y)];
    volume.has_sign().then(|| rows.map(|row| row / volume))
}
