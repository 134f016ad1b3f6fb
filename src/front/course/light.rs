//! The lights: points and spheres, and suns.

use super::decode::{Context, Spanned, Value};
use super::lower::Lowering;
use super::number::NonNegative;
use super::record::{FieldOutcome, keys, record};
use super::schema::Definitions;
use super::value::{Channels, Color, Point, Vector, word, word_schema};
use crate::diag::{Severity, codes};
use crate::ir::{self, Field, Noun};
use crate::source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A point or sphere that shines equally in all directions, without falloff; or a sun, infinitely far away: a scene
    /// with one is shown by its paths.
    struct Light, "light" {
        /// What kind of light this is.
        kind: Spanned<LightKind>, optional, keys!["type"];
        /// Where the light stands.
        position: Spanned<Point>, optional, keys!["position"];
        /// Its colour: red, green, blue; more than 1 is allowed.
        color: Spanned<Color>, optional, keys!["color"];
        /// The radius of the sphere that shines; 0 is a point. A larger one makes the edges of shadows soft.
        radius: Spanned<NonNegative>, default(NonNegative(0.0)), keys!["radius" "size"];
        /// The direction from the scene to the sun.
        direction: Spanned<Vector>, optional, keys!["direction"];
        /// The irradiance on a surface that faces the sun: red, green, blue, or one number for all. A white surface
        /// then has the radiance irradiance/π.
        irradiance: Spanned<Channels>, optional, keys!["irradiance"];
    }
    forms { [position color] [direction irradiance] }
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightKind {
    Point,
    Sun,
}

/// The words for the kinds.
const KINDS: &[(&str, LightKind)] = &[("point", LightKind::Point), ("sun", LightKind::Sun)];

impl Value for LightKind {
    fn decode(node: NodeId, context: &mut Context<'_>) -> Option<Self> {
        word(node, KINDS, context)
    }

    fn schema(_: &mut Definitions) -> Json {
        word_schema(KINDS)
    }

    fn json(&self) -> Json {
        KINDS
            .iter()
            .find(|(_, kind)| kind == self)
            .map_or(Json::Null, |(word, _)| json!(word))
    }
}

impl Lowering {
    /// Lowers a light.
    pub(super) fn light(&mut self, light: &Spanned<Light>, context: &mut Context<'_>) {
        let Light {
            kind,
            position,
            color,
            radius,
            direction,
            irradiance,
        } = &light.value;
        let index = self.scene.lights.len();
        let (made, is) = match (position, color, direction, irradiance) {
            (FieldOutcome::Read(position), FieldOutcome::Read(color), ..) => {
                self.origin(Noun::Light, index, Field::Position, position.span);
                self.origin(Noun::Light, index, Field::Color, color.span);
                self.origin(Noun::Light, index, Field::LightRadius, radius.span);
                let (position, color, radius) = (position.value.0, color.value.0, radius.value.0);
                (
                    ir::Light::Point(ir::PointLight {
                        position,
                        color,
                        radius,
                    }),
                    LightKind::Point,
                )
            }
            (.., FieldOutcome::Read(direction), FieldOutcome::Read(irradiance)) => {
                let emitter = ir::Emitter::Sun {
                    direction: direction.value.0,
                };
                (
                    ir::Light::Punctual(ir::Punctual {
                        emitter,
                        intensity: irradiance.value.0,
                    }),
                    LightKind::Sun,
                )
            }
            _ => return,
        };
        if let FieldOutcome::Read(Spanned {
            value,
            span: Some(span),
        }) = kind
            && *value != is
        {
            let message =
                || "the `type` of the light has no effect: its other keys say otherwise".to_owned();
            context.report(&codes::NO_EFFECT, *span, message, |d| {
                let hint = "a sun has `direction` and `irradiance`, a point `position` and `color`";
                d.at(*span, "ignored")
                    .severity(Severity::Warning)
                    .hint(hint)
            });
        }
        self.scene.lights.push(made);
        self.origin(Noun::Light, index, Field::Whole, light.span);
    }
}
