//! The intersection interface that every shape implements.

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::emitter::{Emitter, FaceEmitter};
use crate::shape::four::Shape4;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, Vec3};

/// A kind of prepared shape: the list of shapes, and the arithmetic of their intersections.
pub trait Intersect: Sized + Send + Sync {
    /// Whether mesh instances may be flattened into world-space triangles.
    const FLATTENS: bool = true;

    /// Whether integrators are compiled for the features of a plan, or once with all features.
    const HAS_KERNELS: bool = true;

    /// Whether four rays are intersected at once by the same operations as one.
    const HAS_SHAPE4: bool = false;

    /// The smallest root above 0 and its primitive; `watertight` is that of the ray. Roots beyond
    /// `t_max` may be left out.
    #[must_use]
    fn intersect(&self, ray: &Ray, watertight: &WatertightRay, t_max: f64) -> Option<(f64, u32)>;

    /// Whether [`Intersect::intersect`] uses the watertight ray.
    #[must_use]
    fn uses_watertight_ray(&self) -> bool {
        false
    }

    /// As [`Intersect::intersect`], but of roots that rounding cannot distinguish, the one on the
    /// first primitive.
    #[must_use]
    #[inline]
    fn closest_hit(&self, ray: &Ray, watertight: &WatertightRay, t_max: f64) -> Option<(f64, u32)> {
        self.intersect(ray, watertight, t_max)
    }

    /// Calls `visit` with roots above 0 and their primitives: all up to `t_max` that may be the
    /// nearest.
    fn visit_roots(
        &self,
        ray: &Ray,
        watertight: &WatertightRay,
        t_max: f64,
        visit: &mut dyn FnMut(f64, u32),
    ) {
        if let Some((t, prim_id)) = self.intersect(ray, watertight, t_max) {
            visit(t, prim_id);
        }
    }

    /// A bound on the rounding error of a root; 0 for formulas without a known bound.
    #[must_use]
    fn error(&self, _ray: &Ray, _t: f64, _prim_id: u32) -> f64 {
        0.0
    }

    /// Visits the points where the ray enters and leaves a solid, over the whole line; none for a
    /// shape without an inside. For the surface that the ray starts on, no crossing is ahead.
    fn visit_crossings(&self, _ray: &Ray, _visit: &mut dyn FnMut(SolidCrossing)) {}

    /// As [`Intersect::interaction`], of a crossing of a part.
    #[must_use]
    fn interaction_on(&self, ray: &Ray, t: f64, part: u32) -> Interaction {
        self.interaction(ray, t, part)
    }

    /// The attributes of the point at `t`, a root on `prim_id` of this shape.
    #[must_use]
    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction;

    /// Whether its shading normals are not the geometric ones.
    #[must_use]
    fn has_shading_normals(&self) -> bool {
        false
    }

    /// The requested attributes of the point: normal, coordinates, colour.
    #[must_use]
    fn shading_attributes(
        &self,
        _ray: &Ray,
        _at: &Interaction,
        _prim_id: u32,
        _asked: AttributeRequest,
    ) -> ShadingAttributes {
        ShadingAttributes::default()
    }

    /// The derivatives of a point with respect to u and v, the texture coordinates of set `_set`, in
    /// the world; `None` where they are not known.
    #[must_use]
    fn uv_derivatives(
        &self,
        _ray: &Ray,
        _at: &Interaction,
        _prim_id: u32,
        _set: usize,
    ) -> Option<[Vec3; 2]> {
        None
    }

    /// The number of its triangles, which can be lights; each is a `prim_id` of
    /// [`Intersect::intersect`].
    #[must_use]
    fn triangles(&self) -> usize {
        0
    }

    /// The corners of a triangle.
    #[must_use]
    fn corners(&self, _prim_id: u32) -> Option<[Vec3; 3]> {
        None
    }

    /// How light sampling samples it; `None` for triangles, which are sampled one by one, for
    /// solids, whose faces are, and for shapes that only BSDF sampling finds.
    #[must_use]
    fn emitter(&self) -> Option<Emitter>;

