//! The environment: its radiance by direction, and importance sampling of bright directions.

use crate::math::{Vec3, acos, atan2, cos, sin};
use crate::render::bsdf::direction_turned;
use crate::render::sampler::discrete::Distribution2D;
use crate::render::texture::sampled::{ColorSpace, sample};
use crate::render::texture::{Filter, Image, Wrap};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The light of the environment, from infinitely far away.
pub(in crate::render) struct Environment {
    radiance: Vec3,
    /// The image, and the distribution of its pixels by radiance and solid angle.
    image: Option<(Arc<Image>, Distribution2D)>,
    image_from_world: [Vec3; 3],
}

/// The radiance of the environment in one direction.
pub(in crate::render) struct EnvironmentRadiance {
    pub(in crate::render) radiance: Vec3,
    /// The density of [`Environment::sample`] per solid angle.
    pub(in crate::render) pdf: f64,
}

impl Environment {
    /// An environment of this radiance, times the image if there is one; the rows of
    /// `image_from_world` rotate directions into the image.
    pub(in crate::render) fn new(
        radiance: Vec3,
        image: Option<Arc<Image>>,
        image_from_world: [Vec3; 3],
    ) -> Self {
        let image = image.map(|image| {
            let table = table(&image);
            (image, table)
        });
        Self {
            radiance,
            image,
            image_from_world,
        }
    }

    /// Whether the radiance is the same in all directions.
    pub(in crate::render) fn is_uniform(&self) -> bool {
        self.image.is_none()
    }

    /// The mean radiance over all directions, in the strongest channel.
    pub(in crate::render) fn mean(&self) -> f64 {
        // Undo the sine of the colatitude in the table's weights: its mean is 2/π.
        let mean = self
            .image
            .as_ref()
            .map_or(1.0, |(_, table)| table.mean() * PI / 2.0);
        self.radiance.max_element() * mean
    }

    /// The radiance and the density in a direction, a unit vector.
    pub(in crate::render) fn seen(&self, direction: Vec3) -> EnvironmentRadiance {
        let Some((image, table)) = &self.image else {
            return self.uniform();
        };
        let place = self.place(direction);
        self.seen_at(image, table, place, sin(place[1] * PI))
    }

    /// Samples a direction, and returns its radiance and density.
    pub(in crate::render) fn sample(&self, u: [f64; 2]) -> (Vec3, EnvironmentRadiance) {
        let Some((image, table)) = &self.image else {
            return (direction_turned(1.0 - 2.0 * u[0], u[1]), self.uniform());
        };
        // Sample a point of the image.
        let place = table.sample(u);
        let (longitude, colatitude) = ((place[0] - 0.5) * TAU, place[1] * PI);
        let sine = sin(colatitude);
        // Convert from longitude and colatitude to a direction.
        let local = Vec3::new(
            sine * sin(longitude),
            cos(colatitude),
            -sine * cos(longitude),
        );
        // Rotate from the image to the world.
        let [x, y, z] = self.image_from_world;
        let direction = (x * local.x + y * local.y + z * local.z).normalize();
        (direction, self.seen_at(image, table, place, sine))
    }

    fn uniform(&self) -> EnvironmentRadiance {
        EnvironmentRadiance {
            radiance: self.radiance,
            pdf: 0.5 / TAU,
        }
    }

    /// The radiance and the density at a point of the image, given the sine of its colatitude.
    fn seen_at(
        &self,
        image: &Image,
        table: &Distribution2D,
        place: [f64; 2],
        sine: f64,
    ) -> EnvironmentRadiance {
        let [r, g, b, _] = sample(
            image,
            place,
            [Wrap::Repeat, Wrap::Clamp],
            Filter::Linear,
            ColorSpace::Srgb,
        );
        // Convert the density from the unit square to solid angle.
        let pdf = if sine > 0.0 {
            table.pdf(place) / (TAU * PI * sine)
        } else {
            0.0
        };
        EnvironmentRadiance {
            radiance: self.radiance * Vec3::new(r, g, b),
            pdf,
        }
    }

    /// Maps a direction to the image: −z to its middle, +y to its top, longitude grows towards +x.
    fn place(&self, direction: Vec3) -> [f64; 2] {
        let [x, y, z] = &self.image_from_world;
        let (x, y, z) = (x.dot(direction), y.dot(direction), z.dot(direction));
        [0.5 + atan2(x, -z) / TAU, acos(y.clamp(-1.0, 1.0)) / PI]
    }
}

/// The distribution of pixels by their strongest channel and their solid angle.
fn table(image: &Image) -> Distribution2D {
    let [width, height] = [image.width, image.height];
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
        r.max(g).max(b) * sin(v * PI)
    };
    Distribution2D::new([width, height], weight)
}
