//! The camera: an eye, an image plane, and a lens.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A camera with any frustum, sheared ones included.
///
/// Sub-sample (i, j) of pixel (x, y), y downwards, looks from the eye through
/// `center + (x + (i+½)/factor − width/2)·right + (height/2 − y − (j+½)/factor)·up`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Camera {
    /// Where rays start.
    pub eye: [f64; 3],
    /// The middle of the image, a point in the plane of focus.
    pub center: [f64; 3],
    /// The step from a pixel to its right neighbour in the image plane.
    pub right: [f64; 3],
    /// The step from a pixel to its upper neighbour; at a right angle to `right`.
    pub up: [f64; 3],
    /// Width and height of the image in pixels.
    #[schemars(inner(range(min = 1)))]
    pub size: [u32; 2],
    /// The aperture.
    pub lens: Lens,
    /// How the rays run.
    #[serde(default, skip_serializing_if = "Projection::is_perspective")]
    pub projection: Projection,
}

/// How the rays of a camera run.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase")]
pub enum Projection {
    /// From the eye.
    #[default]
    Perspective,
    /// Side by side: through each point of the image, in the direction from the eye to its middle,
    /// from as far before.
    Orthographic,
}

impl Projection {
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde hands over a reference"
    )]
    fn is_perspective(&self) -> bool {
        *self == Self::Perspective
    }
}

/// A thin lens; radius 0 or one sample is a pinhole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Lens {
    /// The radius of the aperture in scene units, at least 0.
    #[schemars(range(min = 0.0))]
    pub radius: f64,
    /// How many points of the aperture each sub-sample takes, at least 1.
    #[schemars(range(min = 1))]
    pub samples: u32,
}
