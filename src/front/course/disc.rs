//! The disc.

use super::decode::{SharedValue, Spanned};
use super::lower::Lowering;
use super::material::Material;
use super::number::Positive;
use super::record::{keys, record};
use super::value::{Point, Text, Vector};
use crate::ir::{self, Field};

record! {
    /// A disc, seen from both sides.
    struct Disc, "circle" {
        /// What kind of object this is.
        kind: Spanned<Text>, required, keys!["type"];
        /// The centre.
        center: Spanned<Point>, required, keys!["center" "position"];
        /// The direction at right angles to it, of any length but 0.
        normal: Spanned<Vector>, required, keys!["normal" "N" "n"];
        /// The radius, above 0.
        radius: Spanned<Positive>, required, keys!["radius" "r"];
        /// What it is made of.
        material: Spanned<SharedValue<Material>>, required, keys!["material"];
    }
}

impl Lowering {
    /// Lowers a disc.
    pub(super) fn disc(&mut self, disc: &Disc) {
        let Disc {
            kind,
            center,
            normal,
            radius,
            material,
        } = disc;
        let shape = ir::Disc {
            center: center.value.0,
            normal: normal.value.0,
            radius: radius.value.0,
        };
        let places = [
            (Field::DiscCenter, center.span),
            (Field::DiscNormal, normal.span),
            (Field::DiscRadius, radius.span),
        ];
        if let Some(clothes) = self.clothe(kind, material) {
            self.put(&clothes, ir::Shape::Disc(shape), &places);
        }
    }
}
