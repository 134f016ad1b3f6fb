//! The rules: each proves that something adds exactly nothing.

use super::path;

/// A rule, known to users by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u64)]
#[expect(missing_docs, reason = "each is described by its text")]
pub enum Rule {
    Mode,
    LightBlack,
    LightUnreached,
    LightBehind,
    ShadowOff,
    ShadowFacing,
    ShadowUnlit,
    ShadowConvex,
    ShadowPair,
    SoftPoint,
    HighlightKs,
    MirrorKs,
    MirrorDepth,
    MirrorUnreached,
    MirrorConvex,
    Opaque,
    GlossyMirror,
    Cut,
    TextureConstant,
    TextureUnseen,
    NormalFlat,
    Pinhole,
    OneSample,
    PixelMiss,
    PixelFlat,
    Cull,
    PathLightBlack,
    PathDarkSky,
    PathZero,
    PathUnlitMaterial,
    PathMapUnseen,
    PathMapConstant,
    PathOpaque,
    PathLightReach,
    PathDark,
    PathUnlit,
    PathLast,
    PathDelta,
    PathShadowAlone,
    PathCull,
    PathEvenSky,
    PathCullShadow,
}

impl Rule {
    /// All rules, those by light first.
    pub const ALL: [Self; 42] = [
        Self::Mode,
        Self::LightBlack,
        Self::LightUnreached,
        Self::LightBehind,
        Self::ShadowOff,
        Self::ShadowFacing,
        Self::ShadowUnlit,
        Self::ShadowConvex,
        Self::ShadowPair,
        Self::SoftPoint,
        Self::HighlightKs,
        Self::MirrorKs,
        Self::MirrorDepth,
        Self::MirrorUnreached,
        Self::MirrorConvex,
        Self::Opaque,
        Self::GlossyMirror,
        Self::Cut,
        Self::TextureConstant,
        Self::TextureUnseen,
        Self::NormalFlat,
        Self::Pinhole,
        Self::OneSample,
        Self::PixelMiss,
        Self::PixelFlat,
        Self::Cull,
        Self::PathLightBlack,
        Self::PathDarkSky,
        Self::PathZero,
        Self::PathUnlitMaterial,
        Self::PathMapUnseen,
        Self::PathMapConstant,
        Self::PathOpaque,
        Self::PathLightReach,
        Self::PathDark,
        Self::PathUnlit,
        Self::PathLast,
        Self::PathDelta,
        Self::PathShadowAlone,
        Self::PathCull,
        Self::PathEvenSky,
        Self::PathCullShadow,
    ];

