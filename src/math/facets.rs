//! Models of microfacets and of plastics.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A distribution of microfacets, and how they hide each other.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Microfacets {
    /// GGX (Trowbridge and Reitz) with Smith's height-correlated masking, as glTF has it.
    #[default]
    Ggx,
    /// GGX whose facets hide light and viewer independently: the product of both maskings.
    SeparableGgx,
    /// Beckmann's, with such a product.
    Beckmann,
}

impl Microfacets {
    /// The keywords of the distributions, each with its description.
    pub const KEYWORDS: &[(&str, Self, &str)] = &[
        (
            "ggx",
            Self::Ggx,
            "GGX with height-correlated masking, as glTF has it.",
        ),
        (
            "separable-ggx",
            Self::SeparableGgx,
            "GGX with the product of the maskings of light and viewer.",
        ),
        (
            "beckmann",
            Self::Beckmann,
            "Beckmann's distribution with the product of both maskings.",
        ),
    ];
}

/// How light leaves a diffuse base below the boundary of a dielectric.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary,
)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub enum Plastic {
    /// As glTF's appendix B says: what no facet reflects.
    #[default]
    None,
    /// Reflected inside again and again, without a change of colour: `plastic` of Mitsuba.
    Linear,
    /// Reflected inside again and again, each time with the colour of the base.
    Nonlinear,
    /// Once through a smooth boundary and out again, as if the index inside were that outside:
    /// `pplastic` of Mitsuba.
    Single,
}

impl Plastic {
    /// The keywords of the kinds, each with its description.
    pub const KEYWORDS: &[(&str, Self, &str)] = &[
        ("none", Self::None, "As glTF says."),
        (
            "linear",
            Self::Linear,
            "Light is reflected inside without a change of colour.",
        ),
        (
            "nonlinear",
            Self::Nonlinear,
            "Light is reflected inside, and its colour becomes more saturated.",
        ),
        (
            "single",
            Self::Single,
            "Light goes in and out of a smooth boundary once.",
        ),
    ];
}
