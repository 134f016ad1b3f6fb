//! CSG solids: union, intersection and difference (Roth 1982, "Ray casting for modeling solids").
//!
//! Each operand reports where the ray enters and leaves it, over the whole line. The crossings are
//! traversed in the order of t, with a bit per operand for being inside, and the boundary is where
//! the operations over these bits change their result. Crossings that rounding cannot distinguish
//! are taken in one step, so that coincident faces leave no film; the first operand wins.

use super::Shape;
use crate::ray::{Interaction, Ray};
use crate::shape::baseline::ray::BaselineRay;
use crate::shape::baseline::real::{Real, RealVector};
use crate::shape::baseline::{Baseline, HasBaseline};
use crate::shape::emitter::{Emitter, FaceEmitter};
use crate::shape::geometry::{AttributeRequest, Intersect, ShadingAttributes, SolidCrossing};
use crate::shape::mesh::BaselineMesh;
use crate::shape::tie;
use crate::shape::triangle::WatertightRay;
use rtc_math::{Bounds, SetStep, Vec3, Vector, evaluate_set};
use rtc_plan::MIN_HIT_DISTANCE;
use std::sync::Arc;

/// Offsets of new rays in units of that of the operand: faces of others may coincide with it.
const APART: f64 = 4.0;

/// A part of the boundary of a CSG solid: the part that lies on some of the operands.
#[derive(Clone, Debug)]
pub struct Csg {
    expression: Arc<SetExpression>,
    /// A bit for each operand whose surface contains this part.
    faces: u64,
    bounds: Option<Bounds>,
}

/// The operands and the operations over them.
#[derive(Debug)]
struct SetExpression {
    operands: Vec<Shape>,
    steps: Vec<SetStep>,
}

/// A crossing of an operand.
#[derive(Clone, Copy)]
struct OperandCrossing {
    t: f64,
    operand: usize,
    enters: bool,
    part: u32,
}

/// The contents of a primitive id: the part of an operand, the operand, and whether its normal
/// points into the solid.
#[derive(Clone, Copy)]
struct OperandFace {
    part: u32,
    operand: usize,
    is_turned: bool,
}

impl OperandFace {
    /// The normal of the solid for one of the operand, or the other way round.
    fn turned(self, normal: Vec3) -> Vec3 {
        if self.is_turned { -normal } else { normal }
    }

    fn prim_id(self) -> u32 {
        let operand = u32::try_from(self.operand).unwrap_or(u32::MAX);
        self.part << 7 | (operand & 63) << 1 | u32::from(self.is_turned)
    }

    /// The number of all of the surface of an operand.
    fn whole(operand: usize) -> u32 {
        let (part, is_turned) = (0, false);
        Self {
            part,
            operand,
            is_turned,
        }
        .prim_id()
    }

    fn of(prim_id: u32) -> Self {
        Self {
            part: prim_id >> 7,
            operand: (prim_id >> 1 & 63) as usize,
            is_turned: prim_id & 1 != 0,
        }
    }
}

impl Csg {
    /// The part of the boundary that lies on `faces`, a bit for each of at most 64 operands, which
    /// must be solids. The steps must leave one result.
    #[must_use]
    pub fn new(operands: Vec<Shape>, steps: Vec<SetStep>, faces: u64) -> Self {
        let boxes = operands.iter().map(|operand| {
            if let Shape::Plane(plane) = operand {
                return Bounds::of_half_space(plane.anchor(), plane.normal());
            }
            operand.bounds().unwrap_or(Bounds::EVERYTHING)
        });
        let bounds = Bounds::of_set(&steps, boxes);
        Self {
            expression: Arc::new(SetExpression { operands, steps }),
            faces,
            bounds,
        }
    }

