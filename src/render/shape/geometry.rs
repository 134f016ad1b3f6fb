//! What a world asks of the shapes in it.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
use crate::render::shape::instance::{Asked, Details};
use crate::render::shape::triangle::Shear;

/// A kind of prepared shape: which shapes there are, and by which arithmetic rays meet them.
pub trait Geometry: Sized + Send + Sync {
    /// The smallest root above 0 and the part of the shape it is on; `shear` is that of the ray.
    /// Roots beyond `t_max` may be left out.
    #[must_use]
    fn intersect(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)>;

    /// As [`Geometry::intersect`], but of roots as near as rounding can tell the one on the first
    /// part.
    #[must_use]
    #[inline]
    fn closest_hit(&self, ray: &Ray, shear: &Shear, t_max: f64) -> Option<(f64, u32)> {
        self.intersect(ray, shear, t_max)
    }

    /// Calls `visit` with roots above 0 and their parts: all up to `t_max` that may be the nearest.
    fn visit_roots(&self, ray: &Ray, shear: &Shear, t_max: f64, visit: &mut dyn FnMut(f64, u32)) {
        if let Some((t, prim_id)) = self.intersect(ray, shear, t_max) {
            visit(t, prim_id);
        }
    }

    /// How far rounding may have moved a root; 0 for formulas whose errors nobody has bounded.
    #[must_use]
    fn error(&self, _ray: &Ray, _t: f64, _part: u32) -> f64 {
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

    /// What the shape knows of the point beyond its geometry, as far as that is asked.
    #[must_use]
    fn details(&self, ray: &Ray, at: &Interaction, prim_id: u32, asked: Asked) -> Details;

    /// How many flat parts it has that can be lights; each is a `prim_id` of
    /// [`Geometry::intersect`].
    #[must_use]
    fn triangles(&self) -> usize {
        0
    }

    /// The corners of such a part.
    #[must_use]
    fn corners(&self, _part: u32) -> Option<[Vec3; 3]> {
        None
    }

    /// How far rounding may have moved those corners.
    #[must_use]
    fn error_bound(&self) -> f64 {
        0.0
    }

    /// The root above 0 of such a part alone.
    #[must_use]
    fn intersect_prim(&self, _ray: &Ray, _part: u32) -> Option<f64> {
        None
    }

    /// A box around it, for shapes that have an end.
    #[must_use]
    fn bounds(&self) -> Option<Bounds>;
}
