//! The rules: each proves that some work contributes exactly zero.
//!
//! A [`Rule`] names a rule of either integrator; [`RuleSet`] is a set of them as bits. The names
//! (`E-…` for the Whitted integrator, `P-…` for path tracing, `B-…` for bounded errors) and the
//! texts are what `rtc explain` prints. A rule is one row of the table below; the row of a rule for
//! path tracing is its item in [`crate::path::rules`].

use super::path::rules::{PathRule, light, material, paths, texture};

/// Declares the rules: those of the Whitted integrator with name and text (the statement and its
/// proof), then those for path tracing with their items, in the order in which they run.
macro_rules! rules {
    ($($name:ident: $label:literal, $text:literal;)* --- $($of_paths:ident: $item:path;)*) => {
        /// A rule.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u64)]
        #[expect(missing_docs, reason = "each is described by its text")]
        pub enum Rule {
            $($name,)*
            $($of_paths,)*
        }

        /// The names and texts of all rules.
        const ROWS: &[(&str, &str)] = &[$(($label, $text),)* $(($item.name, $item.text),)*];

        /// The rules for path tracing, in the order in which they run.
        pub(crate) const PATH_RULES: &[(Rule, &PathRule)] = &[$((Rule::$of_paths, &$item),)*];

        impl Rule {
            /// All rules, those of the Whitted integrator first.
            pub const ALL: [Self; ROWS.len()] = [$(Self::$name,)* $(Self::$of_paths,)*];
        }
    };
}

rules! {
    Mode: "E-MODE",
        "A depth or normal buffer is a function of the first hit only: it does not depend on \
         lights, colours and bounces.";
    LightBlack: "E-LIGHT-BLACK",
        "The terms of a light of colour 0 are finite values times 0. The rule does not apply to \
         Gooch shading, whose tones do not depend on the colour of the light.";
    LightUnreached: "E-LIGHT-UNREACH",
        "If kd·C and ks are 0 on all visible surfaces, each direct term has a factor of 0.";
    LightBehind: "E-LIGHT-BEHIND",
        "If a flat surface is visible from one side only and the light is on the other side, \
         then N·L < 0: the diffuse term max(0, N·L) is 0, and the highlight is 0 as well, with \
         shadows by its definition, without shadows because ks is 0.";
    ShadowOff: "E-SHADOW-OFF", "Shadows are off in the scene.";
    ShadowFacing: "E-SHADOW-NL",
        "If N·L ≤ 0 for the shading or the geometric normal, the surface shadows itself at this \
         point: no shadow ray is needed.";
    ShadowUnlit: "E-SHADOW-KM",
        "At a hit with kd·C = 0 and ks = 0 a light contributes nothing, occluded or not: no \
         shadow ray is needed.";
    ShadowConvex: "E-SHADOW-CONVEX",
        "A convex solid lies behind its tangent plane at any point with N·L > 0, and the light \
         lies in front of that plane: the solid does not shadow itself. The same holds for a \
         flat surface if the light is not in its plane.";
    ShadowPair: "E-SHADOW-PAIR",
        "All segments from a surface to a light lie in the convex hull of both: a surface \
         outside this hull casts no shadow there.";
    SoftPoint: "E-SOFT",
        "A light of radius 0 is a point light, and a single sample of a light is its centre: no \
         sampling is needed.";
    HighlightKs: "E-SPEC",
        "If ks is 0, the highlight is 0 times a power of at most 1: the power is not computed.";
    MirrorKs: "E-REFL-KS",
        "The radiance along a reflected or refracted ray is multiplied by kr (ks by default) or \
         kt. If this factor is 0, the ray is not traced.";
    MirrorDepth: "E-REFL-DEPTH", "The scene allows no bounce.";
    MirrorUnreached: "E-REFL-UNREACH",
        "A flat reflective surface that is visible from one side reflects only the half-space \
         on that side, and the background is black. So the longest chain of reflective surfaces \
         that are visible from one another bounds the number of bounces.";
    MirrorConvex: "E-REFL-CONVEX",
        "A ray that is reflected off a convex solid from outside stays in the half-space in \
         front of its tangent plane: it can't hit the solid again.";
    Opaque: "E-REFR", "No visible material has kt > 0: there is no refraction.";
    GlossyMirror: "E-GLOSSY",
        "A glossy lobe of one sample is a perfect reflection, and a lobe of weight 0 contributes \
         nothing.";
    Cut: "B-CUT",
        "Bounces are cut off once their weight bounds the remaining contribution below half a \
         level of 8 bits. Only with --approx: the picture may differ by that much.";
    TextureConstant: "E-TEX-CONST",
        "A texture whose texels are all equal has this value everywhere.";
    TextureUnseen: "E-TEX-UNSEEN",
        "A map is not used on a surface without texture coordinates, on an invisible surface, or \
         for a term of weight 0.";
    NormalFlat: "E-NORMAL",
        "Shading normals are not used without light and reflections. If the vertex normals of \
         each triangle are equal, there is nothing to interpolate.";
    Pinhole: "E-DOF",
        "A lens of radius 0, or a lens with one sample, is its centre: one camera ray is enough.";
    OneSample: "E-SS", "A factor of 1 is one sample per pixel.";
    PixelMiss: "E-SS-MISS",
        "No ray of a pixel outside the projected bounding boxes of all surfaces can hit \
         anything: the pixel is black and is not traced.";
    PixelFlat: "E-SS-FLAT",
        "If all rays of a pixel hit one flat surface of one value, one ray is traced for all.";
    Cull: "E-CULL",
        "A surface that no camera, shadow, reflected or refracted ray can hit is removed from \
         the world.";
    ---
    PathLightBlack: light::ZERO_INTENSITY;
    PathDarkSky: light::BLACK_ENVIRONMENT;
    PathEvenSky: light::CONSTANT_ENVIRONMENT;
    PathZero: material::ZERO;
    PathUnlitMaterial: material::UNLIT;
    PathMapUnseen: texture::UNSEEN;
    PathMapConstant: texture::CONSTANT;
    PathOpaque: material::OPAQUE;
    PathMediumClear: material::CLEAR_MEDIA;
    PathLightReach: light::OUT_OF_RANGE;
    PathDark: paths::NO_EMISSION;
    PathUnlit: paths::UNLIT_ONLY;
    PathLast: paths::LAST_RAY;
    PathDelta: light::DELTA_ONLY;
    PathShadowAlone: light::SINGLE_CONVEX;
    PathCull: paths::CULL;
    PathCullShadow: paths::CULL_SHADOW;
}

