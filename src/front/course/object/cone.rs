//! The cone and the paraboloid: round shapes with one cap and a top; and the keys of a base and an
//! axis, which the cylinder has too.

use super::LowerObject;
use crate::course::decode::{DecodeContext, SharedValue, Spanned, SpannedVector};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Positive};
use crate::course::record::{FieldResult, SameKeys, record};
use crate::course::synonym::{AXIS, ENDS, HEIGHT, POSITION, RADIUS, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_ir as ir;
use rtc_math::{Vec3, unit};

/// The values of the keys of a base and an axis.
pub(super) struct AxisKeys<'o> {
    pub(super) position: &'o FieldResult<Spanned<Point>>,
    pub(super) up: &'o FieldResult<Spanned<Vector>>,
    pub(super) direction: &'o FieldResult<Spanned<Vector>>,
    pub(super) height: &'o FieldResult<Spanned<Positive>>,
    pub(super) ends: &'o FieldResult<[Spanned<Point>; 2]>,
}

impl AxisKeys<'_> {
    /// The centre of the base and the vector from it to the top.
    pub(super) fn base_and_up(&self) -> Option<(SpannedVector, SpannedVector)> {
        let Self {
            position,
            up,
            direction,
            height,
            ends,
        } = self;
        match (position, up, direction, height, ends) {
            (.., FieldResult::Read([base, top])) => {
                let up = Vec3::from_array(top.value.0) - Vec3::from_array(base.value.0);
                Some((base.map(|point| point.0), top.map(|_| up.to_array())))
            }
            (FieldResult::Read(base), FieldResult::Read(up), ..) => {
                Some((base.map(|point| point.0), up.map(|vector| vector.0)))
            }
            (
                FieldResult::Read(base),
                _,
                FieldResult::Read(direction),
                FieldResult::Read(height),
                _,
            ) => {
                // The validator rejects a direction of length 0.
                let along = unit(Vec3::from_array(direction.value.0)).unwrap_or(Vec3::ZERO);
                let up = (along * height.value.0).to_array();
                Some((base.map(|point| point.0), direction.map(|_| up)))
            }
            _ => None,
        }
    }
}

record! {
    /// A cone with a cap at its base.
    struct Cone, "cone" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The centre of the base.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position");
        /// From the centre of the base to the top; its length is the height.
        up: Spanned<Vector>, optional, &[&["up"]];
        /// The direction from the base to the top, of any length but 0.
        direction: Spanned<Vector>, optional, &with_canonical(AXIS, "direction");
        /// From the base to the top, above 0.
        height: Spanned<Positive>, optional, &HEIGHT;
        /// The centre of the base, and the top.
        ends: [Spanned<Point>; 2], optional, &ENDS;
        /// The radius of the base; 0 is invisible.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius");
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores
        /// `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera`
        /// is open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
    variants { [position up] [position direction height] [ends] }
}

impl LowerObject for Cone {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        self.lower_as(lowering, context, |base, up, radius| {
            ir::Shape::Cone(ir::Cone { base, up, radius })
        });
    }
}

/// A paraboloid, which has the keys of a cone.
pub(super) struct Paraboloid(Cone);

impl SameKeys for Paraboloid {
    type Keys = Cone;
    const NAME: &'static str = "paraboloid";
    const DOC: &'static str = " A paraboloid with a cap at its base.";

    fn from_keys(keys: Cone) -> Self {
        Self(keys)
    }
}

impl LowerObject for Paraboloid {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        self.0.lower_as(lowering, context, |base, up, radius| {
            ir::Shape::Paraboloid(ir::Paraboloid { base, up, radius })
        });
    }
}

impl Cone {
    /// Adds the shape with a base, the vector from it to the top, and a radius.
    fn lower_as(
        &self,
        lowering: &mut Lowering,
        context: &mut DecodeContext<'_>,
        shape: impl FnOnce([f64; 3], [f64; 3], f64) -> ir::Shape,
    ) {
        let Self {
            kind,
            position,
            up,
            direction,
            height,
            ends,
            radius,
            material,
            shadow,
            velocity,
        } = self;
        let axis_keys = AxisKeys {
            position,
            up,
            direction,
            height,
            ends,
        };
        let props = lowering.surface_props(kind, material, (shadow, velocity), context);
        let (Some(props), Some((base, up))) = (props, axis_keys.base_and_up()) else {
            return;
        };
        let value_spans = [
            ("base", base.span),
            ("up", up.span),
            ("radius", radius.span),
        ];
        let shape = shape(base.value, up.value, radius.value.0);
        lowering.add_surface(&props, shape, &value_spans);
    }
}
