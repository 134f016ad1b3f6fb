//! What surrounds the scene: its radiance by direction, and directions sampled as they are bright.

use super::table::Table;
use super::texture::{Content, sample};
use crate::math::{Vec3, acos, atan2, cos, sin};
use crate::render::bsdf::direction_turned;
use crate::valid::{Filter, Image, ValidScene, Wrap};
use std::f64::consts::{PI, TAU};

/// The surroundings.
pub(super) struct Environment<'world> {
    radiance: Vec3,
    image: Option<&'world Image>,
    image_from_world: [Vec3; 3],
    /// Pixels of the image by what they send to the scene.
    table: Option<Table>,
}

impl<'world> Environment<'world> {
    /// Those of a scene; darkness if it has none.
    pub(super) fn new(scene: &'world ValidScene) -> Self {
        let Some(environment) = scene.environment() else {
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            return Self { radiance: Vec3::ZERO, image: None, image_from_world: axes, table: None };
        };
        let image = environment.image.map(|image| &scene.images()[image]);
        Self {
            radiance: environment.radiance,
            image,
            image_from_world: environment.image_from_world,
            table: image.map(table),
        }
    }

    /// Whether all directions are the same.
    pub(super) fn is_uniform(&self) -> bool {
        self.image.is_none()
    }

    /// The mean of the radiance over all directions, by the strongest channel.
    pub(super) fn mean(&self) -> f64 {
        let mean = self.table.as_ref().map_or(1.0, Table::mean);
        // The table weighs rows by the sine of the colatitude, whose mean is 2/π.
        self.radiance.max_element() * mean * if self.table.is_some() { PI / 2.0 } else { 1.0 }
    }

    /// The radiance from a direction, a unit vector.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let Some(image) = self.image else { return self.radiance };
        let uv = self.place(direction);
        let [r, g, b, _] = sample(image, uv, [Wrap::Repeat, Wrap::Clamp], Filter::Linear, Content::Color);
        self.radiance * Vec3::new(r, g, b)
    }

    /// The density of [`Environment::sample`] per solid angle.
    pub(super) fn pdf(&self, direction: Vec3) -> f64 {
        let Some(table) = &self.table else { return 0.5 / TAU };
        let uv = self.place(direction);
        let sine = sin(uv[1] * PI);
        if sine > 0.0 { table.pdf(uv) / (TAU * PI * sine) } else { 0.0 }
    }

    /// A direction.
    pub(super) fn sample(&self, u: [f64; 2]) -> Vec3 {
        let Some(table) = &self.table else { return direction_turned(1.0 - 2.0 * u[0], u[1]) };
        let [u, v] = table.sample(u);
        let (longitude, colatitude) = ((u - 0.5) * TAU, v * PI);
        let sine = sin(colatitude);
        let local = Vec3::new(sine * sin(longitude), cos(colatitude), -sine * cos(longitude));
        let [x, y, z] = self.image_from_world;
        (x * local.x + y * local.y + z * local.z).normalize()
    }

    /// The place in the image of a direction: its middle towards −z, +y up, longitude growing towards +x.
    fn place(&self, direction: Vec3) -> [f64; 2] {
        let [x, y, z] = &self.image_from_world;
        let (x, y, z) = (x.dot(direction), y.dot(direction), z.dot(direction));
        [0.5 + atan2(x, -z) / TAU, acos(y.clamp(-1.0, 1.0)) / PI]
    }
}

/// Pixels by their strongest channel, and by the solid angle they span.
fn table(image: &Image) -> Table {
    let [width, height] = [image.width, image.height];
    let weight = |x: u32, y: u32| {
        let v = (f64::from(y) + 0.5) / f64::from(height);
        let uv = [(f64::from(x) + 0.5) / f64::from(width), v];
        let [r, g, b, _] = sample(image, uv, [Wrap::Repeat, Wrap::Clamp], Filter::Nearest, Content::Color);
        r.max(g).max(b) * sin(v * PI)
    };
    Table::new([width, height], weight)
}
