//! What surrounds a scene, infinitely far away.

use super::ImageId;
use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The radiance that arrives from each direction where no surface stands; the path integrator sees
/// it and is lit by it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Environment {
    /// The radiance, linear Rec. 709, each channel at least 0; multiplied with the image, if there
    /// is one.
    #[schemars(inner(range(min = 0.0)))]
    pub radiance: [f64; 3],
    /// A picture of all directions: longitude across, latitude down, +y up, its middle towards −z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageId>,
    /// The rows of the rotation from directions of the world to those of the image; none for the
    /// identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_from_world: Option<[[f64; 3]; 3]>,
}