    /// The crossings beyond `nearest` in their order, and the operands that hold the point there.
    fn crossings(&self, ray: &Ray, nearest: f64) -> (Vec<OperandCrossing>, u64) {
        let (mut crossings, mut inside) = (Vec::new(), 0_u64);
        for (operand, shape) in self.expression.operands.iter().enumerate() {
            shape.visit_crossings(ray, &mut |SolidCrossing { t, enters, part }| {
                if t > nearest && t.is_finite() {
                    crossings.push(OperandCrossing {
                        t,
                        operand,
                        enters,
                        part,
                    });
                } else if t <= nearest {
                    inside = with(inside, operand, enters);
                }
            });
        }
        crossings.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.operand.cmp(&b.operand)));
        (crossings, inside)
    }

    /// The number of crossings from the first on that rounding cannot distinguish.
    fn coincident(&self, ray: &Ray, crossings: &[OperandCrossing]) -> usize {
        let error = |crossing: &OperandCrossing| {
            let shape = &self.expression.operands[crossing.operand];
            let at = shape.interaction_on(ray, crossing.t, crossing.part);
            tie::error(ray, crossing.t, &at)
        };
        let mut count = 1;
        while let Some(next) = crossings.get(count) {
            let last = &crossings[count - 1];
            let is_distinct = next.operand == last.operand || next.t > last.t * tie::CLOSE;
            if is_distinct || next.t - error(next) > last.t + error(last) {
                break;
            }
            count += 1;
        }
        count
    }

    /// The surface of an operand as light sampling samples it.
    fn face_emitter(&self, shape: &Shape) -> Option<Emitter> {
        match (shape, self.bounds) {
            (Shape::Plane(plane), Some(bounds)) => {
                Some(Emitter::of_plane(plane.anchor(), plane.normal(), bounds))
            }
            _ => shape.emitter()?.by_area(self.bounds),
        }
    }

    /// Whether points with these operands around them are inside.
    fn is_inside(&self, inside: u64) -> bool {
        evaluate_set(&self.expression.steps, inside)
    }

    /// The first operand of some crossings without which the result would not change.
    fn ruling<'c>(&self, inside: u64, group: &'c [OperandCrossing]) -> &'c OperandCrossing {
        let after = group.iter().fold(inside, |inside, crossing| {
            with(inside, crossing.operand, crossing.enters)
        });
        let decides = |crossing: &&OperandCrossing| {
            let alone = with(inside, crossing.operand, crossing.enters);
            let without = with(after, crossing.operand, !crossing.enters);
            self.is_inside(alone) != self.is_inside(inside)
                || self.is_inside(without) != self.is_inside(after)
        };
        let first = |a: &&OperandCrossing, b: &&OperandCrossing| a.operand.cmp(&b.operand);
        let decisive = group.iter().filter(decides).min_by(first);
        decisive.or(group.iter().min_by(first)).unwrap_or(&group[0])
    }
}

/// The bits with one set or cleared.
fn with(inside: u64, operand: usize, is_inside: bool) -> u64 {
    let bit = 1 << operand;
    if is_inside {
        inside | bit
    } else {
        inside & !bit
    }
}

impl Csg {
    /// The first point of this part of the boundary beyond `nearest`.
    fn first_beyond(&self, nearest: f64, ray: &Ray, t_max: f64) -> Option<(f64, u32)> {
        let (crossings, mut inside) = self.crossings(ray, nearest);
        let mut rest = &crossings[..];
        while let Some(first) = rest.first() {
            if first.t > t_max * tie::CLOSE {
                return None;
            }
            let (group, after) = rest.split_at(self.coincident(ray, rest));
            let next = group.iter().fold(inside, |inside, crossing| {
                with(inside, crossing.operand, crossing.enters)
            });
            let enters = self.is_inside(next);
            if self.is_inside(inside) != enters {
                let crossing = self.ruling(inside, group);
                if self.faces >> crossing.operand & 1 != 0 {
                    let face = OperandFace {
                        part: crossing.part,
                        operand: crossing.operand,
                        is_turned: crossing.enters != enters,
                    };
                    return Some((crossing.t, face.prim_id()));
                }
            }
            (rest, inside) = (after, next);
        }
        None
    }
}

