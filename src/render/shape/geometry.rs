//! What a world asks of the shapes in it.

use crate::math::Vec3;
use crate::render::accel::bounds::Bounds;
use crate::render::ray::{Interaction, Ray};
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
    fn has_uv(&self) -> bool {
        false
    }

    /// Whether its shading normals are not the geometric ones.
    #[must_use]
    fn has_shading_normals(&self) -> bool {
        false
    }

    /// What the shape knows of the point beyond its geometry, as far as that is asked.
    #[must_use]
    fn details(&self, _ray: &Ray, _at: &Interaction, _prim_id: u32, _asked: Asked) -> Details {
        Details::default()
    }

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

/// The requested [`Details`] beyond normal and colour; others may be omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The texture coordinates.
    pub uv: bool,
    /// The tangent and its side.
    pub tangent: bool,
}

impl Asked {
    /// Nothing more.
    pub const NONE: Self = Self {
        uv: false,
        tangent: false,
    };

    /// All there is.
    pub const ALL: Self = Self {
        uv: true,
        tangent: true,
    };
}

/// The shading attributes of a point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Details {
    /// The unit shading normal, where it is not the geometric one.
    pub normal: Option<Vec3>,
    /// The texture coordinates.
    pub uv: Option<[f64; 2]>,
    /// A direction along the surface in which u grows and v stays.
    pub tangent: Option<Vec3>,
    /// ±1: the second axis of normal maps is `side·(normal × tangent)`.
    pub side: f64,
    /// The second set of texture coordinates.
    pub second_uv: Option<[f64; 2]>,
    /// The colour of the corners, with alpha.
    pub color: Option<[f64; 4]>,
}

impl Default for Details {
    fn default() -> Self {
        Self {
            normal: None,
            uv: None,
            tangent: None,
            side: 1.0,
            second_uv: None,
            color: None,
        }
    }
}