    /// How light sampling samples each of its faces, in the order of their numbers; none for a
    /// shape that is sampled as a whole.
    #[must_use]
    fn face_emitters(&self) -> Vec<FaceEmitter> {
        Vec::new()
    }

    /// The face that a `prim_id` lies on, and the normal there of the whole surface that the face
    /// is a part of, for one of this shape.
    #[must_use]
    fn face(&self, prim_id: u32, normal: Vec3) -> (u32, Vec3) {
        (prim_id, normal)
    }

    /// How its unit normals change along it; `None` where that is not known: ray differentials
    /// then do not continue from it.
    #[must_use]
    fn normal_field(&self) -> Option<NormalField<'_>> {
        None
    }

    /// A bound on the rounding error of the corners.
    #[must_use]
    fn error_bound(&self) -> f64 {
        0.0
    }

    /// The ray as [`Intersect::intersect_prim`] wants it.
    #[must_use]
    #[inline]
    fn local(&self, ray: &Ray) -> LocalRay {
        LocalRay::new(*ray)
    }

    /// The root above 0 of one triangle.
    #[must_use]
    fn intersect_prim(&self, _ray: &LocalRay, _prim_id: u32) -> Option<f64> {
        None
    }

    /// As [`Intersect::intersect_prim`], of a root below `t_max` alone.
    #[must_use]
    #[inline]
    fn intersect_prim_before(&self, ray: &LocalRay, prim_id: u32, t_max: f64) -> Option<f64> {
        self.intersect_prim(ray, prim_id).filter(|t| *t < t_max)
    }

    /// Whether its triangles are those of an instance that is not moved: the coordinates of the
    /// shape are those of the world.
    #[must_use]
    fn is_in_place(&self) -> bool {
        false
    }

    /// A box around it; `None` for unbounded shapes.
    #[must_use]
    fn bounds(&self) -> Option<Bounds>;

    /// Itself, if it intersects four rays at a time.
    #[must_use]
    fn shape4(&self) -> Option<Shape4<'_>> {
        None
    }

    /// A ball around it; `None` for unbounded shapes, and where hits are not known to lie within.
    #[must_use]
    fn ball(&self) -> Option<BoundingSphere> {
        let Bounds { min, max } = self.bounds()?;
        Some(BoundingSphere {
            center: min * 0.5 + max * 0.5,
            radius: (max - min).length() * 0.5,
        })
    }
}

/// Where a ray enters or leaves a solid.
#[derive(Clone, Copy, Debug)]
pub struct SolidCrossing {
    /// Its t on the ray, of either sign; −∞ if the ray has always been inside.
    pub t: f64,
    /// Whether the ray enters there.
    pub enters: bool,
    /// The part of the solid.
    pub part: u32,
}

impl SolidCrossing {
    /// Visits both ends of a stretch inside a solid, each with its part.
    pub(crate) fn visit_both(enter: (f64, u32), leave: (f64, u32), visit: &mut dyn FnMut(Self)) {
        for ((t, part), enters) in [(enter, true), (leave, false)] {
            visit(Self { t, enters, part });
        }
    }
}

/// A ray in the coordinates of a shape, and its shear.
#[derive(Clone, Copy, Debug)]
pub struct LocalRay {
    /// The ray; its `t` are those of the world.
    pub ray: Ray,
    /// Its shear.
    pub watertight: WatertightRay,
}

impl LocalRay {
    /// The watertight ray of a ray in the coordinates of the shape.
    #[must_use]
    #[inline]
    pub fn new(ray: Ray) -> Self {
        let watertight = WatertightRay::new(&ray);
        Self { ray, watertight }
    }
}

/// The requested [`ShadingAttributes`] beyond normal and colour; others may be omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AttributeRequest {
    /// The texture coordinates.
    pub uv: bool,
    /// The tangent and its side.
    pub tangent: bool,
}

impl AttributeRequest {
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
pub struct ShadingAttributes {
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

impl Default for ShadingAttributes {
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
