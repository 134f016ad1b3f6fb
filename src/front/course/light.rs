//! The lights.

use super::decode::Spanned;
use super::lower::Lowering;
use super::number::NonNegative;
use super::record::{keys, record};
use super::value::{Color, Point};
use crate::ir::{self, Field, Noun};

record! {
    /// A point or sphere that shines equally in all directions, without falloff.
    struct Light, "light" {
        /// Where the light stands.
        position: Spanned<Point>, required, keys!["position"];
        /// Its colour: red, green, blue; more than 1 is allowed.
        color: Spanned<Color>, required, keys!["color"];
        /// The radius of the sphere that shines; 0 is a point. A larger one makes the edges of shadows soft.
        radius: Spanned<NonNegative>, default(NonNegative(0.0)), keys!["radius" "size"];
    }
}

impl Lowering {
    /// Lowers a light.
    pub(super) fn light(&mut self, light: &Spanned<Light>) {
        let Light { position, color, radius } = light.value;
        let index = self.scene.lights.len();
        self.scene.lights.push(ir::Light::Point(ir::PointLight {
            position: position.value.0,
            color: color.value.0,
            radius: radius.value.0,
        }));
        self.origin(Noun::Light, index, Field::Whole, light.span);
        self.origin(Noun::Light, index, Field::Position, position.span);
        self.origin(Noun::Light, index, Field::Color, color.span);
        self.origin(Noun::Light, index, Field::LightRadius, radius.span);
    }
}
