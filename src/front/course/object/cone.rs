//! The cone.

use super::Lower;
use crate::course::decode::{Context, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::Positive;
use crate::course::record::{keys, record};
use crate::course::value::{Point, Text, Vector};
use rtc_ir as ir;

record! {
    /// A cone with a cap at its base.
    struct Cone, "cone" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre of the base.
        position: Spanned<Point>, required, keys!["position" "center"];
        /// From the centre of the base to the apex; its length is the height.
        up: Spanned<Vector>, required, keys!["up"];
        /// The radius of the base, above 0.
        radius: Spanned<Positive>, required, keys!["radius" "r"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"];
    }
}

impl Lower for Cone {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Cone {
            kind,
            position,
            up,
            radius,
            material,
            shadow,
        } = self;
        let shape = ir::Cone {
            base: position.value.0,
            up: up.value.0,
            radius: radius.value.0,
        };
        let places = [
            ("base", position.span),
            ("up", up.span),
            ("radius", radius.span),
        ];
        if let Some(clothes) = lowering.clothe(kind, material, shadow, context) {
            lowering.put(&clothes, ir::Shape::Cone(shape), &places);
        }
    }
}
