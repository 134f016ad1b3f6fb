//! The torus.

use super::Lower;
use crate::course::decode::{Context, SharedValue, Spanned};
use crate::course::lower::Lowering;
use crate::course::material::Material;
use crate::course::number::Positive;
use crate::course::record::{FieldOutcome, keys, record};
use crate::course::value::{Point, Text, Vector};
use rtc_diag::codes;
use rtc_ir as ir;

record! {
    /// A torus.
    struct Torus, "torus" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"], json "type";
        /// The centre.
        position: Spanned<Point>, required, keys!["position" "center"], json "position";
        /// From the centre to the middle of the tube, above 0.
        radius: Spanned<Positive>, optional, keys!["radius" "r"];
        /// The radius of the tube, above 0.
        alpha: Spanned<Positive>, optional, keys!["alpha"];
        /// The radii of the hole and of the whole torus. In some programs they are those of the tube and of the ring that
        /// it goes along, which are `alpha` and `radius`.
        rims: [Spanned<Positive>; 2], optional, &[&["innerRadius", "outerRadius"]], json "innerRadius";
        /// The direction of the axis, of any length but 0.
        direction: Spanned<Vector>, default(Vector([0.0, 0.0, 1.0])), keys!["direction" "axis" "normal" "N"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"], json "material";
        /// Whether it casts shadows, where the scene has `Shadows`; paths know only surfaces that do.
        shadow: Spanned<bool>, default(true), keys!["shadow"], json "shadow";
    }
    forms { [radius alpha] [rims] }
}

impl Lower for Torus {
    fn lower(&self, lowering: &mut Lowering, context: &mut Context<'_>) {
        let Torus {
            kind,
            position,
            radius,
            alpha,
            rims,
            direction,
            material,
            shadow,
        } = self;
        let (radius, alpha) = match (radius, alpha, rims) {
            (FieldOutcome::Read(radius), FieldOutcome::Read(alpha), _) => {
                (radius.map(|radius| radius.0), alpha.map(|alpha| alpha.0))
            }
            (.., FieldOutcome::Read([inner, outer])) => {
                two_radii(inner, outer, context);
                let (hole, whole) = (inner.value.0, outer.value.0);
                (
                    outer.map(|_| f64::midpoint(hole, whole)),
                    inner.map(|_| (whole - hole) / 2.0),
                )
            }
            _ => return,
        };
        let (center, axis) = (position.value.0, direction.value.0);
        let shape = ir::Torus {
            center,
            axis,
            major: radius.value,
            minor: alpha.value,
        };
        let places = [
            ("center", position.span),
            ("axis", direction.span),
            ("major", radius.span),
            ("minor", alpha.span),
        ];
        if let Some(clothes) = lowering.clothe(kind, material, shadow, context) {
            lowering.put(&clothes, ir::Shape::Torus(shape), &places);
        }
    }
}

/// Says how two radii are read that programs read in two ways.
fn two_radii(inner: &Spanned<Positive>, outer: &Spanned<Positive>, context: &mut Context<'_>) {
    if let Some(span) = inner.span {
        let message =
            || "`innerRadius` and `outerRadius` are those of the hole and of the whole".to_owned();
        context.report(&codes::TWO_READINGS, span, message, |d| {
            d.at(span, "the hole").also(outer.span, "the whole").hint(
                "in some programs they are those of the tube and of the ring: here `alpha` and `radius`",
            )
        });
    }
}
