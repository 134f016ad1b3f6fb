//! The lights.

use arbitrary::Arbitrary;
use rtc_math::{Vec3, unit};
use rtc_profile::{IesAngles, Profile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Light {
    /// A point or sphere that shines equally in all directions, without falloff.
    Point(PointLight),
    /// A light in physical units.
    Punctual(Punctual),
}

impl Light {
    /// Whether it has any intensity.
    #[must_use]
    pub fn shines(&self) -> bool {
        let intensity = match self {
            Self::Point(light) => light.color,
            Self::Punctual(light) => light.intensity,
        };
        intensity.iter().any(|channel| *channel > 0.0)
    }

    /// The light, if it is one of the course.
    #[must_use]
    pub fn point(&self) -> Option<&PointLight> {
        match self {
            Self::Point(light) => Some(light),
            Self::Punctual(_) => None,
        }
    }
}

/// A light without extent, in physical units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Punctual {
    /// How and from where it shines.
    pub emitter: Emitter,
    /// Linear Rec. 709: of a sun the irradiance on a surface that faces it, of a measured lamp a
    /// factor of its intensity, of the others the radiant intensity (power per steradian); each
    /// channel at least 0.
    #[schemars(inner(range(min = 0.0)))]
    pub intensity: [f64; 3],
}

/// How a light without extent shines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Emitter {
    /// From infinitely far away.
    Sun {
        /// The direction from the scene to it, of any length but 0.
        direction: [f64; 3],
    },
    /// From a point into all directions.
    #[serde(rename_all = "camelCase")]
    Point {
        /// Where it stands.
        position: [f64; 3],
        /// Beyond this distance it is dark, by the falloff of `KHR_lights_punctual`; none for
        /// infinite.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
    /// From a point into a cone.
    #[serde(rename_all = "camelCase")]
    Spot {
        /// Where it stands.
        position: [f64; 3],
        /// Where it shines, of any length but 0.
        direction: [f64; 3],
        /// Within this angle from the direction it shines fully, in radians.
        inner_angle: f64,
        /// Beyond this angle it is dark, in radians, at most π/2.
        outer_angle: f64,
        /// As of a point.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
    /// From a point, as measured: the intensity is a factor of the candelas.
    Lamp {
        /// Where it stands.
        position: [f64; 3],
        /// Its axis, where the vertical angle is 0; of any length but 0.
        direction: [f64; 3],
        /// The direction of the horizontal angle 0; only its part across the axis counts.
        horizontal: [f64; 3],
        /// What was measured.
        photometry: Box<Photometry>,
    },
}

/// The intensity of a lamp, measured around its axis (type C of LM-63-2002), in between linear in
/// both angles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Photometry {
    /// The name of its file.
    pub name: String,
    /// Angles from the axis in degrees, ascending within 0 to 180; beyond them it is dark.
    pub vertical: Vec<f64>,
    /// Angles about the axis in degrees, ascending from 0 to 360; or 0 alone, for a lamp that is the
    /// same all around. Against the axis they are seen to run counterclockwise.
    pub horizontal: Vec<f64>,
    /// The intensity at all vertical angles of each horizontal one, at least 0.
    pub candela: Vec<f64>,
}

impl Photometry {
    /// That of a lamp without light.
    #[must_use]
    pub fn dark(name: String) -> Self {
        Self {
            name,
            vertical: vec![0.0, 180.0],
            horizontal: vec![0.0],
            candela: vec![0.0; 2],
        }
    }
}

