//! Light sources.

use crate::Map;
use arbitrary::Arbitrary;
use rtc_math::{Vec3, unit};
use rtc_profile::{IesAngles, LightProfile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A light of any kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Light {
    /// A point or sphere that emits equally in all directions, without falloff.
    Point(PointLight),
    /// A light in physical units.
    Punctual(Punctual),
}

impl Light {
    /// Whether any channel of its intensity is above 0.
    #[must_use]
    pub fn emits(&self) -> bool {
        let intensity = match self {
            Self::Point(light) => light.color,
            Self::Punctual(light) => light.intensity,
        };
        intensity.iter().any(|channel| *channel > 0.0)
    }

    /// The light, if it is a point light of the course.
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
    /// The emitter: its kind, position and direction.
    pub emitter: PunctualKind,
    /// Linear Rec. 709, each channel at least 0: the irradiance on a surface that faces a sun, a
    /// factor of a lamp's measured intensity, or else the radiant intensity (power per steradian).
    #[schemars(inner(range(min = 0.0)))]
    pub intensity: [f64; 3],
    /// The texture that it projects; not of a sun.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub projected: Option<Box<ProjectedTexture>>,
}

impl Punctual {
    /// A light that projects no texture.
    #[must_use]
    pub fn new(emitter: PunctualKind, intensity: [f64; 3]) -> Self {
        Self {
            emitter,
            intensity,
            projected: None,
        }
    }
}

/// The texture that a light projects, as a slide projector does: it multiplies the intensity by
/// direction. Outside of the unit square of texture coordinates it is black.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ProjectedTexture {
    /// The texture; its set of texture coordinates is the first one.
    pub map: Map,
    /// The rows that map a direction from the light to (u·w, v·w, w); where w is not above 0, it is
    /// black.
    pub uv_from_direction: [[f64; 3]; 3],
    /// Whether its colours are the irradiance on a plane across the axis at the distance 1, which
    /// is the third row: then the intensity has the factor 1 / cos³ of the angle from the axis.
    /// Otherwise they are factors of the intensity.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_irradiance: bool,
}

/// The kind, position and direction of a light without extent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum PunctualKind {
    /// A directional light, infinitely far away.
    Sun {
        /// The direction from the scene to the sun, of any length but 0.
        direction: [f64; 3],
    },
    /// A point that emits in all directions.
    #[serde(rename_all = "camelCase")]
    Point {
        /// The position.
        position: [f64; 3],
        /// The distance beyond which it emits nothing, with the falloff of `KHR_lights_punctual`;
        /// absent for infinite.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
    /// A point that emits into a cone.
    #[serde(rename_all = "camelCase")]
    Spot {
        /// The position.
        position: [f64; 3],
        /// The axis of the cone, of any length but 0.
        direction: [f64; 3],
        /// The angle from the axis within which the intensity is full, in radians.
        inner_angle: f64,
        /// The angle from the axis beyond which it emits nothing, in radians, at most π/2.
        outer_angle: f64,
        /// As for a point.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<f64>,
    },
    /// A photometric light (IES profile): its intensity is a factor of the measured candelas.
    #[serde(rename = "lamp")]
    Photometric {
        /// The position.
        position: [f64; 3],
        /// The axis, where the vertical angle is 0; of any length but 0.
        direction: [f64; 3],
        /// The direction of horizontal angle 0; only its component perpendicular to the axis
        /// counts.
        horizontal: [f64; 3],
        /// The measured intensities.
        photometry: Box<Photometry>,
    },
}

/// The measured intensity of a lamp around its axis (type C of LM-63-2002), interpolated linearly
/// in both angles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Photometry {
    /// The name of its file.
    pub name: String,
    /// Angles from the axis in degrees, ascending within 0 to 180; the intensity is 0 outside them.
    pub vertical: Vec<f64>,
    /// Angles about the axis in degrees, ascending from 0 to 360; or only 0, for a lamp that is
    /// rotationally symmetric. They run counterclockwise as seen against the axis.
    pub horizontal: Vec<f64>,
    /// The intensity in candela, at least 0: all vertical angles of the first horizontal angle,
    /// then of the next.
    pub candela: Vec<f64>,
}

impl Photometry {
    /// A profile of zero intensity.
    #[must_use]
    pub fn dark(name: String) -> Self {
        Self {
            name,
            vertical: vec![0.0, 180.0],
            horizontal: vec![0.0],
            candela: vec![0.0; 2],
        }
    }

    /// Two angles in degrees, if the intensity is 1 up to the first one, falls linearly in the
    /// angle, and is 0 from the second one on.
    #[must_use]
    pub fn linear_falloff(&self) -> Option<[f64; 2]> {
        match (&self.vertical[..], &self.candela[..]) {
            ([0.0, inner, outer], [1.0, 1.0, 0.0]) if self.horizontal == [0.0] => {
                Some([*inner, *outer])
            }
            _ => None,
        }
    }
}

