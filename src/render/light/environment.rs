//! The environment: its radiance by direction, and importance sampling of bright directions.

use crate::math::{Vec3, acos, atan2, sin, sin_cos};
use crate::render::bsdf::direction_turned;
use crate::render::sampler::discrete::Distribution2D;
use crate::render::texture::sampled::{ColorSpace, sample};
use crate::render::texture::{Filter, Image, Wrap};
use std::cell::Cell;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The light of the environment, from infinitely far away.
pub(in crate::render) struct Environment {
    radiance: Vec3,
    map: Option<EnvironmentMap>,
}

/// An image of all directions.
struct EnvironmentMap {
    image: Arc<Image>,
    /// The value of all pixels, where they are proven to be equal.
    constant: Option<Vec3>,
    /// The distribution of the pixels by radiance and solid angle.
    table: Distribution2D,
    /// The strongest channel of all pixels.
    peak: f64,
    image_from_world: [Vec3; 3],
}

/// The radiance of the environment in one direction.
pub(in crate::render) struct EnvironmentRadiance {
    pub(in crate::render) radiance: Vec3,
    /// The density of [`Environment::sample`] per solid angle.
    pub(in crate::render) pdf: f64,
}

/// The density of directions that are uniform over the sphere.
const UNIFORM: f64 = 0.5 / TAU;

impl Environment {
    /// An environment of this radiance, times the image if there is one; the rows of
    /// `image_from_world` rotate directions into the image. `is_constant` says that all pixels are
    /// equal.
    pub(in crate::render) fn new(
        radiance: Vec3,
        image: Option<Arc<Image>>,
        image_from_world: [Vec3; 3],
        is_constant: bool,
    ) -> Self {
        let map = image.map(|image| {
            let (table, peak) = table(&image);
            EnvironmentMap {
                constant: is_constant.then(|| look_up(&image, [0.5; 2])),
                table,
                peak,
                image,
                image_from_world,
            }
        });
        Self { radiance, map }
    }

    /// Whether the radiance is the same in all directions.
    pub(in crate::render) fn is_uniform(&self) -> bool {
        self.map.is_none()
    }

    /// Whether an image is looked up for each direction.
    pub(in crate::render) fn is_looked_up(&self) -> bool {
        let map = self.map.as_ref();
        map.is_some_and(|map| map.constant.is_none())
    }

    /// The mean radiance over all directions, in the strongest channel.
    pub(in crate::render) fn mean(&self) -> f64 {
        // Undo the sine of the colatitude in the table's weights: its mean is 2/π.
        let mean = self
            .map
            .as_ref()
            .map_or(1.0, |map| map.table.mean() * PI / 2.0);
        self.radiance.max_element() * mean
    }

    /// A radiance that no direction exceeds, in the strongest channel.
    pub(in crate::render) fn brightest(&self) -> f64 {
        self.radiance.max_element() * self.map.as_ref().map_or(1.0, |map| map.peak)
    }

    /// The radiance from a direction, a unit vector, and its point of the image if that was found.
    pub(in crate::render) fn seen(&self, direction: Vec3) -> (Vec3, Option<[f64; 2]>) {
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
    pub(in crate::render) fn pdf(&self, direction: Vec3, place: Option<[f64; 2]>) -> f64 {
        self.map.as_ref().map_or(UNIFORM, |map| {
            let place = place.unwrap_or_else(|| map.place(direction));
            map.pdf(place, sin(place[1] * PI))
        })
    }

    /// Samples a direction, and returns its radiance and density.
    pub(in crate::render) fn sample(&self, u: [f64; 2]) -> (Vec3, EnvironmentRadiance) {
        let Some(map) = &self.map else {
            let (radiance, pdf) = (self.radiance, UNIFORM);
            let direction = direction_turned(1.0 - 2.0 * u[0], u[1]);
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

/// The value of an image at a point.
fn look_up(image: &Image, place: [f64; 2]) -> Vec3 {
    let [r, g, b, _] = sample(
        image,
        place,
        [Wrap::Repeat, Wrap::Clamp],
        Filter::Linear,
        ColorSpace::Srgb,
    );
    Vec3::new(r, g, b)
}

/// The distribution of pixels by their strongest channel and their solid angle, and the strongest of
/// all.
fn table(image: &Image) -> (Distribution2D, f64) {
    let [width, height] = [image.width, image.height];
    let peak = Cell::new(0.0_f64);
    let weight = |x: u32, y: u32| {
        let v = (f64::from(y) + 0.5) / f64::from(height);
        let uv = [(f64::from(x) + 0.5) / f64::from(width), v];
        let [r, g, b, _] = sample(
            image,
            uv,
            [Wrap::Repeat, Wrap::Clamp],
            Filter::Nearest,
            ColorSpace::Srgb,
        );
        let value = r.max(g).max(b);
        peak.set(peak.get().max(value));
        value * sin(v * PI)
    };
    let table = Distribution2D::new([width, height], weight);
    (table, peak.get())
}
