//! The state of a path between two vertices.

use super::chain::MAX_CHAIN;
use crate::material::standard::StandardMaterial;
use crate::ray::Ray;
use crate::sampler::sobol::{SobolPair, SobolPath};
use crate::world::{MediumId, NO_PRIMITIVE, SurfacePrimitive};
use rtc_math::{Vec3, exp, to_u32};

/// Bounces before Russian roulette may end a path.
const RR_MIN_DEPTH: u32 = 3;

/// The probability that a path survives, over its throughput.
const RR_SURVIVAL: f64 = 2.0;

/// The inside of a body that light is in, or the space outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Body {
    /// The coefficient of absorption, per unit of length.
    pub(super) absorption: Vec3,
    /// 1/n² of its index n over that where the path began. Paths carry basic radiance L/n², which
    /// refraction does not change; this is what light of the radiance 1 counts that a body emits,
    /// or that lies in it.
    pub(super) scale: f64,
}

impl Body {
    const OUTSIDE: Self = Self {
        absorption: Vec3::ZERO,
        scale: 1.0,
    };

    /// What lies beyond the surface of a body, for light that enters or leaves it there. Leaving
    /// takes back exactly what entering did.
    pub(super) fn beyond(
        self,
        material: &StandardMaterial,
        channel: Option<usize>,
        enters: bool,
    ) -> Self {
        let index = material.refractive_index(channel);
        let inside = 1.0 / (index * index);
        if enters {
            Self {
                absorption: material.absorption,
                scale: self.scale * inside,
            }
        } else {
            Self {
                absorption: Vec3::ZERO,
                scale: self.scale / inside,
            }
        }
    }

    /// What light of the radiance 1 counts after a distance in the body; from infinity, it is not
    /// absorbed.
    pub(super) fn carried(&self, distance: Option<f64>) -> Vec3 {
        let passed = match distance.filter(|_| self.absorption != Vec3::ZERO) {
            None => Vec3::ONE,
            Some(distance) => (self.absorption * -distance).map(exp),
        };
        passed * self.scale
    }
}

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
    /// Those of them that do not count: straight through panes, in a scene with media.
    pub(super) free: u32,
    /// The density of the ray's direction in BSDF sampling; `None` if light sampling could not have
    /// found it. Panes do not change it.
    pub(super) pdf: Option<f64>,
    /// The distance from where the direction was sampled to the start of the ray: through panes.
    pub(super) passed: f64,
    /// The body that the ray is in.
    pub(super) body: Body,
    /// The participating medium along the ray.
    pub(super) medium: Option<MediumId>,
    /// The wavelength channel that dispersion picked.
    pub(super) channel: Option<usize>,
    /// The number of smooth surfaces since a vertex whose caustics through such surfaces were
    /// estimated; `None` if there was none, or something else in between.
    pub(super) caustic: Option<u32>,
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
            free: 0,
            pdf: None,
            passed: 0.0,
            body: Body::OUTSIDE,
            medium: None,
            channel: None,
            caustic: None,
            travelled: 0.0,
        }
    }

    /// The number of bounces that count.
    pub(super) fn depth(&self) -> u32 {
        self.bounces - self.free
    }

    /// A pair of numbers of this vertex.
    pub(super) fn pair(&self, of: impl FnOnce(u32) -> SobolPair) -> [f64; 2] {
        self.sobol.pair(of(self.bounces))
    }

    /// Attenuates by the medium along the ray (Beer-Lambert).
    pub(super) fn attenuate(&mut self) {
        self.beta *= (self.body.absorption * -self.travelled).map(exp);
    }

    /// Enters the body that a surface of a material bounds, or leaves it.
    pub(super) fn enter(&mut self, material: &StandardMaterial, enters: bool) {
        self.body = self.body.beyond(material, self.channel, enters);
    }

    /// Whether the path came from a vertex whose caustics were estimated, through a chain of smooth
    /// surfaces that the estimate covers.
    pub(super) fn is_caustic(&self) -> bool {
        (1..=to_u32(MAX_CHAIN)).contains(&self.caustic.unwrap_or(0))
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