/// The spelling of an emitter in the scene format.
#[derive(Clone, Debug, PartialEq)]
pub struct EmitterSpelling {
    /// The value of its key `type`.
    pub kind: &'static str,
    /// The keys of its points and directions, with their values.
    pub triples: Vec<(&'static str, [f64; 3])>,
    /// The keys of its numbers, with their values.
    pub numbers: Vec<(&'static str, f64)>,
    /// The key of the intensity.
    pub intensity: &'static str,
}

/// Properties of emitters, as all stages use them.
impl PunctualKind {
    /// The position; `None` for a sun.
    #[must_use]
    pub fn position(&self) -> Option<[f64; 3]> {
        match self {
            Self::Sun { .. } => None,
            Self::Point { position, .. }
            | Self::Spot { position, .. }
            | Self::Photometric { position, .. } => Some(*position),
        }
    }

    /// The direction to a sun, or else the axis; `None` for a point.
    #[must_use]
    pub fn direction(&self) -> Option<[f64; 3]> {
        match self {
            Self::Point { .. } => None,
            Self::Sun { direction }
            | Self::Spot { direction, .. }
            | Self::Photometric { direction, .. } => Some(*direction),
        }
    }

    /// The distance beyond which it emits nothing.
    #[must_use]
    pub fn range(&self) -> Option<f64> {
        match self {
            Self::Sun { .. } | Self::Photometric { .. } => None,
            Self::Point { range, .. } | Self::Spot { range, .. } => *range,
        }
    }

    /// The angular distribution of the intensity.
    ///
    /// # Errors
    /// A message, if an angle, direction or profile is invalid.
    pub fn profile(&self) -> Result<LightProfile, String> {
        match self {
            Self::Sun { .. } | Self::Point { .. } => Ok(LightProfile::Uniform),
            Self::Spot {
                direction,
                inner_angle,
                outer_angle,
                ..
            } => LightProfile::cone(axis(*direction)?, *inner_angle, *outer_angle),
            Self::Photometric {
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
                LightProfile::measured(
                    axis(*direction)?,
                    horizontal,
                    angles,
                    photometry.candela.clone(),
                )
            }
        }
    }

    /// Maps its position by `point`, its directions by `rotate`, and multiplies its range by
    /// `scale`.
    pub fn transform(
        &mut self,
        point: impl Fn([f64; 3]) -> [f64; 3],
        mut rotate: impl FnMut([f64; 3]) -> [f64; 3],
        scale: f64,
    ) {
        // Transform positions, directions and distances.
        match self {
            Self::Sun { direction } => *direction = rotate(*direction),
            Self::Point { position, range } => {
                *position = point(*position);
                *range = range.map(|range| range * scale);
            }
            Self::Spot {
                position,
                direction,
                inner_angle: _,
                outer_angle: _,
                range,
            } => {
                *position = point(*position);
                *direction = rotate(*direction);
                *range = range.map(|range| range * scale);
            }
            Self::Photometric {
                position,
                direction,
                horizontal,
                photometry: _,
            } => {
                *position = point(*position);
                *direction = rotate(*direction);
                *horizontal = rotate(*horizontal);
            }
        }
    }

    /// The spelling of this emitter in the scene format.
    #[must_use]
    pub fn spelling(&self) -> EmitterSpelling {
        // Each kind lists its vectors and numbers by their keys.
        let range = self.range().map(|range| ("range", range));
        match self {
            Self::Sun { direction } => EmitterSpelling {
                kind: "sun",
                triples: vec![("direction", *direction)],
                numbers: Vec::new(),
                intensity: "irradiance",
            },
            Self::Point { position, range: _ } => EmitterSpelling {
                kind: "point",
                triples: vec![("position", *position)],
                numbers: range.into_iter().collect(),
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
                EmitterSpelling {
                    kind: "spot",
                    triples: vec![("position", *position), ("direction", *direction)],
                    numbers: angles.into_iter().chain(range).collect(),
                    intensity: "intensity",
                }
            }
            Self::Photometric {
                position,
                direction,
                horizontal,
                photometry: _,
            } => EmitterSpelling {
                kind: "ies",
                triples: vec![
                    ("position", *position),
                    ("direction", *direction),
                    ("horizontal", *horizontal),
                ],
                numbers: Vec::new(),
                intensity: "color",
            },
        }
    }
}

/// The unit vector of a direction.
fn axis(direction: [f64; 3]) -> Result<Vec3, String> {
    unit(Vec3::from_array(direction)).ok_or_else(|| "a light shines in no direction".to_owned())
}

/// A point light; with a radius it is a spherical light and casts soft shadows. It is not a
/// surface, so no ray hits it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PointLight {
    /// The position.
    pub position: [f64; 3],
    /// The intensity, linear RGB, each channel at least 0; values above 1 are allowed.
    #[schemars(inner(range(min = 0.0)))]
    pub color: [f64; 3],
    /// The radius, at least 0; 0 is a point.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0))]
    pub radius: f64,
}

impl PointLight {
    /// The radiant intensity of a point with falloff that lights a place as much: a white
    /// Lambertian surface that faces it there has the colour of the light as radiance.
    #[must_use]
    pub fn intensity_at(&self, place: [f64; 3]) -> [f64; 3] {
        let square = Vec3::from_array(place).distance_squared(Vec3::from_array(self.position));
        self.color.map(|channel| channel * PI * square)
    }
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over a reference"
)]
fn is_zero(radius: &f64) -> bool {
    radius.to_bits() == 0
}
