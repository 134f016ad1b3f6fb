//! The environment: its radiance by direction, and importance sampling of bright directions.

use crate::bsdf::direction_at_angle;
use crate::sampler::discrete::BilinearDistribution;
use crate::texture::sampled::{ColorSpace, sample};
use crate::texture::{Filter, Image, Wrap};
use rtc_math::{Vec3, acos, atan2, sin, sin_cos};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The light of the environment, from infinitely far away.
#[derive(Clone)]
pub(crate) struct Environment {
    radiance: Vec3,
    map: Option<Arc<EnvironmentMap>>,
}

/// An image of all directions.
struct EnvironmentMap {
    image: Arc<Image>,
    /// The value of all pixels, where they are validated to be equal.
    constant: Option<Vec3>,
    /// The distribution of sampled positions.
    table: BilinearDistribution,
    /// The mean of the strongest channel over all directions.
    mean: f64,
    /// The strongest channel of all pixels.
    peak: f64,
    image_from_world: [Vec3; 3],
}

/// The radiance of the environment in one direction.
pub(crate) struct EnvironmentRadiance {
    pub(crate) radiance: Vec3,
    /// The density of [`Environment::sample`] per solid angle.
    pub(crate) pdf: f64,
}

/// The density of directions that are uniform over the sphere.
const UNIFORM: f64 = 0.5 / TAU;

/// The least fraction of its radiance that a direction is sampled by.
const LEAST: f64 = 1.0 / 64.0;

impl Environment {
    /// An environment of this radiance, times the image if there is one; the rows of
    /// `image_from_world` rotate directions into the image. `is_constant` says that all pixels are
    /// equal.
    pub(crate) fn new(
        radiance: Vec3,
        image: Option<Arc<Image>>,
        image_from_world: [Vec3; 3],
        is_constant: bool,
    ) -> Self {
        let map = image.map(|image| EnvironmentMap::new(image, image_from_world, is_constant));
        let map = map.map(Arc::new);
        Self { radiance, map }
    }

    /// Whether the radiance is the same in all directions.
    pub(crate) fn is_uniform(&self) -> bool {
        self.map.is_none()
    }

    /// Whether an image is looked up for each direction.
    pub(crate) fn is_looked_up(&self) -> bool {
        let map = self.map.as_ref();
        map.is_some_and(|map| map.constant.is_none())
    }

    /// The mean radiance over all directions, in the strongest channel.
    pub(crate) fn mean(&self) -> f64 {
        let mean = self.map.as_ref().map_or(1.0, |map| map.mean);
        self.radiance.max_element() * mean
    }

    /// A radiance that no direction exceeds, in the strongest channel.
    pub(crate) fn brightest(&self) -> f64 {
        self.radiance.max_element() * self.map.as_ref().map_or(1.0, |map| map.peak)
    }

    /// The radiance from a direction, a unit vector, and its point of the image if that was found.
    pub(crate) fn seen(&self, direction: Vec3) -> (Vec3, Option<[f64; 2]>) {
        match &self.map {
            None => (self.radiance, None),
            Some(map) => match map.constant {
                Some(value) => (self.radiance * value, None),
                None => {
                    let place = map.place(direction);
                    (self.radiance * look_up(&map.image, place), Some(place))
                }
            },
        }
    }

    /// The density of [`Self::sample`] per solid angle in a direction, whose point of the image may
    /// be known.
    pub(crate) fn pdf(&self, direction: Vec3, place: Option<[f64; 2]>) -> f64 {
        self.map.as_ref().map_or(UNIFORM, |map| {
            let place = place.unwrap_or_else(|| map.place(direction));
            map.pdf(place, sin(place[1] * PI))
        })
    }

    /// Samples a direction, and returns its radiance and density.
    pub(crate) fn sample(&self, u: [f64; 2]) -> (Vec3, EnvironmentRadiance) {
        let Some(map) = &self.map else {
            let (radiance, pdf) = (self.radiance, UNIFORM);
            let direction = direction_at_angle(1.0 - 2.0 * u[0], u[1]);
            return (direction, EnvironmentRadiance { radiance, pdf });
        };
        // Sample a point of the image.
        let place = map.table.sample(u);
        let (longitude, colatitude) = ((place[0] - 0.5) * TAU, place[1] * PI);
        let ((sine, cosine), (across, along)) = (sin_cos(colatitude), sin_cos(longitude));
        // Convert from longitude and colatitude to a direction.
        let local = Vec3::new(sine * across, cosine, -sine * along);
        // Rotate from the image to the world.
        let [x, y, z] = map.image_from_world;
        let direction = (x * local.x + y * local.y + z * local.z).normalize();
        let value = map.constant.unwrap_or_else(|| look_up(&map.image, place));
        let (radiance, pdf) = (self.radiance * value, map.pdf(place, sine));
        (direction, EnvironmentRadiance { radiance, pdf })
    }
}

