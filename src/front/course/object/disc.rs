//! The disc.

use super::Lower;
use crate::course::decode::{Context, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::NonNegative;
use crate::course::record::{keys, record};
use crate::course::synonym::{AXIS, PLACE, RADIUS, led_by};
use crate::course::value::{Point, Text, Vector};
use rtc_ir as ir;

record! {
    /// A disc, seen from both sides.
    struct Disc, "circle" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        center: Spanned<Point>, required, &led_by(PLACE, "center");
        /// The direction at right angles to it, of any length but 0.
        normal: Spanned<Vector>, required, &led_by(AXIS, "normal");
        /// The radius; nothing shows at 0.
        radius: Spanned<NonNegative>, required, &led_by(RADIUS, "radius");
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
}

impl Lower for Disc {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Disc {
            kind,
            center,
            normal,
            radius,
            material,
            shadow,
        } = self;
        let shape = ir::Disc {
            center: center.value.0,
            normal: normal.value.0,
            radius: radius.value.0,
        };
        let places = [
            ("center", center.span),
            ("normal", normal.span),
            ("radius", radius.span),
        ];
        if let Some(clothes) = lowering.clothe(kind, material, shadow, context) {
            lowering.put(&clothes, ir::Shape::Disc(shape), &places);
        }
    }
}
