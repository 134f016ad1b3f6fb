//! Ray and effect counts. They are incremented where the ray or the lobe is created.

use rtc_plan::Effect;

/// Rays by kind, and evaluations by effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayCounts {
    /// From the eye.
    pub camera: u64,
    /// To a light.
    pub shadow: u64,
    /// Reflected, glossy ones too; of traced paths all that stay on their side of a surface.
    pub mirror: u64,
    /// Through a surface.
    pub refracted: u64,
    /// Camera rays that hit something.
    pub hits: u64,
    /// Camera rays of Whitted's integrator whose colour is no number; a display clamps it to 0.
    pub unnumbered: u64,
    /// What [`RenderSelection::clamp`](super::RenderSelection::clamp) took.
    pub clamped: ClampedLight,
    /// Evaluations of effects that are no rays.
    evaluations: [u64; Effect::COUNT],
}

/// Light that a clamp took. Whole numbers, so that their sums are the same in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClampedLight {
    /// The paths that it took light from.
    pub paths: u64,
    /// The radiance taken, in all channels, in 2⁻⁴⁰.
    taken: u128,
    /// The radiance of all paths before, in the same unit.
    all: u128,
}

impl ClampedLight {
    /// The fraction of the light of all paths that was taken, from 0 to 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.taken as f64 / self.all.max(1) as f64
    }

    /// Counts a path with the sum of its channels' radiance, and the amount clamped.
    pub(crate) fn add(&mut self, radiance: f64, taken: f64) {
        const UNITS: f64 = 1_099_511_627_776.0;
        /// A maximum per path such that 2³² of them do not overflow.
        const MOST: f64 = 7.9e28;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "within bounds, or no number, which is 0"
        )]
        let whole = |light: f64| (light * UNITS).min(MOST).round() as u128;
        self.paths += u64::from(taken > 0.0);
        self.taken += whole(taken);
        self.all += whole(radiance);
    }

    fn plus(self, other: Self) -> Self {
        Self {
            paths: self.paths + other.paths,
            taken: self.taken + other.taken,
            all: self.all + other.all,
        }
    }

    fn since(self, before: Self) -> Self {
        Self {
            paths: self.paths - before.paths,
            taken: self.taken - before.taken,
            all: self.all - before.all,
        }
    }
}

impl Default for RayCounts {
    fn default() -> Self {
        Self {
            camera: 0,
            shadow: 0,
            mirror: 0,
            refracted: 0,
            hits: 0,
            unnumbered: 0,
            clamped: ClampedLight::default(),
            evaluations: [0; Effect::COUNT],
        }
    }
}

impl RayCounts {
    /// The kinds of rays counted.
    const RAYS: usize = 6;

    /// The number of all counts.
    const LENGTH: usize = Self::RAYS + Effect::COUNT;

    /// All rays.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.camera + self.shadow + self.secondary()
    }

    /// Reflected and refracted rays.
    #[must_use]
    pub fn secondary(&self) -> u64 {
        self.mirror + self.refracted
    }

    /// Counts an evaluation of an effect.
    #[inline]
    pub(crate) fn add(&mut self, effect: Effect) {
        self.evaluations[effect.index()] += 1;
    }

    /// Counts evaluations of an effect.
    #[inline]
    pub(crate) fn add_several(&mut self, effect: Effect, count: u32) {
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
            | Effect::Blend
            | Effect::Mis
            | Effect::Caustics
            | Effect::Microfacets
            | Effect::Compensation
            | Effect::Layer(_)
            | Effect::Volume
            | Effect::Media
            | Effect::MotionBlur
            | Effect::Dispersion
            | Effect::VertexColors
            | Effect::EnvironmentMap => self.evaluations[effect.index()],
        }
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            clamped: self.clamped.plus(other.clamped),
            ..self.by(&other, |a, b| a + b)
        }
    }

    /// The rays and evaluations since an earlier count.
    #[must_use]
    pub(crate) fn since(self, before: &Self) -> Self {
        Self {
            clamped: self.clamped.since(before.clamped),
            ..self.by(before, |a, b| a - b)
        }
    }

    /// The same counts, each scaled by a fraction of whole numbers.
    #[must_use]
    pub fn scaled(self, numerator: u64, denominator: u64) -> Self {
        self.by(&self, |count, _| {
            let scaled = u128::from(count) * u128::from(numerator) / u128::from(denominator.max(1));
            u64::try_from(scaled).unwrap_or(u64::MAX)
        })
    }

    /// All counts except the clamped radiance, rays by kind before evaluations.
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

    /// The counts of [`Self::to_array`]: parts of pictures are never clamped.
    pub(super) fn from_array(counts: [u64; Self::LENGTH]) -> Self {
        let [camera, shadow, mirror, refracted, hits, unnumbered, ..] = counts;
        Self {
            camera,
            shadow,
            mirror,
            refracted,
            hits,
            unnumbered,
            clamped: ClampedLight::default(),
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
            clamped: ClampedLight::default(),
            evaluations: std::array::from_fn(each),
        }
    }
}