/// How an emitter is written in a scene of the course.
#[derive(Clone, Debug, PartialEq)]
pub struct Spelling<'a> {
    /// Its `type`.
    pub kind: &'static str,
    /// The keys of its points and directions, with their values.
    pub triples: Vec<(&'static str, [f64; 3])>,
    /// The keys of its numbers, with their values.
    pub numbers: Vec<(&'static str, f64)>,
    /// The file of its profile.
    pub file: Option<&'a str>,
    /// The key of the intensity.
    pub intensity: &'static str,
}

/// The table of emitters: what all stages ask of one.
impl Emitter {
    /// Where it stands, unless it is infinitely far away.
    #[must_use]
    pub fn position(&self) -> Option<[f64; 3]> {
        match self {
            Self::Sun { .. } => None,
            Self::Point { position, .. }
            | Self::Spot { position, .. }
            | Self::Lamp { position, .. } => Some(*position),
        }
    }

    /// The direction to a sun, else that in which it shines.
    #[must_use]
    pub fn direction(&self) -> Option<[f64; 3]> {
        match self {
            Self::Point { .. } => None,
            Self::Sun { direction }
            | Self::Spot { direction, .. }
            | Self::Lamp { direction, .. } => Some(*direction),
        }
    }

    /// Beyond this distance it is dark.
    #[must_use]
    pub fn range(&self) -> Option<f64> {
        match self {
            Self::Sun { .. } | Self::Lamp { .. } => None,
            Self::Point { range, .. } | Self::Spot { range, .. } => *range,
        }
    }

    /// How its intensity depends on the direction.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn profile(&self) -> Result<Profile, String> {
        match self {
            Self::Sun { .. } | Self::Point { .. } => Ok(Profile::Uniform),
            Self::Spot {
                direction,
                inner_angle,
                outer_angle,
                ..
            } => Profile::cone(axis(*direction)?, *inner_angle, *outer_angle),
            Self::Lamp {
                position: _,
                direction,
                horizontal,
                photometry,
            } => {
                let angles = IesAngles {
                    vertical: photometry.vertical.clone(),
                    horizontal: photometry.horizontal.clone(),
                };
                let horizontal = Vec3::from_array(*horizontal);
                Profile::measured(
                    axis(*direction)?,
                    horizontal,
                    angles,
                    photometry.candela.clone(),
                )
            }
        }
    }

    /// Moves its position, turns its directions, and multiplies its range.
    pub fn transform(
        &mut self,
        place: impl Fn([f64; 3]) -> [f64; 3],
        mut turn: impl FnMut([f64; 3]) -> [f64; 3],
        scale: f64,
    ) {
        match self {
            Self::Sun { direction } => *direction = turn(*direction),
            Self::Point { position, range } => {
                *position = place(*position);
                *range = range.map(|range| range * scale);
            }
            Self::Spot {
                position,
                direction,
                inner_angle: _,
                outer_angle: _,
                range,
            } => {
                *position = place(*position);
                *direction = turn(*direction);
                *range = range.map(|range| range * scale);
            }
            Self::Lamp {
                position,
                direction,
                horizontal,
                photometry: _,
            } => {
                *position = place(*position);
                *direction = turn(*direction);
                *horizontal = turn(*horizontal);
            }
        }
    }

    /// How a scene of the course writes it.
    #[must_use]
    pub fn spelling(&self) -> Spelling<'_> {
        let range = self.range().map(|range| ("range", range));
        match self {
            Self::Sun { direction } => Spelling {
                kind: "sun",
                triples: vec![("direction", *direction)],
                numbers: Vec::new(),
                file: None,
                intensity: "irradiance",
            },
            Self::Point { position, range: _ } => Spelling {
                kind: "point",
                triples: vec![("position", *position)],
                numbers: range.into_iter().collect(),
                file: None,
                intensity: "intensity",
            },
            Self::Spot {
                position,
                direction,
                inner_angle,
                outer_angle,
                range: _,
            } => {
                let angles = [("innerAngle", *inner_angle), ("outerAngle", *outer_angle)];
                Spelling {
                    kind: "spot",
                    triples: vec![("position", *position), ("direction", *direction)],
                    numbers: angles.into_iter().chain(range).collect(),
                    file: None,
                    intensity: "intensity",
                }
            }
            Self::Lamp {
                position,
                direction,
                horizontal,
                photometry,
            } => Spelling {
                kind: "ies",
                triples: vec![
                    ("position", *position),
                    ("direction", *direction),
                    ("horizontal", *horizontal),
                ],
                numbers: Vec::new(),
                file: Some(&photometry.name),
                intensity: "color",
            },
        }
    }
}

/// The unit vector of a direction.
fn axis(direction: [f64; 3]) -> Result<Vec3, String> {
    unit(Vec3::from_array(direction)).ok_or_else(|| "a light shines in no direction".to_owned())
}

/// A point light, or with a radius the sphere around it: then shadows have soft edges. It is no
/// surface, so no ray sees or hits it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PointLight {
    /// Where it stands.
    pub position: [f64; 3],
    /// Its colour, each channel at least 0; more than 1 is allowed.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
    /// Its radius, at least 0; 0 is a point.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub radius: f64,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(radius: &f64) -> bool {
    radius.to_bits() == 0
}
