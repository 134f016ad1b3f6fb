//! The studio: light for scenes without light. An environment map of softboxes in a room.
//!
//! In each set a surface of reflectance 0.8 is never overexposed: the radiance of a white diffuse
//! surface is at most 1.25, whichever way it faces.

use rtc_ir::{Environment, Image, Pixels, Scene};
use rtc_math::{Vec3, acos, atan2, cos, pow, sin};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The size of the environment map: a pixel spans less than 6°, about half of the soft edge of a
/// softbox.
const SIZE: [u32; 2] = [64, 32];
/// The width of the soft edge of a softbox, in degrees.
const EDGE: f64 = 10.0;
/// The brightness of the studio as a fill light.
const FILL: f64 = 0.5;

/// A set of the studio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StudioSet {
    /// A near-white backdrop under a dark ceiling, for dark subjects.
    Light,
    /// A dim room, which any subject but a black one stands out from.
    #[default]
    Dark,
    /// A near-white room, with a weak key light.
    Soft,
}

/// A room: its radiance above and below, the elevation between them and the width of the
/// transition, in degrees, and its softboxes.
struct StudioRoom {
    radiance: [f64; 2],
    transition: [f64; 2],
    boxes: [SoftBox; 3],
}

/// A softbox: the azimuth (from +z towards +x) and elevation of its centre, half its width and
/// height, in degrees, and its radiance.
struct SoftBox {
    middle: [f64; 2],
    half: [f64; 2],
    radiance: f64,
}

/// The softboxes of a room: the key light from the left and above, a fill light from the right, and
/// a rim light from behind.
const fn boxes([key, fill, rim]: [f64; 3]) -> [SoftBox; 3] {
    [
        SoftBox {
            middle: [-35.0, 45.0],
            half: [30.0, 20.0],
            radiance: key,
        },
        SoftBox {
            middle: [70.0, 20.0],
            half: [20.0, 30.0],
            radiance: fill,
        },
        SoftBox {
            middle: [170.0, 50.0],
            half: [35.0, 15.0],
            radiance: rim,
        },
    ]
}

const LIGHT: StudioRoom = StudioRoom {
    radiance: [0.06, 0.72],
    transition: [12.0, 30.0],
    boxes: boxes([4.5, 0.5, 3.5]),
};
const DARK: StudioRoom = StudioRoom {
    radiance: [0.3, 0.14],
    transition: [20.0, 30.0],
    boxes: boxes([5.0, 1.5, 3.0]),
};
const SOFT: StudioRoom = StudioRoom {
    radiance: [0.6, 0.72],
    transition: [25.0, 40.0],
    boxes: boxes([1.6, 0.4, 0.4]),
};

impl StudioSet {
    const fn room(self) -> &'static StudioRoom {
        match self {
            Self::Light => &LIGHT,
            Self::Dark => &DARK,
            Self::Soft => &SOFT,
        }
    }

    /// The reflectance of a ground that is as bright in the open as the room is below.
    pub(super) fn ground_reflectance(self) -> f64 {
        self.room().radiance[1] / self.room().reflected_radiance(Vec3::Y)
    }
}

impl SoftBox {
    fn at(&self, [azimuth, elevation]: [f64; 2]) -> f64 {
        let across = (azimuth - self.middle[0] + 540.0).rem_euclid(360.0) - 180.0;
        let offsets = [across, elevation - self.middle[1]];
        let falloff =
            |axis: usize| 1.0 - smooth((offsets[axis].abs() - self.half[axis]) / EDGE + 0.5);
        self.radiance * falloff(0) * falloff(1)
    }
}

/// The smoothstep from 0 to 1.
pub(super) fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

impl StudioRoom {
    /// The radiance from a direction (a unit vector).
    fn radiance(&self, direction: Vec3) -> f64 {
        let azimuth = atan2(direction.x, direction.z).to_degrees();
        let elevation = (FRAC_PI_2 - acos(direction.y.clamp(-1.0, 1.0))).to_degrees();
        let ([above, below], [horizon, width]) = (self.radiance, self.transition);
        let room = below + (above - below) * smooth((elevation - horizon) / width + 0.5);
        let boxes = self.boxes.iter();
        room + boxes.map(|one| one.at([azimuth, elevation])).sum::<f64>()
    }

