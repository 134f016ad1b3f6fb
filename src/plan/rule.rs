//! The rules: each proves that something adds exactly nothing.

/// A rule, known to users by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum Rule {
    /// At a hit that is turned away from a light, no shadow ray: its terms are 0 by the language.
    ShadowFacing,
    /// At a hit whose colour·kd and ks are 0, no direct light: every term has a factor 0.
    ShadowUnlit,
    /// At a hit whose ks is 0, no power: the highlight has a factor 0.
    HighlightKs,
    /// A mirrored or refracted ray of weight 0 is not traced.
    MirrorKs,
}

impl Rule {
    /// All rules.
    pub const ALL: [Self; 4] = [Self::ShadowFacing, Self::ShadowUnlit, Self::HighlightKs, Self::MirrorKs];

    /// The name, as `E-SPEC`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ShadowFacing => "E-SHADOW-NL",
            Self::ShadowUnlit => "E-SHADOW-KM",
            Self::HighlightKs => "E-SPEC",
            Self::MirrorKs => "E-REFL-KS",
        }
    }
}

/// A set of rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules(u32);

impl Rules {
    /// No rule: everything a scene could ask for is simulated.
    pub const NONE: Self = Self(0);
    /// Every rule.
    pub const ALL: Self = Self(u32::MAX);
    /// The rules that decide hit by hit.
    pub const AT_HITS: Self =
        Self::NONE.with(Rule::ShadowFacing).with(Rule::ShadowUnlit).with(Rule::HighlightKs).with(Rule::MirrorKs);

    /// The set with a rule more.
    #[must_use]
    pub const fn with(self, rule: Rule) -> Self {
        Self(self.0 | 1 << rule as u32)
    }

    /// The set with a rule less.
    #[must_use]
    pub const fn without(self, rule: Rule) -> Self {
        Self(self.0 & !(1 << rule as u32))
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
