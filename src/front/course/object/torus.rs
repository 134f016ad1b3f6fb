//! The torus.

use super::Lower;
use crate::front::course::decode::{Context, SharedValue, Spanned};
use crate::front::course::lower::Lowering;
use crate::front::course::material::Material;
use crate::front::course::number::Positive;
use crate::front::course::record::{keys, record};
use crate::front::course::value::{Point, Text, Vector};
use crate::ir;

record! {
    /// A torus.
    struct Torus, "torus" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        position: Spanned<Point>, required, keys!["position" "center"];
        /// From the centre to the middle of the tube, above 0.
        radius: Spanned<Positive>, required, keys!["radius" "r"];
        /// The radius of the tube, above 0.
        alpha: Spanned<Positive>, required, keys!["alpha"];
        /// The direction of the axis, of any length but 0.
        direction: Spanned<Vector>, default(Vector([0.0, 0.0, 1.0])), keys!["direction" "axis" "normal" "N"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
    }
}

impl Lower for Torus {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Torus {
            kind,
            position,
            radius,
            alpha,
            direction,
            material,
        } = self;
        let (center, axis) = (position.value.0, direction.value.0);
        let shape = ir::Torus {
            center,
            axis,
            major: radius.value.0,
            minor: alpha.value.0,
        };
        let places = [
            ("center", position.span),
            ("axis", direction.span),
            ("major", radius.span),
            ("minor", alpha.span),
        ];
        if let Some(clothes) = lowering.clothe(kind, material, context) {
            lowering.put(&clothes, ir::Shape::Torus(shape), &places);
        }
    }
}
