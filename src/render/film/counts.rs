//! How many rays were traced and how often each effect was evaluated: counted where the ray or the
//! lobe is made.

use crate::plan::Effect;

/// Rays by kind, and evaluations by effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// From the eye.
    pub camera: u64,
    /// To a light.
    pub shadow: u64,
    /// Mirrored, glossy ones too; of traced paths all that stay on their side of a surface.
    pub mirror: u64,
    /// Through a surface.
    pub refracted: u64,
    /// Camera rays that hit something.
    pub hits: u64,
    /// Camera rays of Whitted's integrator whose colour is no number; a display clamps it to 0.
    pub unnumbered: u64,
    /// Evaluations of effects that are no rays.
    evaluations: [u64; Effect::COUNT],
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            camera: 0,
            shadow: 0,
            mirror: 0,
            refracted: 0,
            hits: 0,
            unnumbered: 0,
            evaluations: [0; Effect::COUNT],
        }
    }
}

impl Counts {
    /// The kinds of rays counted.
    const RAYS: usize = 6;

    /// The number of all counts.
    const LENGTH: usize = Self::RAYS + Effect::COUNT;

    /// All rays.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.camera + self.shadow + self.secondary()
    }

    /// Mirrored and refracted rays.
    #[must_use]
    pub fn secondary(&self) -> u64 {
        self.mirror + self.refracted
    }

    /// Counts an evaluation of an effect.
    #[inline]
    pub(in crate::render) fn add(&mut self, effect: Effect) {
        self.evaluations[effect.index()] += 1;
    }

    /// Counts so many evaluations of an effect.
    #[inline]
    pub(in crate::render) fn add_several(&mut self, effect: Effect, count: u32) {
        self.evaluations[effect.index()] += u64::from(count);
    }

    /// How often an effect was simulated: its rays, or its evaluations.
    #[must_use]
    pub fn of(&self, effect: Effect) -> u64 {
        match effect {
            Effect::Surfaces => self.hits,
            Effect::Shadows => self.shadow,
            Effect::Mirror => self.mirror,
            Effect::Refraction => self.refracted,
            Effect::Depth => self.secondary(),
            Effect::DepthBuffer
            | Effect::NormalBuffer
            | Effect::DirectLight
            | Effect::SoftLight
            | Effect::Highlight
            | Effect::GlossyReflection
            | Effect::Textures
            | Effect::NormalInterpolation
            | Effect::NormalMapping
            | Effect::Lens
            | Effect::Supersampling
            | Effect::Environment
            | Effect::Emission
            | Effect::Unlit
            | Effect::Alpha
            | Effect::Mis
            | Effect::Microfacets
            | Effect::Compensation
            | Effect::Layer(_)
            | Effect::Volume
            | Effect::Dispersion
            | Effect::VertexColors
            | Effect::EnvironmentMap => self.evaluations[effect.index()],
        }
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        self.by(&other, |a, b| a + b)
    }

    /// The rays and evaluations since an earlier count.
    #[must_use]
    pub(in crate::render) fn since(self, before: &Self) -> Self {
        self.by(before, |a, b| a - b)
    }

    /// The same counts, each scaled by a fraction of whole numbers.
    #[must_use]
    pub fn scaled(self, numerator: u64, denominator: u64) -> Self {
        self.by(&self, |count, _| {
            let scaled = u128::from(count) * u128::from(numerator) / u128::from(denominator.max(1));
            u64::try_from(scaled).unwrap_or(u64::MAX)
        })
    }

    /// All counts, rays by kind before evaluations.
    pub(super) fn to_array(self) -> [u64; Self::LENGTH] {
        let rays = [
            self.camera,
            self.shadow,
            self.mirror,
            self.refracted,
            self.hits,
            self.unnumbered,
        ];
        std::array::from_fn(|at| match at.checked_sub(Self::RAYS) {
            None => rays[at],
            Some(effect) => self.evaluations[effect],
        })
    }

    /// The counts of [`Self::to_array`].
    pub(super) fn from_array(counts: [u64; Self::LENGTH]) -> Self {
        let [camera, shadow, mirror, refracted, hits, unnumbered, ..] = counts;
        Self {
            camera,
            shadow,
            mirror,
            refracted,
            hits,
            unnumbered,
            evaluations: std::array::from_fn(|effect| counts[Self::RAYS + effect]),
        }
    }

    fn by(&self, other: &Self, both: impl Fn(u64, u64) -> u64) -> Self {
        let each = |effect: usize| both(self.evaluations[effect], other.evaluations[effect]);
        Self {
            camera: both(self.camera, other.camera),
            shadow: both(self.shadow, other.shadow),
            mirror: both(self.mirror, other.mirror),
            refracted: both(self.refracted, other.refracted),
            hits: both(self.hits, other.hits),
            unnumbered: both(self.unnumbered, other.unnumbered),
            evaluations: std::array::from_fn(each),
        }
    }
}
