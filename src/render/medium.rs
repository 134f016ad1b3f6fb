//! Homogeneous participating media: transmittance, free-flight sampling and the phase function of
//! Henyey and Greenstein.

use crate::bsdf::warp::direction_at_angle;
use rtc_math::{Medium, OrthonormalBasis, Vec3, exp, ln};
use std::f64::consts::PI;

/// A prepared medium; lengths are in scene units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HomogeneousMedium {
    /// The extinction coefficient σ_t = σ_a + σ_s.
    sigma_t: Vec3,
    /// The scattering coefficient σ_s.
    sigma_s: Vec3,
    /// The mean cosine of the scattering angle.
    g: f64,
}

impl From<Medium> for HomogeneousMedium {
    fn from(medium: Medium) -> Self {
        let [sigma_a, sigma_s] = [medium.sigma_a, medium.sigma_s].map(Vec3::from_array);
        Self {
            sigma_t: sigma_a + sigma_s,
            sigma_s,
            g: medium.g,
        }
    }
}

impl HomogeneousMedium {
    /// The part of the light that a distance leaves, which may be infinite (Beer-Lambert).
    pub(crate) fn transmittance(&self, distance: f64) -> Vec3 {
        // 0·∞ is the 0 of a channel without extinction.
        let depth = |sigma: f64| if sigma > 0.0 { sigma * distance } else { 0.0 };
        self.sigma_t.map(|sigma| exp(-depth(sigma)))
    }

    /// The phase function, for the cosine of the angle between the directions to the viewer and to
    /// the light: a density of directions ("Diffuse radiation in the galaxy", Astrophysical Journal
    /// 93, 1941).
    pub(crate) fn phase(&self, cosine: f64) -> f64 {
        let g = self.g;
        let square = 1.0 + g * g + 2.0 * g * cosine;
        // By rounding the square may be below its minimum.
        let square = square.max((1.0 - g.abs()) * (1.0 - g.abs()));
        (1.0 - g * g) / (4.0 * PI * square * square.sqrt())
    }

    /// Samples a direction to the light for one to the viewer; with its density, which is the value
    /// of the phase function ("Physically Based Rendering", 4th ed., §11.3.1).
    pub(crate) fn sample_phase(&self, wo: Vec3, [u, v]: [f64; 2]) -> (Vec3, f64) {
        /// Below it, light is scattered equally within rounding.
        const ISOTROPIC: f64 = 1e-3;
        let g = self.g;
        let cosine = if g.abs() < ISOTROPIC {
            1.0 - 2.0 * u
        } else {
            let ratio = (1.0 - g * g) / (1.0 + g - 2.0 * g * u);
            -(1.0 + g * g - ratio * ratio) / (2.0 * g)
        };
        let cosine = cosine.clamp(-1.0, 1.0);
        let wi = OrthonormalBasis::around(wo).to_world(direction_at_angle(cosine, v));
        (wi.normalize(), self.phase(cosine))
    }
}

/// The free flight of a ray, through one medium after another: where it is scattered, and with
/// which weight.
///
/// The distance is sampled by the extinction of one of the three channels, which is chosen at
/// random; the balance heuristic over the channels weights it ("Physically Based Rendering", 3rd
/// ed., §15.2). There the channels have equal probabilities; here they have those of the throughput
/// of the path, so that a medium that absorbs nothing keeps the sum of its channels. Media that
/// only absorb are not sampled.
pub(crate) struct FreeFlight {
    /// The probability of each channel.
    shares: Vec3,
    /// The channel of the sampled extinction.
    channel: usize,
    /// The optical depth in that channel until the ray is scattered.
    left: f64,
    /// The transmittance of the sampled media so far.
    transmittance: Vec3,
    /// The transmittance of the media that only absorb.
    absorption: Vec3,
}

impl FreeFlight {
    /// A flight of a path with a throughput, by two random numbers.
    pub(crate) fn new(beta: Vec3, [u, v]: [f64; 2]) -> Self {
        let sum = beta.element_sum();
        let shares = match sum.is_normal() {
            true => beta / sum,
            false => Vec3::splat(1.0 / 3.0),
        };
        let channel = match u {
            _ if u < shares.x => 0,
            _ if u < shares.x + shares.y || shares.z == 0.0 => 1,
            _ => 2,
        };
        Self {
            shares,
            channel,
            left: -ln(1.0 - v),
            transmittance: Vec3::ONE,
            absorption: Vec3::ONE,
        }
    }

    /// Flies a distance through a medium, or to where the ray is scattered: the distance to there.
    pub(crate) fn pass(&mut self, medium: &HomogeneousMedium, distance: f64) -> Option<f64> {
        if medium.sigma_s == Vec3::ZERO {
            self.absorption *= medium.transmittance(distance);
            return None;
        }
        let sigma = medium.sigma_t[self.channel];
        let reach = self.left / sigma;
        if reach < distance {
            self.transmittance *= medium.transmittance(reach);
            return Some(reach);
        }
        self.transmittance *= medium.transmittance(distance);
        if sigma > 0.0 {
            self.left = (self.left - sigma * distance).max(0.0);
        }
        None
    }

    /// The weight of a ray that was not scattered.
    pub(crate) fn weight(&self) -> Vec3 {
        // Without a sampled medium the weight is 1, whatever the rounding of the shares.
        match self.transmittance == Vec3::ONE {
            true => self.absorption,
            false => self.weighted(self.transmittance, self.transmittance),
        }
    }

    /// The weight of a ray that a medium scattered.
    pub(crate) fn weight_of_scattering(&self, medium: &HomogeneousMedium) -> Vec3 {
        let [scattered, density] =
            [medium.sigma_s, medium.sigma_t].map(|sigma| self.transmittance * sigma);
        self.weighted(scattered, density)
    }

    /// A value over the mean of the densities of the channels.
    fn weighted(&self, value: Vec3, densities: Vec3) -> Vec3 {
        let density = densities.dot(self.shares);
        if density > 0.0 {
            value / density * self.absorption
        } else {
            Vec3::ZERO
        }
    }
}
