//! The textbook intersection formulas in f64 or f32, next to the robust ones. They measure the cost
//! and benefit of accuracy. Each shape's file contains its baseline.
//!
//! Hits with t < 1e-5 are taken for the origin of the ray and ignored; rays start at the surface
//! point itself. The robust shape supplies the properties that do not depend on the arithmetic:
//! texture coordinates, shading normals and bounds.

pub(crate) mod ray;
pub(crate) mod real;
pub(crate) mod roots;

use crate::accel::bounds::BoundingSphere;
use crate::ray::{Interaction, Ray};
use crate::shape::emitter::{Emitter, FaceEmitter};
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
use crate::shape::mesh::BaselineMesh;
use crate::shape::normal_field::NormalField;
use crate::shape::triangle::WatertightRay;
use crate::shape::{BaselineKind, Shape};
use ray::BaselineRay;
use real::{Real, RealVector};
use rtc_math::{Bounds, Vec3, Vector};
use std::fmt::Debug;
use std::sync::Arc;

/// Intersection by baseline formulas.
pub(crate) trait Baseline<R>: Clone + Debug + Send + Sync {
    /// The first root that counts, and the part of the shape it is on; roots beyond `t_max` may be
    /// left out.
    fn intersect(&self, ray: &BaselineRay<R>, t_max: f64) -> Option<(R, u32)>;

    /// The normal at a point of a part.
    fn normal(&self, ray: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R>;
}

impl<R, P: Baseline<R>> Baseline<R> for Box<P> {
    #[inline]
    fn intersect(&self, ray: &BaselineRay<R>, t_max: f64) -> Option<(R, u32)> {
        (**self).intersect(ray, t_max)
    }

    fn normal(&self, ray: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        (**self).normal(ray, point, prim_id)
    }
}

/// A robust shape that has a baseline.
pub(crate) trait HasBaseline {
    /// The baseline; a large one is boxed.
    type Baseline<R: Real>: Baseline<R>;

    /// The baseline, from the same numbers; `mesh` is that of an instance. `None` for an instance
    /// without one.
    fn plain<R: Real>(&self, mesh: Option<&Arc<BaselineMesh<R>>>) -> Option<Self::Baseline<R>>;
}

/// A shape of any kind, ready to be hit by the baseline formulas in `R`.
#[derive(Clone, Debug)]
pub struct BaselineShape<R: Real> {
    form: BaselineKind<R>,
    /// Forwards the methods that do not depend on the arithmetic.
    robust: Box<Shape>,
}

/// Declares the intersection of a shape of any kind, and forwards its methods to the shape.
macro_rules! baselines {
    ($($Name:ident)*) => {
        /// The intersection of a shape of any kind by baseline formulas in `R`.
        #[derive(Clone, Debug)]
        pub(crate) enum BaselineKind<R: Real> {
            $($Name(<$Name as HasBaseline>::Baseline<R>),)*
        }

        impl<R: Real> BaselineKind<R> {
            pub(crate) fn of(robust: &Shape, mesh: Option<&Arc<BaselineMesh<R>>>) -> Option<Self> {
                Some(match robust {
                    $(Shape::$Name(shape) => Self::$Name(shape.plain(mesh)?),)*
                })
            }

            #[inline]
            pub(crate) fn intersect(&self, ray: &BaselineRay<R>, t_max: f64) -> Option<(R, u32)> {
                match self {
                    $(Self::$Name(shape) => Baseline::intersect(shape, ray, t_max),)*
                }
            }

            pub(crate) fn normal(
                &self,
                ray: &BaselineRay<R>,
                point: Vector<R>,
                prim_id: u32,
            ) -> Vector<R> {
                match self {
                    $(Self::$Name(shape) => Baseline::normal(shape, ray, point, prim_id),)*
                }
            }
        }
    };
}
pub(crate) use baselines;

impl<R: Real> BaselineShape<R> {
    /// The baseline of a shape; `mesh` is that of an instance. `None` for an instance without one.
    pub(crate) fn new(robust: Shape, mesh: Option<&Arc<BaselineMesh<R>>>) -> Option<Self> {
        Some(Self {
            form: BaselineKind::of(&robust, mesh)?,
            robust: Box::new(robust),
        })
    }
}

impl<R: Real> Intersect for BaselineShape<R> {
    const FLATTENS: bool = false;

    // Plain formulas are there to be compared with: one kernel is enough.
    const HAS_KERNELS: bool = false;

    #[inline]
    fn intersect(&self, ray: &Ray, _shear: &WatertightRay, t_max: f64) -> Option<(f64, u32)> {
        let hit = self.form.intersect(&BaselineRay::of(ray), t_max);
        hit.map(|(t, prim_id)| (t.wide(), prim_id))
    }

    /// The point on the ray; new rays start at the point itself.
    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        let ray = BaselineRay::<R>::of(ray);
        let point = ray.at(R::of(t));
        let normal = self.form.normal(&ray, point, prim_id).wide();
        Interaction {
            point: point.wide(),
            normal,
            offset: 0.0,
            back: Vec3::ZERO,
        }
    }

    fn has_shading_normals(&self) -> bool {
        self.robust.has_shading_normals()
    }

    fn shading_attributes(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        request: AttributeRequest,
    ) -> ShadingAttributes {
        self.robust.shading_attributes(ray, at, prim_id, request)
    }

    fn uv_derivatives(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        set: usize,
    ) -> Option<[Vec3; 2]> {
        self.robust.uv_derivatives(ray, at, prim_id, set)
    }

    /// The lights are those of the robust shape: light is sampled in the same way by each
    /// arithmetic.
    fn triangles(&self) -> usize {
        self.robust.triangles()
    }

    fn corners(&self, prim_id: u32) -> Option<[Vec3; 3]> {
        self.robust.corners(prim_id)
    }

    fn normal_field(&self) -> Option<NormalField<'_>> {
        self.robust.normal_field()
    }

    fn emitter(&self) -> Option<Emitter> {
        self.robust.emitter()
    }

    fn face_emitters(&self) -> Vec<FaceEmitter> {
        self.robust.face_emitters()
    }

    fn face(&self, prim_id: u32, normal: Vec3) -> (u32, Vec3) {
        self.robust.face(prim_id, normal)
    }

    fn bounds(&self) -> Option<Bounds> {
        self.robust.bounds()
    }

    /// Plain formulas may hit beside the shape.
    fn ball(&self) -> Option<BoundingSphere> {
        None
    }
}
