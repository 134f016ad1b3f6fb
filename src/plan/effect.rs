//! The effects of a picture, and the status of each.

use super::layer::Layer;
use super::rules::Rule;
use rtc_ir::ValuePath;

/// The effects with their names; layers take their names from the table of layers.
macro_rules! effects {
    ($($effect:ident $name:literal,)*) => {
        /// A part of light transport or of the camera model that a scene may not need.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "each is named as in the books")]
        pub enum Effect {
            $($effect,)*
            Layer(Layer),
        }

        /// The index of each effect; the layers follow after the others.
        enum EffectIndex {
            $($effect,)*
            Layers,
        }

        impl Effect {
            /// The number of effects.
            pub const COUNT: usize = EffectIndex::Layers as usize + Layer::ALL.len();

            /// The index of the effect.
            #[must_use]
            #[inline]
            pub const fn index(self) -> usize {
                match self {
                    $(Self::$effect => EffectIndex::$effect as usize,)*
                    Self::Layer(layer) => EffectIndex::Layers as usize + layer as usize,
                }
            }

            /// The name.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$effect => $name,)*
                    Self::Layer(layer) => layer.name(),
                }
            }
        }
    };
}

effects! {
    DepthBuffer "depth buffer",
    NormalBuffer "normal buffer",
    Surfaces "surfaces",
    DirectLight "direct light",
    Shadows "shadows",
    SoftLight "soft light",
    Highlight "highlight",
    Mirror "mirror",
    GlossyReflection "glossy mirror",
    Refraction "refraction",
    Depth "bounces",
    Textures "textures",
    NormalInterpolation "corner normals",
    NormalMapping "normal maps",
    Lens "lens",
    Supersampling "supersampling",
    Environment "environment",
    Emission "emission",
    Unlit "unlit surfaces",
    Alpha "alpha",
    Blend "blends",
    Mis "light weights",
    Caustics "caustics",
    Microfacets "microfacets",
    Compensation "compensation",
    Volume "absorption",
    Dispersion "dispersion",
    VertexColors "corner colours",
    EnvironmentMap "environment map",
    Media "media",
    MotionBlur "motion blur",
}

impl Effect {
    /// The effects that only the Whitted integrator has.
    pub const OF_WHITTED: [Self; 6] = [
        Self::DepthBuffer,
        Self::NormalBuffer,
        Self::SoftLight,
        Self::Highlight,
        Self::Mirror,
        Self::GlossyReflection,
    ];
}

/// The effects of path tracing before the layers of the glTF material, and after them.
const OF_PATHS: ([Effect; 14], [Effect; 10]) = (
    [
        Effect::Surfaces,
        Effect::Environment,
        Effect::EnvironmentMap,
        Effect::Emission,
        Effect::Unlit,
        Effect::Alpha,
        Effect::Blend,
        Effect::DirectLight,
        Effect::Shadows,
        Effect::Mis,
        Effect::Caustics,
        Effect::Depth,
        Effect::Microfacets,
        Effect::Compensation,
    ],
    [
        Effect::Refraction,
        Effect::Volume,
        Effect::Media,
        Effect::Dispersion,
        Effect::Textures,
        Effect::VertexColors,
        Effect::NormalInterpolation,
        Effect::NormalMapping,
        Effect::Lens,
        Effect::Supersampling,
    ],
);

impl Effect {
    /// The effects that path tracing may have.
    pub const OF_PATHS: [Self; 24 + Layer::ALL.len()] = {
        let ((before, after), layers) = (OF_PATHS, Layer::ALL);
        let mut all = [Self::Surfaces; 24 + Layer::ALL.len()];
        let mut at = 0;
        while at < all.len() {
            all[at] = if at < before.len() {
                before[at]
            } else if at < before.len() + layers.len() {
                Self::Layer(layers[at - before.len()])
            } else {
                after[at - before.len() - layers.len()]
            };
            at += 1;
        }
        all
    };
}

impl EffectState {
    /// The name of the state.
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
pub enum EffectState {
    /// The picture needs it.
    Needed,
    /// The scene requires it, but a rule proves that its contribution is zero.
    Pruned,
    /// The scene does not require it.
    Absent,
}

/// The status of one effect, for the whole scene or for one light, material or surface.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectStatus {
    /// The effect.
    pub effect: Effect,
    /// The entity; `None` for the whole scene.
    pub of: Option<ValuePath>,
    /// The state.
    pub state: EffectState,
    /// The rule that removed it.
    pub rule: Option<Rule>,
    /// The reason: one line, lower case, no full stop.
    pub reason: String,
    /// The scene values that decide it.
    pub facts: Vec<ValuePath>,
}
