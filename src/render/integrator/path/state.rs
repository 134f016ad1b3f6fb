//! The state of a path between two vertices.

use crate::ray::Ray;
use crate::sampler::sobol::{SobolPair, SobolPath};
use crate::world::{NO_PRIMITIVE, SurfacePrimitive};
use rtc_math::Vec3;

/// Bounces before Russian roulette may end a path.
const RR_MIN_DEPTH: u32 = 3;

/// The probability that a path survives, over its throughput.
const RR_SURVIVAL: f64 = 2.0;

/// The state of a path.
pub(super) struct PathState {
    pub(super) ray: Ray,
    /// The primitive where the ray starts.
    pub(super) from: SurfacePrimitive,
    /// The throughput `beta`: the factor on the radiance along the ray.
    pub(super) beta: Vec3,
    /// The radiance found so far.
    pub(super) radiance: Vec3,
    /// The part of it from the first vertex, after a bounce.
    pub(super) radiance_of_first: Vec3,
    pub(super) sobol: SobolPath,
    /// The number of bounces so far.
    pub(super) bounces: u32,
    /// The density of the ray's direction in BSDF sampling; `None` if light sampling could not have
    /// found it.
    pub(super) pdf: Option<f64>,
    /// The coefficient of absorption along the ray, per unit of length.
    pub(super) absorption: Vec3,
    /// The wavelength channel that dispersion picked.
    pub(super) channel: Option<usize>,
    /// The distance that the ray has travelled, through skipped surfaces too.
    pub(super) travelled: f64,
}

impl PathState {
    /// A path that begins with a ray.
    pub(super) fn new(ray: Ray, sobol: SobolPath) -> Self {
        Self {
            ray,
            from: NO_PRIMITIVE,
            beta: Vec3::ONE,
            radiance: Vec3::ZERO,
            radiance_of_first: Vec3::ZERO,
            sobol,
            bounces: 0,
            pdf: None,
            absorption: Vec3::ZERO,
            channel: None,
            travelled: 0.0,
        }
    }

    /// A pair of numbers of this vertex.
    pub(super) fn pair(&self, of: impl FnOnce(u32) -> SobolPair) -> [f64; 2] {
        self.sobol.pair(of(self.bounces))
    }

    /// Picks one colour channel, weighted by 3.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "one of three"
    )]
    pub(super) fn pick_wavelength(&mut self) {
        let [u, _] = self.pair(SobolPair::russian_roulette);
        let channel = ((u * 3.0) as usize).min(2);
        let mut kept = [0.0; 3];
        kept[channel] = 3.0;
        self.beta *= Vec3::from_array(kept);
        self.channel = Some(channel);
    }

    /// Russian roulette: ends paths of low throughput at random; false if the path ends. One that
    /// continues has a throughput of at least `1/RR_SURVIVAL`.
    pub(super) fn russian_roulette(&mut self) -> bool {
        let largest = self.beta.max_element();
        let survival = largest * RR_SURVIVAL;
        if self.bounces < RR_MIN_DEPTH || survival >= 1.0 {
            return largest > 0.0;
        }
        let [_, u] = self.pair(SobolPair::russian_roulette);
        self.beta /= survival;
        u < survival
    }
}