    /// The name, as `E-SPEC`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// The statement and the reason.
    #[must_use]
    pub fn text(self) -> &'static str {
        self.row().1
    }

    /// The rule of a name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|rule| rule.name().eq_ignore_ascii_case(name))
    }

    #[expect(clippy::too_many_lines, reason = "a table, one row a rule")]
    fn row(self) -> (&'static str, &'static str) {
        if let Some(item) = path::rules::find(self) {
            return (item.name, item.text);
        }
        match self {
            Self::Mode => (
                "E-MODE",
                "A depth or normal buffer is a function of the first hit alone: lights, colours and bounces do not show.",
            ),
            Self::LightBlack => (
                "E-LIGHT-BLACK",
                "A black light multiplies finite terms by 0. Not in Gooch's shading, whose tones are not the light's.",
            ),
            Self::LightUnreached => (
                "E-LIGHT-UNREACH",
                "Where kd·C and ks are 0 on all that can be seen, each direct term has a factor 0.",
            ),
            Self::LightBehind => (
                "E-LIGHT-BEHIND",
                "A flat surface seen from one side has N·L < 0 for a light on the other: its diffuse term is max(0, N·L) \
                 = 0, and so is the highlight, with shadows by the language or because ks is 0.",
            ),
            Self::ShadowOff => ("E-SHADOW-OFF", "The scene does not ask for shadows."),
            Self::ShadowFacing => (
                "E-SHADOW-NL",
                "Where N·L ≤ 0, with the shading or the geometric normal, the surface stands in its own light: no shadow ray \
                 need say so.",
            ),
            Self::ShadowUnlit => (
                "E-SHADOW-KM",
                "At a hit whose kd·C and ks are 0 a light adds nothing, hidden or not: no shadow ray.",
            ),
            Self::ShadowConvex => (
                "E-SHADOW-CONVEX",
                "A convex solid lies behind the plane that touches it at a point with N·L > 0, the light before it: it \
                 does not shadow itself. Nor does a flat surface whose plane the light is off.",
            ),
            Self::ShadowPair => (
                "E-SHADOW-PAIR",
                "All segments from a surface to a light lie in the convex hull of the two: a solid outside the hull casts \
                 no shadow there.",
            ),
            Self::SoftPoint => (
                "E-SOFT",
                "A light of radius 0 is a point, and one sample of a light asks its centre: no sampling.",
            ),
            Self::HighlightKs => (
                "E-SPEC",
                "Where ks is 0 the highlight is 0 times a power of at most 1: no power.",
            ),
            Self::MirrorKs => (
                "E-REFL-KS",
                "The radiance along a mirrored or refracted ray is multiplied by ks or kt. If that is 0, no ray is traced.",
            ),
            Self::MirrorDepth => ("E-REFL-DEPTH", "The scene allows no bounce."),
            Self::MirrorUnreached => (
                "E-REFL-UNREACH",
                "A flat mirror seen from one side shows only that half of space, and the background is black: chains of \
                 mirrors that can see one another bound the bounces.",
            ),
            Self::MirrorConvex => (
                "E-REFL-CONVEX",
                "A ray mirrored off a convex solid from outside leaves through the half-space before its tangent plane: \
                 it can't meet the solid again.",
            ),
            Self::Opaque => (
                "E-REFR",
                "No material that can be seen has kt > 0: nothing refracts.",
            ),
            Self::GlossyMirror => (
                "E-GLOSSY",
                "A lobe of one sample is the mirror, a lobe of weight 0 is nothing.",
            ),
            Self::Cut => (
                "B-CUT",
                "Bounces whose weight bounds all they can add below half a level of 8 bits are cut off. Only with \
                 --approx: the picture may differ by that much.",
            ),
            Self::TextureConstant => (
                "E-TEX-CONST",
                "A texture whose texels are all equal is that value everywhere.",
            ),
            Self::TextureUnseen => (
                "E-TEX-UNSEEN",
                "A map on a surface without texture coordinates, on one that can't be seen, or for a term whose weight \
                 is 0, does not show.",
            ),
            Self::NormalFlat => (
                "E-NORMAL",
                "Shading normals do not show without light and mirrors, and where all corners of each triangle have the \
                 same normal there is nothing to interpolate.",
            ),
            Self::Pinhole => (
                "E-DOF",
                "A lens of radius 0 or of one sample is its centre: one ray.",
            ),
            Self::OneSample => ("E-SS", "A factor of 1 is one sample a pixel."),
            Self::PixelMiss => (
                "E-SS-MISS",
                "No ray of a pixel outside the projected boxes of all surfaces meets anything: it is black, untraced.",
            ),
            Self::PixelFlat => (
                "E-SS-FLAT",
                "Where all rays of a pixel meet one flat surface of one value, one is traced and counts for all.",
            ),
            Self::Cull => (
                "E-CULL",
                "A surface that no camera, shadow or mirror ray can meet is left out of the world.",
            ),
            Self::PathLightBlack
            | Self::PathDarkSky
            | Self::PathZero
            | Self::PathUnlitMaterial
            | Self::PathMapUnseen
            | Self::PathMapConstant
            | Self::PathOpaque
            | Self::PathLightReach
            | Self::PathDark
            | Self::PathUnlit
            | Self::PathLast
            | Self::PathDelta
            | Self::PathShadowAlone
            | Self::PathCull
            | Self::PathEvenSky
            | Self::PathCullShadow => {
                unreachable!("rules for paths are items of `plan::path::rules`")
            }
        }
    }
}

/// A set of rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules(u64);

impl Rules {
    /// No rule: everything a scene could ask for is simulated.
    pub const NONE: Self = Self(0);
    /// Every rule that changes no bit.
    pub const ALL: Self = Self(u64::MAX).without(Rule::Cut);
    /// The rules that decide hit by hit.
    pub const AT_HITS: Self = Self::NONE
        .with(Rule::ShadowFacing)
        .with(Rule::ShadowUnlit)
        .with(Rule::HighlightKs)
        .with(Rule::MirrorKs);

    /// The set with a rule more.
    #[must_use]
    pub const fn with(self, rule: Rule) -> Self {
        Self(self.0 | 1 << rule as u64)
    }

    /// The set with a rule less.
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
            !Rules::ALL.contains(Rule::Cut),
            "what changes a picture is asked for"
        );
    }

    #[test]
    fn a_set_has_the_rules_it_was_given_and_no_more() {
        let two = Rules::NONE.with(Rule::Mode).with(Rule::Cull);
        assert_eq!([two.with(Rule::Cull), two.without(Rule::Cut)], [two, two]);
        assert_eq!(two.without(Rule::Cull), Rules::NONE.with(Rule::Mode));
        assert_eq!(
            two.intersection(Rules::AT_HITS.with(Rule::Cull)),
            Rules::NONE.with(Rule::Cull)
        );
        assert!(two.contains(Rule::Cull) && two.contains_all(two) && two.contains_all(Rules::NONE));
        assert!(!two.contains(Rule::Cut) && !two.contains_all(two.with(Rule::Cut)));
        let others = [
            Rule::ShadowFacing,
            Rule::ShadowUnlit,
            Rule::HighlightKs,
            Rule::MirrorKs,
        ];
        assert_eq!(
            others.into_iter().fold(Rules::NONE, Rules::with),
            Rules::AT_HITS
        );
    }
}
