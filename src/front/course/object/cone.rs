//! The cone.

use super::Lower;
use super::round::Upright;
use crate::course::decode::{Context, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::{NonNegative, Positive};
use crate::course::record::{keys, record};
use crate::course::synonym::{AXIS, ENDS, HEIGHT, PLACE, RADIUS, led_by};
use crate::course::value::{Point, Text, Vector};
use rtc_ir as ir;

record! {
    /// A cone with a cap at its base.
    struct Cone, "cone" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre of the base.
        position: Spanned<Point>, optional, &led_by(PLACE, "position");
        /// From the centre of the base to the apex; its length is the height.
        up: Spanned<Vector>, optional, keys!["up"];
        /// The direction from the base to the apex, of any length but 0.
        direction: Spanned<Vector>, optional, &led_by(AXIS, "direction");
        /// From the base to the apex, above 0.
        height: Spanned<Positive>, optional, &HEIGHT;
        /// The centre of the base, and the apex.
        ends: [Spanned<Point>; 2], optional, &ENDS;
        /// The radius of the base; nothing shows at 0.
        radius: Spanned<NonNegative>, required, &led_by(RADIUS, "radius");
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
    forms { [position up] [position direction height] [ends] }
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
        let upright = Upright {
            position,
            up,
            direction,
            height,
            ends,
        };
        let clothes = lowering.clothe(kind, material, shadow, context);
        let (Some(clothes), Some((base, up))) = (clothes, upright.base_and_up()) else {
            return;
        };
        let shape = ir::Cone {
            base: base.value,
            up: up.value,
            radius: radius.value.0,
        };
        let places = [
            ("base", base.span),
            ("up", up.span),
            ("radius", radius.span),
        ];
        lowering.put(&clothes, ir::Shape::Cone(shape), &places);
    }
}
