//! The lights: points and spheres, suns, and lamps as measured.

use super::assets::Asset;
use super::decode::{Context, Spanned, Value};
use super::lower::Lowering;
use super::number::NonNegative;
use super::record::{FieldOutcome, keys, record};
use super::schema::Definitions;
use super::value::{Channels, Color, FileName, Point, Vector, word, word_schema};
use crate::diag::{Severity, codes};
use crate::ir::{self, Field, Noun, Photometry};
use crate::source::Span;
use crate::source::tree::NodeId;
use serde_json::{Value as Json, json};

record! {
    /// A point or sphere that shines equally in all directions, without falloff; a sun, infinitely far away; or a lamp
    /// with a measured profile, whose light falls off with the square of the distance. A scene with a sun or such a lamp is
    /// shown by its paths.
    struct Light, "light" {
        /// What kind of light this is.
        kind: Spanned<LightKind>, optional, keys!["type"];
        /// Where the light stands.
        position: Spanned<Point>, optional, keys!["position"], json "position";
        /// Its colour: red, green, blue; more than 1 is allowed. With a `file`, a factor of its candelas.
        color: Spanned<Color>, optional, keys!["color"], json "color";
        /// The radius of the sphere that shines; 0 is a point. A larger one makes the edges of shadows soft.
        radius: Spanned<NonNegative>, default(NonNegative(0.0)), keys!["radius" "size"];
        /// The direction from the scene to the sun; with a `file`, that in which the lamp points, its vertical angle 0.
        direction: Spanned<Vector>, optional, keys!["direction"];
        /// The irradiance on a surface that faces the sun: red, green, blue, or one number for all. A white surface
        /// then has the radiance irradiance/π.
        irradiance: Spanned<Channels>, optional, keys!["irradiance"];
        /// The profile of the lamp: an IES file (LM-63) of type C with `TILT=NONE`.
        file: Spanned<FileName>, optional, keys!["file"];
        /// The direction of the horizontal angle 0 of the profile; only its part across `direction` counts.
        horizontal: Spanned<Vector>, default(Vector([1.0, 0.0, 0.0])), keys!["horizontal"];
    }
    forms { [position color] [direction irradiance] [position direction file] [position direction file color] }
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightKind {
    Point,
    Sun,
    Ies,
}

/// The words for the kinds.
const KINDS: &[(&str, LightKind)] = &[
    ("point", LightKind::Point),
    ("sun", LightKind::Sun),
    ("ies", LightKind::Ies),
];

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
        let Some((made, is)) = self.light_of_its_kind(&light.value) else {
            return;
        };
        let (kind, radius, horizontal) = (
            &light.value.kind,
            &light.value.radius,
            &light.value.horizontal,
        );
        if let FieldOutcome::Read(kind) = kind
            && kind.value != is
        {
            let message = "the `type` of the light has no effect: its other keys say otherwise";
            let hint = "a sun has `direction` and `irradiance`, a point `position` and `color`, a \
                        lamp `position`, `direction` and `file`";
            no_effect(kind.span, message, hint, context);
        }
        if is != LightKind::Point {
            let message = "the `radius` of the light has no effect: only a point has one";
            no_effect(radius.span, message, "remove it", context);
        }
        if is != LightKind::Ies {
            let message =
                "`horizontal` has no effect on this light: only a profile has horizontal angles";
            no_effect(horizontal.span, message, "remove it", context);
        }
        let index = self.scene.lights.len();
        self.scene.lights.push(made);
        self.origin(Noun::Light, index, Field::Whole, light.span);
    }

    /// The light that the keys make.
    fn light_of_its_kind(&mut self, light: &Light) -> Option<(ir::Light, LightKind)> {
        let Light {
            kind: _,
            position,
            color,
            radius,
            direction,
            irradiance,
            file,
            horizontal,
        } = light;
        match (position, color, direction, irradiance, file) {
            (
                FieldOutcome::Read(position),
                color,
                FieldOutcome::Read(direction),
                _,
                FieldOutcome::Read(file),
            ) => {
                let intensity = match color {
                    FieldOutcome::Read(color) => color.value.0,
                    FieldOutcome::Absent => [1.0; 3],
                    FieldOutcome::Broken => return None,
                };
                self.files
                    .want(Asset::Photometry(self.scene.lights.len()), file);
                let emitter = ir::Emitter::Lamp {
                    position: position.value.0,
                    direction: direction.value.0,
                    horizontal: horizontal.value.0,
                    photometry: Box::new(Photometry::dark(file.value.0.replace('\\', "/"))),
                };
                let lamp = ir::Punctual { emitter, intensity };
                Some((ir::Light::Punctual(lamp), LightKind::Ies))
            }
            (FieldOutcome::Read(position), FieldOutcome::Read(color), ..) => {
                let index = self.scene.lights.len();
                self.origin(Noun::Light, index, Field::Position, position.span);
                self.origin(Noun::Light, index, Field::Color, color.span);
                self.origin(Noun::Light, index, Field::LightRadius, radius.span);
                let (position, color, radius) = (position.value.0, color.value.0, radius.value.0);
                let point = ir::PointLight {
                    position,
                    color,
                    radius,
                };
                Some((ir::Light::Point(point), LightKind::Point))
            }
            (_, _, FieldOutcome::Read(direction), FieldOutcome::Read(irradiance), _) => {
                let emitter = ir::Emitter::Sun {
                    direction: direction.value.0,
                };
                let sun = ir::Punctual {
                    emitter,
                    intensity: irradiance.value.0,
                };
                Some((ir::Light::Punctual(sun), LightKind::Sun))
            }
            _ => None,
        }
    }
}

/// Warns of a key that changes nothing, if it is written.
fn no_effect(span: Option<Span>, message: &str, hint: &str, context: &mut Context<'_>) {
    if let Some(span) = span {
        context.report(
            &codes::NO_EFFECT,
            span,
            || message.to_owned(),
            |d| d.at(span, "ignored").severity(Severity::Warning).hint(hint),
        );
    }
}