impl Intersect for Csg {
    fn intersect(&self, ray: &Ray, _: &WatertightRay, t_max: f64) -> Option<(f64, u32)> {
        self.first_beyond(0.0, ray, t_max)
    }

    fn interaction(&self, ray: &Ray, t: f64, prim_id: u32) -> Interaction {
        let face = OperandFace::of(prim_id);
        let at = self.expression.operands[face.operand].interaction_on(ray, t, face.part);
        Interaction {
            normal: face.turned(at.normal),
            offset: APART * at.offset,
            ..at
        }
    }

    fn shading_attributes(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        request: AttributeRequest,
    ) -> ShadingAttributes {
        let face = OperandFace::of(prim_id);
        let own = Interaction {
            normal: face.turned(at.normal),
            ..*at
        };
        let shape = &self.expression.operands[face.operand];
        let attributes = shape.shading_attributes(ray, &own, face.part, request);
        ShadingAttributes {
            normal: None,
            ..attributes
        }
    }

    fn uv_derivatives(
        &self,
        ray: &Ray,
        at: &Interaction,
        prim_id: u32,
        set: usize,
    ) -> Option<[Vec3; 2]> {
        let face = OperandFace::of(prim_id);
        let own = Interaction {
            normal: face.turned(at.normal),
            ..*at
        };
        let shape = &self.expression.operands[face.operand];
        shape.uv_derivatives(ray, &own, face.part, set)
    }

    fn emitter(&self) -> Option<Emitter> {
        None
    }

    fn face_emitters(&self) -> Vec<FaceEmitter> {
        let operands = self.expression.operands.iter().enumerate();
        let own = operands.filter(|(operand, _)| self.faces >> operand & 1 != 0);
        let faces = own.filter_map(|(operand, shape)| {
            let emitter = self.face_emitter(shape)?;
            let face = OperandFace::whole(operand);
            Some(FaceEmitter { face, emitter })
        });
        faces.collect()
    }

    fn face(&self, prim_id: u32, normal: Vec3) -> (u32, Vec3) {
        let face = OperandFace::of(prim_id);
        (OperandFace::whole(face.operand), face.turned(normal))
    }

    fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }
}

impl HasBaseline for Csg {
    type Baseline<R: Real> = BaselineCsg;

    fn plain<R: Real>(&self, _: Option<&Arc<BaselineMesh<R>>>) -> Option<BaselineCsg> {
        Some(BaselineCsg(self.clone()))
    }
}

/// The baseline is the robust solid: there is no textbook formula to compare it with.
#[derive(Clone, Debug)]
pub(crate) struct BaselineCsg(Csg);

impl BaselineCsg {
    fn wide<R: Real>(ray: &BaselineRay<R>) -> Ray {
        Ray {
            origin: ray.origin.wide(),
            direction: ray.direction.wide(),
        }
    }
}

impl<R: Real> Baseline<R> for BaselineCsg {
    fn intersect(&self, ray: &BaselineRay<R>, t_max: f64) -> Option<(R, u32)> {
        let wide = Self::wide(ray);
        // Hits near the origin are taken for the origin.
        let nearest = MIN_HIT_DISTANCE / wide.direction.length();
        let (t, prim_id) = self.0.first_beyond(nearest, &wide, t_max)?;
        Some((R::of(t), prim_id))
    }

