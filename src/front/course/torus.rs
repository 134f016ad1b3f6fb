//! The torus.

use super::decode::{SharedValue, Spanned};
use super::lower::Lowering;
use super::material::Material;
use super::number::Positive;
use super::record::{keys, record};
use super::value::{Point, Text, Vector};
use crate::ir::{self, Field};

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

impl Lowering {
    /// Lowers a torus.
    pub(super) fn torus(&mut self, torus: &Torus) {
        let Torus {
            kind,
            position,
            radius,
            alpha,
            direction,
            material,
        } = torus;
        let (center, axis) = (position.value.0, direction.value.0);
        let shape = ir::Torus {
            center,
            axis,
            major: radius.value.0,
            minor: alpha.value.0,
        };
        let places = [
            (Field::TorusCenter, position.span),
            (Field::TorusAxis, direction.span),
            (Field::TorusMajor, radius.span),
            (Field::TorusMinor, alpha.span),
        ];
        if let Some(clothes) = self.clothe(kind, material) {
            self.put(&clothes, ir::Shape::Torus(shape), &places);
        }
    }
}
