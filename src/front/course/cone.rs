//! The cone.

use super::decode::{SharedValue, Spanned};
use super::lower::Lowering;
use super::material::Material;
use super::number::Positive;
use super::record::{keys, record};
use super::value::{Point, Text, Vector};
use crate::ir::{self, Field};

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
    }
}

impl Lowering {
    /// Lowers a cone.
    pub(super) fn cone(&mut self, cone: &Cone) {
        let Cone {
            kind,
            position,
            up,
            radius,
            material,
        } = cone;
        let shape = ir::Cone {
            base: position.value.0,
            up: up.value.0,
            radius: radius.value.0,
        };
        let places = [
            (Field::ConeBase, position.span),
            (Field::ConeUp, up.span),
            (Field::ConeRadius, radius.span),
        ];
        if let Some(clothes) = self.clothe(kind, material) {
            self.put(&clothes, ir::Shape::Cone(shape), &places);
        }
    }
}
