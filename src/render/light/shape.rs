//! An emissive shape that is not made of triangles.

use crate::ray::Ray;
use crate::shape::emitter::{Emitter, EmitterPoint};
use crate::shape::geometry::Intersect;
use crate::shape::triangle::WatertightRay;
use crate::world::SurfaceId;
use rtc_math::{Bounds, Vec3};
use std::f64::consts::PI;

/// The part of a way before a sampled point within which the boundary of a solid is looked for.
const NEAR: f64 = 1e-5;

/// A surface with an emissive material, sampled as its shape declares, or a face of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapeLight {
    pub(super) surface: SurfaceId,
    pub(super) emitter: Emitter,
    /// `None` for an infinite one.
    pub(super) bounds: Option<Bounds>,
    /// The number of the face, if it is one of a solid.
    pub(super) face: Option<u32>,
}

impl ShapeLight {
    /// The lights of a surface; none if its shape is not sampled as a whole or by its faces.
    pub(super) fn of<S: Intersect>(surface: SurfaceId, shape: &S) -> impl Iterator<Item = Self> {
        let bounds = shape.bounds();
        let light = move |emitter, face| Self {
            surface,
            emitter,
            bounds,
            face,
        };
        let whole = shape.emitter().map(|emitter| light(emitter, None));
        let faces = shape.face_emitters().into_iter();
        whole
            .into_iter()
            .chain(faces.map(move |face| light(face.emitter, Some(face.face))))
    }

    /// The approximate power of a mean radiance: an open shape shines from both of its sides. Of an
    /// infinite one the part within a distance counts.
    pub(super) fn power(&self, radiance: Vec3, reach: f64) -> f64 {
        let sides = if self.emitter.is_open() { 2.0 } else { 1.0 };
        let area = if let Emitter::InfiniteCylinder { radius, .. } = self.emitter {
            4.0 * PI * radius * reach
        } else {
            self.emitter.area()
        };
        sides * PI * area * radiance.max_element()
    }

    /// A point from which to sample it if none is given.
    pub(super) fn middle(&self) -> Vec3 {
        match (self.bounds, self.emitter) {
            (Some(bounds), _) => bounds.center(),
            (None, Emitter::InfiniteCylinder { base, .. }) => base,
            (None, _) => Vec3::ZERO,
        }
    }

    /// The sampled point as it is seen along a direction, and the end of a shadow ray to it; `None`
    /// where a face is not on the boundary of its solid.
    pub(super) fn seen<S: Intersect>(
        &self,
        shape: &S,
        from: Vec3,
        wi: Vec3,
        at: EmitterPoint,
    ) -> Option<(EmitterPoint, Vec3)> {
        let Some(face) = self.face else {
            let bounds = (self.bounds).unwrap_or_else(|| Bounds::of([at.point, from]));
            return Some((at, Emitter::end(&at, &bounds, from)));
        };
        let before = NEAR * at.point.distance(from);
        let ray = Ray {
            origin: at.point - wi * before,
            direction: wi,
        };
        let (t, prim_id) = shape.intersect(&ray, &WatertightRay::new(&ray), 2.0 * before)?;
        let hit = shape.interaction(&ray, t, prim_id);
        let is_it = t <= 1.5 * before && shape.face(prim_id, hit.normal).0 == face;
        let side = hit.offset.copysign(-wi.dot(hit.normal));
        let normal = hit.normal;
        is_it.then_some((
            EmitterPoint {
                prim_id,
                normal,
                ..at
            },
            hit.point + normal * side,
        ))
    }
}