    fn normal(&self, ray: &BaselineRay<R>, point: Vector<R>, prim_id: u32) -> Vector<R> {
        let wide = Self::wide(ray);
        let t =
            (point.wide() - wide.origin).dot(wide.direction) / wide.direction.dot(wide.direction);
        Vector::of(self.0.interaction(&wide, t, prim_id).normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::plane::Plane;
    use crate::shape::sphere::{Sphere, TexturedSphere};
    use SetStep::{Difference, Intersection, Operand, Union};

    fn ball(x: f64) -> Shape {
        Shape::Sphere(TexturedSphere {
            sphere: Sphere {
                center: Vec3::X * x,
                radius: 1.0,
            },
            texture_from_world: Vec3::AXES,
        })
    }

    /// The half-spaces of a cube of side 2 about a point.
    fn cube(center: Vec3) -> ([Shape; 6], [SetStep; 11]) {
        let normals = Vec3::AXES.map(|axis| [axis, -axis]);
        let mut sides = normals.as_flattened().iter().copied();
        let operands = std::array::from_fn(|_| {
            let normal = sides.next().unwrap_or(Vec3::X);
            Shape::Plane(Plane::new(center + normal, normal))
        });
        let steps = std::array::from_fn(|at| match at {
            0 => Operand,
            at if at % 2 == 1 => Operand,
            _ => Intersection,
        });
        (operands, steps)
    }

    /// All points at which a ray along x crosses parts of the boundary, each with its normal.
    fn crossings(csg: &Csg, y: f64) -> Vec<(f64, f64)> {
        let mut ray = Ray {
            origin: Vec3::new(-8.0, y, 0.0),
            direction: Vec3::X,
        };
        let mut found = Vec::new();
        while let Some((t, prim_id)) = csg.intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY)
        {
            let at = csg.interaction(&ray, t, prim_id);
            found.push(((at.point.x * 1024.0).round() / 1024.0, at.normal.x.signum()));
            ray = at.ray(ray.direction);
        }
        found
    }

    #[test]
    fn a_ray_crosses_the_boundary_of_each_operation() {
        for (step, expected) in [
            (Union, [(-1.0, -1.0), (1.5, 1.0)]),
            (Intersection, [(-0.5, -1.0), (1.0, 1.0)]),
            (Difference, [(-1.0, -1.0), (-0.5, 1.0)]),
        ] {
            let csg = Csg::new(vec![ball(0.0), ball(0.5)], vec![Operand, Operand, step], 3);
            assert_eq!(crossings(&csg, 0.0), expected, "{step:?}");
        }
    }

    #[test]
    fn an_eye_in_the_plane_of_two_faces_sees_what_they_bound() {
        let (left, steps) = cube(Vec3::ZERO);
        let operands = [left, cube(Vec3::X * 2.0).0].concat();
        let csg = Csg::new(
            operands,
            [&steps[..], &steps[..], &[Union]].concat(),
            u64::MAX,
        );
        for target in [-0.5, 0.0, 2.5] {
            let origin = Vec3::new(1.0, 0.0, -8.0);
            let ray = Ray {
                origin,
                direction: Vec3::new(target, 0.0, -1.0) - origin,
            };
            let found = csg.intersect(&ray, &WatertightRay::new(&ray), f64::INFINITY);
            assert!(
                found.is_some_and(|(t, _)| (t - 1.0).abs() < 1e-12),
                "{found:?} {target}"
            );
        }
    }

    #[test]
    fn faces_that_coincide_leave_no_film() {
        let (left, steps) = cube(Vec3::ZERO);
        for (step, x, expected) in [
            (Union, 2.0, &[(-1.0, -1.0), (3.0, 1.0)][..]),
            (Union, 0.0, &[(-1.0, -1.0), (1.0, 1.0)]),
            (Intersection, 2.0, &[]),
            (Intersection, 0.0, &[(-1.0, -1.0), (1.0, 1.0)]),
            (Difference, 2.0, &[(-1.0, -1.0), (1.0, 1.0)]),
            (Difference, 0.0, &[]),
        ] {
            let (right, _) = cube(Vec3::X * x);
            let operands = [left.clone(), right].concat();
            let steps = [&steps[..], &steps[..], &[step]].concat();
            for y in [0.0, 0.25, 0.999] {
                let csg = Csg::new(operands.clone(), steps.clone(), u64::MAX);
                assert_eq!(crossings(&csg, y), expected, "{step:?} {x}");
                // Of faces that coincide, the first operand's is seen.
                let first = Csg::new(operands.clone(), steps.clone(), 63);
                let count = if step == Union && x > 0.0 {
                    1
                } else {
                    expected.len()
                };
                assert_eq!(crossings(&first, y), expected[..count], "{step:?} {x}");
            }
        }
    }
}