impl Rule {
    /// The name, as `E-SPEC`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ROWS[self as usize].0
    }

    /// The statement and its proof.
    #[must_use]
    pub fn text(self) -> &'static str {
        ROWS[self as usize].1
    }

    /// Whether it is a rule for path tracing.
    #[must_use]
    pub fn is_of_paths(self) -> bool {
        PATH_RULES.iter().any(|(rule, _)| *rule == self)
    }

    /// The rule with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|rule| rule.name().eq_ignore_ascii_case(name))
    }
}

/// A set of rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RuleSet(u64);

impl RuleSet {
    /// No rule: everything that a scene could require is simulated.
    pub const NONE: Self = Self(0);
    /// Every rule that does not change the picture.
    pub const ALL: Self = Self(u64::MAX).without(Rule::Cut);
    /// The rules that are decided at each hit.
    pub const AT_HITS: Self = Self::NONE
        .with(Rule::ShadowFacing)
        .with(Rule::ShadowUnlit)
        .with(Rule::HighlightKs)
        .with(Rule::MirrorKs);

    /// The rules of path tracing whose proofs do not depend on where surfaces are.
    pub(crate) const AT_ANY_PLACE: Self = Self::NONE
        .with(Rule::PathLightBlack)
        .with(Rule::PathDarkSky)
        .with(Rule::PathEvenSky)
        .with(Rule::PathUnlitMaterial)
        .with(Rule::PathMediumClear)
        .with(Rule::PathDark)
        .with(Rule::PathUnlit)
        .with(Rule::PathLast)
        .with(Rule::PathDelta);

    /// The set with one more rule.
    #[must_use]
    pub const fn with(self, rule: Rule) -> Self {
        Self(self.0 | 1 << rule as u64)
    }

    /// The set without a rule.
    #[must_use]
    pub const fn without(self, rule: Rule) -> Self {
        Self(self.0 & !(1 << rule as u64))
    }

    /// The rules that are in both sets.
    #[must_use]
    pub const fn intersection(self, others: Self) -> Self {
        Self(self.0 & others.0)
    }

    /// Whether the rule is in the set.
    #[must_use]
    pub const fn contains(self, rule: Rule) -> bool {
        self.contains_all(Self::NONE.with(rule))
    }

    /// Whether all of `others` are in the set.
    #[must_use]
    pub const fn contains_all(self, others: Self) -> bool {
        self.0 & others.0 == others.0
    }
}

impl FromIterator<Rule> for RuleSet {
    fn from_iter<T: IntoIterator<Item = Rule>>(rules: T) -> Self {
        rules.into_iter().fold(Self::NONE, Self::with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_found_by_their_names_and_no_two_share_one() {
        for (index, rule) in Rule::ALL.into_iter().enumerate() {
            assert_eq!(rule as usize, index);
            assert_eq!(Rule::find(&rule.name().to_lowercase()), Some(rule));
        }
        assert!(Rule::find("E-NOTHING").is_none());
        assert!(
            !RuleSet::ALL.contains(Rule::Cut),
            "a rule that changes the picture is off by default"
        );
    }

    #[test]
    fn a_set_has_the_rules_it_was_given_and_no_more() {
        let two = RuleSet::NONE.with(Rule::Mode).with(Rule::Cull);
        assert_eq!([two.with(Rule::Cull), two.without(Rule::Cut)], [two, two]);
        assert_eq!(two.without(Rule::Cull), RuleSet::NONE.with(Rule::Mode));
        assert_eq!(
            two.intersection(RuleSet::AT_HITS.with(Rule::Cull)),
            RuleSet::NONE.with(Rule::Cull)
        );
        assert!(
            two.contains(Rule::Cull) && two.contains_all(two) && two.contains_all(RuleSet::NONE)
        );
        assert!(!two.contains(Rule::Cut) && !two.contains_all(two.with(Rule::Cut)));
        let others = [
            Rule::ShadowFacing,
            Rule::ShadowUnlit,
            Rule::HighlightKs,
            Rule::MirrorKs,
        ];
        assert_eq!(
            others.into_iter().fold(RuleSet::NONE, RuleSet::with),
            RuleSet::AT_HITS
        );
    }
}
