//! The disc.

use super::LowerObject;
use crate::course::decode::{DecodeContext, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::NonNegative;
use crate::course::record::record;
use crate::course::synonym::{AXIS, POSITION, RADIUS, with_canonical};
use crate::course::value::{AnyScalar, Point, Vector};
use rtc_ir as ir;

record! {
    /// A two-sided disc.
    struct Disc, "circle" {
        /// The type of the object.
        kind: Spanned<AnyScalar>, required, &[&["type"]];
        /// The centre.
        center: Spanned<Point>, required, &with_canonical(POSITION, "center");
        /// The normal, of any length but 0.
        normal: Spanned<Vector>, required, &with_canonical(AXIS, "normal");
        /// The radius; 0 is invisible.
        radius: Spanned<NonNegative>, required, &with_canonical(RADIUS, "radius");
        /// The material.
        material: Spanned<SharedValue<Material>>, required, &[&["material"]];
        /// Whether it casts shadows, if the scene has `Shadows`. Path tracing ignores `false`.
        shadow: Spanned<bool>, default(true), &[&["shadow"]], own true;
        /// How far it moves per second along each axis, while the `shutter` of the `Camera` is
        /// open.
        velocity: Spanned<Point>, default(Point([0.0; 3])), &[&["velocity"]], own true;
    }
}

impl LowerObject for Disc {
    fn lower(&self, lowering: &mut Lowering, context: &mut DecodeContext<'_>) {
        let Disc {
            kind,
            center,
            normal,
            radius,
            material,
            shadow,
            velocity,
        } = self;
        let shape = ir::Disc {
            center: center.value.0,
            normal: normal.value.0,
            radius: radius.value.0,
        };
        let value_spans = [
            ("center", center.span),
            ("normal", normal.span),
            ("radius", radius.span),
        ];
        if let Some(props) = lowering.surface_props(kind, material, (shadow, velocity), context) {
            lowering.add_surface(&props, ir::Shape::Disc(shape), &value_spans);
        }
    }
}
