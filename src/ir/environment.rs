//! The environment light, infinitely far away.

use super::ImageId;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The radiance that arrives along rays that hit no surface. Used by the path integrator only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Environment {
    /// The radiance, linear Rec. 709, each channel at least 0; multiplied by the image, if there is
    /// one.
    #[schemars(inner(range(min = 0.0)))]
    pub radiance: [f64; 3],
    /// An equirectangular image of all directions: longitude across, latitude down, +y up, its
    /// centre towards −z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageId>,
    /// The rows of the rotation from world directions to image directions; absent for the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_from_world: Option<[[f64; 3]; 3]>,
}
