//! What a world asks of the shapes in it.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::instance::{Asked, Details};
use crate::render::shape::triangle::Shear;

/// A kind of prepared shape: which shapes there are, and by which arithmetic rays meet them.
pub trait Geometry: Sized + Send + Sync {
    /// Whether triangles of instances can stand in the world one by one.
    const FLATTENS: bool = true;

    /// The smallest root above 0 and its primitive; `shear` is that of the ray. Roots beyond `t_max`
    /// may be left out.
    #[must_use]
    fn intersect(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)>;

    /// As [`Geometry::intersect`], but of roots that rounding cannot tell apart, the one on the
    /// first primitive.
    #[must_use]
    #[inline]
    fn closest_hit(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        self.intersect(ray, shear, t_max)
    }

    /// Calls `visit` with roots above 0 and their primitives: all up to `t_max` that may be the nearest.
    fn visit_roots(&self, ray: &Ray, shear: &Shear, t_max: f64, visit: &mut dyn FnMut(f64, u32)) {
        if let Some((t, prim_id)) = self.intersect(ray, shear, t_max) {
            visit(t, prim_id);
        }
    }

    /// A bound on the rounding error of a root; 0 for formulas without a known bound.
    #[must_use]
    fn error(&self, _ray: &Ray, _t: f64, _prim_id: u32) -> f64 {
        0.0
    }

    /// What is known of the point at `t`, a root on `prim_id` of this shape.
    #[must_use]
    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction;

    /// Whether its points have texture coordinates.
    #[must_use]
    fn has_uv(&self) -> bool;

    /// Whether its shading normals are not the geometric ones.
    #[must_use]
    fn has_shading_normals(&self) -> bool;

    /// The details of the point that are asked for: normal, coordinates, colour.
    #[must_use]
    fn details(&self, ray: &Ray, at: &Interaction, prim_id: u32, asked: Asked) -> Details;

    /// The number of its triangles, which can be lights; each is a `prim_id` of
    /// [`Geometry::intersect`].
    #[must_use]
    fn triangles(&self) -> usize {
        0
    }

    /// The corners of a triangle.
    #[must_use]
    fn corners(&self, _prim_id: u32) -> Option<[Vec3; 3]> {
        None
    }

    /// A bound on the rounding error of the corners.
    #[must_use]
    fn error_bound(&self) -> f64 {
        0.0
    }

    /// The root above 0 of one triangle.
    #[must_use]
    fn intersect_prim(&self, _ray: &Ray, _prim_id: u32) -> Option<f64> {
        None
    }

    /// A box around it; `None` for unbounded shapes.
    #[must_use]
    fn bounds(&self) -> Option<Bounds>;
}