impl EnvironmentMap {
    /// Directions are sampled by the strongest channel, less its mean: BSDF sampling finds uniform
    /// light (Karlík, Šik, Vévoda, Skřivan, Křivánek, "MIS compensation", 2019, §4.1). A fraction
    /// of the mean is kept, so that no direction with light has a density of 0.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a density may be less precise than what it samples"
    )]
    fn new(image: Arc<Image>, image_from_world: [Vec3; 3], is_constant: bool) -> Self {
        let width = image.width as usize;
        let row = |y: u32| (f64::from(y) + 0.5) / f64::from(image.height);
        let sines: Vec<_> = (0..image.height).map(|y| sin(row(y) * PI)).collect();
        let mut weights = Vec::with_capacity(width * sines.len());
        let (mut sum, mut peak) = (0.0, 0.0_f64);
        for (y, sine) in (0..image.height).zip(&sines) {
            for x in 0..image.width {
                let u = (f64::from(x) + 0.5) / f64::from(image.width);
                let value = value(&image, [u, row(y)], Filter::Nearest).max_element();
                sum += value * sine;
                peak = peak.max(value);
                weights.push(value as f32);
            }
        }
        let mean = sum / (sines.iter().sum::<f64>() * f64::from(image.width));
        for (row, sine) in weights.chunks_mut(width).zip(&sines) {
            for weight in row {
                let value = f64::from(*weight);
                *weight = ((value - mean).max(value * LEAST) * sine) as f32;
            }
        }
        Self {
            constant: is_constant.then(|| look_up(&image, [0.5; 2])),
            table: BilinearDistribution::new(width, weights),
            mean,
            peak,
            image,
            image_from_world,
        }
    }

    /// Maps a direction to the image: −z to its middle, +y to its top, longitude grows towards +x.
    fn place(&self, direction: Vec3) -> [f64; 2] {
        let [x, y, z] = &self.image_from_world;
        let (x, y, z) = (x.dot(direction), y.dot(direction), z.dot(direction));
        [0.5 + atan2(x, -z) / TAU, acos(y.clamp(-1.0, 1.0)) / PI]
    }

    /// The density per solid angle at a point of the image, given the sine of its colatitude.
    fn pdf(&self, place: [f64; 2], sine: f64) -> f64 {
        // Convert the density from the unit square to solid angle.
        if sine > 0.0 {
            self.table.pdf(place) / (TAU * PI * sine)
        } else {
            0.0
        }
    }
}

/// The value of an image at a point, filtered linearly.
fn look_up(image: &Image, place: [f64; 2]) -> Vec3 {
    value(image, place, Filter::Linear)
}

fn value(image: &Image, place: [f64; 2], filter: Filter) -> Vec3 {
    let wrap = [Wrap::Repeat, Wrap::Clamp];
    let [r, g, b, _] = sample(image, place, wrap, filter, ColorSpace::Srgb);
    Vec3::new(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_image::Texels;

    /// Radiance over density of a grid of samples of a sky of 1 with one texel, in units of 4π.
    fn estimates(texel: f32) -> (f64, Vec<f64>) {
        let mut pixels = vec![1.0_f32; 32 * 16 * 3];
        pixels[3 * (5 * 32 + 20)..][..3].fill(texel);
        let bytes: Vec<u8> = pixels.iter().flat_map(|x| x.to_le_bytes()).collect();
        let image = Image {
            width: 32,
            height: 16,
            texels: Texels::Rgb32f(bytes.into()),
        };
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let sky = Environment::new(Vec3::ONE, Some(Arc::new(image)), axes, false);
        let number = |k: u32| (f64::from(k) + 0.5) / 256.0;
        let pairs = (0..256).flat_map(|x| (0..256).map(move |y| [number(x), number(y)]));
        let estimate = |u| {
            let (_, found) = sky.sample(u);
            found.radiance.x / (found.pdf * 2.0 * TAU)
        };
        (sky.mean(), pairs.map(estimate).collect())
    }

    #[test]
    fn no_sample_beside_the_sun_is_worth_much_more_than_the_mean() {
        let (mean, estimates) = estimates(1e5);
        let found = estimates.iter().sum::<f64>() / estimates.len() as f64;
        assert!((found / mean - 1.0).abs() < 0.02, "{found} {mean}");
        let most = estimates.iter().copied().fold(0.0, f64::max);
        assert!(most < 1.1 / LEAST * mean, "{most} {mean}");
    }

    #[test]
    fn an_even_sky_is_sampled_evenly() {
        let (mean, estimates) = estimates(1.0);
        assert!((mean - 1.0).abs() < 1e-12);
        assert!(estimates.iter().all(|one| (one - 1.0).abs() < 0.02));
    }
}
