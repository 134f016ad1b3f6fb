//! The cone.

use super::Lower;
use super::axis_keys::AxisKeys;
use crate::course::decode::{Context, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Positive};
use crate::course::record::{keys, record};
use crate::course::synonym::{AXIS, ENDS, HEIGHT, POSITION, RADIUS, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_ir as ir;

record! {
    /// A cone with a cap at its base.
    struct Cone, "cone" {
        /// What kind of object this is.
        kind: Spanned<AnyScalar>, required, keys!["type"];
        /// The centre of the base.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position");
        /// From the centre of the base to the apex; its length is the height.
        up: Spanned<Vector>, optional, keys!["up"];
        /// The direction from the base to the apex, of any length but 0.
        direction: Spanned<Vector>, optional, &with_canonical(AXIS, "direction");
        /// From the base to the apex, above 0.
        height: Spanned<Positive>, optional, &HEIGHT;
        /// The centre of the base, and the apex.
        ends: [Spanned<Point>; 2], optional, &ENDS;
        /// The radius of the base; nothing shows at 0.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius");
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
    variants { [position up] [position direction height] [ends] }
}

impl Lower for Cone {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Cone {
            kind,
            position,
            up,
            direction,
            height,
            ends,
            radius,
            material,
            shadow,
        } = self;
        let axis_keys = AxisKeys {
            position,
            up,
            direction,
            height,
            ends,
        };
        let props = lowering.surface_props(kind, material, shadow, context);
        let (Some(props), Some((base, up))) = (props, axis_keys.base_and_up()) else {
            return;
        };
        let shape = ir::Cone {
            base: base.value,
            up: up.value,
            radius: radius.value.0,
        };
        let value_spans = [
            ("base", base.span),
            ("up", up.span),
            ("radius", radius.span),
        ];
        lowering.add_surface(&props, ir::Shape::Cone(shape), &value_spans);
    }
}
