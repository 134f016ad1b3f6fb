//! Feature sets of the integrators. They are compile-time constants, so that the code of unused
//! effects is not compiled in.

/// A set of features, of path tracing or of the Whitted integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FeatureSet<const OF_PATHS: bool>(pub u32);

/// A set of features of the Whitted integrator.
pub type WhittedFeatures = FeatureSet<false>;

/// A set of features of the path integrator.
pub type PathFeatures = FeatureSet<true>;

impl<const OF_PATHS: bool> FeatureSet<OF_PATHS> {
    /// The union of two sets.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all of `others` are in the set.
    #[must_use]
    pub const fn contains(self, others: Self) -> bool {
        self.0 & others.0 == others.0
    }

    /// The number of features.
    #[must_use]
    pub const fn count(self) -> u32 {
        self.0.count_ones()
    }
}

impl WhittedFeatures {
    /// First hit only.
    pub const NONE: Self = Self(0);
    /// Several samples per pixel, or several points of the lens.
    pub const CAMERA: Self = Self(1);
    /// Texture lookups for colour, ks and normal.
    pub const MAPS: Self = Self(1 << 1);
    /// Diffuse term.
    pub const LIGHT: Self = Self(1 << 2);
    /// Specular highlights.
    pub const HIGHLIGHT: Self = Self(1 << 3);
    /// Gooch and cartoon shading.
    pub const GOOCH: Self = Self(1 << 4);
    /// Shadow rays.
    pub const SHADOW: Self = Self(1 << 5);
    /// Reflected and refracted rays.
    pub const BOUNCE: Self = Self(1 << 6);
    /// Sampling of area lights and glossy lobes.
    pub const SAMPLED: Self = Self(1 << 7);
    /// Work that the rules of [`RuleSet::AT_HITS`](super::RuleSet::AT_HITS) skip, for plans without
    /// these rules.
    pub const UNPRUNED: Self = Self(1 << 8);
    /// All of them.
    pub const EVERYTHING: Self = Self((1 << 9) - 1);
}

impl PathFeatures {
    /// Diffuse surfaces only, without light sampling.
    pub const NONE: Self = Self(0);
    /// Alpha blending and blends of materials (both stochastic), and alpha masks.
    pub const ALPHA: Self = Self(1);
    /// Next-event estimation: lights are sampled.
    pub const NEE: Self = Self(1 << 1);
    /// Shadow rays.
    pub const SHADOWS: Self = Self(1 << 2);
    /// Microfacet reflection.
    pub const MICROFACETS: Self = Self(1 << 3);
    /// Transmission.
    pub const TRANSMISSION: Self = Self(1 << 4);
    /// Layers of a material ([`super::Layer`]).
    pub const LAYERS: Self = Self(1 << 5);
    /// Participating media.
    pub const MEDIA: Self = Self(1 << 6);
    /// All of them.
    pub const EVERYTHING: Self = Self((1 << 7) - 1);
}

/// A set of shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeSet {
    /// Spheres, planes and triangles.
    Basic,
    /// All shapes.
    All,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_feature_is_a_bit_of_its_own_and_everything_is_all_of_them() {
        let single = [
            WhittedFeatures::CAMERA,
            WhittedFeatures::MAPS,
            WhittedFeatures::LIGHT,
            WhittedFeatures::HIGHLIGHT,
            WhittedFeatures::GOOCH,
            WhittedFeatures::SHADOW,
            WhittedFeatures::BOUNCE,
            WhittedFeatures::SAMPLED,
            WhittedFeatures::UNPRUNED,
        ];
        assert!(single.iter().all(|feature| feature.count() == 1));
        assert_eq!(
            single
                .into_iter()
                .fold(WhittedFeatures::NONE, WhittedFeatures::with),
            WhittedFeatures::EVERYTHING
        );
        assert_eq!(WhittedFeatures::EVERYTHING.count(), 9);
        let of_paths = [
            PathFeatures::ALPHA,
            PathFeatures::NEE,
            PathFeatures::SHADOWS,
            PathFeatures::MICROFACETS,
            PathFeatures::TRANSMISSION,
            PathFeatures::LAYERS,
            PathFeatures::MEDIA,
        ];
        assert!(of_paths.iter().all(|feature| feature.count() == 1));
        let all_of_paths = of_paths
            .into_iter()
            .fold(PathFeatures::NONE, PathFeatures::with);
        assert_eq!(all_of_paths, PathFeatures::EVERYTHING);
        assert_eq!(PathFeatures::EVERYTHING.count(), 7);
        let two = WhittedFeatures::MAPS.with(WhittedFeatures::LIGHT);
        assert_eq!(two.with(WhittedFeatures::LIGHT), two);
        assert!(
            two.contains(WhittedFeatures::LIGHT)
                && two.contains(two)
                && two.contains(WhittedFeatures::NONE)
        );
        assert!(
            !two.contains(WhittedFeatures::SHADOW)
                && !two.contains(two.with(WhittedFeatures::SHADOW))
        );
    }
}
