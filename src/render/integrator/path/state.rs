//! A path under way.

use crate::math::Vec3;
use crate::render::ray::Ray;
use crate::render::sampler::sobol::{CORNERS, Sobol};
use crate::render::world::NOWHERE;

/// Bounces before Russian roulette may end a path.
const RR_MIN_DEPTH: u32 = 3;

/// Pairs of numbers that a vertex takes.
const PAIRS: u32 = 4;

/// A path under way.
pub(super) struct PathState {
    pub(super) ray: Ray,
    /// The primitive where the ray starts.
    pub(super) from: (usize, u32),
    /// The throughput: the factor by which what the ray sees counts.
    pub(super) beta: Vec3,
    /// The radiance found so far.
    pub(super) radiance: Vec3,
    pub(super) sobol: Sobol,
    /// How often it has gone on from a surface.
    pub(super) bounces: u32,
    /// The density with which the BSDF took the ray; `None` if no light could have been aimed at
    /// so.
    pub(super) pdf: Option<f64>,
    /// The coefficient of absorption along the ray, per unit of length.
    pub(super) absorption: Vec3,
    /// The one colour that dispersion left.
    pub(super) channel: Option<usize>,
    /// How far the ray has come, surfaces that it went through included.
    pub(super) travelled: f64,
}

impl PathState {
    /// A path that begins with a ray.
    pub(super) fn new(ray: Ray, sobol: Sobol) -> Self {
        Self {
            ray,
            from: NOWHERE,
            beta: Vec3::ONE,
            radiance: Vec3::ZERO,
            sobol,
            bounces: 0,
            pdf: None,
            absorption: Vec3::ZERO,
            channel: None,
            travelled: 0.0,
        }
    }

    /// A pair of numbers of this vertex.
    pub(super) fn pair(&self, pair: u32) -> [f64; 2] {
        self.sobol.pair(CORNERS + PAIRS * self.bounces + pair)
    }

    /// Keeps one colour, which stands for all three.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "one of three"
    )]
    pub(super) fn pick_wavelength(&mut self) {
        let [u, _] = self.pair(3);
        let channel = ((u * 3.0) as usize).min(2);
        let mut kept = [0.0; 3];
        kept[channel] = 3.0;
        self.beta *= Vec3::from_array(kept);
        self.channel = Some(channel);
    }

    /// Russian roulette: ends the path with a probability that grows as its throughput falls; false
    /// if it ends.
    pub(super) fn russian_roulette(&mut self) -> bool {
        let largest = self.beta.max_element();
        if self.bounces < RR_MIN_DEPTH || largest >= 1.0 {
            return largest > 0.0;
        }
        let [_, u] = self.pair(3);
        self.beta /= largest;
        u < largest
    }
}
