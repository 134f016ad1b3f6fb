//! Why a value is not proven.

use std::collections::BTreeSet;
use std::ops::BitOr;

/// The names of what can be unsupported, each with its own bit; others share that of the last.
const NAMES: [&str; 17] = [
    "instance",
    "ellipsoid",
    "csg",
    "quad",
    "triangle",
    "textures",
    "normal maps",
    "refraction by vertex normals",
    "toon shading",
    "stereo",
    "motion",
    "a background colour",
    "a standard material",
    "lights with falloff",
    "path tracing",
    "an environment",
    "another feature",
];

/// A set of reasons why enclosures do not decide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Doubts(u32);

impl Doubts {
    /// None.
    pub const NONE: Self = Self(0);
    /// A ray passes the border of a surface within rounding.
    pub const SILHOUETTE: Self = Self(1);
    /// A ray starts on another surface within rounding, or at a grazing angle.
    pub const CONTACT: Self = Self(1 << 1);
    /// Two surfaces are equally far within rounding.
    pub const ORDER: Self = Self(1 << 2);
    /// A light passes the border of a surface within rounding.
    pub const SHADOW: Self = Self(1 << 3);
    /// Refraction or total reflection.
    pub const CRITICAL_ANGLE: Self = Self(1 << 4);
    /// The value lies on the border of two levels within rounding.
    pub const LEVEL: Self = Self(1 << 5);
    /// A camera ray has more branches than are followed.
    pub const BRANCHES: Self = Self(1 << 6);
    /// A texture, or the frame of random directions, jumps here.
    pub const SEAM: Self = Self(1 << 7);
    /// The bit of the first name.
    const FIRST: u32 = 8;

    /// A feature whose formula is not evaluated.
    #[must_use]
    pub fn unsupported(name: &str) -> Self {
        let index = NAMES.iter().position(|known| *known == name);
        Self(1 << (Self::FIRST as usize + index.unwrap_or(NAMES.len() - 1)))
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether only rounding is in doubt: no feature is unsupported.
    #[must_use]
    pub fn is_rounding(self) -> bool {
        self.0 >> Self::FIRST == 0
    }

    /// The reasons in words.
    #[must_use]
    pub fn names(self) -> BTreeSet<&'static str> {
        let rounding = [
            (Self::SILHOUETTE, "the border of a surface"),
            (Self::CONTACT, "a surface at the start of a ray"),
            (Self::ORDER, "surfaces equally far"),
            (Self::SHADOW, "the border of a shadow"),
            (Self::CRITICAL_ANGLE, "the critical angle"),
            (Self::LEVEL, "the border of two levels"),
            (Self::BRANCHES, "too many branches"),
            (Self::SEAM, "the seam of a texture"),
        ];
        let rounding = rounding.into_iter().filter(|(one, _)| self.0 & one.0 != 0);
        let features = NAMES.into_iter().enumerate();
        let features = features.filter(|(k, _)| self.0 >> (Self::FIRST as usize + k) & 1 != 0);
        let names = rounding.map(|(_, name)| name);
        names.chain(features.map(|(_, name)| name)).collect()
    }
}

impl BitOr for Doubts {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}
