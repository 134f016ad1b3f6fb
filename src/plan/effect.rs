//! The effects of a picture, and the verdict on each.

use super::rules::Rule;
use crate::ir::Place;

/// A part of the simulation that not every scene needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "each is named as in the books")]
pub enum Effect {
    DepthBuffer,
    NormalBuffer,
    Surfaces,
    DirectLight,
    Shadows,
    SoftLight,
    Highlight,
    Mirror,
    GlossyReflection,
    Refraction,
    Depth,
    Textures,
    NormalInterpolation,
    NormalMapping,
    Lens,
    Supersampling,
    Environment,
    Emission,
    Unlit,
    Alpha,
    Mis,
    Microfacets,
    Compensation,
    Clearcoat,
    Sheen,
    Anisotropy,
    Iridescence,
    Volume,
    Dispersion,
    VertexColors,
    EnvironmentMap,
}

impl Effect {
    /// The number of effects.
    pub const COUNT: usize = Self::EnvironmentMap as usize + 1;

    /// The effects of pictures of the course alone.
    pub const OF_THE_COURSE: [Self; 6] = [
        Self::DepthBuffer,
        Self::NormalBuffer,
        Self::SoftLight,
        Self::Highlight,
        Self::Mirror,
        Self::GlossyReflection,
    ];

    /// The effects of traced paths.
    pub const OF_PATHS: [Self; 25] = [
        Self::Surfaces,
        Self::Environment,
        Self::EnvironmentMap,
        Self::Emission,
        Self::Unlit,
        Self::Alpha,
        Self::DirectLight,
        Self::Shadows,
        Self::Mis,
        Self::Depth,
        Self::Microfacets,
        Self::Compensation,
        Self::Clearcoat,
        Self::Sheen,
        Self::Anisotropy,
        Self::Iridescence,
        Self::Refraction,
        Self::Volume,
        Self::Dispersion,
        Self::Textures,
        Self::VertexColors,
        Self::NormalInterpolation,
        Self::NormalMapping,
        Self::Lens,
        Self::Supersampling,
    ];

    /// The name, as in the books.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::DepthBuffer => "depth buffer",
            Self::NormalBuffer => "normal buffer",
            Self::Surfaces => "surfaces",
            Self::DirectLight => "direct light",
            Self::Shadows => "shadows",
            Self::SoftLight => "soft light",
            Self::Highlight => "highlight",
            Self::Mirror => "mirror",
            Self::GlossyReflection => "glossy mirror",
            Self::Refraction => "refraction",
            Self::Depth => "bounces",
            Self::Textures => "textures",
            Self::NormalInterpolation => "corner normals",
            Self::NormalMapping => "normal maps",
            Self::Lens => "lens",
            Self::Supersampling => "supersampling",
            Self::Environment => "environment",
            Self::Emission => "emission",
            Self::Unlit => "unlit surfaces",
            Self::Alpha => "alpha",
            Self::Mis => "light weights",
            Self::Microfacets => "microfacets",
            Self::Compensation => "compensation",
            Self::Clearcoat => "clearcoat",
            Self::Sheen => "sheen",
            Self::Anisotropy => "anisotropy",
            Self::Iridescence => "iridescence",
            Self::Volume => "absorption",
            Self::Dispersion => "dispersion",
            Self::VertexColors => "corner colours",
            Self::EnvironmentMap => "environment map",
        }
    }
}

impl State {
    /// The state in a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Needed => "needed",
            Self::Pruned => "pruned",
            Self::Absent => "absent",
        }
    }
}

/// The state of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The picture needs it.
    Needed,
    /// The scene asks for it, and a rule proves that it adds nothing.
    Pruned,
    /// The scene does not ask for it.
    Absent,
}

/// The verdict on one effect, of the whole scene or of one light, material or surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The effect.
    pub effect: Effect,
    /// The entity; `None` for the whole scene.
    pub of: Option<Place>,
    /// The state.
    pub state: State,
    /// The rule that left it out.
    pub rule: Option<Rule>,
    /// The reason in plain words: one line, lower case, no full stop.
    pub because: String,
    /// The values that decided.
    pub facts: Vec<Place>,
}