    /// The radiance of a white diffuse surface with this normal: the irradiance over π.
    fn reflected_radiance(&self, normal: Vec3) -> f64 {
        let [width, height] = SIZE.map(f64::from);
        let received = |y: u32, from: Vec3| {
            self.radiance(from)
                * normal.dot(from).max(0.0)
                * sin((f64::from(y) + 0.5) / height * PI)
        };
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, direction(x, y))));
        let sum: f64 = pixels.map(|(y, from)| received(y, from)).sum();
        sum * (PI / height) * (TAU / width) / PI
    }
}

/// The direction to the centre of the key light (a unit vector).
pub(super) fn key_light_direction() -> Vec3 {
    let [azimuth, elevation] = LIGHT.boxes[0].middle.map(f64::to_radians);
    Vec3::new(
        sin(azimuth) * cos(elevation),
        sin(elevation),
        cos(azimuth) * cos(elevation),
    )
}

/// The direction of a pixel of the environment map: the centre of the map is −z, +y is up.
fn direction(x: u32, y: u32) -> Vec3 {
    let longitude = ((f64::from(x) + 0.5) / f64::from(SIZE[0]) - 0.5) * TAU;
    let colatitude = (f64::from(y) + 0.5) / f64::from(SIZE[1]) * PI;
    Vec3::new(
        sin(colatitude) * sin(longitude),
        cos(colatitude),
        -sin(colatitude) * cos(longitude),
    )
}

/// The environment map of a room.
fn picture(room: &StudioRoom) -> Image {
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| direction(x, y)));
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float"
    )]
    let bytes: Vec<u8> = pixels
        .flat_map(|direction| [(room.radiance(direction) as f32).to_le_bytes(); 3].concat())
        .collect();
    Image {
        name: String::new(),
        width: SIZE[0],
        height: SIZE[1],
        kind: Pixels::Rgb32f,
        pixels: bytes.into(),
    }
}

/// Sets a set of the studio as the environment of a scene, scaled by a factor.
pub(super) fn install(scene: &mut Scene, set: StudioSet, factor: f64) {
    let image = scene.add_image(picture(set.room()));
    scene.environment = Some(Environment {
        radiance: [factor; 3],
        image: Some(image),
        image_from_world: None,
    });
}

/// Sets the studio as a fill light for a picture with an exposure of `stops`.
pub fn fill(scene: &mut Scene, stops: f64) {
    install(scene, StudioSet::Dark, FILL * pow(2.0, -stops));
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETS: [StudioSet; 3] = [StudioSet::Light, StudioSet::Dark, StudioSet::Soft];

    #[test]
    fn no_light_surface_is_overexposed_in_any_set() {
        let normals: Vec<_> = (0..8)
            .flat_map(|y| (0..16).map(move |x| direction(4 * x, 4 * y)))
            .collect();
        for set in SETS {
            let reflected = normals
                .iter()
                .map(|normal| set.room().reflected_radiance(*normal));
            let most = reflected.fold(0.0, f64::max);
            assert!((0.9..1.25).contains(&most), "{set:?}: {most}");
            let reflectance = set.ground_reflectance();
            assert!((0.05..0.9).contains(&reflectance), "{set:?}: {reflectance}");
        }
    }

    #[test]
    fn the_front_is_well_lit_and_brightest_where_the_key_light_is() {
        for set in SETS {
            let room = set.room();
            let front = room.reflected_radiance(Vec3::Z);
            assert!((0.7..0.95).contains(&front), "{set:?}: {front}");
            let all = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| direction(x, y)));
            let brightest = all
                .max_by(|a, b| room.radiance(*a).total_cmp(&room.radiance(*b)))
                .unwrap();
            assert!(brightest.dot(key_light_direction()) > 0.9, "{set:?}");
        }
    }
}
